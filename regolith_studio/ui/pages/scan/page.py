"""Page "Scan": three slices with the grains, histogram, settings, and the steps of the workflow."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QSizePolicy

from regolith_studio.errors import RegolithError
from regolith_studio.imaging.label_table import voxel_inside
from regolith_studio.imaging.segmentation.segment import Segmentation, SegmentationSettings
from regolith_studio.imaging.segmentation.strokes import ERASER
from regolith_studio.imaging.volume import Box, Volume
from regolith_studio.jobs.classifier_jobs import find_suspects
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.extraction_settings import GrainSettings
from regolith_studio.jobs.scan_jobs import (
    GrainSegmentation,
    Scan,
    find_grains,
    preview_heights,
    preview_part,
    view_labels,
)
from regolith_studio.ui.layout import CONTROLS_WIDTH, FoldingSplitter, hbox, padded, scrolled_column, tabs
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.scan.controls import SegmentationControls, WorkflowPanel
from regolith_studio.ui.pages.scan.corrections import Corrections, Painting
from regolith_studio.ui.pages.scan.files import ParticleMaking, SettingsFiles, VolumeOpening
from regolith_studio.ui.pages.scan.slices import SlicesView
from regolith_studio.ui.pages.scan.tools import Brush, BrushPanel, EditsPanel, ObjectsPanel
from regolith_studio.ui.result_card import ResultRecord, RunController
from regolith_studio.ui.translation import tr

DELAY = 120
"""Milliseconds from the last change to the preview."""


class FramePreview(QObject):
    """Segments the frame of the slices.

    `found` holds its grains, ``None`` where there are none; `pending` says that others are being looked for.
    """

    changed = Signal()

    def __init__(
        self, context: PageContext, controls: SegmentationControls, slices: SlicesView, parent: QObject
    ) -> None:
        super().__init__(parent)
        self._context, self._controls, self._slices = context, controls, slices
        self._scan: Scan | None = None
        self._timer = QTimer(self, interval=DELAY, singleShot=True)
        self._timer.timeout.connect(self._start)
        self.found: Segmentation | None = None
        self.pending = False

    def schedule(self, scan: Scan | None) -> None:
        """Segment the frame soon, if the scan has grey values."""
        if scan is not None and scan.volume.kind == "grey":
            self._scan = scan
            self.pending = True
            self._controls.show_heights(())
            self._timer.start()

    def stop(self) -> None:
        self._timer.stop()
        self._stop_jobs()
        self.pending = False

    def forget(self) -> None:
        """Stop, and forget the grains."""
        self.stop()
        self.found = None

    def _stop_jobs(self) -> None:
        for queue in ("preview", "heights"):
            self._context.stop(queue)

    def _start(self) -> None:
        if self._scan is None:
            return
        scan, settings, box = self._scan, self._controls.value().segmentation, self._slices.box
        job = Job(preview_part, (scan, box, settings))
        self._stop_jobs()
        self._context.start(
            tr("Preview"),
            job,
            lambda found: self._take(found, scan, settings, box),
            failed=self._fail,
            stopped=self._end,
            queue="preview",
            repeats=True,
        )

    def _end(self) -> None:
        self.pending = False
        self.changed.emit()

    def _fail(self, failure: Failed) -> None:
        self._end()
        self._context.toast.problem(failure.sentence, failure.details)

    def _take(self, found: Segmentation | None, scan: Scan, settings: SegmentationSettings, box: Box) -> None:
        self.found, self.pending = found, False
        self._slices.show_preview(found, box)
        self.changed.emit()
        if found is not None and settings.splitting.enabled:
            arguments = (
                scan,
                box,
                settings,
                found.level,
                compared_heights(settings.splitting.h_maxima),
            )
            job = Job(preview_heights, arguments)
            self._context.start(
                tr("Grains at other h"), job, self._controls.show_heights, queue="heights", repeats=True
            )


def compared_heights(h: float) -> tuple[float, ...]:
    """h, half of it, twice and four times as much; from a small step on for 0."""
    return (h / 2, h, 2 * h, 4 * h) if h > 0 else (0.0, 0.4, 0.8, 1.6)


BOX = Brush(ERASER, 1.0, "box")


def _settings_in(state: Mapping[str, Any]) -> GrainSettings:
    """The settings in the state of the page."""
    return GrainSettings.from_document({key: value for key, value in state.items() if key != "scan"})


class ScanPage(PageWidget):
    """Opens a volume, previews its grains after every change, and segments all of it on request."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("scan")
        self.setAcceptDrops(True)
        self._context = context
        self._found_with: SegmentationSettings | None = None
        self._to_restore: dict[str, Any] = {}  # what a project says of a scan that is not open yet
        self._restoring = False
        self._suspected: Segmentation | None = None

    def build(self) -> None:
        context = self._context
        self.slices = SlicesView(context.views)
        self.controls = SegmentationControls()
        self.workflow = WorkflowPanel()
        self.brush, self.objects, self.edits = BrushPanel(), ObjectsPanel(), EditsPanel()
        self.suspects = self.edits.suspects
        self.opening = VolumeOpening(context, self.controls, self)
        self.preview = FramePreview(context, self.controls, self.slices, self)
        self.painting = Painting(context, self.brush, self.slices, self)
        self.corrections = Corrections(context, self.objects, self.edits, self.slices, self)
        self.finding = RunController(context, self.workflow.card, "grains", self.find_grains)
        self.making = ParticleMaking(context, self.opening, self)
        self.files = SettingsFiles(
            context, self.controls, self.painting, self.corrections, self.opening, self
        )
        self._arrange()
        self._connect()
        self._show_state()

    @property
    def scan(self) -> Scan | None:
        """The volume that is shown, or ``None``."""
        return self.opening.scan

    @property
    def grains(self) -> Segmentation | None:
        """The grains of the whole volume, corrected, or ``None``."""
        return self.corrections.grains

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {
            "open_volume": self.opening.ask_for_file,
            "open_slices": self.opening.ask_for_folder,
            "sample_volume": self.opening.open_sample,
            "gradient_volume": self.opening.open_gradient,
            "open_settings": self.files.open_settings,
            "save_settings": self.save_settings,
            "find_grains": self.find_grains,
            "save_labels": self.save_labels,
            "make_particles": self.make_particles,
        }

    def state(self) -> dict[str, Any]:
        document = self._settings().as_document()
        if self.scan is not None:
            scan = self.opening.state() | ({"found": True} if self.grains is not None else {})
            return document | {"scan": scan}
        return document | self._to_restore

    def restore(self, state: Mapping[str, Any]) -> None:
        scan = state.get("scan")
        try:
            self._use(_settings_in(state))
        except RegolithError:
            return
        self._to_restore, self._restoring = {}, False
        if isinstance(scan, Mapping):
            self._to_restore = dict(state)
            named = {key: value for key, value in scan.items() if key != "found"}
            if self.opening.restore(named):
                self._restoring = True
                return
        self.corrections.forget()  # corrections belong to one scan

    def on_close(self) -> None:
        self.preview.stop()
        self.corrections.discard()
        self.slices.grains.release()
        self.opening.close()

    def open_path(self, path: Path) -> None:
        self.opening.open(path)

    # --- the steps -----------------------------------------------------------------------------

    def find_grains(self) -> None:
        if self.scan is None or self.scan.volume.kind == "labels":
            self._context.toast.note(tr("Open a volume of grey values first."))
            return
        self.preview.stop()
        settings = self.controls.value().segmentation
        job = Job(find_grains, (self.scan, settings))
        self.finding.start(
            tr("Finding grains"),
            job,
            lambda found: self._show_grains(found, settings),
            ended=self._schedule_preview,
        )

    def save_settings(self) -> None:
        """Ask for a file and write the settings as a recipe."""
        self.files.save_settings(self._settings())

    def save_labels(self) -> None:
        """Ask for a file and write the labels of the grains."""
        self.making.save_labels(self.grains, self.controls.value())

    def make_particles(self) -> None:
        segmentation = self.corrections.added_to(self._found_with or SegmentationSettings())
        settings = replace(self.controls.value(), segmentation=segmentation, region=self.opening.region)
        self.making.make_particles(self.grains, settings)

    def _settings(self) -> GrainSettings:
        """The settings with the object step and the corrections by hand."""
        chosen = self.controls.value()
        return replace(chosen, segmentation=self.corrections.added_to(chosen.segmentation))

    def _use(self, recipe: GrainSettings) -> None:
        self.controls.setValue(recipe)
        self.corrections.take_from(recipe.segmentation)
        self._on_settings(self.controls.value())

    # --- what follows --------------------------------------------------------------------------

    def _on_leaving(self) -> None:
        self._stop_work()
        self.corrections.forget()

    def _on_opened(self) -> None:
        self._stop_work()
        self.preview.forget()
        if self.scan is None:
            return
        self.slices.set_scan(self.scan)
        self.painting.stop()
        self.painting.set_volume(self.scan.filled)
        self.controls.set_kind(self.scan.volume.kind)
        self._show_level()
        self._schedule_preview()
        self._go_on_with_project()

    def _go_on_with_project(self) -> None:
        """Find the grains of the scan of a project again; its corrections are of no other scan.

        A scan that had moved is known by its fingerprint when it is opened from its new place.
        """
        state, restoring = self._to_restore, self._restoring
        self._to_restore, self._restoring = {}, False
        if not state or self.scan is None:
            return
        if self.opening.fingerprint != state["scan"].get("fingerprint"):
            if restoring:
                self.corrections.forget()
            return
        if not restoring:
            self._use(_settings_in(state))
            if self.opening.wanted_region != self.opening.region:  # it is being read again
                self._to_restore, self._restoring = state, True
                return
        if state["scan"].get("found") and self.scan.volume.kind != "labels":
            self.find_grains()

    def _on_looked(self) -> None:
        self._stop_work()
        self.preview.forget()
        self.painting.stop()
        self.painting.set_volume(None)
        if self.opening.first is not None:
            self.slices.show_first(self.opening.first.scan)
        self._show_state()

    def _on_settings(self, recipe: GrainSettings) -> None:
        """Read another region; discard grains of other settings and start a preview."""
        if self.opening.follow_region():
            return
        if self.grains is not None and recipe.segmentation == self._found_with:
            self._show_state()
            return
        self.corrections.discard()
        self._context.stop("surface")
        self.finding.forget()
        self._show_level()
        self._schedule_preview()

    def _on_preview(self) -> None:
        self._hide_probabilities(self.controls.value().segmentation)
        self._show_state()

    def _on_corrected(self) -> None:
        """Follow the grains as they are corrected."""
        self._find_suspects()
        if self._found_with is not None:
            self._hide_probabilities(self._found_with)
        self._show_state()

    def _show_grains(self, found: GrainSegmentation, settings: SegmentationSettings) -> None:
        assert self.scan is not None
        self.preview.forget()
        self.workflow.card.show_record(ResultRecord())  # it runs no more
        self._found_with = settings
        self.corrections.begin(self.scan.volume, found, settings)
        self.controls.show_automatic_level(found.segmentation.level)
        self._show_state()

    def _find_suspects(self) -> None:
        """List the grains that are least like the others, while the tab of corrections is seen."""
        scan, grains = self.scan, self.grains
        seen = self.tabs.currentWidget() is self.edits
        if grains is not self._suspected:
            self._suspected = None
            self._context.stop("suspects")
            self.suspects.clear()
        if not seen or scan is None or grains is None or grains is self._suspected:
            return
        self._suspected = grains
        job = Job(find_suspects, (scan.volume, grains))
        show = self.suspects.show_objects
        self._context.start(tr("Describing objects"), job, show, queue="suspects", repeats=True)

    def _show_grain(self, label: int, box: Box) -> None:
        """Move the slices to a grain, and let it stand out."""
        if self.grains is not None:
            self.slices.go_to(voxel_inside(self.grains.labels.array, label, box))
            self.slices.highlight({label})

    def _make_surface(self, labels: Volume) -> None:
        """Contour labels in the background for the view of all grains."""
        show = self.slices.show_surface
        job = Job(view_labels, (labels,))
        self._context.start(tr("Drawing grains"), job, lambda made: show(labels, *made), queue="surface")

    def _schedule_preview(self) -> None:
        if self.grains is None:
            self.preview.schedule(self.scan)
        self._show_state()

    def _show_state(self) -> None:
        least = self.controls.value().extraction.min_voxels
        self.workflow.show_state(self.scan, self.preview.found, self.grains, least, self.preview.pending)
        if self.opening.first is not None:
            self.workflow.show_first(self.opening.first)

    def _stop_work(self) -> None:
        self.preview.stop()
        self.finding.forget()
        for queue in ("surface", "suspects"):
            self._context.stop(queue)

    # --- the level in the histogram ------------------------------------------------------------

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

    def _hide_probabilities(self, settings: SegmentationSettings) -> None:
        """Keep a classifier's probabilities out of the histogram of grey values."""
        if settings.classifier is not None:
            self.slices.histogram.set_denoised(None)
            self.slices.histogram.set_level(None)

    # --- parts, keys and drops -----------------------------------------------------------------

    def _arrange(self) -> None:
        parts = (
            (self.controls, tr("Settings")),
            (self.brush, tr("Brush")),
            (self.objects, tr("Objects")),
            (self.edits, tr("Correct")),
        )
        self.tabs = tabs("scan_tabs", parts)
        for part, _ in parts:
            if (inside := part.layout()) is not None:
                inside.setContentsMargins(8, 8, 8, 8)
        self.tabs.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        controls = scrolled_column([self.workflow, self.tabs])
        columns = FoldingSplitter(padded(self.slices, 10, 10, 2, 8), controls, (1100, CONTROLS_WIDTH + 20))
        columns.setObjectName("scan_columns")
        hbox(columns, parent=self)

    def _connect(self) -> None:
        self.opening.leaving.connect(self._on_leaving)
        self.opening.looked.connect(self._on_looked)
        self.opening.opened.connect(self._on_opened)
        self.preview.changed.connect(self._on_preview)
        self.controls.valueChanged.connect(self._on_settings)
        self.controls.draw_box.toggled.connect(
            lambda on: self.slices.set_line_tool((lambda: BOX) if on else None)
        )
        self.painting.trained.connect(self.controls.set_classifier)
        self.corrections.changed.connect(self._on_corrected)
        self.making.made.connect(self.workflow.set_particles)
        self.files.settingsOpened.connect(self._use)
        self.tabs.currentChanged.connect(self._stop_tools)
        self.tabs.currentChanged.connect(self._find_suspects)
        self.suspects.grainChosen.connect(self._show_grain)
        self.slices.boxMoved.connect(self._schedule_preview)
        self.slices.surfaceWanted.connect(self._make_surface)
        self.slices.strokeDrawn.connect(self.opening.crop_to_box)
        self.slices.histogram.levelDragged.connect(self._on_level_dragged)
        self._connect_buttons()

    def _connect_buttons(self) -> None:
        self.brush.use.clicked.connect(self.controls.use_classifier)
        self.brush.labels.clicked.connect(self.files.read_labels)
        self.brush.browse.clicked.connect(self.files.open_classifier)
        self.brush.save.clicked.connect(self.files.save_classifier)
        self.objects.browse.clicked.connect(self.files.open_objects)
        self.objects.save.clicked.connect(self.files.save_objects)
        self.workflow.browse.clicked.connect(self.opening.ask_for_file)
        self.workflow.sample.clicked.connect(self.opening.open_sample)
        self.workflow.save.clicked.connect(self.save_labels)
        self.workflow.convert.clicked.connect(self.make_particles)
        self.workflow.show_them.clicked.connect(lambda: self._context.go("sample"))

    def _stop_tools(self) -> None:
        """Let clicks show slices again when another tab is chosen."""
        self.controls.draw_box.setChecked(False)
        self.brush.paint.setChecked(False)
        self.corrections.stop_tools()

    def step(self, name: str) -> Callable[[], None] | None:
        """Of strokes while they are painted, or of examples and corrections of grains."""
        shown = self.tabs.currentWidget()
        steps: Painting | Corrections = self.painting
        if shown in (self.objects, self.edits):
            steps = self.corrections
        elif not self.brush.paint.isChecked():
            return None
        if name == "undo":
            return steps.undo if steps.history.can_undo else None
        return steps.redo if steps.history.can_redo else None

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take one file or folder; several go on to the window, which opens meshes or says what it cannot."""
        if len(event.mimeData().urls()) == 1:
            event.acceptProposedAction()
        else:
            event.ignore()

    def dropEvent(self, event: QDropEvent) -> None:
        files = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
        if files:
            event.acceptProposedAction()
            self.opening.open(files[0])
