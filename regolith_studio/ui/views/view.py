"""What a three-dimensional view can do, its mouse, cameras that follow each other, and its frame."""

import html
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import QImage, QKeyEvent, QMouseEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QFrame, QLabel, QWidget

from regolith_studio.scene import annotations, cameras, plotter_setup
from regolith_studio.scene.cameras import (
    CameraPose,
    Projection,
    framing_pose,
    orbited,
    panned,
    refitted,
    rolled,
    turned,
    zoomed,
)
from regolith_studio.scene.palette import ThemeColors
from regolith_studio.ui.keyboard import FOCUSED
from regolith_studio.ui.layout import hbox, named, vbox
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.fields import ChoiceBox
from regolith_studio.ui.widgets.labels import ElidedLabel
from regolith_studio.ui.widgets.plots.base import plain_text

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


class DragHandle(Protocol):
    """A handle in the picture that can be dragged; pixels count from the upper left."""

    cursor: Qt.CursorShape

    def is_under_cursor(self, sight: Projection, x: float, y: float) -> bool: ...

    def pull(self, sight: Projection, right: float, down: float) -> None:
        """Follow the mouse by so many pixels."""
        ...


Pointed = Callable[[Projection, float, float], None]


class CameraMouse:
    """Turns mouse events into poses.

    - ``pose``: reads the present pose.
    - ``move``: receives the new one.
    - ``widget``: whose size the picture has, and which gets the cursor.
    """

    def __init__(
        self, pose: Callable[[], CameraPose], move: Callable[[CameraPose], None], widget: QWidget
    ) -> None:
        self._pose, self._move, self._widget = pose, move, widget
        self._last: QPointF | None = None
        self._held: DragHandle | None = None
        self.handles: list[DragHandle] = []
        self.pointed: list[Pointed] = []
        self.left: list[Callable[[], None]] = []

    def press(self, event: QMouseEvent) -> None:
        """A drag begins."""
        self._last = event.position()
        self._held = self._under(event.position()) if event.button() == Qt.MouseButton.LeftButton else None
        self.leave()
        event.accept()

    def release(self, event: QMouseEvent) -> None:
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
        for each in (self.handles, self.pointed, self.left):
            each.clear()
        self._held = None

    def _hover(self, place: QPointF) -> None:
        handle = self._under(place)
        self._widget.setCursor(handle.cursor if handle is not None else Qt.CursorShape.ArrowCursor)
        if handle is None:
            for callback in self.pointed:
                callback(self._sight(), place.x(), place.y())
        else:
            self.leave()

    def _under(self, place: QPointF) -> DragHandle | None:
        sight = self._sight()
        return next(
            (handle for handle in self.handles if handle.is_under_cursor(sight, place.x(), place.y())), None
        )

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


Picture = NDArray[np.uint8]


