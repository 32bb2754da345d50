"""Three slices through one voxel and the histogram."""

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QStackedLayout, QVBoxLayout, QWidget

from regolith_studio.imaging.bounding_boxes import Box, box_about, box_between
from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.imaging.slice_images import SliceImages
from regolith_studio.jobs.volume_jobs import Scan
from regolith_studio.ui.layout import equal_parts
from regolith_studio.ui.pages.scan.histogram_plot import HistogramPlot
from regolith_studio.ui.pages.scan.slice_view import SliceView
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import remark

PREVIEW_EDGE = 96
"""Edge of the preview box in voxels, if the volume is that large."""


class SlicesView(QWidget):
    """Shows a :class:`Scan` and the grains of the preview or of the whole volume."""

    boxMoved = Signal()  # noqa: N815
    """The preview box has moved."""

    def __init__(self) -> None:
        super().__init__()
        self.views = [SliceView(axis) for axis in (2, 1, 0)]
        self.histogram = HistogramPlot()
        self.position = (0, 0, 0)
        self.box: Box = box_between((0, 0, 0), (1, 1, 1))
        self._scan: Scan | None = None
        self._labels: SliceImages | None = None
        self._part: Box = self.box
        self._arrange()
        for view in self.views:
            view.placePicked.connect(lambda x, y, z: self.go_to((x, y, z)))
            view.sliceChosen.connect(self._turn)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        for view in self.views:
            view.set_theme(theme)
        self.histogram.set_theme(theme)

    def set_scan(self, scan: Scan) -> None:
        """Show another volume, with slices through its centre."""
        self._scan, self._labels = scan, None
        for view in self.views:
            view.set_volume(scan.volume, scan.sections, scan.contrast)
            view.set_box_shown(scan.volume.kind == "grey")
        self.histogram.set_scanned(scan.histogram)
        self._stack.setCurrentIndex(1)
        self.box = box_between((0, 0, 0), (0, 0, 0))
        x, y, z = (edge // 2 for edge in scan.volume.shape)
        self.go_to((x, y, z))

    def go_to(self, position: tuple[int, int, int]) -> None:
        """Show the slices through a voxel."""
        if self._scan is None:
            return
        self.position = position
        box = box_about(position, PREVIEW_EDGE, self._scan.volume.shape)
        moved, self.box = box != self.box, box
        for view in self.views:
            view.show_position(position, box)
        self._lay_over()
        if moved:
            self.boxMoved.emit()

    def show_preview(self, found: Segmentation | None, box: Box) -> None:
        """Overlay the grains of the preview."""
        self._labels = None if found is None else SliceImages(found.labels.array)
        self._part = box
        self.histogram.set_denoised(None if found is None else found.seen)
        for view in self.views:
            view.set_box_shown(True)
        self._lay_over()

    def show_segmentation(self, found: Segmentation, labels: SliceImages) -> None:
        """Overlay the grains of the whole volume."""
        self._labels, self._part = labels, box_between((0, 0, 0), found.labels.shape)
        self.histogram.set_denoised(found.seen)
        self.histogram.set_level(found.level)
        for view in self.views:
            view.set_box_shown(False)
        self._lay_over()

    def _turn(self, axis: int, number: int) -> None:
        position = list(self.position)
        position[axis] = number
        self.go_to((position[0], position[1], position[2]))

    def _lay_over(self) -> None:
        for view in self.views:
            view.show_grains(self._labels, self._part, self.position[view.axis])

    def _arrange(self) -> None:
        above = equal_parts(Qt.Orientation.Horizontal, self.views[:2])
        below = equal_parts(Qt.Orientation.Horizontal, [self.views[2], self.histogram])
        page = equal_parts(Qt.Orientation.Vertical, [above, below])
        hint = QWidget()
        column_of_words = QVBoxLayout(hint)
        words = remark(
            tr(
                "Open a CT volume: TIFF stack, folder of slices, TXM, DICOM, OME-Zarr, Amira, HDF5, NRRD, "
                "MetaImage, NIfTI, NPY, raw, or the header of a scanner. Drop it here, or begin with the "
                "sample scan."
            )
        )
        words.setAlignment(Qt.AlignmentFlag.AlignCenter)
        column_of_words.addStretch(1)
        column_of_words.addWidget(words)
        column_of_words.addStretch(1)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(hint)
        self._stack.addWidget(page)
