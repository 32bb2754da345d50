"""Steps of the workflow, and settings of region, denoising, threshold, splitting and surface."""

from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any, cast

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtGui import QStandardItemModel
from PySide6.QtWidgets import QCheckBox, QPushButton, QSizePolicy, QWidget

from regolith_studio.errors import InputError
from regolith_studio.imaging.extraction import voxel_diameter
from regolith_studio.imaging.segmentation.pixel_classifier import TrainingSet
from regolith_studio.imaging.segmentation.segment import GrainsAtHeight, Segmentation, SegmentationSettings
from regolith_studio.imaging.settings import (
    THRESHOLDS,
    CleaningSettings,
    DenoiseSettings,
    ExtractionSettings,
    SplittingSettings,
    ThresholdSettings,
)
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs.extraction_settings import GrainSettings
from regolith_studio.jobs.scan_jobs import FirstLook, Scan
from regolith_studio.messages import N_
from regolith_studio.readers.volumes.region import RegionSettings
from regolith_studio.ui.layout import Collapsible, hbox, named, vbox
from regolith_studio.ui.result_card import ResultRecord, ResultState, ResultView
from regolith_studio.ui.translation import number_text, tr, tr_count, translate
from regolith_studio.ui.widgets.fields import ChoiceBox, DecimalField
from regolith_studio.ui.widgets.forms import SettingsForm, form_layout
from regolith_studio.ui.widgets.labels import FixedHeightText, WrappedLabel, heading, hint_label

CLASSIFIER = {"classifier": N_("Classifier from examples")}
"""A threshold of the window only: the probability map of a classifier that has been trained on the scan."""
BOUNDARIES = {1: N_("dark | middle"), 2: N_("middle | bright")}
_PROBABLE = ("probability", "classifier")
"""Thresholds that are probabilities."""


