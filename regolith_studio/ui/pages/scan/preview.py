"""Preview: the grains in the frame, segmented anew shortly after every change."""

from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal

from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.volume_jobs import Scan, preview_part
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.scan.controls import SegmentationControls
from regolith_studio.ui.pages.scan.slices_view import SlicesView
from regolith_studio.ui.translation import tr

DELAY = 120
"""Milliseconds from the last change to the preview."""


class FramePreview(QObject):
    """Segments the frame of the slices; `found` holds its grains, ``None`` where there are none."""

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

    def schedule(self, scan: Scan | None) -> None:
        """Segment the frame soon, if the scan has grey values."""
        if scan is not None and scan.volume.kind == "grey":
            self._scan = scan
            self._timer.start()

    def stop(self) -> None:
        """Stop what was scheduled or has begun."""
        self._timer.stop()
        self._context.stop("preview")

    def forget(self) -> None:
        """Stop, and forget the grains."""
        self.stop()
        self.found = None

    def _start(self) -> None:
        if self._scan is None:
            return
        settings, box = self._controls.value().segmentation, self._slices.box
        job = Job(preview_part, (self._scan.volume, box, settings, self._scan.level(settings)))
        self._context.start(tr("Preview"), job, lambda found: self._take(found, box), lane="preview")

    def _take(self, found: Segmentation | None, box: Any) -> None:
        self.found = found
        self._slices.show_preview(found, box)
        self.changed.emit()
