"""Panels of the tools on the slices: brush, classes of grains, and edits by hand."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtGui import QColor, QIcon, QPixmap
from PySide6.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QFormLayout,
    QGridLayout,
    QLabel,
    QListWidget,
    QRadioButton,
    QWidget,
)

from regolith_studio.errors import InputError
from regolith_studio.imaging.segmentation.label_edits import LabelEdit
from regolith_studio.imaging.segmentation.object_classifier import (
    OBJECT_ACTIONS,
    OBJECT_CLASSES,
    ObjectAction,
    SuspectObject,
)
from regolith_studio.imaging.segmentation.pixel_classifier import PixelClass
from regolith_studio.imaging.segmentation.pixel_features import FeatureSettings
from regolith_studio.imaging.segmentation.strokes import ERASER
from regolith_studio.messages import N_
from regolith_studio.ui.layout import STRETCH, hbox, named, vbox
from regolith_studio.ui.pages.scan.controls import button
from regolith_studio.ui.translation import number_text, tr
from regolith_studio.ui.widgets.fields import NumberSlider, NumbersLine, NumberSpec, choice
from regolith_studio.ui.widgets.labels import heading, hint_label
from regolith_studio.ui.widgets.text_table import TextTable

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


class TrainingPanel(QWidget):
    """The buttons of a classifier that is trained by examples, and what it lacks."""

    def __init__(self, name: str, undo: tuple[str, str], tips: tuple[str, str, str]) -> None:
        super().__init__()
        self.setObjectName(name)
        self.undo = button(f"{name}_undo", *undo)
        self.clear, self.browse, self.save = (
            button(f"{name}_{key}", words, tip)
            for key, words, tip in zip(
                ("clear", "open", "save"), (tr("Clear"), tr("Open …"), tr("Save …")), tips, strict=True
            )
        )
        self.state = hint_label()

    def show_missing(self, words: str) -> None:
        """Say what is missing for a classifier, or nothing."""
        self.state.setText(words)
        self.state.setVisible(bool(words))


class BrushPanel(TrainingPanel):
    """Chooses the brush and the overlay."""

    featuresChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__(
            "brush",
            (tr("Undo stroke"), tr("Undo the last stroke (Ctrl+Z)")),
            (
                tr("Undo all strokes"),
                tr("Open a classifier and use it for the grains"),
                tr("Save the classifier for other scans"),
            ),
        )
        self.paint = QCheckBox(tr("Paint examples"))
        self.paint.setObjectName("brush_paint")
        self.paint.setToolTip(tr("Strokes in the slices train a classifier of voxels."))
        self.kind = choice("brush_class", tr("Class of the brush"), tuple(enumerate(_CLASS_NAMES)))
        self.eraser = named(QCheckBox(tr("Eraser")), "brush_eraser")
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
        for number, colour in enumerate(CLASS_COLOURS):
            self.kind.setItemIcon(number, swatch(colour))
        self.kind.setCurrentIndex(1)
        self._arrange()
        self._connect()
        self.set_state(0, "", trained=False)
        self._enable()

    @property
    def brush(self) -> Brush:
        label = ERASER if self.eraser.isChecked() else self.kind.value()
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
            self.show_missing(tr("Widths are numbers of voxels, such as {example}.", example="1, 2, 4, 8"))
            return
        except InputError as error:
            self.show_missing(str(error))
            return
        self.show_missing(self._missing)
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
        self.show_missing(missing)

    def _enable(self) -> None:
        for part in (self.kind, self.eraser, self.diameter, self.overlay):
            part.setEnabled(self.paint.isChecked())

    def _connect(self) -> None:
        self.paint.toggled.connect(lambda _: self._enable())
        self.sigmas.editingFinished.connect(self._take_features)
        self.planar.toggled.connect(self._take_features)
        self.kind.currentIndexChanged.connect(lambda: self.eraser.setChecked(False))

    def _arrange(self) -> None:
        vbox(
            heading(tr("Classifier")),
            hbox(self.paint, self.eraser),
            self.kind,
            self.diameter,
            self.overlay,
            hbox(QLabel(tr("Widths")), self.sigmas),
            self.planar,
            hbox(self.undo, self.clear),
            hbox(self.use, self.labels),
            hbox(self.browse, self.save),
            self.state,
            STRETCH,
            parent=self,
        )


def swatch(colour: str) -> QIcon:
    pixmap = QPixmap(12, 12)
    pixmap.fill(QColor(colour))
    return QIcon(pixmap)


OBJECT_COLOURS = ("#22c55e", "#f59e0b", "#d946ef")
_OBJECT_CLASSES = (N_("Grain"), N_("Several grains"), N_("Artefact"))
_PLURALS = (N_("Grains"), N_("Several grains"), N_("Artefacts"))
_ACTION_NAMES = (N_("Keep"), N_("Split again"), N_("Drop"))


class ObjectsPanel(TrainingPanel):
    """Chooses the class of a click and the actions."""

    def __init__(self) -> None:
        super().__init__(
            "objects",
            (tr("Undo"), tr("Undo the last step (Ctrl+Z)")),
            (
                tr("Remove all examples"),
                tr("Open an object classifier and apply it"),
                tr("Save the object classifier for other scans"),
            ),
        )
        self.mark = named(
            QCheckBox(tr("Mark examples")),
            "objects_mark",
            tip=tr("A click on an object makes it an example of a class; all others are classified."),
        )
        self.kind = choice(
            "objects_class", tr("Class of the next example"), tuple(enumerate(_OBJECT_CLASSES))
        )
        rows = tuple(zip(OBJECT_ACTIONS, _ACTION_NAMES, strict=True))
        self.action_boxes = tuple(
            choice(f"objects_action_{number}", tr("Action on them"), rows)
            for number in range(len(OBJECT_CLASSES))
        )
        self.counts = tuple(QLabel() for _ in OBJECT_CLASSES)
        for number, colour in enumerate(OBJECT_COLOURS):
            self.kind.setItemIcon(number, swatch(colour))
            self.action_boxes[number].setCurrentIndex(number)
        self.apply = QCheckBox(tr("Apply to the grains"))
        self.apply.setObjectName("objects_apply")
        self.apply.setToolTip(tr("Keep, split or drop the grains by their class"))
        self._arrange()
        self.mark.toggled.connect(self.kind.setEnabled)
        self.set_state(found=False, trained=False, applied=False, can_undo=False)
        self.set_counts({}, "")

    def action_of_each(self) -> tuple[ObjectAction, ...]:
        return tuple(box.value() for box in self.action_boxes)

    def set_actions(self, actions: tuple[ObjectAction, ...]) -> None:
        """Show other actions without emitting a signal."""
        for box, action in zip(self.action_boxes, actions, strict=True):
            box.setValue(action)

    def set_state(self, *, found: bool, trained: bool, applied: bool, can_undo: bool) -> None:
        """Enable what can be done; `found` says whether there are grains."""
        self.mark.setEnabled(found)
        self.kind.setEnabled(found and self.mark.isChecked())
        self.undo.setEnabled(can_undo)
        self.clear.setEnabled(trained or can_undo)
        self.apply.setEnabled(trained)
        self.save.setEnabled(trained)
        with QSignalBlocker(self.apply):
            self.apply.setChecked(applied)

    def set_counts(self, counts: Mapping[str, int], missing: str) -> None:
        """Show how many objects each class has, and what is missing for a classifier."""
        for words, name, label in zip(_PLURALS, OBJECT_CLASSES, self.counts, strict=True):
            count = counts.get(name)
            label.setText(tr(words) if count is None else f"{tr(words)}: {count}")
        self.show_missing(missing)

    def _arrange(self) -> None:
        form = QFormLayout()
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        for label, box in zip(self.counts, self.action_boxes, strict=True):
            form.addRow(label, box)
        vbox(
            heading(tr("Object classifier")),
            *(self.mark, self.kind, self.state, form, self.apply),
            hbox(self.undo, self.clear),
            hbox(self.browse, self.save),
            STRETCH,
            parent=self,
        )


NO_TOOL = ""
TOOLS = (
    (
        NO_TOOL,
        N_("Inspect"),
        N_("Click to move the slices."),
    ),
    ("merge", N_("Merge"), N_("Click two grains that are one.")),
    ("delete", N_("Delete"), N_("Click a grain.")),
    ("seeds", N_("Split by seeds"), N_("Click two places in a grain that are two grains.")),
    ("cut", N_("Split by a line"), N_("Draw a line across a grain.")),
    (
        "fill",
        N_("Fill"),
        N_("Click a grain to fill what it encloses in the slices of that view."),
    ),
    ("paint", N_("Paint"), N_("Draw from a grain to extend it, or from a free place for a new grain.")),
    ("erase", N_("Erase"), N_("Draw over grains to free their voxels.")),
)
BALL_SIZE = NumberSpec(
    N_("Size"), N_("Diameter of the ball that paints and erases, in voxels"), 1, 30, limit=200
)
BRUSHED = ("paint", "erase")
"""Tools whose mouse is a ball."""
_DONE = {
    "merge": N_("{number}. Grains merged at {place}"),
    "delete": N_("{number}. Grain deleted at {place}"),
    "seeds": N_("{number}. Grain split by seeds at {place}"),
    "cut": N_("{number}. Grain split by a line at {place}"),
    "fill": N_("{number}. Grain filled at {place}"),
    "paint": N_("{number}. Voxels painted at {place}"),
    "erase": N_("{number}. Voxels erased at {place}"),
}


_REASONS = (N_("concave"), N_("size"))
SUSPECT_HEADINGS = (N_("Grain"), N_("Voxels"), N_("Solidity"), N_("Unusual"))


class SuspectsTable(TextTable):
    """Grains unlike the others, the most unusual first; a chosen one is shown in the slices."""

    grainChosen = Signal(int, object)  # noqa: N815
    """Its label and its box."""

    def __init__(self) -> None:
        super().__init__("scan_suspects", tr("Suspect grains"), [tr(each) for each in SUSPECT_HEADINGS])
        self.setMinimumHeight(120)
        self.setToolTip(
            tr("Grains whose solidity (volume over that of the convex hull) is low or whose size is unusual")
        )
        self._objects: tuple[SuspectObject, ...] = ()
        self.chosen.connect(
            lambda row: self.grainChosen.emit(self._objects[row].label, self._objects[row].box)
        )

    def show_objects(self, objects: Sequence[SuspectObject]) -> None:
        self._objects = tuple(objects)
        rows = [
            (
                str(each.label),
                number_text(each.n_voxels, ","),
                number_text(each.solidity, ".3f"),
                tr(_REASONS[each.by_size]),
            )
            for each in objects
        ]
        tip = tr("Choose it to see it in the slices.")
        self.set_rows(rows, [tip] * len(rows))

    def clear(self) -> None:
        self.show_objects(())


class EditsPanel(QWidget):
    """Chooses the tool; ``toolChanged`` tells its kind."""

    toolChanged = Signal(str)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("edits")
        self._group = QButtonGroup(self)
        self.tools = {}
        for kind, words, tip in TOOLS:
            made = named(QRadioButton(tr(words)), f"edit_{kind or 'look'}", tip=tr(tip))
            self._group.addButton(made)
            self.tools[kind] = made
        self.tools[NO_TOOL].setChecked(True)
        self.diameter = NumberSlider(BALL_SIZE)
        self.diameter.field.setObjectName("edit_size")
        self.diameter.setValue(6)
        self.hint = hint_label()
        self.list = named(QListWidget(), spoken=tr("Corrections so far"))
        self.list.setMinimumHeight(80)
        self.suspects = SuspectsTable()
        self.undo = button("edit_undo", tr("Undo"), tr("Undo the last step (Ctrl+Z)"))
        self.redo = button("edit_redo", tr("Redo"), tr("Redo the last step (Ctrl+Shift+Z)"))
        self._arrange()
        for made in self.tools.values():
            made.toggled.connect(self._chosen)
        self.set_state(found=False, can_undo=False, can_redo=False)
        self._chosen(True)

    @property
    def tool(self) -> str:
        """Kind of the edit that the mouse makes; empty for none."""
        return next(kind for kind, made in self.tools.items() if made.isChecked())

    def set_state(self, *, found: bool, can_undo: bool, can_redo: bool) -> None:
        """Enable what can be done; `found` says whether there are grains."""
        for kind, made in self.tools.items():
            made.setEnabled(found or kind == NO_TOOL)
        self.diameter.setEnabled(found)
        self.undo.setEnabled(can_undo)
        self.redo.setEnabled(can_redo)

    def set_edits(self, edits: Sequence[LabelEdit]) -> None:
        self.list.clear()
        for number, edit in enumerate(edits, start=1):
            place = ", ".join(str(at + 1) for at in edit.points[0])
            self.list.addItem(tr(_DONE[edit.kind], number=number, place=place))
        self.list.scrollToBottom()

    def show_hint(self, words: str = "") -> None:
        """Say what to do next; without words, what the tool does."""
        self.hint.setText(words or next(tr(tip) for kind, _, tip in TOOLS if kind == self.tool))

    def _chosen(self, on: bool) -> None:
        if on:
            self.show_hint()
            self.toolChanged.emit(self.tool)

    def _arrange(self) -> None:
        grid = QGridLayout()
        for number, made in enumerate(self.tools.values()):
            grid.addWidget(made, number // 2, number % 2)
        vbox(
            heading(tr("Corrections by hand")),
            *(grid, self.diameter, self.hint),
            heading(tr("Suspect grains")),
            (self.suspects, 1),
            (self.list, 1),
            hbox(self.undo, self.redo),
            parent=self,
        )
