"""A view that renders off-screen and shows the image; needs neither OpenGL in the window nor an X server."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pyvista as pv
from PySide6.QtCore import QEvent, QRect, Qt
from PySide6.QtGui import QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from regolith_studio.scene import annotations, cameras, plotter_setup
from regolith_studio.scene.cameras import CameraPose
from regolith_studio.scene.palette import LIGHT, ThemeColors
from regolith_studio.ui.views.view import CameraMouse, KeepFramed, Picture, SceneView


class ImageView(QWidget):
    """See :class:`~regolith_studio.ui.views.view.SceneView`."""

    def __init__(self, surroundings: ThemeColors = LIGHT, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        plotter_setup.choose_off_screen_window()
        self._plotter: Any = pv.Plotter(off_screen=True, window_size=[64, 64])
        plotter_setup.set_stage(self._plotter, surroundings)
        self._scale_bar = annotations.ScaleBar(self._plotter, surroundings)
        self._image = QImage()
        self._stale = True
        self._moved: list[Callable[[CameraPose], None]] = []
        self._refitting = KeepFramed(self)
        self.mouse = CameraMouse(lambda: self.pose, self._move, self)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    @property
    def widget(self) -> QWidget:
        return self

    @property
    def pose(self) -> CameraPose:
        return cameras.pose_of(self._plotter)

    def draw(self, fill: Callable[[Any], None]) -> None:
        fill(self._plotter)
        self._plotter.renderer.ResetCameraClippingRange()
        self._ask()

    def set_pose(self, pose: CameraPose) -> None:
        cameras.apply_pose(self._plotter, pose)
        self._refitting.placed()
        self._ask()

    def when_moved(self, callback: Callable[[CameraPose], None]) -> None:
        self._moved.append(callback)

    def set_surroundings(self, surroundings: ThemeColors) -> None:
        plotter_setup.set_background(self._plotter, surroundings)
        self._scale_bar.set_ink(surroundings)
        self._ask()

    def set_font_factor(self, factor: float) -> None:
        self._scale_bar.set_factor(factor)
        self._ask()

    def picture(self) -> Picture:
        self._render()
        image = self._image
        rows = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
        return rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).copy()

    def shot(self, scale: int = 1, transparent: bool = False) -> Picture:
        self._render()
        self._scale_bar.suspended = True
        try:
            return plotter_setup.thumbnail(self._plotter, scale, transparent)
        finally:
            self._scale_bar.suspended = False
            self._ask()

    def release(self) -> None:
        self._moved.clear()
        self.mouse.forget()
        if self._plotter is not None:
            self._scale_bar.remove()
            self._plotter.close()
            self._plotter = None

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        self._render()
        painter = QPainter(self)
        painter.drawImage(QRect(0, 0, self.width(), self.height()), self._image)
        painter.end()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._plotter is not None:
            self._refitting.resized()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.mouse.press(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.mouse.drag(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.mouse.release(event)

    def leaveEvent(self, event: QEvent) -> None:  # noqa: ARG002
        self.mouse.leave()

    def wheelEvent(self, event: QWheelEvent) -> None:
        self.mouse.wheel(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        self.mouse.key(event)

    def _move(self, pose: CameraPose) -> None:
        self.set_pose(pose)
        for callback in self._moved:
            callback(pose)

    def _ask(self) -> None:
        self._stale = True
        self.update()

    def _render(self) -> None:
        ratio = self.devicePixelRatioF()
        size = [max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio))]
        if self._plotter is None or (not self._stale and [self._image.width(), self._image.height()] == size):
            return
        if list(self._plotter.window_size) != size:  # it draws
            self._plotter.window_size = size
        self._plotter.render()
        pixels = np.ascontiguousarray(self._plotter.screenshot(return_img=True)[..., :3])
        height, width, _ = pixels.shape
        self._image = QImage(pixels.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()
        self._stale = False


def make_view(kind: str, surroundings: ThemeColors = LIGHT, parent: QWidget | None = None) -> SceneView:
    """A view of the kind ``live`` or ``image``."""
    if kind == "image":
        return ImageView(surroundings, parent)
    from regolith_studio.ui.views.live_view import LiveView

    return LiveView(surroundings, parent)
