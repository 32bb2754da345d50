"""Mouse, wheel and keys on a view: turn with the left button, shift with the middle or right one, zoom.

What can be taken hold of in the picture, such as the line of a wipe, comes before the camera.
"""

from collections.abc import Callable
from typing import Protocol

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from regolith_studio.scene.cameras import CameraPose, Projection, orbited, panned, rolled, zoomed

WHEEL_ZOOM = 1.12
"""Factor of one notch of the wheel."""
KEY_STEP = 0.02
"""What an arrow key moves, as a share of the picture's height."""
ARROWS = {
    Qt.Key.Key_Left: (-KEY_STEP, 0.0),
    Qt.Key.Key_Right: (KEY_STEP, 0.0),
    Qt.Key.Key_Down: (0.0, -KEY_STEP),
    Qt.Key.Key_Up: (0.0, KEY_STEP),
}
"""To the right and upwards, as if dragged."""
ZOOMS = {
    Qt.Key.Key_Plus: WHEEL_ZOOM,
    Qt.Key.Key_Equal: WHEEL_ZOOM,
    Qt.Key.Key_Minus: 1.0 / WHEEL_ZOOM,
}


class Grip(Protocol):
    """A handle in the picture that can be dragged; pixels count from the upper left."""

    cursor: Qt.CursorShape

    def is_under_cursor(self, sight: Projection, x: float, y: float) -> bool:
        """Whether it is under the mouse."""
        ...

    def pull(self, sight: Projection, right: float, down: float) -> None:
        """Follow the mouse by so many pixels."""
        ...


Pointed = Callable[[Projection, float, float], None]


class CameraMouse:
    """Turns mouse events into poses.

    Parameters
    ----------
    pose
        Reads the present pose.
    move
        Receives the new one.
    widget
        Whose size the picture has, and which gets the cursor.
    """

    def __init__(
        self, pose: Callable[[], CameraPose], move: Callable[[CameraPose], None], widget: QWidget
    ) -> None:
        self._pose, self._move, self._widget = pose, move, widget
        self._last: QPointF | None = None
        self._held: Grip | None = None
        self.grips: list[Grip] = []
        self.pointed: list[Pointed] = []
        self.left: list[Callable[[], None]] = []

    def press(self, event: QMouseEvent) -> None:
        """A drag begins."""
        self._last = event.position()
        self._held = self._under(event.position()) if event.button() == Qt.MouseButton.LeftButton else None
        self.leave()
        event.accept()

    def release(self, event: QMouseEvent) -> None:
        """The drag has ended."""
        self._last = self._held = None
        event.accept()

    def drag(self, event: QMouseEvent) -> None:
        """The mouse moved; with a button down the camera follows, or what was taken hold of."""
        buttons, last = event.buttons(), self._last
        if buttons == Qt.MouseButton.NoButton:
            self._hover(event.position())
            return
        if last is None:
            return
        here = event.position()
        self._last = here
        if self._held is not None:
            self._held.pull(self._sight(), here.x() - last.x(), here.y() - last.y())
        else:
            height = max(self._widget.height(), 1)
            right, up = (here.x() - last.x()) / height, (last.y() - here.y()) / height
            self._move(self._moved(buttons, event.modifiers(), right, up))
        event.accept()

    def wheel(self, event: QWheelEvent) -> None:
        """Zoom about the middle of the picture."""
        notches = event.angleDelta().y() / 120.0
        if notches:
            self._move(zoomed(self._pose(), WHEEL_ZOOM**notches))
        event.accept()

    def key(self, event: QKeyEvent) -> None:
        """Do with arrow keys, plus and minus what dragging and the wheel do; other keys are for others."""
        key, keys = Qt.Key(event.key()), event.modifiers()
        if key in ARROWS:
            self._move(self._moved(Qt.MouseButton.LeftButton, keys, *ARROWS[key]))
        elif key in ZOOMS and not keys & Qt.KeyboardModifier.ControlModifier:
            self._move(zoomed(self._pose(), ZOOMS[key]))
        else:
            event.ignore()
            return
        event.accept()

    def leave(self) -> None:
        """The mouse is elsewhere, or busy."""
        for callback in self.left:
            callback()

    def forget(self) -> None:
        """Tell nobody any more, and hold nothing."""
        for each in (self.grips, self.pointed, self.left):
            each.clear()
        self._held = None

    def _hover(self, place: QPointF) -> None:
        grip = self._under(place)
        self._widget.setCursor(grip.cursor if grip is not None else Qt.CursorShape.ArrowCursor)
        if grip is None:
            for callback in self.pointed:
                callback(self._sight(), place.x(), place.y())
        else:
            self.leave()

    def _under(self, place: QPointF) -> Grip | None:
        sight = self._sight()
        return next((grip for grip in self.grips if grip.is_under_cursor(sight, place.x(), place.y())), None)

    def _sight(self) -> Projection:
        return Projection(self._pose(), self._widget.width(), self._widget.height())

    def _moved(
        self, buttons: Qt.MouseButton, keys: Qt.KeyboardModifier, right: float, up: float
    ) -> CameraPose:
        pose = self._pose()
        shifting = buttons & (Qt.MouseButton.MiddleButton | Qt.MouseButton.RightButton)
        if shifting or keys & Qt.KeyboardModifier.ShiftModifier:
            return panned(pose, right, up)
        if keys & Qt.KeyboardModifier.ControlModifier:
            return rolled(pose, 3.0 * right)
        return orbited(pose, right, up)
