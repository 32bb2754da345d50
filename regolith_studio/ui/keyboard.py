"""Keyboard: a visible focus, keys of the window in number boxes, and undo while typing."""

from typing import cast

import shiboken6
from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QGuiApplication, QKeyEvent, QKeySequence, QWindow
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QDoubleSpinBox,
    QScrollArea,
    QSpinBox,
    QTabBar,
    QTableView,
    QWidget,
)

FOCUSED = "focused"
"""Property that the style sheet asks for; parts around a widget that have it are framed with it."""
FRAMED = (QAbstractButton, QScrollArea, QTabBar, QTableView)
"""Kinds of widgets whose frame is the style sheet's; all others are framed by Qt's own style."""
AROUND = 2
"""Levels above a widget that may frame it."""
NOT_YET = (Qt.Key.Key_Shift, Qt.Key.Key_Control, Qt.Key.Key_Alt, Qt.Key.Key_AltGr, Qt.Key.Key_Meta)
"""Keys that do nothing alone."""
_MODIFIER = Qt.KeyboardModifier
CHORDS = _MODIFIER.ControlModifier | _MODIFIER.AltModifier | _MODIFIER.MetaModifier
"""Commands go by such keys; who gives them may be pointing with the mouse."""


class KeyboardFocus(QObject):
    """Watches keys and mouse of the window that is active, and frames what has the focus since a key.

    A press of the mouse takes the frame away, the next key brings it back.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._keys = False
        self._marked: tuple[QWidget, ...] = ()
        self._window: QWindow | None = None
        app = cast(QApplication, QApplication.instance())
        app.focusChanged.connect(self._move)
        app.focusWindowChanged.connect(self._watch)

    @property
    def by_keys(self) -> bool:
        """Whether the keyboard was used last."""
        return self._keys

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        match event.type():
            case QEvent.Type.MouseButtonPress:
                self._take(False)
            case QEvent.Type.KeyPress if _walks(cast(QKeyEvent, event)):
                self._take(True)
        return super().eventFilter(watched, event)

    def _watch(self, window: QWindow | None) -> None:
        if self._window is not None and shiboken6.isValid(self._window):
            self._window.removeEventFilter(self)
        self._window = window
        if window is not None:
            window.installEventFilter(self)

    def _take(self, keys: bool) -> None:
        now = QApplication.focusWidget()
        if keys != self._keys:
            self._keys = keys
            self._mark(now)
        if now is not None and now.window().testAttribute(_BY_KEYS) != keys:  # Qt never takes it back
            now.window().setAttribute(_BY_KEYS, keys)
            now.update()

    def _move(self, _old: QWidget | None, now: QWidget | None) -> None:
        if QGuiApplication.mouseButtons() != Qt.MouseButton.NoButton:  # in a native window within the window
            self._keys = False
        self._mark(now)

    def _mark(self, now: QWidget | None) -> None:
        marked = _framed(now) if now is not None and self._keys else ()
        for widget in self._marked:
            if widget not in marked and shiboken6.isValid(widget):
                _set(widget, False)
        for widget in marked:
            if widget not in self._marked:
                _set(widget, True)
        self._marked = marked


_BY_KEYS = Qt.WidgetAttribute.WA_KeyboardFocusChange


def _walks(event: QKeyEvent) -> bool:
    """True for keys that move the focus."""
    if event.key() in (Qt.Key.Key_Tab, Qt.Key.Key_Backtab):
        return True
    return event.key() not in NOT_YET and not event.modifiers() & CHORDS


def _framed(widget: QWidget) -> tuple[QWidget, ...]:
    framed: list[QWidget] = [widget] if isinstance(widget, FRAMED) else []
    around = widget.parentWidget()
    for _ in range(AROUND):
        if around is None or around.isWindow():
            break
        if around.property(FOCUSED) is not None:
            framed.append(around)
        around = around.parentWidget()
    return tuple(framed)


def _set(widget: QWidget, focused: bool) -> None:
    widget.setProperty(FOCUSED, focused)
    widget.style().unpolish(widget)
    widget.style().polish(widget)
    widget.update()


_KEYS = (QKeySequence.StandardKey.Undo, QKeySequence.StandardKey.Redo)


class UndoKeys(QObject):
    """Watches the number box that has the focus.

    Its line would take the keys for itself, also where it has nothing to undo, and undo of the window would
    not be reached from where its choices are made.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._box: QWidget | None = None
        cast(QApplication, QApplication.instance()).focusChanged.connect(self._move)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(watched, QAbstractSpinBox):
            wanted = any(cast(QKeyEvent, event).matches(key) for key in _KEYS)
            if wanted and not is_being_typed(watched):
                event.ignore()
                return True
        return super().eventFilter(watched, event)

    def _move(self, _old: QWidget | None, now: QWidget | None) -> None:
        if self._box is not None and shiboken6.isValid(self._box):
            self._box.removeEventFilter(self)
        self._box = now if isinstance(now, QAbstractSpinBox) else None
        if self._box is not None:
            self._box.installEventFilter(self)


def is_being_typed(box: QAbstractSpinBox) -> bool:
    """Whether a box shows another text than that of its value."""
    if not isinstance(box, QSpinBox | QDoubleSpinBox):
        return False
    number = box.textFromValue(box.value())  # type: ignore[arg-type]
    default = f"{box.prefix()}{number}{box.suffix()}"
    if box.value() == box.minimum():
        default = box.specialValueText() or default
    return box.text() != default
