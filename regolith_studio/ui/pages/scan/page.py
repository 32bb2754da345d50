"""Page "Scan": three slices with the grains, histogram, settings, and the steps of the workflow."""

import contextlib
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QTimer
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QKeyEvent, QKeySequence
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QSizePolicy

from regolith_studio.errors import RegolithError
from regolith_studio.imaging.extraction import Extraction
from regolith_studio.imaging.label_files import LABEL_SUFFIXES
from regolith_studio.imaging.sample_volumes import sample_file
from regolith_studio.imaging.segmentation.segment import Segmentation, SegmentationSettings
from regolith_studio.imaging.segmentation.strokes import ERASER
from regolith_studio.imaging.volume import Volume
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.json_text import json_bytes
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.extraction_settings import (
    GrainSettings,
    VolumeInput,
    read_classifier,
    read_grain_settings,
    read_objects,
)
from regolith_studio.jobs.label_jobs import write_labels
from regolith_studio.jobs.volume_jobs import (
    GrainSegmentation,
    Scan,
    extract_labels,
    find_grains,
    preview_part,
    read_header,
    read_sample_scan,
    read_scan,
    view_labels,
)
from regolith_studio.messages import N_
from regolith_studio.readers.volume_formats import volume_suffixes
from regolith_studio.readers.volumes.header import VolumeHeader, layout_from_name
from regolith_studio.readers.volumes.region import RegionSettings, crop_of_rectangle
from regolith_studio.readers.voxels.scanner_headers import header_beside
from regolith_studio.session.batch.preprocessing import entry_of
from regolith_studio.session.provenance import VolumeSource
from regolith_studio.session.recipe import VolumeEntry
from regolith_studio.ui.layout import CONTROLS_WIDTH, padded, scrolled_column, side_by_side, tabs
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.scan.brush_panel import Brush, BrushPanel
from regolith_studio.ui.pages.scan.controls import SegmentationControls
from regolith_studio.ui.pages.scan.corrections import Corrections
from regolith_studio.ui.pages.scan.edits_panel import EditsPanel
from regolith_studio.ui.pages.scan.objects_panel import ObjectsPanel
from regolith_studio.ui.pages.scan.painting import Painting
from regolith_studio.ui.pages.scan.slices_view import SlicesView
from regolith_studio.ui.pages.scan.volume_dialog import RAW_SUFFIXES, VolumeDialog, needs_asking
from regolith_studio.ui.pages.scan.workflow_panel import WorkflowPanel
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr, translate

VOLUMES = N_("Volumes ({suffixes});;All files (*)")
CLASSIFIERS = N_("Classifiers (*.json);;All files (*)")
RECIPES = N_("Settings (*.json);;All files (*)")
BOX = Brush(ERASER, 1.0, "box")
PREVIEW_DELAY = 120
"""Milliseconds from the last change to the preview."""


