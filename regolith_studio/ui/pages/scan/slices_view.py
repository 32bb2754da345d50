"""Three slices through one voxel, the histogram, and the grains in three dimensions."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QStackedLayout, QVBoxLayout, QWidget

from regolith_studio.geometry.arrays import IntArray
from regolith_studio.imaging.bounding_boxes import Box, box_about, box_between
from regolith_studio.imaging.label_surface import LabelSurface
from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.imaging.slice_images import SliceImages
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs.classifier_jobs import SlicePrediction
from regolith_studio.jobs.scan_jobs import Scan
from regolith_studio.ui.layout import equal_parts
from regolith_studio.ui.pages.scan.brush_panel import Brush, BrushPanel
from regolith_studio.ui.pages.scan.grains_view import GrainsView
from regolith_studio.ui.pages.scan.histogram_plot import HistogramPlot
from regolith_studio.ui.pages.scan.painted_pictures import overlay_picture, paint_picture
from regolith_studio.ui.pages.scan.slice_view import SliceView, colours_of_labels
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import remark

PREVIEW_EDGE = 96
"""Edge of the preview box in voxels, if the volume is that large."""


class SlicesView(QWidget):
    """Shows a :class:`Scan` and the grains of the preview or of the whole volume."""

    boxMoved = Signal()  # noqa: N815
    """The preview box has moved."""
    moved = Signal()
    """Other slices are shown."""
    strokeDrawn = Signal(int, int, object)  # noqa: N815
    """As of a :class:`SliceView`."""
    picked = Signal(int, int, int, int)
    """A voxel that was clicked, after its slices are shown, and the axis of the slice that was clicked."""
    surfaceWanted = Signal(object)  # noqa: N815
    """Labels whose surfaces are to be made and given to :meth:`show_surface`."""

    def __init__(self, views: str) -> None:
        super().__init__()
        self.views = [SliceView(axis) for axis in (2, 1, 0)]
        self.histogram = HistogramPlot()
        self.grains = GrainsView(views)
        self._surface: tuple[Volume, LabelSurface] | None = None
        self._class_colours: NDArray[np.uint8] | None = None
        self._highlighted: set[int] = set()
        self.position = (0, 0, 0)
        self.box: Box = box_between((0, 0, 0), (1, 1, 1))
        self._scan: Scan | None = None
        self._labels: SliceImages | None = None
        self._part: Box = self.box
        self._predicted: dict[int, SlicePrediction] = {}
        self._overlay = "probability"
        self._painted = np.zeros((0, 3), np.int64), np.zeros(0, np.int64)
        self._panel: BrushPanel | None = None
        self._arrange()
        for view in self.views:
            view.placePicked.connect(lambda x, y, z: self.go_to((x, y, z)))
            view.placePicked.connect(lambda x, y, z, axis=view.axis: self.picked.emit(x, y, z, axis))
            view.sliceChosen.connect(self._turn)
            view.strokeDrawn.connect(self.strokeDrawn)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        for view in self.views:
            view.set_theme(theme)
        self.histogram.set_theme(theme)
        self.grains.set_theme(theme)

    def set_scan(self, scan: Scan) -> None:
        """Show another volume, with slices through its centre."""
        self._scan, self._labels = scan, None
        for view in self.views:
            view.set_volume(scan.volume, scan.sections, scan.contrast)
        self._show_boxes(scan.volume.kind == "grey")
        self.histogram.set_scanned(scan.histogram)
        self._stack.setCurrentIndex(1)
        self._class_colours, self._surface, self._highlighted = None, None, set()
        self.grains.set_volume(scan.volume)
        if scan.volume.kind == "labels":
            self.surfaceWanted.emit(scan.volume)
        self.box = box_between((0, 0, 0), (0, 0, 0))
        x, y, z = (edge // 2 for edge in scan.volume.shape)
        self.go_to((x, y, z))

    def show_first(self, scan: Scan) -> None:
        """Show a coarse picture of a volume, in which no frame can be segmented."""
        self.set_scan(scan)
        self.histogram.set_level(None)
        self._show_boxes(False)

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
        self._show_painting()
        self.moved.emit()
        if moved:
            self.boxMoved.emit()

    def show_preview(self, found: Segmentation | None, box: Box) -> None:
        """Overlay the grains of the preview."""
        self._labels = None if found is None else SliceImages(found.labels.array)
        for view in self.views:
            view.set_class_colours(None)
        self.grains.clear()
        self._surface, self._part = None, box
        self.histogram.set_denoised(None if found is None else found.seen)
        self._show_boxes(True)
        self._lay_over()

    def show_segmentation(
        self, found: Segmentation, labels: SliceImages, colours: NDArray[np.uint8] | None = None
    ) -> None:
        """Overlay the grains of the whole volume, in colours as of :meth:`SliceView.set_class_colours`."""
        for view in self.views:
            view.set_class_colours(colours)
        self._class_colours = colours
        if self._surface is not None and self._surface[0] is found.labels:
            self.show_surface(*self._surface)
        else:
            self.surfaceWanted.emit(found.labels)
        self._labels, self._part = labels, box_between((0, 0, 0), found.labels.shape)
        self.histogram.set_denoised(found.seen)
        self.histogram.set_level(found.level)
        self._show_boxes(False)
        self._lay_over()

    def show_surface(self, labels: Volume, surface: LabelSurface) -> None:
        """Show the surfaces of labels in three dimensions, in the colours of the slices."""
        self._surface = labels, surface
        highest = int(surface.labels.max(initial=0))
        colours = self._class_colours
        if colours is None:
            colours = colours_of_labels(np.arange(highest + 1))
        self.grains.show(surface, colours, self._highlighted)

    def highlight(self, labels: set[int]) -> None:
        """Let grains stand out among all others in three dimensions; none for all alike."""
        changed, self._highlighted = labels != self._highlighted, labels
        if changed and self._surface is not None:
            self.show_surface(*self._surface)

    def set_painting(self, panel: BrushPanel | None) -> None:
        """Let the mouse paint with the brush of a panel, or go back to choosing voxels."""
        self._panel = panel
        for view in self.views:
            view.brush = None if panel is None else lambda: panel.brush
            view.canvas.setCursor(Qt.CursorShape.ArrowCursor if panel is None else Qt.CursorShape.CrossCursor)
        self._lay_over()
        self._show_painting()

    def set_line_tool(self, brush: Callable[[], Brush] | None) -> None:
        """Let the mouse draw lines or boxes over the grains, or go back to choosing voxels."""
        for view in self.views:
            view.brush = brush
            view.canvas.setCursor(Qt.CursorShape.ArrowCursor if brush is None else Qt.CursorShape.CrossCursor)

    def set_overlay(self, overlay: str) -> None:
        """Show another side of the prediction: probability, class, uncertainty or none."""
        self._overlay = overlay
        self._show_painting()

    def show_strokes(self, positions: IntArray, labels: IntArray) -> None:
        """Show painted voxels, shape (n, 3), and their classes, shape (n,)."""
        self._painted = positions, labels
        self._show_painting()

    def show_predictions(self, found: Sequence[SlicePrediction]) -> None:
        """Show the probabilities of slices, as far as they are still seen."""
        self._predicted |= {each.axis: each for each in found}
        self._show_painting()

    def clear_predictions(self) -> None:
        """Forget all probabilities."""
        self._predicted.clear()
        self._show_painting()

    def _show_boxes(self, shown: bool) -> None:
        for view in self.views:
            view.set_box_shown(shown)

    def _show_painting(self) -> None:
        positions, labels = self._painted
        for view in self.views:
            number = self.position[view.axis]
            here = positions[:, view.axis] == number
            shown = self._panel is not None and self._scan is not None
            found = self._predicted.get(view.axis)
            seen = shown and found is not None and found.number == number
            view.show_overlay(overlay_picture(found, self._overlay) if seen and found else None)
            if not shown or self._scan is None or not here.any():
                view.show_paint(None)
                continue
            size = self._scan.volume.shape[view.across], self._scan.volume.shape[view.down]
            view.show_paint(paint_picture(positions[here][:, [view.across, view.down]], labels[here], size))

    def _turn(self, axis: int, number: int) -> None:
        position = list(self.position)
        position[axis] = number
        self.go_to((position[0], position[1], position[2]))

    def _lay_over(self) -> None:
        labels = self._labels if self._panel is None else None
        for view in self.views:
            view.show_grains(labels, self._part, self.position[view.axis])

    def _arrange(self) -> None:
        above = equal_parts(Qt.Orientation.Horizontal, self.views)
        below = equal_parts(Qt.Orientation.Horizontal, [self.histogram, self.grains.frame])
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