class SegmentationControls(QWidget):
    """Edits a :class:`GrainSettings`. ``valueChanged`` is emitted for changes by the user only."""

    valueChanged = Signal(object)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("segmentation")
        self._recipe = GrainSettings()
        self._classifier: TrainingSet | None = None
        self._grey, self._parting, self._selection = form_layout(), form_layout(), form_layout()
        self._denoise = SettingsForm(DenoiseSettings, names=("method",), prefix="denoise_", rows=self._grey)
        self._threshold = SettingsForm(
            ThresholdSettings,
            {"method": THRESHOLDS | CLASSIFIER, "boundary": BOUNDARIES},
            ("method", "value", "low", "boundary", "dark"),
            "threshold_",
            self._grey,
        )
        cleaning = ("opening", "closing", "fill_pores")
        self._cleaning = SettingsForm(CleaningSettings, None, cleaning, "cleaning_", self._grey)
        splitting = ("enabled", "h_maxima")
        self._splitting = SettingsForm(SplittingSettings, None, splitting, "splitting_", self._parting)
        extraction = ("exclude_border", "min_voxels", "surface")
        self._extraction = SettingsForm(ExtractionSettings, None, extraction, "extraction_", self._selection)
        self._forms = (self._denoise, self._threshold, self._cleaning, self._splitting, self._extraction)
        self.denoise, self.surface = self._denoise.editors["method"], self._extraction.editors["surface"]
        self.threshold: ChoiceBox = self._threshold.editors["method"]
        self.level: DecimalField = self._threshold.editors["value"]
        self.low: DecimalField = self._threshold.editors["low"]
        self.boundary, self.dark = (self._threshold.editors[name] for name in ("boundary", "dark"))
        self.split: QCheckBox = self._splitting.editors["enabled"]
        self.h_maxima, self.least = (
            self._splitting.editors["h_maxima"],
            self._extraction.editors["min_voxels"],
        )
        self.region = SettingsForm(RegionSettings)
        self.draw_box = QPushButton(tr("Draw the region"))
        self.draw_box.setObjectName("draw_region")
        self.draw_box.setToolTip(tr("Draw a box in a slice; what is outside of it is left out."))
        self.draw_box.setCheckable(True)
        self.diameter, self.region_error, self.heights = hint_label(), hint_label(), hint_label()
        self.region_fold = Collapsible(
            tr("Region of interest"), self.region, self.draw_box, self.region_error
        )
        self._arrange()
        self._connect()
        self.setValue(self._recipe)

    def value(self) -> GrainSettings:
        how, method = self._recipe.segmentation, self.threshold.value()
        threshold = self._threshold.values()
        if method in CLASSIFIER:
            threshold["method"] = "probability"
        if method not in ("manual", *_PROBABLE):
            threshold["value"] = ThresholdSettings.value
        if method not in _PROBABLE or threshold["dark"]:
            threshold["low"] = 0.0
        cleaning, chosen = self._cleaning.values(), self._extraction.values()
        segmentation = SegmentationSettings(
            replace(how.denoise, **self._denoise.values()),
            replace(how.threshold, **threshold),
            CleaningSettings(**cleaning, min_voxels=min(CleaningSettings.min_voxels, chosen["min_voxels"])),
            replace(how.splitting, **self._splitting.values()),
            classifier=self._classifier if method in CLASSIFIER else None,
        )
        extraction = replace(self._recipe.extraction, **chosen, fill_pores=cleaning["fill_pores"])
        return GrainSettings(segmentation, extraction, self._recipe.region)

    def setValue(self, recipe: GrainSettings) -> None:
        """Show other settings without emitting a signal."""
        self._recipe = recipe
        how = recipe.segmentation
        self._set_classifier(how.classifier or self._classifier)
        threshold = asdict(how.threshold)
        if how.classifier is not None:
            threshold["method"] = next(iter(CLASSIFIER))
        self._denoise.setValue(asdict(how.denoise))
        self._threshold.setValue(threshold)
        self._show_which()  # ranges, which those of the values before have cut
        self._threshold.setValue(threshold)
        self._cleaning.setValue(asdict(how.cleaning))
        self._splitting.setValue(asdict(how.splitting))
        self._extraction.setValue(asdict(recipe.extraction))
        self.region.setValue(asdict(recipe.region))
        self.region_error.hide()
        if recipe.region != RegionSettings():
            self.region_fold.set_open(True)
        self._show_which()

    def set_level(self, level: float) -> None:
        """Set a manual threshold: a grey value, or for a probability map its share."""
        method = self.threshold.value()
        method = method if method in ("probability", "classifier") else "manual"
        self.threshold.setValue(method)
        self._show_level(level)
        self._changed()

    def set_classifier(self, training: TrainingSet | None) -> None:
        """Offer a classifier as a threshold; if it is chosen already, the settings change."""
        used = self.threshold.value() == "classifier"
        self._set_classifier(training)
        if used:
            self._changed()

    def set_crop(self, crop: str) -> None:
        """Take another region of interest, as if it had been entered."""
        changes = asdict(self._recipe.region) | {"crop": crop}
        self.region.setValue(changes)
        self._region_changed(changes)

    def use_classifier(self) -> None:
        """Choose the classifier as the threshold."""
        self.threshold.choose("classifier")

    def _set_classifier(self, training: TrainingSet | None) -> None:
        self._classifier = training
        row = self.threshold.findData("classifier")
        item = cast(QStandardItemModel, self.threshold.model()).item(row)
        item.setEnabled(training is not None)
        if training is None and self.threshold.currentIndex() == row:
            with QSignalBlocker(self.threshold):
                self.threshold.setCurrentIndex(0)

    def show_automatic_level(self, level: float | None) -> None:
        if level is not None and self.threshold.value() in ("otsu", "multi-otsu"):
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
        grey = (*self._denoise.editors.values(), *self._threshold.editors.values())
        shapes = (self._cleaning.editors["opening"], self._cleaning.editors["closing"])
        for part in (*grey, *shapes, *self._splitting.editors.values(), self.surface):
            part.setEnabled(kind == "grey")
        if kind == "grey":
            self._show_which()
        else:
            self.show_heights(())

    def _show_level(self, level: float) -> None:
        with QSignalBlocker(self.level):
            self.level.setValue(level)

    def _show_which(self) -> None:
        method = self.threshold.value()
        was_probable = self.level.maximum() < 1.0
        with QSignalBlocker(self.level):
            self.level.setRange(*((0.01, 0.99) if method in _PROBABLE else (-1e9, 1e9)))
            if method in _PROBABLE and not was_probable:
                self.level.setValue(0.5)
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
                "{least} voxels = sphere of {diameter:.1f} voxels in diameter",
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
            self._recipe = replace(self._recipe, region=RegionSettings(**changes))
        except InputError as error:
            self.region_error.setText(translate(str(error)))
            self.region_error.show()
            self.region_fold.set_open(True)
            return
        self.region_error.hide()
        self._changed()

    def _connect(self) -> None:
        for form in self._forms:
            form.valueChanged.connect(self._changed)
        self.region.valueChanged.connect(self._region_changed)

    def _arrange(self) -> None:
        self.level.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)  # not for 1e9
        layout = vbox(
            self.region_fold,
            heading(tr("Segmentation")),
            self._grey,
            4,
            heading(tr("Separation of grains")),
            self._parting,
            FixedHeightText((self.heights,)),
            parent=self,
        )
        self.heights.hide()
        layout.addSpacing(4)
        layout.addWidget(heading(tr("Selection of grains")))
        self._selection.insertRow(2, self.diameter)
        layout.addLayout(self._selection)


def button(name: str, words: str, tip: str) -> QPushButton:
    return named(QPushButton(words), name, tip=tip)


_DENSEST, _LARGEST = 0.7, 0.4
"""Plausible limits of the volume fraction of all grains, and of a single grain."""