class ScanPage(PageWidget):
    """Opens a volume, previews its grains after every change, and segments all of it on request."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("scan")
        self.setAcceptDrops(True)
        self._context = context
        self.scan: Scan | None = None
        self._given = self._wanted = VolumeInput(Path())
        self._region = self._wanted_region = RegionSettings()
        self.preview: Segmentation | None = None
        self._found_with: SegmentationSettings | None = None

    def build(self) -> None:
        self.slices = SlicesView(self._context.views)
        self.controls = SegmentationControls()
        self.workflow = WorkflowPanel()
        self.brush = BrushPanel()
        self.painting = Painting(self._context, self.brush, self.slices, self)
        self.objects, self.edits = ObjectsPanel(), EditsPanel()
        self.corrections = Corrections(self._context, self.objects, self.edits, self.slices, self)
        self._timer = QTimer(self, interval=PREVIEW_DELAY, singleShot=True)
        self._arrange()
        self._connect()
        self._show_state()

    @property
    def grains(self) -> Segmentation | None:
        """The grains of the whole volume, corrected, or ``None``."""
        return self.corrections.grains

    def set_theme(self, theme: Theme) -> None:
        self.slices.set_theme(theme)

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {
            "open_volume": self.ask_for_file,
            "open_slices": self.ask_for_folder,
            "sample_volume": self.open_sample,
            "open_settings": self.ask_for_settings,
            "save_settings": self.save_settings,
            "find_grains": self.find_grains,
            "save_labels": self.save_labels,
            "make_particles": self.make_particles,
        }

    def state(self) -> dict[str, Any]:
        return self._all_settings().as_document()

    def restore(self, state: Mapping[str, Any]) -> None:
        with contextlib.suppress(RegolithError):
            self._use(GrainSettings.from_document(state))

    def on_close(self) -> None:
        self._timer.stop()
        self.corrections.discard()
        self.slices.grains.release()
        if self.scan is not None:
            self.scan.scratch.close()

    # --- opening -------------------------------------------------------------------------------

    def open_path(self, path: Path) -> None:
        self.open(path)

    def ask_for_file(self) -> None:
        """Ask for a volume and open it."""
        kinds = tr(VOLUMES, suffixes=" ".join(f"*{suffix}" for suffix in sorted(volume_suffixes())))
        name, _ = QFileDialog.getOpenFileName(self, tr("Open a volume"), self._folder(), kinds)
        if name:
            self.open(Path(name))

    def ask_for_folder(self) -> None:
        """Ask for a folder of slices and open it."""
        name = QFileDialog.getExistingDirectory(self, tr("Open a folder of slices"), self._folder())
        if name:
            self.open(Path(name))

    def open(self, path: Path) -> None:
        """Open a file or a folder of slices whole, and ask for missing properties."""
        settings = self.controls.value()
        self.controls.setValue(replace(settings, region=replace(settings.region, crop="")))
        self._context.remember("folder", str(path.parent))
        if path.suffix.lower() in RAW_SUFFIXES and header_beside(path) is None:
            self._ask_layout(path)
            return
        job = Job(read_header, (VolumeInput(path),))
        self._context.start(
            tr("Looking at the volume"), job, lambda header: self._on_header(path, header), lane="read"
        )

    def open_sample(self) -> None:
        """Open the shipped scan."""
        self.read(VolumeInput(sample_file("grey")))

    def read(self, volume: VolumeInput) -> None:
        """Read the region of interest of a volume."""
        region = self.controls.value().region
        self._wanted, self._wanted_region = volume, region
        job = Job(read_scan, (volume, region))
        title = tr("Reading the volume")
        if volume.path == sample_file("grey"):
            job, title = Job(read_sample_scan, ("grey", region)), tr("Reading the sample scan")
        self._context.start(title, job, lambda scan: self._take(scan, volume, region), lane="read")

    def _on_header(self, path: Path, header: VolumeHeader) -> None:
        if needs_asking(header):
            self._ask(path, header)
        else:
            self.read(VolumeInput(path))

    def _ask(self, path: Path, header: VolumeHeader) -> None:
        self._show_dialog(VolumeDialog(path, header, last=self._last_size(), parent=self))

    def _ask_layout(self, path: Path) -> None:
        try:
            layout = layout_from_name(path)
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        self._show_dialog(VolumeDialog(path, None, layout, self._last_size(), self))

    def _show_dialog(self, dialog: VolumeDialog) -> None:
        dialog.accepted.connect(lambda: self._read_volume(dialog.value()))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def _read_volume(self, volume: VolumeInput) -> None:
        size = np.ravel(np.asarray(volume.voxel_size))[0]
        self._context.remember("voxel_size", [float(size), volume.unit])
        self.read(volume)

    def _last_size(self) -> tuple[float, str]:
        """Voxel size and unit of the previous volume, proposed for the next one."""
        size, unit = self._context.recall("voxel_size", [1.0, "um"])
        return float(size), str(unit)

    def _take(self, scan: Scan, volume: VolumeInput, region: RegionSettings) -> None:
        self._stop_work()
        if self.scan is not None:
            self.corrections.forget()
            self.scan.scratch.close()
        self.scan, self.preview, self._given, self._region = scan, None, volume, region
        self.slices.set_scan(scan)
        self.painting.stop()
        self.painting.set_volume(scan.volume)
        self.controls.set_kind(scan.volume.kind)
        self._show_level()
        self._schedule_preview()
        self._show_state()

    # --- settings ------------------------------------------------------------------------------

    def ask_for_settings(self) -> None:
        """Ask for a recipe of this page or of ``extract`` and apply its settings."""
        name, _ = QFileDialog.getOpenFileName(self, tr("Open settings"), self._folder(), tr(RECIPES))
        if not name:
            return
        try:
            self._use(read_grain_settings(Path(name)))
        except RegolithError as error:
            self._context.toast.problem(str(error))

    def save_settings(self) -> None:
        """Ask for a file and write the settings as a recipe."""
        start = str(Path(self._folder()) / "grains.json")
        name, _ = QFileDialog.getSaveFileName(self, tr("Save settings"), start, tr(RECIPES))
        if not name:
            return
        try:
            write_bytes(Path(name), json_bytes(self.state()))
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        command = f"regolith-studio extract --recipe {Path(name).name}"
        self._context.toast.note(tr("Saved; use it with: {command}", command=command))

    def ask_for_classifier(self) -> None:
        """Ask for the file of a classifier and take it as the threshold."""
        name, _ = QFileDialog.getOpenFileName(self, tr("Open a classifier"), self._folder(), tr(CLASSIFIERS))
        if not name:
            return
        try:
            self.controls.set_classifier(read_classifier(Path(name)))
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        self.controls.use_classifier()

    def save_classifier(self) -> None:
        """Ask for a file and write the classifier that was trained by strokes."""
        start = str(Path(self._folder()) / "classifier.json")
        name, _ = QFileDialog.getSaveFileName(self, tr("Save the classifier"), start, tr(CLASSIFIERS))
        if name:
            self.painting.save(Path(name), self._given.path, self._on_classifier_saved)

    def _on_classifier_saved(self, path: Path) -> None:
        command = f"regolith-studio extract --classifier {path.name}"
        self._context.toast.note(tr("Saved; use it with: {command}", command=command))

    def ask_for_objects(self) -> None:
        """Ask for the file of an object classifier and apply it."""
        name, _ = QFileDialog.getOpenFileName(self, tr("Open a classifier"), self._folder(), tr(CLASSIFIERS))
        if not name:
            return
        try:
            self.corrections.load(read_objects(Path(name)))
        except RegolithError as error:
            self._context.toast.problem(str(error))

    def save_objects(self) -> None:
        """Ask for a file and write the object classifier."""
        start = str(Path(self._folder()) / "objects.json")
        name, _ = QFileDialog.getSaveFileName(self, tr("Save the classifier"), start, tr(CLASSIFIERS))
        if name:
            self.corrections.save(Path(name), self._given.path, self._on_objects_saved)

    def _on_objects_saved(self, path: Path) -> None:
        command = f"regolith-studio extract --objects {path.name}"
        self._context.toast.note(tr("Saved; use it with: {command}", command=command))

    def _use(self, recipe: GrainSettings) -> None:
        self.controls.setValue(recipe)
        self.corrections.take_from(recipe.segmentation)
        self._on_settings(self.controls.value())

    def _all_settings(self) -> GrainSettings:
        """The settings with the object step and the corrections by hand."""
        chosen = self.controls.value()
        return replace(chosen, segmentation=self.corrections.added_to(chosen.segmentation))

    # --- segmenting ----------------------------------------------------------------------------

    def find_grains(self) -> None:
        """Segment the whole volume."""
        if self.scan is None or self.scan.volume.kind == "labels":
            self._context.toast.note(tr("Open a volume of grey values first."))
            return
        self._context.stop("preview")
        settings = self.controls.value().segmentation
        job = Job(find_grains, (self.scan, settings))
        self._context.start(
            tr("Finding grains"), job, lambda found: self._show_grains(found, settings), lane="grains"
        )

    def save_labels(self) -> None:
        """Ask for a file and write the labels of the grains."""
        if self.grains is None:
            self._context.toast.note(tr("Find the grains first."))
            return
        kinds = tr(VOLUMES, suffixes=" ".join(f"*{suffix}" for suffix in LABEL_SUFFIXES))
        start = str(Path(self._folder()) / f"{self._given.path.stem}_labels.tif")
        name, _ = QFileDialog.getSaveFileName(self, tr("Save labels"), start, kinds)
        if not name:
            return
        path = Path(name)
        job = Job(write_labels, (self.grains.labels, self.controls.value().extraction, path, True))
        self._context.start(
            tr("Saving labels"), job, lambda table: self._labels_saved(path, table), lane="grains"
        )

    def _labels_saved(self, path: Path, table: Path) -> None:
        words = tr(
            "Labels were written to {file}, their particles to {table}.", file=path.name, table=table.name
        )
        self._context.toast.note(words)

    def make_particles(self) -> None:
        """Convert the grains to particles and open them."""
        labels = self.grains.labels if self.grains else None
        if self.scan is not None and self.scan.volume.kind == "labels":
            labels = self.scan.volume
        if labels is None or self.scan is None:
            self._context.toast.note(tr("Find the grains first."))
            return
        chosen = self.controls.value()
        segmentation = self.corrections.added_to(self._found_with or SegmentationSettings())
        settings = replace(chosen, segmentation=segmentation, region=self._region)
        entry = entry_of(self._given, settings)
        grey = self.scan.volume if self.scan.volume.kind == "grey" else None
        job = Job(extract_labels, (labels, settings.extraction, self._given.path, grey))
        self._context.start(tr("Making particles"), job, lambda made: self._adopt(made, entry), lane="grains")

    def _show_grains(self, found: GrainSegmentation, settings: SegmentationSettings) -> None:
        assert self.scan is not None
        self.preview, self._found_with = None, settings
        self.corrections.begin(self.scan.volume, found, settings)
        self.controls.show_automatic_level(found.segmentation.level)
        self._show_state()

    def _on_corrected(self) -> None:
        """Follow the grains as they are corrected."""
        if self._found_with is not None:
            self._hide_probabilities(self._found_with)
        self._show_state()

    def _crop_to_box(self, axis: int, _number: int, points: NDArray[np.float64]) -> None:
        """Read the region that was drawn in a slice."""
        if self.scan is None or not self.controls.draw_box.isChecked():
            return
        self.controls.draw_box.setChecked(False)
        shape = [edge for each, edge in enumerate(self.scan.volume.shape) if each != axis]
        ends = points[[0, -1]]
        low, high = np.floor(ends.min(axis=0)), np.ceil(ends.max(axis=0))
        (x0, y0), (x1, y1) = (np.clip(each, 0, shape).astype(int).tolist() for each in (low, high))
        if x0 < x1 and y0 < y1:
            origin = self.scan.volume.origin
            self.controls.set_crop(crop_of_rectangle(self._region, origin, axis, (x0, y0), (x1, y1)))

    def _make_surface(self, labels: Volume) -> None:
        """Contour labels in the background for the view of all grains."""
        show = self.slices.show_surface
        job = Job(view_labels, (labels,))
        self._context.start(tr("Drawing grains"), job, lambda made: show(labels, made), lane="surface")

    def _hide_probabilities(self, settings: SegmentationSettings) -> None:
        """Keep a classifier's probabilities out of the histogram of grey values."""
        if settings.classifier is not None:
            self.slices.histogram.set_denoised(None)
            self.slices.histogram.set_level(None)

    def _adopt(self, extraction: Extraction, entry: VolumeEntry) -> None:
        if not extraction.found:
            self._context.toast.problem(
                tr(
                    "No grain became a particle: {border} touch the border of the volume,"
                    " {small} are too small.",
                    border=len(extraction.border),
                    small=len(extraction.small),
                )
            )
            return
        origin = VolumeSource.of(entry, extraction.particles)
        self._context.session.adopt(extraction.particles, origin=origin)
        summary = translate(extraction.summary)
        self._context.toast.note(summary)
        self.workflow.set_particles(summary)

    def _on_settings(self, recipe: GrainSettings) -> None:
        """Read another region; discard grains of other settings and start a preview."""
        if recipe.region != self._wanted_region and self._wanted.path != Path():
            self.read(self._wanted)
            return
        if self.grains is not None and recipe.segmentation == self._found_with:
            self._show_state()
            return
        self.corrections.discard()
        self._context.stop("surface")
        self._context.stop("grains")
        self._show_level()
        self._schedule_preview()
        self._show_state()

    def _on_level_dragged(self, level: float) -> None:
        if self.scan is not None:
            self.controls.set_level(level / self._probability_range())

    def _show_level(self) -> None:
        if self.scan is None:
            return
        settings = self.controls.value().segmentation
        level = self.scan.level(settings)
        self.slices.histogram.set_level(level if settings.classifier is None else None)
        self.controls.show_automatic_level(level)

    def _probability_range(self) -> float:
        """Grey value of probability 1 in a probability map; else 1."""
        settings = self.controls.value().segmentation
        if self.scan is None or settings.threshold.method != "probability":
            return 1.0
        return (self.scan.level(settings) or 1.0) / settings.threshold.value

    # --- preview -------------------------------------------------------------------------------

    def _schedule_preview(self) -> None:
        if self.scan is not None and self.scan.volume.kind == "grey" and self.grains is None:
            self._timer.start()

    def _start_preview(self) -> None:
        if self.scan is None:
            return
        settings = self.controls.value().segmentation
        arguments = (self.scan.volume, self.slices.box, settings, self.scan.level(settings))
        box = self.slices.box
        self._context.start(
            tr("Preview"),
            Job(preview_part, arguments),
            lambda found: self._show_preview(found, box),
            lane="preview",
        )

    def _show_preview(self, found: Segmentation | None, box: Any) -> None:
        self.preview = found
        self.slices.show_preview(found, box)
        self._hide_probabilities(self.controls.value().segmentation)
        self._show_state()

    # --- the rest ------------------------------------------------------------------------------

    def _show_state(self) -> None:
        least = self.controls.value().extraction.min_voxels
        self.workflow.show_state(self.scan, self.preview, self.grains, least)

    def _stop_work(self) -> None:
        self._timer.stop()
        for lane in ("preview", "grains", "surface"):
            self._context.stop(lane)

    def _folder(self) -> str:
        return str(self._context.recall("folder", str(Path.home())))

    def _connect(self) -> None:
        self._timer.timeout.connect(self._start_preview)
        self.controls.valueChanged.connect(self._on_settings)
        self.painting.trained.connect(self.controls.set_classifier)
        self.corrections.changed.connect(self._on_corrected)
        self.objects.openRequested.connect(self.ask_for_objects)
        self.objects.saveRequested.connect(self.save_objects)
        self.tabs.currentChanged.connect(self._stop_tools)
        self.brush.useRequested.connect(self.controls.use_classifier)
        self.brush.openRequested.connect(self.ask_for_classifier)
        self.brush.saveRequested.connect(self.save_classifier)
        self.slices.boxMoved.connect(self._schedule_preview)
        self.slices.surfaceWanted.connect(self._make_surface)
        self.controls.draw_box.toggled.connect(lambda on: self.slices.set_line_tool(BOX if on else None))
        self.slices.strokeDrawn.connect(self._crop_to_box)
        self.slices.histogram.levelDragged.connect(self._on_level_dragged)
        self.workflow.openRequested.connect(self.ask_for_file)
        self.workflow.sampleRequested.connect(self.open_sample)
        self.workflow.findRequested.connect(self.find_grains)
        self.workflow.labelsRequested.connect(self.save_labels)
        self.workflow.particlesRequested.connect(self.make_particles)
        self.workflow.showRequested.connect(lambda: self._context.go("sample"))

    def _arrange(self) -> None:
        parts = ((self.controls, tr("Settings")), (self.brush, tr("Brush")), (self.objects, tr("Objects")),
                 (self.edits, tr("Correct")))  # fmt: skip
        self.tabs = tabs("scan_tabs", parts)
        for part, _ in parts:
            if (inside := part.layout()) is not None:
                inside.setContentsMargins(8, 8, 8, 8)
        self.tabs.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        controls = scrolled_column([self.workflow, self.tabs])
        columns = side_by_side(
            [padded(self.slices, 10, 10, 2, 8), controls], [1100, CONTROLS_WIDTH + 20], stretch=0
        )
        columns.setObjectName("scan_columns")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(columns)

    def event(self, event: QEvent) -> bool:
        """Take Ctrl+Z for strokes and corrections while the page has the focus and there are some."""
        if event.type() == QEvent.Type.ShortcutOverride and self._step_of(cast(QKeyEvent, event)):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if step := self._step_of(event):
            step()
        else:
            super().keyPressEvent(event)

    def _stop_tools(self) -> None:
        """Let clicks show slices again when another tab is chosen."""
        self.controls.draw_box.setChecked(False)
        self.brush.paint.setChecked(False)
        self.corrections.stop_tools()

    def _step_of(self, event: QKeyEvent) -> Callable[[], None] | None:
        """What the keys of undo and redo do to strokes, or to examples and corrections of grains."""
        shown = self.tabs.currentWidget()
        steps: Painting | Corrections = self.painting
        if shown in (self.objects, self.edits):
            steps = self.corrections
        elif not self.brush.paint.isChecked():
            return None
        if event.matches(QKeySequence.StandardKey.Undo) and steps.can_undo:
            return steps.undo
        if event.matches(QKeySequence.StandardKey.Redo) and steps.can_redo:
            return steps.redo
        return None

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if event.mimeData().hasUrls():
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        files = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
        if files:
            event.acceptProposedAction()
            self.open(files[0])
