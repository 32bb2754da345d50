"""A view that renders with OpenGL into the window."""

from collections.abc import Iterator
from contextlib import contextmanager

from PySide6.QtCore import QEvent, QMessageLogContext, QtMsgType, qInstallMessageHandler
from PySide6.QtGui import QHideEvent, QImage, QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QWidget
from pyvistaqt import QtInteractor

from regolith_studio.ui.layout import vbox
from regolith_studio.ui.views.view import CameraMouse, SceneView


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


class LiveView(SceneView):
    """A view of OpenGL, on a canvas of its own."""

    def __init__(self) -> None:
        super().__init__()
        canvas = _Canvas(self)
        canvas.mouse = self.mouse
        canvas.setMouseTracking(True)
        self._set_stage(canvas)
        vbox(canvas, parent=self)

    def release(self) -> None:
        if self._plotter is not None:
            self._plotter.mouse = None
        super().release()

    def _ask(self) -> None:
        self._plotter.update()

    def _current_image(self) -> QImage:
        image: QImage = self._plotter.grabFramebuffer()
        return image.convertToFormat(QImage.Format.Format_RGB888)

    def hideEvent(self, event: QHideEvent) -> None:
        """Give back frame buffers, shaders and surfaces on the graphics card, some 10 MB a view.

        VTK makes them again for the next picture, which takes 0.01 s longer with software OpenGL. A minimized
        window keeps them.
        """
        super().hideEvent(event)
        if self._plotter is not None and not event.spontaneous():
            self._plotter.render_window.Finalize()
