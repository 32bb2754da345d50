"""The brush: class, size, eraser, what the prediction shows, and the buttons of the classifier."""

from dataclasses import dataclass
from typing import Literal

from PySide6.QtCore import Signal
from PySide6.QtGui import QColor, QIcon, QPixmap
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from regolith_studio.errors import InputError
from regolith_studio.imaging.segmentation.pixel_classifier import PixelClass
from regolith_studio.imaging.segmentation.pixel_features import FeatureSettings
from regolith_studio.imaging.segmentation.strokes import ERASER
from regolith_studio.messages import N_
from regolith_studio.ui.pages.scan.controls import choice
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import heading, remark
from regolith_studio.ui.widgets.number_fields import NumbersLine
from regolith_studio.ui.widgets.number_slider import NumberSlider, NumberSpec

CLASSES = (
    PixelClass("background", False),
    PixelClass("grain", True),
    PixelClass("second mineral", True),
    PixelClass("artefact", False),
)
CLASS_COLOURS = ("#3b82f6", "#f59e0b", "#ef4444", "#a855f7")
_CLASS_NAMES = (N_("Background"), N_("Grain"), N_("Grain of a second mineral"), N_("Artefact"))
OVERLAYS = (
    ("probability", N_("Probability of grain")),
    ("class", N_("Class")),
    ("uncertainty", N_("Uncertainty")),
    ("none", N_("Nothing")),
)
SIZE = NumberSpec(N_("Size"), N_("Diameter of the brush in voxels"), 1, 30, limit=200)


@dataclass(frozen=True)
class Brush:
    """What a stroke paints: a class from 0 or the eraser, with a diameter in voxels.

    `shape` says whether the line follows the mouse (``free``), is straight (``line``), or is the diagonal
    of a rectangle (``box``).
    """

    label: int
    diameter: float
    shape: Literal["free", "line", "box"] = "free"


