"""The slices of a scan, their grey levels and grains, and what is painted on them."""

from collections.abc import Callable, Mapping, Sequence, Set

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QStackedLayout, QWidget

from regolith_studio.geometry.arrays import IntArray
from regolith_studio.imaging.label_surface import LabelSurface
from regolith_studio.imaging.segmentation.segment import Segmentation
from regolith_studio.imaging.segmentation.thresholding import Histogram
from regolith_studio.imaging.volume import Box, Volume, box_about, box_between
from regolith_studio.imaging.volume_slabs import SliceImages
from regolith_studio.jobs.classifier_jobs import SlicePrediction
from regolith_studio.jobs.scan_jobs import Scan
from regolith_studio.messages import N_
from regolith_studio.scene.cameras import framing_pose
from regolith_studio.scene.surfaces import show_grains
from regolith_studio.ui.layout import STRETCH, equal_parts, named, vbox
from regolith_studio.ui.pages.scan.slice_view import SliceView, colours_of_labels
from regolith_studio.ui.pages.scan.tools import CLASS_COLOURS, Brush, BrushPanel
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import number_text, tr, tr_count
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.views.view import CameraLink, ViewFrame
from regolith_studio.ui.widgets.labels import ElidedLabel, grouped_number, hint_label
from regolith_studio.ui.widgets.plots.base import Numbers, Plot
from regolith_studio.ui.widgets.plots.curves import plain_decades

MIN_PERCENTAGE = 1e-4
"""Height of empty bins on the logarithmic axis."""


class HistogramPlot(Plot):
    """Histograms before and after denoising."""

    levelDragged = Signal(float)  # noqa: N815
    """Grey value of the line while it is dragged or after it is released."""

    def __init__(self) -> None:
        self._scanned: Histogram | None = None
        self._denoised: Histogram | None = None
        self._curves: list[pg.PlotDataItem] = []
        self.line = pg.InfiniteLine(
            angle=90, movable=True, label="", labelOpts={"position": 0.92, "movable": False}
        )
        super().__init__(
            tr("Grey value"),
            tr("Voxels [%]"),
            tr("Open a volume of grey values to see its histogram."),
        )
        self.canvas.setLogMode(x=False, y=True)
        self.canvas.getAxis("left").logTickStrings = plain_decades
        self.canvas.addItem(self.line, ignoreBounds=True)
        self.canvas.setAccessibleName(tr("Histogram of grey values with the threshold"))
        self.line.sigPositionChanged.connect(
            lambda line: line.label.setText(number_text(float(line.value()), ".4g"))
        )
        self.line.sigDragged.connect(lambda line: self.levelDragged.emit(float(line.value())))

    def set_scanned(self, seen: Histogram | None) -> None:
        self._scanned, self._denoised = seen, None
        self.set_empty(seen is None, tr("A volume of labels has no histogram of grey values."))
        self.redraw()

    def set_denoised(self, seen: Histogram | None) -> None:
        """Set the histogram after denoising, of the preview or of the volume."""
        self._denoised = seen
        self.redraw()

    def set_level(self, level: float | None) -> None:
        """Move the line without emitting a signal."""
        self.line.setVisible(level is not None)
        if level is not None and level != self.line.value():
            self.line.setValue(level)

    def set_theme(self, theme: Theme) -> None:
        super().set_theme(theme)
        self.line.setPen(pg.mkPen(theme.accent, width=2))
        self.line.setHoverPen(pg.mkPen(theme.accent, width=4))
        self.line.label.setColor(theme.accent)
        self.line.label.fill = pg.mkBrush(theme.base)

    def value_at(self, place: QPointF) -> str:
        """Grey values of the bin at a position and their share of the voxels."""
        box = self.canvas.getViewBox()
        if not self._shown() or not box.sceneBoundingRect().contains(place):
            return ""
        value = float(box.mapSceneToView(place).x())
        first, *_ = (seen for seen, _, _ in self._shown())
        found = first.bin_of(value)
        if found is None:
            return ""
        lines = [_bin_text(first, found)]
        for seen, _, label in self._shown():
            place_in = seen.bin_of(value)
            if place_in is not None:
                share = 100 * seen.shares[place_in]
                lines.append(tr("{label}: {share:.3g} % of voxels", label=label, share=share))
        return "\n".join(lines)

    def numbers(self) -> Numbers:
        rows: list[tuple[str | float, ...]] = [
            (label, float(low), float(high), int(count))
            for seen, _, label in self._shown()
            for low, high, count in zip(seen.edges[:-1], seen.edges[1:], seen.counts, strict=True)
        ]
        return (tr("Histogram"), tr("From"), tr("To"), tr("Voxels")), rows

    def redraw(self) -> None:
        for curve in self._curves:
            self.canvas.removeItem(curve)
        self._curves = [
            self.canvas.plot(
                seen.edges,
                np.maximum(100 * seen.shares, MIN_PERCENTAGE),
                stepMode="center",
                pen=self.pen(colour, 1.0),
            )
            for seen, colour, _ in self._shown()
        ]
        self.set_legend([(colour, label) for _, colour, label in self._shown()])
        self.line.setZValue(10)

    def _shown(self) -> list[tuple[Histogram, str, str]]:
        """Histograms with their colours and names."""
        known = [
            (self._scanned, self.theme.particle, tr("as scanned")),
            (self._denoised, self.theme.fit, tr("denoised")),
        ]
        return [(seen, colour, label) for seen, colour, label in known if seen is not None]