class SceneView(QWidget):
    """One view: a plotter with its scale bar, which backends place and draw; calls to draw are coalesced."""

    def __init__(self) -> None:
        super().__init__()
        self._plotter: Any = None
        self._moved: list[Callable[[CameraPose], None]] = []
        self._aspect: float | None = None
        self.mouse = CameraMouse(lambda: self.pose, self._move, self)
        """Its ``handles`` can be dragged; ``pointed`` get where the mouse rests, ``left`` when it left."""

    def _set_stage(self, plotter: Any) -> None:
        self._plotter, surroundings = plotter, current_theme().surroundings
        plotter_setup.set_stage(plotter, surroundings)
        self._scale_bar = annotations.ScaleBar(plotter, surroundings)

    def _ask(self) -> None:
        """Ask for a new picture."""
        raise NotImplementedError

    def _current_image(self) -> QImage:
        """What is shown now, in RGB of 8 bits each."""
        raise NotImplementedError

    @property
    def widget(self) -> QWidget:
        return self

    @property
    def pose(self) -> CameraPose:
        return cameras.pose_of(self._plotter)

    def draw(self, fill: Callable[[Any], None]) -> None:
        """Let `fill` change what the plotter shows, and ask for a new picture."""
        fill(self._plotter)
        self._plotter.renderer.ResetCameraClippingRange()
        self._ask()

    def set_pose(self, pose: CameraPose) -> None:
        """Move the camera, fit its clipping range, ask for a new picture; tells nobody."""
        cameras.apply_pose(self._plotter, pose)
        self._aspect = self.width() / max(self.height(), 1)
        self._ask()

    def when_moved(self, callback: Callable[[CameraPose], None]) -> None:
        """Call `callback` with the new pose whenever the user moves the camera."""
        self._moved.append(callback)

    def set_surroundings(self, surroundings: ThemeColors) -> None:
        """Change background and inks."""
        plotter_setup.set_background(self._plotter, surroundings)
        self._scale_bar.set_ink(surroundings)
        self._ask()

    def set_font_factor(self, factor: float) -> None:
        """Change the size of the scale bar."""
        self._scale_bar.set_factor(factor)
        self._ask()

    def picture(self) -> Picture:
        """What the view shows now, shape (height, width, 3)."""
        image = self._current_image()
        rows = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
        return rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).copy()

    def shot(self, scale: int = 1, transparent: bool = False) -> Picture:
        """What the view shows at a multiple of its size, shape (height, width, 3), or 4 if transparent.

        Without what is laid out in pixels: the scale bar.
        """
        self._scale_bar.suspended = True
        try:
            return plotter_setup.thumbnail(self._plotter, scale, transparent)
        finally:
            self._scale_bar.suspended = False
            self._ask()

    def release(self) -> None:
        """Give the graphics memory back; the view is of no use afterwards."""
        self._moved.clear()
        self.mouse.forget()
        if self._plotter is not None:
            self._scale_bar.remove()
            self._plotter.close()
            self._plotter = None

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep what is shown along the shorter side, whatever the user has done with the camera.

        A body that was framed is framed again, and what was looked at closely stays as close.
        """
        super().resizeEvent(event)
        before = self._aspect
        if self._plotter is not None and before is not None and self.width() and self.height():
            self.set_pose(refitted(self.pose, before, self.width() / self.height()))

    def _move(self, pose: CameraPose) -> None:
        self.set_pose(pose)
        for callback in self._moved:
            callback(pose)


class CameraLink:
    """Copies the pose of one view to the others while it is on.

    ``views``: all in one frame of coordinates.
    """

    def __init__(self, views: Sequence[SceneView]) -> None:
        self._views = tuple(views)
        self._linked = True
        self._direction = "isometric"
        for view in self._views:
            view.when_moved(self._follower(view))

    @property
    def linked(self) -> bool:
        return self._linked

    def set_linked(self, linked: bool) -> None:
        """Link, to the pose of the first view, or let go."""
        self._linked = linked
        if linked:
            self._spread(self._views[0])

    def frame(self, points: ArrayLike) -> None:
        """Show points whole in every view, from the direction chosen last."""
        for view in self._views:
            width, height = view.widget.width(), view.widget.height()
            view.set_pose(framing_pose(points, self._direction, width / max(height, 1)))

    def look_from(self, direction: str) -> None:
        """Look from a standard direction, at the same point and scale."""
        self._direction = direction
        for view in self._views:
            view.set_pose(turned(view.pose, direction))

    def _follower(self, moved: SceneView) -> Callable[[CameraPose], None]:
        def follow(pose: CameraPose) -> None:
            if self._linked:
                for view in self._views:
                    if view is not moved:
                        view.set_pose(pose)

        return follow

    def _spread(self, source: SceneView) -> None:
        pose = source.pose
        for view in self._views:
            if view is not source:
                view.set_pose(pose)


_PADDING = 9
_BESIDE = 8
"""Pixels of the frame and beside the box of partners."""

_DEFAULT_PIXELS = 12
"""Height of the font for which scale bars have their usual size."""


class ViewFrame(QFrame):
    """Title, a line of details and the view; a double click on the title enlarges it.

    - ``view``: what is framed.
    - ``name``: object name, and plain name for screen readers.
    - ``partners``: what it can be compared with, by key; the box is shown when :meth:`set_comparing` says
      so.
    - ``compare``: what the box asks, for screen readers.
    - ``colour``: field of :class:`Theme` with the colour of the mark before the title: the same as in the
      plots.
    """

    partnerChanged = Signal(str)  # noqa: N815
    enlargeRequested = Signal()  # noqa: N815

    def __init__(
        self,
        view: SceneView,
        name: str,
        partners: Mapping[str, str] | None = None,
        compare: str = "",
        colour: str = "",
    ) -> None:
        super().__init__()
        self._colour = colour
        self.setObjectName(f"view_{name}")
        self.setProperty("role", "card")
        self.view = view
        self._titles: tuple[str, ...] = ("",)
        self._detail = ""
        self._mark = QLabel()
        self._mark.hide()
        self._title = named(QLabel(), f"title_{name}", role="heading")
        self._title.setTextFormat(Qt.TextFormat.RichText)
        self._title.setMinimumWidth(10)
        self.detail = ElidedLabel(role="hint", by_parts=True)
        self.partner = ChoiceBox(f"partner_{name}", tr(compare), partners or {})
        self.partner.setMinimumContentsLength(7)
        self.partner.prefers_whole = True
        self.partner.setToolTip(tr("Second surface: overlaid, or right of the line"))
        self.partner.currentIndexChanged.connect(lambda _: self.partnerChanged.emit(self.partner.value()))
        self.partner.hide()
        view.widget.setObjectName(f"scene_{name}")
        self._arrange()
        self.setProperty(FOCUSED, False)

    def set_theme(self, theme: Theme) -> None:
        self.view.set_surroundings(theme.surroundings)
        if self._colour:
            self._mark.setText(f'<span style="color:{getattr(theme, self._colour)}">&#9632;</span>')
            self._mark.show()

    def set_texts(self, title: str, detail: str = "", *shorter: str) -> None:
        """Title as rich text, the quiet line, and titles for views too narrow for the first one."""
        self._titles = (title, *shorter)
        self._choose_title()
        self.set_detail(detail)
        self.view.widget.setAccessibleName(f"{title}. {detail}")

    @property
    def title(self) -> str:
        """The title in rich text, at its full length."""
        return self._titles[0]

    def set_detail(self, detail: str) -> None:
        self._detail = detail
        self.detail.setText(detail)

    def show_status(self, words: str) -> None:
        """Words in place of the quiet line while they last; none bring it back."""
        self.detail.setText(words or self._detail)

    def set_comparing(self, comparing: bool) -> None:
        """Offer the box of partners, or not."""
        self.partner.setVisible(comparing and self.partner.count() > 1)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._choose_title()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.position().y() < self.view.widget.y():
            self.enlargeRequested.emit()
            event.accept()
        else:
            super().mouseDoubleClickEvent(event)

    def _arrange(self) -> None:
        vbox(
            hbox(self._mark, (self._title, 1), margins=(_PADDING, 6, _PADDING, 0), spacing=5),
            hbox((self.detail, 1), self.partner, margins=(_PADDING, 0, _PADDING, 4)),
            (self.view.widget, 1),
            parent=self,
            margins=(1, 1, 1, 1),
            spacing=0,
        )

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._choose_title()
            self.view.set_font_factor(self.fontInfo().pixelSize() / _DEFAULT_PIXELS)

    def _choose_title(self) -> None:
        """The longest title that there is room for; the shortest with dots where there is none.

        These are in the middle of one word, since names of particles differ at their ends.
        """
        self._title.ensurePolished()
        self._title.setToolTip(self._titles[0])
        room = self.width() - 2 * _PADDING - 8 - self._mark.sizeHint().width()
        for title in self._titles:
            self._title.setText(title)
            if self._title.sizeHint().width() <= room:
                return
        words = plain_text(self._titles[-1])
        where = Qt.TextElideMode.ElideRight if " " in words else Qt.TextElideMode.ElideMiddle
        dotted = self._title.fontMetrics().elidedText(words, where, room)
        self._title.setText(html.escape(dotted))
