"""Settings of the region of interest and the segmentation: denoising, threshold, splitting, surface."""

import dataclasses
from collections.abc import Sequence
from typing import Any, cast

from PySide6.QtCore import QEvent, QSignalBlocker, Signal
from PySide6.QtGui import QStandardItemModel
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.errors import InputError
from regolith_studio.imaging.extraction import voxel_diameter
from regolith_studio.imaging.segmentation.morphology import CleaningSettings
from regolith_studio.imaging.segmentation.pixel_classifier import TrainingSet
from regolith_studio.imaging.segmentation.segment import GrainsAtHeight, SegmentationSettings
from regolith_studio.jobs.extraction_settings import GrainSettings
from regolith_studio.messages import N_
from regolith_studio.readers.volumes.region import RegionSettings
from regolith_studio.ui.layout import Collapsible
from regolith_studio.ui.translation import number_text, tr, translate
from regolith_studio.ui.widgets.fixed_height_text import FixedHeightText
from regolith_studio.ui.widgets.forms import SettingsForm
from regolith_studio.ui.widgets.labels import heading, remark
from regolith_studio.ui.widgets.numbers import DecimalField, NumberSlider, NumberSpec, align_labels

DENOISE = (
    ("median", N_("Median of 27 voxels")),
    ("gaussian", N_("Gaussian (fast)")),
    ("non-local-means", N_("Non-local means (slow)")),
    ("none", N_("None")),
)
THRESHOLD = (
    ("otsu", N_("Otsu")),
    ("multi-otsu", N_("Multi-Otsu, three classes")),
    ("manual", N_("By hand: drag the line")),
    ("probability", N_("Probability map")),
    ("classifier", N_("Classifier from examples")),
)
SURFACE = (("grey", N_("Grey values")), ("mask", N_("Mask")))
H_MAXIMA = NumberSpec(
    "h",
    N_("Height of a maximum that is a grain of its own, in voxels"),
    0.0,
    6.0,
    0.1,
    limit=50.0,
    tip=N_(
        "Height above which a maximum of the distance map is a grain of its own. Increase it if "
        "grains are split, reduce it if grains stay connected."
    ),
)
OPENING = NumberSpec(
    N_("Opening"), N_("Opening"), 0, 5, tip=N_("Removes specks and thin bridges, in voxels.")
)
CLOSING = NumberSpec(N_("Closing"), N_("Closing"), 0, 5, tip=N_("Closes cracks and thin gaps, in voxels."))
MIN_VOXELS = NumberSpec(
    N_("Smallest"),
    N_("Minimum number of voxels of a grain"),
    0,
    2000,
    1,
    limit=10_000_000,
    tip=N_("Grains of fewer voxels are left out; below 12 voxels in diameter shapes are coarse."),
)

_PROBABLE = ("probability", "classifier")
"""Thresholds that are probabilities."""
_LABEL_WIDTH = 62
"""Minimum pixels before the sliders."""