def _bin_text(seen: Histogram, place: int) -> str:
    low, high = float(seen.edges[place]), float(seen.edges[place + 1])
    if high - low == 1.0 and low % 1.0 == 0.5:
        return tr("Grey value {value:g}", value=low + 0.5)
    return tr("Grey values {low:.4g} to {high:.4g}", low=low, high=high)


_NONE = np.zeros((0, 3), dtype=np.uint8)


class GrainsView:
    """A view with its title; the camera is placed anew for another volume only.

    ``views``: backend of three-dimensional views.
    """

    def __init__(self, views: str) -> None:
        self.frame = ViewFrame(make_view(views), "grains_view")
        self._camera = CameraLink([self.frame.view])
        self._size = np.ones(3)

    def set_volume(self, volume: Volume) -> None:
        self._size = np.array(volume.shape) * volume.voxel_size
        extent = " × ".join(number_text(edge, ".4g" if edge < 1e4 else ".0f") for edge in self._size.tolist())
        self._extent = tr("{edges} µm", edges=extent)
        self.frame.view.set_pose(framing_pose(np.array([np.zeros(3), self._size]), turning=True))
        self.clear()

    def clear(self) -> None:
        self.frame.set_texts(tr("Volume"), self._extent)
        self.frame.view.draw(lambda plotter: show_grains(plotter, None, _NONE, self._size))

    def show(
        self, surface: LabelSurface, colours: NDArray[np.uint8], highlighted: Set[int] = frozenset()
    ) -> None:
        """Show grains.

        Parameters
        ----------
        colours
            RGBA for each label, shape (n_labels + 1, 4).
        highlighted
            Labels that are seen through all others; with none, all are opaque.
        """
        labels = np.minimum(surface.labels, len(colours) - 1)
        rgb = np.ascontiguousarray(colours[labels, :3])
        count = len(np.unique(surface.labels))
        self.frame.set_texts(tr_count(N_("1 grain"), N_("{count} grains"), count), self._extent)
        self.frame.view.draw(lambda plotter: show_grains(plotter, surface, rgb, self._size, highlighted))

    def release(self) -> None:
        self.frame.view.release()


_OPACITY, _PAINT_OPACITY = 110, 220
_COLOURS = np.array([QColor(each).getRgb() for each in CLASS_COLOURS], dtype=np.uint8)


def overlay_picture(found: SlicePrediction, overlay: str) -> NDArray[np.uint8] | None:
    """RGBA of a prediction, shape (n_across, n_down, 4), or ``None`` for none.

    ``overlay``: ``probability`` of grain (the likelier, the more opaque), the likeliest ``class``,
    ``uncertainty`` (opaque where the two likeliest classes are equally likely), or ``none``.
    """
    if overlay == "none":
        return None
    picture = np.empty((*found.grain.shape, 4), dtype=np.uint8)
    if overlay == "class":
        picture[...] = _COLOURS[found.probabilities.argmax(axis=-1)]
        picture[..., 3] = _OPACITY
        return picture
    if overlay == "uncertainty":
        second, first = np.moveaxis(np.sort(found.probabilities, axis=-1)[..., -2:], -1, 0)
        picture[...] = (255, 255, 0, 0)
        picture[..., 3] = np.rint(200 * (1 - (first - second)))
        return picture
    picture[...] = _COLOURS[1]
    picture[..., 3] = np.rint(2 * _OPACITY * np.clip(found.grain, 0, 1) * 0.7)
    return picture