class BrushPanel(QWidget):
    """Chooses the brush and the overlay. ``paintingChanged`` is emitted when painting begins or ends."""

    paintingChanged = Signal(bool)  # noqa: N815
    overlayChanged = Signal(str)  # noqa: N815
    featuresChanged = Signal()  # noqa: N815
    undoRequested = Signal()  # noqa: N815
    clearRequested = Signal()  # noqa: N815
    useRequested = Signal()  # noqa: N815
    labelsRequested = Signal()  # noqa: N815
    openRequested = Signal()  # noqa: N815
    saveRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("brush")
        self.paint = QCheckBox(tr("Paint examples"))
        self.paint.setObjectName("brush_paint")
        self.paint.setToolTip(tr("Strokes in the slices train a classifier of voxels."))
        self.kind = choice("brush_class", tr("Class of the brush"), tuple(enumerate(_CLASS_NAMES)))
        self.eraser = QCheckBox(tr("Eraser"))
        self.eraser.setObjectName("brush_eraser")
        self.diameter = NumberSlider(SIZE)
        self.diameter.field.setObjectName("brush_size")
        self.diameter.setValue(4)
        self.overlay = choice("brush_overlay", tr("Prediction shown"), OVERLAYS)
        self.sigmas = NumbersLine(", ".join(f"{each:g}" for each in FeatureSettings().sigmas))
        self.sigmas.setObjectName("brush_sigmas")
        self.sigmas.setAccessibleName(tr("Widths of the features"))
        self.sigmas.setToolTip(
            tr(
                "Standard deviations of the Gaussians that the classifier sees, ascending, in voxels; the "
                "widest should be about as wide as half a grain."
            )
        )
        self.planar = QCheckBox(tr("Features within slices only"))
        self.planar.setObjectName("brush_planar")
        self.planar.setToolTip(tr("For slices that lie far apart: what is above and below does not count."))
        self._features, self._missing = FeatureSettings(), ""
        self.undo = button("brush_undo", tr("Undo stroke"), tr("Undo the last stroke (Ctrl+Z)"))
        self.clear = button("brush_clear", tr("Clear"), tr("Undo all strokes"))
        self.use = button(
            "brush_use",
            tr("Use for the grains"),
            tr("Use the classifier as the threshold of the segmentation"),
        )
        self.labels = button(
            "brush_labels",
            tr("Read labels …"),
            tr(
                "Read what was painted in another program, such as ilastik or napari, from a volume of labels"
            ),
        )
        self.browse = button("brush_open", tr("Open …"), tr("Open a classifier and use it for the grains"))
        self.save = button("brush_save", tr("Save …"), tr("Save the classifier for other scans"))
        self.state = remark()
        for number, colour in enumerate(CLASS_COLOURS):
            self.kind.setItemIcon(number, swatch(colour))
        self.kind.setCurrentIndex(1)
        self._arrange()
        self._connect()
        self.set_state(0, "", trained=False)
        self._enable()

    @property
    def brush(self) -> Brush:
        """Class and diameter of the next stroke."""
        label = ERASER if self.eraser.isChecked() else int(self.kind.currentData())
        return Brush(label, float(self.diameter.value()))

    @property
    def features(self) -> FeatureSettings:
        """What the classifier sees of a voxel."""
        return self._features

    def _take_features(self) -> None:
        """Use the widths that were typed, or say what is wrong with them."""
        try:
            sigmas = tuple(float(each) for each in self.sigmas.value().split(","))
            features = FeatureSettings(sigmas, self.planar.isChecked())
        except ValueError:
            self._show_words(tr("Widths are numbers of voxels, such as {example}.", example="1, 2, 4, 8"))
            return
        except InputError as error:
            self._show_words(str(error))
            return
        self._show_words(self._missing)
        if features != self._features:
            self._features = features
            self.featuresChanged.emit()

    def set_state(self, n_strokes: int, missing: str, *, trained: bool) -> None:
        """Show how much is painted, and what is missing for a classifier."""
        self.undo.setEnabled(n_strokes > 0)
        self.clear.setEnabled(n_strokes > 0)
        self.use.setEnabled(trained)
        self.save.setEnabled(trained)
        self._missing = missing
        self._show_words(missing)

    def _show_words(self, words: str) -> None:
        self.state.setText(words)
        self.state.setVisible(bool(words))

    def _enable(self) -> None:
        for part in (self.kind, self.eraser, self.diameter, self.overlay):
            part.setEnabled(self.paint.isChecked())

    def _connect(self) -> None:
        self.paint.toggled.connect(lambda _: self._enable())
        self.paint.toggled.connect(self.paintingChanged)
        self.overlay.currentIndexChanged.connect(lambda: self.overlayChanged.emit(self.overlay.currentData()))
        self.sigmas.editingFinished.connect(self._take_features)
        self.planar.toggled.connect(self._take_features)
        self.kind.currentIndexChanged.connect(lambda: self.eraser.setChecked(False))
        for part, signal in (
            (self.undo, self.undoRequested),
            (self.clear, self.clearRequested),
            (self.use, self.useRequested),
            (self.labels, self.labelsRequested),
            (self.browse, self.openRequested),
            (self.save, self.saveRequested),
        ):
            part.clicked.connect(signal)

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(heading(tr("Classifier")))
        rows: tuple[tuple[QWidget, ...], ...] = (
            (self.paint, self.eraser),
            (self.kind,),
            (self.diameter,),
            (self.overlay,),
            (QLabel(tr("Widths")), self.sigmas),
            (self.planar,),
            (self.undo, self.clear),
            (self.use, self.labels),
            (self.browse, self.save),
        )
        for parts in rows:
            row = QHBoxLayout()
            for part in parts:
                row.addWidget(part)
            layout.addLayout(row)
        layout.addWidget(self.state)
        layout.addStretch(1)


def button(name: str, words: str, tip: str) -> QPushButton:
    """A button with its object name and tool tip."""
    made = QPushButton(words)
    made.setObjectName(name)
    made.setToolTip(tip)
    return made


def swatch(colour: str) -> QIcon:
    """A square of one colour."""
    pixmap = QPixmap(12, 12)
    pixmap.fill(QColor(colour))
    return QIcon(pixmap)