class SegmentationControls(QWidget):
    """Edits a :class:`GrainSettings`. ``valueChanged`` is emitted for changes by the user only."""

    valueChanged = Signal(object)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("segmentation")
        self._recipe = GrainSettings()
        self._classifier: TrainingSet | None = None
        self.denoise = choice("denoise", tr("Denoise"), DENOISE)
        self.threshold = choice("threshold", tr("Threshold"), THRESHOLD)
        self.level, self.low = DecimalField(), DecimalField()
        self.boundary = choice(
            "boundary", tr("Boundary"), ((1, N_("dark | middle")), (2, N_("middle | bright")))
        )
        self.dark = _check("dark", tr("Grains are dark"), tr("Grains are darker than what is between them."))
        self.split = _check(
            "split", tr("Separate touching grains"), tr("Otherwise each connected body is one grain.")
        )
        self.pores = _check(
            "fill_pores", tr("Fill closed pores"), tr("Pores enclosed by a grain are counted as grain.")
        )
        self.border = _check(
            "exclude_border",
            tr("Leave out grains at the border"),
            tr("They are cut by the border. The others then have larger weights (Miles-Lantuéjoul)."),
        )
        self.opening, self.closing = _slider("opening", OPENING), _slider("closing", CLOSING)
        self.h_maxima, self.least = _slider("h_maxima", H_MAXIMA), _slider("min_voxels", MIN_VOXELS)
        self._sliders = (self.opening, self.closing, self.h_maxima, self.least)
        align_labels(self._sliders, _LABEL_WIDTH)
        self.surface = choice("surface", tr("Surface"), SURFACE)
        self.surface.setToolTip(
            tr(
                "The grey values around a grain give its volume more accurately than its mask, "
                "also in blurred scans."
            )
        )
        self.region = SettingsForm(RegionSettings)
        self.draw_box = QPushButton(tr("Draw the region"))
        self.draw_box.setObjectName("draw_region")
        self.draw_box.setCheckable(True)
        self.draw_box.setToolTip(tr("Draw a box in a slice; what is outside of it is left out."))
        self.diameter, self.region_error, self.heights = remark(), remark(), remark()
        self.region_fold = Collapsible(
            tr("Region of interest"), self.region, self.draw_box, self.region_error
        )
        self._arrange()
        self._connect()
        self.setValue(self._recipe)

    def value(self) -> GrainSettings:
        """The settings."""
        chosen = str(self.threshold.currentData())
        method = "probability" if chosen == "classifier" else chosen
        before = self._recipe.segmentation
        segmentation = SegmentationSettings(
            dataclasses.replace(before.denoise, method=self.denoise.currentData()),
            dataclasses.replace(
                before.threshold,
                method=method,  # type: ignore[arg-type]  # one of the rows
                value=self.level.value() if method in ("manual", "probability") else 0.5,
                boundary=int(self.boundary.currentData()),
                dark=self.dark.isChecked(),
                low=self.low.value() if method == "probability" and not self.dark.isChecked() else 0.0,
            ),
            CleaningSettings(
                int(self.opening.value()),
                int(self.closing.value()),
                self.pores.isChecked(),
                min(CleaningSettings.min_voxels, int(self.least.value())),
            ),
            dataclasses.replace(
                before.splitting, enabled=self.split.isChecked(), h_maxima=float(self.h_maxima.value())
            ),
            classifier=self._classifier if chosen == "classifier" else None,
        )
        extraction = dataclasses.replace(
            self._recipe.extraction,
            exclude_border=self.border.isChecked(),
            min_voxels=int(self.least.value()),
            fill_pores=self.pores.isChecked(),
            surface=self.surface.currentData(),
        )
        return GrainSettings(segmentation, extraction, self._recipe.region)

    def setValue(self, recipe: GrainSettings) -> None:
        """Show other settings without emitting a signal."""
        self._recipe = recipe
        how, what = recipe.segmentation, recipe.extraction
        self._set_classifier(how.classifier or self._classifier)
        method = "classifier" if how.classifier is not None else how.threshold.method
        for box, value in (
            (self.denoise, how.denoise.method),
            (self.threshold, method),
            (self.boundary, how.threshold.boundary),
            (self.surface, what.surface),
        ):
            with QSignalBlocker(box):
                box.setCurrentIndex(max(0, box.findData(value)))
        for check, on in (
            (self.dark, how.threshold.dark),
            (self.split, how.splitting.enabled),
            (self.pores, how.cleaning.fill_pores),
            (self.border, what.exclude_border),
        ):
            with QSignalBlocker(check):
                check.setChecked(on)
        self._show_level(how.threshold.value)
        self._show_which()
        with QSignalBlocker(self.low):
            self.low.setValue(how.threshold.low)
        self.opening.setValue(how.cleaning.opening)
        self.closing.setValue(how.cleaning.closing)
        self.h_maxima.setValue(how.splitting.h_maxima)
        self.least.setValue(what.min_voxels)
        self.region.setValue(dataclasses.asdict(recipe.region))
        self.region_error.hide()
        if recipe.region != RegionSettings():
            self.region_fold.set_open(True)
        self._show_which()

    def set_level(self, level: float) -> None:
        """Set a manual threshold: a grey value, or for a probability map its share."""
        method = self.threshold.currentData()
        method = method if method in ("probability", "classifier") else "manual"
        with QSignalBlocker(self.threshold):
            self.threshold.setCurrentIndex(self.threshold.findData(method))
        self._show_level(level)
        self._changed()

    def set_classifier(self, training: TrainingSet | None) -> None:
        """Offer a classifier as a threshold; if it is chosen already, the settings change."""
        used = self.threshold.currentData() == "classifier"
        self._set_classifier(training)
        if used:
            self._changed()

    def set_crop(self, crop: str) -> None:
        """Take another region of interest, as if it had been entered."""
        changes = dataclasses.asdict(self._recipe.region) | {"crop": crop}
        self.region.setValue(changes)
        self._region_changed(changes)

    def use_classifier(self) -> None:
        """Choose the classifier as the threshold."""
        self.threshold.setCurrentIndex(self.threshold.findData("classifier"))

    def _set_classifier(self, training: TrainingSet | None) -> None:
        self._classifier = training
        row = self.threshold.findData("classifier")
        item = cast(QStandardItemModel, self.threshold.model()).item(row)
        item.setEnabled(training is not None)
        if training is None and self.threshold.currentIndex() == row:
            with QSignalBlocker(self.threshold):
                self.threshold.setCurrentIndex(0)

    def show_automatic_level(self, level: float | None) -> None:
        """Show the value of an automatic threshold."""
        if level is not None and self.threshold.currentData() in ("otsu", "multi-otsu"):
            self._show_level(level)

    def show_heights(self, found: Sequence[GrainsAtHeight]) -> None:
        """Show how many grains the preview has at some values of h; nothing for none."""
        self.heights.setVisible(bool(found))
        counts = (
            f"{number_text(each.h_maxima, 'g')}\N{NO-BREAK SPACE}→\N{NO-BREAK SPACE}{each.n_grains}"
            for each in found
        )
        self.heights.setText(tr("Grains in the frame by h: {counts}", counts=" · ".join(counts)))

    def set_kind(self, kind: str) -> None:
        """Disable the settings of the segmentation for a volume of labels."""
        for part in (
            self.denoise,
            self.threshold,
            self.level,
            self.low,
            self.boundary,
            self.dark,
            self.split,
            self.opening,
            self.closing,
            self.h_maxima,
            self.surface,
        ):
            part.setEnabled(kind == "grey")
        if kind == "grey":
            self._show_which()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            align_labels(self._sliders, _LABEL_WIDTH)

    def _show_level(self, level: float) -> None:
        with QSignalBlocker(self.level):
            self.level.setValue(level)

    def _show_which(self) -> None:
        method = self.threshold.currentData()
        with QSignalBlocker(self.level):
            self.level.setRange(*((0.01, 0.99) if method in _PROBABLE else (-1e9, 1e9)))
        with QSignalBlocker(self.low):
            self.low.setRange(0.0, max(0.0, self.level.value() - 0.01) if method in _PROBABLE else 0.0)
        self.low.setEnabled(method in _PROBABLE and not self.dark.isChecked())
        self.boundary.setEnabled(method == "multi-otsu")
        self.level.setEnabled(method in ("manual", *_PROBABLE))
        self.denoise.setEnabled(self.threshold.isEnabled() and method not in _PROBABLE)
        self.h_maxima.setEnabled(self.split.isChecked())
        least = int(self.least.value())
        self.diameter.setText(
            tr(
                "{least} voxels are a ball of {diameter:.1f} voxels in diameter.",
                least=least,
                diameter=voxel_diameter(least),
            )
        )

    def _changed(self) -> None:
        self._show_which()
        self.valueChanged.emit(self.value())

    def _region_changed(self, changes: dict[str, Any]) -> None:
        """Take the region that was entered, or show why it is none."""
        try:
            self._recipe = dataclasses.replace(self._recipe, region=RegionSettings(**changes))
        except InputError as error:
            self.region_error.setText(translate(str(error)))
            self.region_error.show()
            self.region_fold.set_open(True)
            return
        self.region_error.hide()
        self._changed()

    def _threshold_chosen(self) -> None:
        if self.threshold.currentData() in _PROBABLE:
            self._show_level(0.5)
        self._changed()

    def _connect(self) -> None:
        self.threshold.currentIndexChanged.connect(self._threshold_chosen)
        for box in (self.denoise, self.boundary, self.surface):
            box.currentIndexChanged.connect(self._changed)
        for check in (self.dark, self.split, self.pores, self.border):
            check.toggled.connect(self._changed)
        for slider in self._sliders:
            slider.valueChanged.connect(lambda _: self._changed())
        for field in (self.level, self.low):
            field.valueChanged.connect(self._changed)
        self.region.valueChanged.connect(self._region_changed)

    def _arrange(self) -> None:
        self.level.setObjectName("level")
        self.level.setAccessibleName(tr("Grey level at which grains begin"))
        self.level.setRange(-1e9, 1e9)
        self.low.setObjectName("low")
        self.low.setAccessibleName(tr("Lower probability of a hysteresis"))
        self.low.setSingleStep(0.05)
        self.low.setToolTip(
            tr(
                "Hysteresis: voxels from this probability on belong to a grain if they are connected to some "
                "from the level on; 0 for none."
            )
        )
        for field in (self.level, self.low):
            field.setDecimals(2)
            field.setKeyboardTracking(False)
        self.level.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)  # not for 1e9
        levels = QHBoxLayout()
        levels.setSpacing(6)
        levels.addWidget(self.level, 3)
        levels.addWidget(QLabel(tr("to")))
        levels.addWidget(self.low, 2)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.region_fold)
        layout.addWidget(heading(tr("Segmentation")))
        layout.addLayout(
            _form(
                (
                    (tr("Denoise"), self.denoise),
                    (tr("Threshold"), self.threshold),
                    (tr("Level"), levels),
                    (tr("Boundary"), self.boundary),
                )
            )
        )
        for part in (self.dark, self.opening, self.closing, self.pores):
            layout.addWidget(part)
        layout.addSpacing(4)
        layout.addWidget(heading(tr("Separation of grains")))
        layout.addWidget(self.split)
        layout.addWidget(self.h_maxima)
        layout.addWidget(FixedHeightText((self.heights,)))
        self.heights.hide()
        layout.addSpacing(4)
        layout.addWidget(heading(tr("Selection of grains")))
        layout.addWidget(self.border)
        layout.addWidget(self.least)
        layout.addWidget(self.diameter)
        layout.addLayout(_form(((tr("Surface"), self.surface),)))


def _check(name: str, words: str, tip: str) -> QCheckBox:
    box = QCheckBox(words)
    box.setObjectName(name)
    box.setToolTip(tip)
    return box


def _slider(name: str, spec: NumberSpec) -> NumberSlider:
    slider = NumberSlider(spec)
    slider.field.setObjectName(name)
    slider.slider.setObjectName(f"{name}_slider")
    return slider


def _form(rows: Sequence[tuple[str, QWidget | QHBoxLayout]]) -> QFormLayout:
    form = QFormLayout()
    form.setVerticalSpacing(4)
    form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
    for words, part in rows:
        form.addRow(words, part)
    return form


def choice(name: str, words: str, rows: Sequence[tuple[Any, str]]) -> QComboBox:
    """A combo box of values and labels; `words` is the accessible name. Translates the labels only."""
    box = QComboBox()
    box.setObjectName(name)
    box.setAccessibleName(words)
    for key, label in rows:
        box.addItem(tr(label), key)
    return box