def paint_picture(places: IntArray, labels: IntArray, size: tuple[int, int]) -> NDArray[np.uint8]:
    """RGBA of painted voxels, shape (n_across, n_down, 4), transparent elsewhere.

    ``places``, ``labels``: voxels across and down, shape (n, 2), and their classes, shape (n,). ``size``:
    voxels of the slice across and down.
    """
    picture = np.zeros((*size, 4), dtype=np.uint8)
    picture[tuple(places.T)] = _COLOURS[labels]
    picture[..., 3] = np.where(picture[..., 3] > 0, _PAINT_OPACITY, 0)
    return picture


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
        self._surface: tuple[Volume, LabelSurface, Mapping[int, int]] | None = None
        self._class_colours: NDArray[np.uint8] | None = None
        self._highlighted: set[int] = set()
        self.position = (0, 0, 0)
        self._pointed: tuple[int, int, int] | None = None
        self.box: Box = box_between((0, 0, 0), (1, 1, 1))
        self._scan: Scan | None = None
        self._labels: SliceImages | None = None
        self._found: Segmentation | None = None
        self._part: Box = self.box
        self._predicted: dict[int, SlicePrediction] = {}
        self._overlay = "probability"
        self._painted = np.zeros((0, 3), np.int64), np.zeros(0, np.int64)
        self._panel: BrushPanel | None = None
        self._arrange()
        for view in self.views:
            view.placePicked.connect(lambda x, y, z: self.go_to((x, y, z)))
            view.placePicked.connect(lambda x, y, z, axis=view.axis: self.picked.emit(x, y, z, axis))
            view.hovered.connect(self._tell)
            view.sliceChosen.connect(self._turn)
            view.strokeDrawn.connect(self.strokeDrawn)

    def set_scan(self, scan: Scan) -> None:
        """Show another volume, with slices through its centre."""
        self._scan, self._labels, self._found = scan, None, None
        self._tell(None)
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
        self._found = found
        self._labels = None if found is None else SliceImages(found.labels.array)
        for view in self.views:
            view.set_class_colours(None)
        self.grains.clear()
        self._surface, self._part = None, box
        self.histogram.set_denoised(None if found is None else found.seen)
        self._show_boxes(True)
        self._lay_over()
        self._tell(self._pointed)

    def show_segmentation(
        self, found: Segmentation, labels: SliceImages, colours: NDArray[np.uint8] | None = None
    ) -> None:
        """Overlay the grains of the whole volume, in colours as of :meth:`SliceView.set_class_colours`."""
        for view in self.views:
            view.set_class_colours(colours)
        self._class_colours, self._found = colours, found
        if self._surface is not None and self._surface[0] is found.labels:
            self.show_surface(*self._surface)
        else:
            self.surfaceWanted.emit(found.labels)
        self._labels, self._part = labels, box_between((0, 0, 0), found.labels.shape)
        self.histogram.set_denoised(found.seen)
        self.histogram.set_level(found.level)
        self._show_boxes(False)
        self._lay_over()
        self._tell(self._pointed)

    def show_surface(self, labels: Volume, surface: LabelSurface, sizes: Mapping[int, int]) -> None:
        """Show the surfaces of labels in three dimensions, in the colours of the slices.

        Parameters
        ----------
        sizes
            Voxels of each label: the number of the one under the mouse is shown.
        """
        self._surface = labels, surface, sizes
        highest = int(surface.labels.max(initial=0))
        colours = self._class_colours
        if colours is None:
            colours = colours_of_labels(np.arange(highest + 1))
        self.grains.show(surface, colours, self._highlighted)
        self._tell(self._pointed)

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

    def _tell(self, position: tuple[int, int, int] | None) -> None:
        """Tell place, grey value and grain of the voxel under the mouse, counted from 1."""
        self._pointed = position
        if self._scan is None or position is None:
            self.readout.setText("")
            return
        parts = [", ".join(f"{axis} = {at + 1}" for axis, at in zip("xyz", position, strict=True))]
        value = self._scan.volume.array[position]
        if self._scan.volume.kind == "grey":
            parts.append(tr("grey value {value:.4g}", value=float(value)))
        if label := self._label_at(position):
            parts.append(self._grain_text(label))
        self.readout.setText("    ".join(parts))

    def _label_at(self, position: tuple[int, int, int]) -> int:
        """Label of the grain that is shown there; 0 for none."""
        if self._scan is not None and self._scan.volume.kind == "labels":
            return int(self._scan.volume.array[position])
        if self._found is None:
            return 0
        places = [at - side.start for at, side in zip(position, self._part, strict=True)]
        inside = all(0 <= at < edge for at, edge in zip(places, self._found.labels.shape, strict=True))
        return max(0, int(self._found.labels.array[tuple(places)])) if inside else 0

    def _grain_text(self, label: int) -> str:
        """The grain with its size, which is known as soon as the surfaces of these labels are."""
        shown = self._found.labels if self._found is not None else None
        known = self._surface is not None and (shown is None or self._surface[0] is shown)
        count = self._surface[2].get(label) if known and self._surface is not None else None
        if count is None or self._scan is None:
            return tr("grain {label}", label=label)
        return tr(
            "grain {label}: {count:,} voxels, {volume} µm³",
            label=label,
            count=count,
            volume=grouped_number(count * float(np.prod(self._scan.volume.voxel_size))),
        )

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
        self.readout = named(ElidedLabel(role="hint"), "scan_readout")
        slices = QWidget()
        vbox((above, 1), self.readout, parent=slices, spacing=2)
        below = equal_parts(Qt.Orientation.Horizontal, [self.histogram, self.grains.frame])
        page = equal_parts(Qt.Orientation.Vertical, [slices, below])
        hint = QWidget()
        words = hint_label(
            tr(
                "Open a CT volume: TIFF stack, folder of slices, TXM, DICOM, OME-Zarr, Amira, HDF5, NRRD, "
                "MetaImage, NIfTI, NPY, raw, or the header of a scanner. Drop it here, or begin with the "
                "sample scan."
            )
        )
        words.setAlignment(Qt.AlignmentFlag.AlignCenter)
        vbox(STRETCH, words, STRETCH, parent=hint, margins=None)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(hint)
        self._stack.addWidget(page)