class WorkflowPanel(QWidget):
    """A button for each step, enabled when its input is available."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("scan_steps")
        self.browse = button(
            "scan_open", tr("Open volume …"), tr("Open a CT volume of grey values or labels")
        )
        self.sample = button(
            "scan_sample", tr("Sample scan"), tr("Open the scan that ships with the program")
        )
        captions = (tr("Grains"), tr("Share of the volume"))
        self.card = ResultView("scan_grains", captions, tr("Find all grains"), tr("Find again"))
        self.search, self.found = self.card.button, self.card.sentence
        self.save = button(
            "scan_save_labels",
            tr("Save labels …"),
            tr("Write the volume of labels and a table of them for other programs"),
        )
        self.convert = button(
            "scan_make", tr("Make particles"), tr("Contour each grain and open it as a particle")
        )
        self.show_them = button("scan_show", tr("Show particles"), tr("Go to the table of particles"))
        self.volume, self.made = _words(), _words()
        kept = self.show_them.sizePolicy()
        kept.setRetainSizeWhenHidden(True)  # the button beside it stays as wide
        self.show_them.setSizePolicy(kept)
        vbox(
            heading(tr("1  Volume")),
            hbox(self.browse, self.sample),
            FixedHeightText((self.volume,)),
            heading(tr("2  Grains")),
            self.card,
            self.save,
            heading(tr("3  Particles")),
            hbox(self.convert, self.show_them),
            FixedHeightText((self.made,)),
            parent=self,
        )

    def show_state(
        self,
        scan: Scan | None,
        preview: Segmentation | None,
        grains: Segmentation | None,
        least: int,
        searching: bool = False,
    ) -> None:
        """Describe the volume and the grains, and how many have fewer than `least` voxels.

        `searching` says that a preview is being computed.
        """
        is_grey = scan is not None and scan.volume.kind == "grey"
        self.card.set_startable("" if is_grey else tr("Open a volume of grey values first."))
        self.save.setEnabled(grains is not None)
        self.convert.setEnabled(grains is not None or (scan is not None and not is_grey))
        self.show_them.hide()
        outside = "" if scan is None or scan.outside is None else translate(scan.outside.hint_label)
        self.volume.setText(
            _sentences(_about(scan.volume.name, scan.volume), outside) if scan else tr("No volume is open.")
        )
        self.made.setText("")
        if self.card.record.state not in (ResultState.RUNNING, ResultState.FAILED):
            self.card.show_record(_record(scan, preview, grains, least, searching))

    def show_first(self, first: FirstLook) -> None:
        """Describe a volume of which a coarse picture is shown until it has been read."""
        self.volume.setText(_about(first.scan.volume.name, first))
        note = tr("The picture is coarse until all of the volume has been read.")
        self.card.show_record(ResultRecord(note=note))

    def set_particles(self, summary: str) -> None:
        self.made.setText(summary)
        self.show_them.show()


def _record(
    scan: Scan | None, preview: Segmentation | None, grains: Segmentation | None, least: int, searching: bool
) -> ResultRecord:
    """All grains, or what the preview says of those in its frame."""
    if scan is None:
        return ResultRecord()
    if scan.volume.kind == "labels":
        return ResultRecord(note=tr("The volume holds labels: its grains have been found already."))
    if grains is not None:
        share = float(grains.sizes.sum()) / grains.labels.array.size
        values = (number_text(grains.n_grains, ","), number_text(share, ".1%"))
        note = _sentences(translate(grains.summary), *_doubts(grains, least))
        return ResultRecord(values, scan.volume.name, state=ResultState.CURRENT, note=note)
    if preview is not None:
        found = tr("In the frame: {counts}.", counts=translate(preview.counts))
        hint = tr("Click into a slice to move the frame.")
        return ResultRecord(note=_sentences(found, *_doubts(preview, least), hint))
    if searching:
        return ResultRecord(note=tr("Searching …"))
    return ResultRecord(
        note=tr("No grain in the frame so far. Move the level, or click into a slice to move the frame.")
    )


def _sentences(*parts: str) -> str:
    return " ".join(filter(None, parts))


def _doubts(found: Segmentation, least: int) -> tuple[str, str]:
    return _too_small(found, least), _too_large(found)


def _too_small(found: Segmentation, least: int) -> str:
    count = int((found.sizes < least).sum())
    if not count:
        return ""
    return tr_count(
        N_("{count} of them has fewer than {least} voxels and will be left out."),
        N_("{count} of them have fewer than {least} voxels and will be left out."),
        count,
        least=least,
    )


def _too_large(found: Segmentation) -> str:
    """Advice if one grain has most of the volume or the volume fraction is implausible."""
    voxels = found.labels.array.size
    if found.sizes.sum() < _DENSEST * voxels and found.sizes.max() < _LARGEST * voxels:
        return ""
    return tr(
        "Grains fill most of the frame and are connected. Tick “Grains are dark” if they are darker than "
        "what is between them; otherwise change the level or reduce h."
    )


def _about(name: str, volume: Volume | FirstLook) -> str:
    edges = " × ".join(map(str, volume.shape))
    size = volume.voxel_size
    voxel = " × ".join(number_text(edge, "g") for edge in (size[:1] if (size == size[0]).all() else size))
    return tr(
        "{name}: {edges} voxels of {voxel}, {what} ({dtype}).",
        name=name,
        edges=edges,
        voxel=f"{voxel} µm",
        what=tr("labels") if volume.kind == "labels" else tr("grey values"),
        dtype=volume.dtype,
    )


def _words() -> WrappedLabel:
    """A label for the result of a step, with all lines visible."""
    return named(WrappedLabel(), role="hint")
