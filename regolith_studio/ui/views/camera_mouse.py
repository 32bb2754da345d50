"""Mouse and wheel on a view: turn with the left button, shift with the middle or right one, zoom."""

from collections.abc import Callable

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent

from regolith_studio.scene.cameras import CameraPose
from regolith_studio.scene.motions import orbited, panned, rolled, zoomed

WHEEL_ZOOM = 1.12
"""Factor of one notch of the wheel."""


class CameraMouse:
    """Turns mouse events into poses.

    Parameters
    ----------
    pose
        Reads the present pose.
    move
        Receives the new one.
    height
        Reads the height of the view in the units of the events.
    """

    def __init__(
        self, pose: Callable[[], CameraPose], move: Callable[[CameraPose], None], height: Callable[[], int]
    ) -> None:
        self._pose, self._move, self._height = pose, move, height
        self._last: QPointF | None = None

    def press(self, event: QMouseEvent) -> None:
        """A drag begins."""
        self._last = event.position()
        event.accept()

    def release(self, event: QMouseEvent) -> None:
        """The drag has ended."""
        self._last = None
        event.accept()

    def drag(self, event: QMouseEvent) -> None:
        """The mouse moved; with a button down the camera follows."""
        buttons, last = event.buttons(), self._last
        if last is None or buttons == Qt.MouseButton.NoButton:
            return
        here = event.position()
        height = max(self._height(), 1)
        right, up = (here.x() - last.x()) / height, (last.y() - here.y()) / height
        self._last = here
        self._move(self._moved(buttons, event.modifiers(), right, up))
        event.accept()

    def wheel(self, event: QWheelEvent) -> None:
        """Zoom about the middle of the picture."""
        notches = event.angleDelta().y() / 120.0
        if notches:
            self._move(zoomed(self._pose(), WHEEL_ZOOM**notches))
        event.accept()

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
