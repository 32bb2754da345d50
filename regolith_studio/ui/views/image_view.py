"""A view that renders off-screen and shows the image; needs neither OpenGL in the window nor an X server."""

import numpy as np
import pyvista as pv
from PySide6.QtCore import QEvent, QRect, Qt
from PySide6.QtGui import QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QWheelEvent
from PySide6.QtWidgets import QSizePolicy

from regolith_studio.scene import plotter_setup
from regolith_studio.ui.views.view import Picture, SceneView


class ImageView(SceneView):
    """A view whose plotter draws off-screen when it is painted."""

    def __init__(self) -> None:
        super().__init__()
        plotter_setup.choose_off_screen_window()
        self._set_stage(pv.Plotter(off_screen=True, window_size=[64, 64]))
        self._image = QImage()
        self._stale = True
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    def shot(self, scale: int = 1, transparent: bool = False) -> Picture:
        self._render()
        return super().shot(scale, transparent)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        self._render()
        painter = QPainter(self)
        painter.drawImage(QRect(0, 0, self.width(), self.height()), self._image)
        painter.end()

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

    def _ask(self) -> None:
        self._stale = True
        self.update()

    def _current_image(self) -> QImage:
        self._render()
        return self._image

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


def make_view(kind: str) -> SceneView:
    """A view of the kind ``live`` or ``image``, in the colours of the present theme."""
    if kind == "image":
        return ImageView()
    from regolith_studio.ui.views.live_view import LiveView

    return LiveView()
