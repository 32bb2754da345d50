"""Preview: the grains in the frame, segmented anew shortly after every change, and how many other h give."""

from PySide6.QtCore import QObject, QTimer, Signal

from regolith_studio.imaging.bounding_boxes import Box
from regolith_studio.imaging.segmentation.segment import Segmentation, SegmentationSettings
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.scan_jobs import Scan, preview_heights, preview_part
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan.controls import SegmentationControls
from regolith_studio.ui.pages.scan.slices_view import SlicesView
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
        """Stop what was scheduled or has begun."""
        self._timer.stop()
        self._stop_jobs()
        self.pending = False

    def forget(self) -> None:
        """Stop, and forget the grains."""
        self.stop()
        self.found = None

    def _stop_jobs(self) -> None:
        for lane in ("preview", "heights"):
            self._context.stop(lane)

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
            lane="preview",
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
                tr("Grains at other h"), job, self._controls.show_heights, lane="heights", repeats=True
            )


def compared_heights(h: float) -> tuple[float, ...]:
    """h, half of it, twice and four times as much; from a small step on for 0."""
    return (h / 2, h, 2 * h, 4 * h) if h > 0 else (0.0, 0.4, 0.8, 1.6)
