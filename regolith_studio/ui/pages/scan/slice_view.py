"""View of one slice of a volume with an overlay of the grains."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, QSignalBlocker, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainterPath, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QBoxLayout, QLabel, QSlider, QWidget

from regolith_studio.imaging.volume import Box, Volume
from regolith_studio.imaging.volume_slabs import SliceImages
from regolith_studio.ui.layout import hbox, named, vbox
from regolith_studio.ui.pages.scan.tools import CLASS_COLOURS, Brush
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr

AXES = "xyz"
ZOOM = 1.25
"""Factor of one notch of the wheel with Ctrl."""
MIN_SLIDER = 80
"""Pixels beside a title for a slider with its margins."""
_OPACITY = 105
_TONES = ((0.75, 1.0), (0.45, 1.0), (0.95, 0.8), (0.6, 0.65))
"""Saturation and value in turn: labels that are a Fibonacci number apart have about the same hue."""


@cache
def label_colours() -> NDArray[np.uint8]:
    """RGBA colours of 255 labels with distant hues, shape (256, 4); entry 0 is transparent."""
    hues = (np.arange(255) * 0.618033988749895) % 1.0
    table = np.zeros((256, 4), dtype=np.uint8)
    for number, (row, hue) in enumerate(zip(table[1:], hues, strict=True)):
        saturation, value = _TONES[number % len(_TONES)]
        row[:] = QColor.fromHsvF(float(hue), saturation, value, _OPACITY / 255).getRgb()
    return table


def colours_of_labels(labels: NDArray[np.int64]) -> NDArray[np.uint8]:
    """RGBA colours of labels of any shape, which come again after 255; 0 and less is transparent."""
    return label_colours()[np.where(labels > 0, (labels - 1) % 255 + 1, 0)]


class SliceView(QWidget):
    """Shows the slice of one direction; a click selects a voxel, the wheel another slice; Ctrl zooms.

    ``axis``: direction of view: 0, 1 or 2.
    """

    placePicked = Signal(int, int, int)  # noqa: N815
    """A voxel that was clicked."""
    sliceChosen = Signal(int, int)  # noqa: N815
    """Axis and number of another slice."""
    hovered = Signal(object)
    """The voxel under the mouse, ``None`` where it has left the slice."""
    strokeDrawn = Signal(int, int, object)  # noqa: N815
    """Axis and number of the slice, and the corners of the line across it in voxels, shape (n, 2)."""

    def __init__(self, axis: int) -> None:
        super().__init__()
        self.axis = axis
        self.across, self.down = (each for each in range(3) if each != axis)
        self._volume: Volume | None = None
        self._sections: SliceImages | None = None
        self._class_colours: NDArray[np.uint8] | None = None
        self.title, self._titles = named(QLabel(), role="heading"), ("", "")
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.slider.setObjectName(f"slice_{AXES[axis]}")
        self.slider.setAccessibleName(tr("Slice along {axis}", axis=AXES[axis]))
        self.canvas = _Canvas(self)
        self._grey, self._grains = pg.ImageItem(), pg.ImageItem()
        self._prediction, self._paint = pg.ImageItem(), pg.ImageItem()
        self._line = pg.QtWidgets.QGraphicsPathItem()
        self.brush: Callable[[], Brush] | None = None
        self._corners: list[QPointF] = []
        self._frame = pg.QtWidgets.QGraphicsRectItem()
        self._cross = [pg.InfiniteLine(angle=angle) for angle in (90, 0)]
        self._arrange()
        self.slider.valueChanged.connect(lambda number: self.sliceChosen.emit(self.axis, number))
        self.set_theme(current_theme())

    def set_theme(self, theme: Theme) -> None:
        self.canvas.setBackground(theme.window)
        self._frame.setPen(pg.mkPen(theme.accent, width=2))
        for line in self._cross:
            line.setPen(pg.mkPen(QColor(theme.accent).lighter(120), width=1, style=Qt.PenStyle.DotLine))

    def set_volume(self, volume: Volume, sections: SliceImages, contrast: tuple[float, float]) -> None:
        """Show another volume as a whole, in micrometres."""
        self._volume, self._sections = volume, sections
        self._grey.setLevels(contrast)
        self._grains.clear()
        with QSignalBlocker(self.slider):
            self.slider.setRange(0, volume.shape[self.axis] - 1)
        width, height = (volume.shape[each] * volume.voxel_size[each] for each in (self.across, self.down))
        self.canvas.view.setRange(QRectF(0, 0, width, height), padding=0.02)

    def show_position(self, position: tuple[int, int, int], box: Box) -> None:
        """Show the slice through a voxel, with a crosshair and the box of the preview."""
        if self._volume is None or self._sections is None:
            return
        number, count = position[self.axis], self._volume.shape[self.axis]
        with QSignalBlocker(self.slider):
            self.slider.setValue(number)
        place = {"axis": AXES[self.axis], "number": number + 1, "count": count}
        plane = AXES[self.across] + AXES[self.down]
        self._titles = (
            tr("{plane}, {axis} = {number} of {count}", plane=plane, **place),
            tr("{axis} = {number} of {count}", **place),
        )
        self._place_title()
        picture = self._sections.picture(self.axis, number)
        whole = (self._volume.shape[self.across], self._volume.shape[self.down])
        if self._volume.kind == "labels":
            self._grey.clear()
            self._set(self._grains, self._painted(picture), (0, 0), whole)
        else:
            self._set(self._grey, np.asarray(picture, dtype=np.float32), (0, 0), whole)
        for line, each in zip(self._cross, (self.across, self.down), strict=True):
            line.setValue((position[each] + 0.5) * self._volume.voxel_size[each])
        corner = self._rectangle(
            (box[self.across].start, box[self.down].start),
            (_length(box[self.across]), _length(box[self.down])),
        )
        self._frame.setRect(corner)
        self._frame.setVisible(box[self.axis].start <= number < box[self.axis].stop)

    def show_grains(self, labels: SliceImages | None, box: Box, number: int) -> None:
        """Overlay the grains of a part of the volume, if it intersects the slice."""
        side = box[self.axis]
        if self._volume is None or self._volume.kind == "labels":
            return
        if labels is None or not side.start <= number < side.stop:
            self._grains.clear()
            return
        picture = labels.picture(self.axis, number - side.start)
        start = (box[self.across].start, box[self.down].start)
        size = (_length(box[self.across]), _length(box[self.down]))
        self._set(self._grains, self._painted(picture), start, size)

    def set_class_colours(self, colours: NDArray[np.uint8] | None) -> None:
        """Give each label a colour, RGBA of shape (n_labels + 1, 4), or go back to distant hues."""
        self._class_colours = colours

    def show_overlay(self, picture: NDArray[np.uint8] | None) -> None:
        """Overlay the prediction of this slice, RGBA of shape (n_across, n_down, 4); it may be coarser."""
        if picture is None or self._volume is None:
            self._prediction.clear()
            return
        self._set(self._prediction, picture, (0, 0), self._size())

    def show_paint(self, picture: NDArray[np.uint8] | None) -> None:
        """Overlay what is painted in this slice, RGBA of shape (n_across, n_down, 4)."""
        if picture is None or self._volume is None:
            self._paint.clear()
            return
        self._set(self._paint, picture, (0, 0), self._size())

    def _size(self) -> tuple[int, int]:
        assert self._volume is not None
        return self._volume.shape[self.across], self._volume.shape[self.down]

    def begin_stroke(self, point: QPointF) -> bool:
        """Begin a line at a point of the view in micrometres; returns whether strokes are drawn."""
        if self.brush is None or self._volume is None:
            return False
        self._corners = []
        brush = self.brush()
        width = brush.diameter * float(self._volume.voxel_size[self.across])
        colour = QColor("white" if brush.label < 0 else CLASS_COLOURS[brush.label])
        colour.setAlpha(150)
        pen = pg.mkPen(colour, width=width, cosmetic=False)
        pen.setCapStyle(Qt.PenCapStyle.RoundCap)
        pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        self._line.setPen(pen)
        self.extend_stroke(point)
        return True

    def extend_stroke(self, point: QPointF) -> None:
        """Draw the line on to a point of the view."""
        shape = self.brush().shape if self.brush is not None else "free"
        self._corners = [*(self._corners if shape == "free" else self._corners[:1]), point]
        path = QPainterPath(self._corners[0])
        if shape == "box":
            path.addRect(QRectF(self._corners[0], point).normalized())
        else:
            for corner in self._corners if len(self._corners) > 1 else self._corners * 2:
                path.lineTo(corner)
        self._line.setPath(path)

    def end_stroke(self) -> None:
        """Hand the line over."""
        corners, self._corners = self._corners, []
        self._line.setPath(QPainterPath())
        if self._volume is not None and corners:
            edges = self._volume.voxel_size[[self.across, self.down]]
            points = np.array([(each.x(), each.y()) for each in corners]) / edges
            self.strokeDrawn.emit(self.axis, self.slider.value(), points)

    @property
    def is_drawing(self) -> bool:
        return bool(self._corners)

    def set_box_shown(self, shown: bool) -> None:
        self._frame.setOpacity(1.0 if shown else 0.0)

    def _painted(self, labels: NDArray[Any]) -> NDArray[np.uint8]:
        number = labels.astype(np.int64)
        if self._class_colours is not None:
            return self._class_colours[np.clip(number, 0, len(self._class_colours) - 1)]
        colours = colours_of_labels(number)
        if self._volume is not None and self._volume.kind == "labels":  # on no grey values
            colours[number > 0, 3] = 255
        return colours

    def _set(self, item: Any, picture: NDArray[Any], start: tuple[int, int], size: tuple[int, int]) -> None:
        """Set an image that covers so many voxels, which may have fewer pixels."""
        item.setImage(picture, autoLevels=False)
        item.setRect(self._rectangle(start, size))

    def _rectangle(self, start: tuple[int, int], size: tuple[int, int]) -> QRectF:
        assert self._volume is not None
        wide, high = (float(self._volume.voxel_size[each]) for each in (self.across, self.down))
        return QRectF(start[0] * wide, start[1] * high, size[0] * wide, size[1] * high)

    def _arrange(self) -> None:
        view = self.canvas.view
        layers = (self._grey, self._grains, self._prediction, self._paint, self._line)
        for item in (*layers, self._frame, *self._cross):
            view.addItem(item)
        self._frame.setBrush(pg.mkBrush(None))
        self._head = hbox(self.title, (self.slider, 1), margins=(4, 0, 4, 0))
        vbox(self._head, (self.canvas, 1), parent=self, spacing=2)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place_title()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            QTimer.singleShot(0, self, self._place_title)  # the title gets its font after this

    def minimumSizeHint(self) -> QSize:
        """As narrow as the shorter title."""
        return QSize(self._title_width(1) + 8, super().minimumSizeHint().height())

    def _title_width(self, which: int) -> int:
        return self.title.fontMetrics().horizontalAdvance(self._titles[which])

    def _place_title(self) -> None:
        """Put the slider beside the title, or below a shorter one where there is little room."""
        beside = self._title_width(0) + MIN_SLIDER <= self.width()
        self.title.setText(self._titles[not beside])
        direction = QBoxLayout.Direction
        self._head.setDirection(direction.LeftToRight if beside else direction.TopToBottom)

    def picked(self, point: QPointF) -> None:
        """Select the voxel at a point of the scene in micrometres."""
        if self._volume is not None:
            position = self._voxel_at(point)
            ends = (each - 1 for each in self._volume.shape)
            self.placePicked.emit(*(min(max(at, 0), end) for at, end in zip(position, ends, strict=True)))

    def hover(self, point: QPointF | None) -> None:
        if self._volume is None or point is None:
            self.hovered.emit(None)
            return
        position = self._voxel_at(point)
        inside = all(0 <= at < edge for at, edge in zip(position, self._volume.shape, strict=True))
        self.hovered.emit(position if inside else None)

    def _voxel_at(self, point: QPointF) -> tuple[int, int, int]:
        """The voxel at a point of the scene in micrometres, maybe outside."""
        assert self._volume is not None
        position = [0, 0, 0]
        position[self.axis] = self.slider.value()
        for each, where in ((self.across, point.x()), (self.down, point.y())):
            position[each] = int(np.floor(where / self._volume.voxel_size[each]))
        return position[0], position[1], position[2]

    def turn(self, steps: int) -> None:
        """Go some slices forward or back."""
        self.slider.setValue(self.slider.value() + steps)


class _Canvas(pg.GraphicsView):  # type: ignore[misc]
    """Fits the slice to its size and forwards clicks and the wheel to the view."""

    def __init__(self, owner: SliceView) -> None:
        super().__init__()
        self._owner = owner
        self.view = pg.ViewBox(lockAspect=True, invertY=True, enableMouse=False, enableMenu=False)
        self.setCentralItem(self.view)
        self.setFrameShape(self.Shape.NoFrame)
        self.setAccessibleName(tr("Slice along {axis}, picture", axis=AXES[owner.axis]))
        self.scene().sigMouseClicked.connect(self._clicked)

    def wheelEvent(self, event: QWheelEvent) -> None:
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            place = self.view.mapSceneToView(self.mapToScene(event.position().toPoint()))
            factor = ZOOM if event.angleDelta().y() < 0 else 1 / ZOOM
            self.view.scaleBy((factor, factor), center=place)
            event.accept()
            return
        self._owner.turn(1 if event.angleDelta().y() > 0 else -1)
        event.accept()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self._owner.begin_stroke(self._point(event)):
            event.accept()
            return
        super().mousePressEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._owner.is_drawing:
            self._owner.extend_stroke(self._point(event))
            event.accept()
            return
        self._owner.hover(self._point(event))
        super().mouseMoveEvent(event)

    def leaveEvent(self, event: QEvent) -> None:
        self._owner.hover(None)
        super().leaveEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._owner.is_drawing:
            self._owner.end_stroke()
            event.accept()
            return
        super().mouseReleaseEvent(event)

    def _point(self, event: QMouseEvent) -> QPointF:
        """Where the mouse is, in micrometres."""
        point: QPointF = self.view.mapSceneToView(self.mapToScene(event.position().toPoint()))
        return point

    def _clicked(self, event: Any) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._owner.picked(self.view.mapSceneToView(event.scenePos()))


def _length(side: slice) -> int:
    return int(side.stop - side.start)
