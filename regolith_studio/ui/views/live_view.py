"""A view that renders with OpenGL into the window."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from PySide6.QtCore import QEvent, QMessageLogContext, QtMsgType, qInstallMessageHandler
from PySide6.QtGui import QHideEvent, QKeyEvent, QMouseEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget
from pyvistaqt import QtInteractor

from regolith_studio.scene import annotations, cameras, plotter_setup
from regolith_studio.scene.cameras import CameraPose
from regolith_studio.scene.palette import LIGHT, ThemeColors
from regolith_studio.ui.layout import vbox
from regolith_studio.ui.views.view import CameraMouse, KeepFramed, Picture


class _Canvas(QtInteractor):
    """A QtInteractor that leaves mouse, keys and dropped files to the program."""

    mouse: CameraMouse | None = None

    def __init__(self, parent: QWidget) -> None:
        with _without_format_warning():
            super().__init__(parent, auto_update=False, multi_samples=0)
        self.setAcceptDrops(False)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if self.mouse:
            self.mouse.press(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self.mouse:
            self.mouse.drag(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self.mouse:
            self.mouse.release(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        event.ignore()

    def wheelEvent(self, event: QWheelEvent) -> None:
        if self.mouse:
            self.mouse.wheel(event)

    def leaveEvent(self, event: QEvent) -> None:  # noqa: ARG002
        if self.mouse:
            self.mouse.leave()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self.mouse:
            self.mouse.key(event)
        else:
            event.ignore()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        event.ignore()


@contextmanager
def _without_format_warning() -> Iterator[None]:
    """pyvistaqt sets the default format once more; that it is the one already in use, Qt cannot see."""

    def handle(kind: QtMsgType, context: QMessageLogContext, text: str) -> None:
        if "Setting a new default format" not in text and before is not None:
            before(kind, context, text)

    before = qInstallMessageHandler(handle)
    try:
        yield
    finally:
        qInstallMessageHandler(before)


class LiveView(QWidget):
    """See :class:`~regolith_studio.ui.views.view.SceneView`."""

    def __init__(self, surroundings: ThemeColors = LIGHT, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas: Any = _Canvas(self)
        self.mouse = CameraMouse(lambda: self.pose, self._move, self)
        self._canvas.mouse = self.mouse
        self._canvas.setMouseTracking(True)
        plotter_setup.set_stage(self._canvas, surroundings)
        self._scale_bar = annotations.ScaleBar(self._canvas, surroundings)
        self._moved: list[Callable[[CameraPose], None]] = []
        self._refitting = KeepFramed(self)
        vbox(self._canvas, parent=self)

    @property
    def widget(self) -> QWidget:
        return self

    @property
    def pose(self) -> CameraPose:
        return cameras.pose_of(self._canvas)

    def draw(self, fill: Callable[[Any], None]) -> None:
        fill(self._canvas)
        self._canvas.renderer.ResetCameraClippingRange()
        self._canvas.update()

    def set_pose(self, pose: CameraPose) -> None:
        cameras.apply_pose(self._canvas, pose)
        self._refitting.placed()
        self._canvas.update()

    def when_moved(self, callback: Callable[[CameraPose], None]) -> None:
        self._moved.append(callback)

    def set_surroundings(self, surroundings: ThemeColors) -> None:
        plotter_setup.set_background(self._canvas, surroundings)
        self._scale_bar.set_ink(surroundings)
        self._canvas.update()

    def set_font_factor(self, factor: float) -> None:
        self._scale_bar.set_factor(factor)
        self._canvas.update()

    def picture(self) -> Picture:
        image = self._canvas.grabFramebuffer()
        image = image.convertToFormat(image.Format.Format_RGB888)
        rows = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
        return rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).copy()

    def shot(self, scale: int = 1, transparent: bool = False) -> Picture:
        self._scale_bar.suspended = True
        try:
            return plotter_setup.thumbnail(self._canvas, scale, transparent)
        finally:
            self._scale_bar.suspended = False
            self._canvas.update()

    def release(self) -> None:
        self._moved.clear()
        self.mouse.forget()
        if self._canvas is not None:
            self._scale_bar.remove()
            self._canvas.mouse = None
            self._canvas.close()
            self._canvas = None

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._canvas is not None:
            self._refitting.resized()

    def hideEvent(self, event: QHideEvent) -> None:
        """Give back frame buffers, shaders and surfaces on the graphics card, some 10 MB a view.

        VTK makes them again for the next picture, which takes 0.01 s longer with software OpenGL. A minimized
        window keeps them.
        """
        super().hideEvent(event)
        if self._canvas is not None and not event.spontaneous():
            self._canvas.render_window.Finalize()

    def _move(self, pose: CameraPose) -> None:
        self.set_pose(pose)
        for callback in self._moved:
            callback(pose)
