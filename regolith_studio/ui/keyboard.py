"""Keyboard: shortcuts and their dialog, a visible focus, keys of the window in number boxes."""

from collections.abc import Mapping
from typing import cast

import shiboken6
from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QAction, QGuiApplication, QKeyEvent, QKeySequence, QWindow
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QKeySequenceEdit,
    QLabel,
    QLineEdit,
    QListWidget,
    QPushButton,
    QScrollArea,
    QSpinBox,
    QTabBar,
    QTableView,
    QWidget,
)

from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.layout import dialog_buttons, hbox, named, room_on_screen, vbox
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import heading, hint_label
from regolith_studio.ui.widgets.text_table import TextTable

FOCUSED = "focused"
"""Property that the style sheet asks for; parts around a widget that have it are framed with it."""
FRAMED = (QAbstractButton, QListWidget, QScrollArea, QTabBar, QTableView)
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


SHORTCUTS = "shortcuts"
"""In the preferences of the window: keys by the name of the command, where they are not the usual ones."""
_NEEDED = {
    "Tab",
    "Shift+Tab",
    "Return",
    "Enter",
    "Esc",
    "Space",
    "Backspace",
    "Del",
    "Up",
    "Down",
    "Left",
    "Right",
}


class Shortcuts:
    """The shortcuts of all commands; commands that are shown together must not share keys.

    ``actions``: by name; those of a page begin with its key and a dot, and work while the page is seen.
    ``pages``: keys of the pages.
    """

    def __init__(
        self, actions: Mapping[str, QAction], pages: tuple[str, ...], preferences: Preferences
    ) -> None:
        self.actions = {name: each for name, each in actions.items() if each.menu() is None and each.text()}
        self._pages, self._preferences = pages, preferences
        self.defaults = {name: each.shortcut().toString() for name, each in self.actions.items()}
        kept = preferences.window.get(SHORTCUTS)
        for name, keys in kept.items() if isinstance(kept, dict) else ():
            if name in self.actions and isinstance(keys, str) and not self.conflict(name, keys):
                self._set(name, keys)

    def keys(self, name: str) -> str:
        """Of one command, as ``Ctrl+Shift+P``; empty for none."""
        return self.actions[name].shortcut().toString()

    def conflict(self, name: str, keys: str) -> str:
        """One sentence on why a command cannot have these keys, or nothing."""
        sequence = QKeySequence(keys)
        text = sequence.toString()
        if not keys:
            return ""
        if not text or sequence.count() != 1:
            return tr("{keys} cannot be assigned to a command.", keys=keys)
        if text in _NEEDED or (len(text) == 1 and text.isprintable()):
            return tr("{keys} is reserved for typing and navigation; add Ctrl or Alt.", keys=text)
        for other in self.actions:
            if other != name and self.keys(other) == text and self._meet(name, other):
                name_of_other = plain(self.actions[other])
                return tr("{keys} is already assigned to “{command}”.", keys=text, command=name_of_other)
        return ""

    def change(self, name: str, keys: str) -> None:
        """Give a command other keys, and keep them."""
        if sentence := self.conflict(name, keys):
            raise InputError(sentence)
        self._set(name, keys)
        self._keep()

    def reset(self) -> None:
        for name, keys in self.defaults.items():
            self._set(name, keys)
        self._keep()

    def _set(self, name: str, keys: str) -> None:
        action = self.actions[name]
        tip = action.toolTip().removesuffix(with_keys("", action.shortcut()))
        action.setShortcut(QKeySequence(keys))
        action.setToolTip(with_keys(tip, action.shortcut()))

    def _keep(self) -> None:
        changed = {
            name: self.keys(name) for name, default in self.defaults.items() if self.keys(name) != default
        }
        self._preferences.window = self._preferences.window | {SHORTCUTS: changed}
        self._preferences.save()

    def _meet(self, one: str, other: str) -> bool:
        """Whether both can be run on the same page."""
        owners = [name.split(".")[0] if name.split(".")[0] in self._pages else "" for name in (one, other)]
        return "" in owners or owners[0] == owners[1]


def shown_keys(keys: QKeySequence) -> str:
    return keys.toString(QKeySequence.SequenceFormat.NativeText)


def with_keys(words: str, keys: QKeySequence) -> str:
    """A tool tip that ends with the keys, if there are any."""
    return words if keys.isEmpty() else f"{words} ({shown_keys(keys)})"


def plain(action: QAction) -> str:
    """The words of a command, without marks and dots."""
    return action.text().replace("&", "").rstrip(" …")


MOUSE = (
    (N_("Left drag"), N_("Rotate the particle")),
    (N_("Right or middle drag, Shift + drag"), N_("Pan the view")),
    (N_("Ctrl + drag"), N_("Roll the view")),
    (N_("Wheel"), N_("Zoom")),
)


class ShortcutsDialog(QDialog):
    """A table of commands; the keys of the chosen one are edited below it."""

    def __init__(self, shortcuts: Shortcuts, titles: dict[str, str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Keyboard and mouse"))
        self.setObjectName("shortcuts_dialog")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(QSize(620, 640).boundedTo(room_on_screen(self)))
        self._shortcuts, self._titles = shortcuts, titles
        self.search = named(QLineEdit(), "shortcuts_search", tr("Search commands"))
        self.search.setPlaceholderText(tr("Search commands and keys"))
        self.search.setClearButtonEnabled(True)
        headings = [tr("Command"), tr("Keys")]
        self.table = TextTable("shortcuts_table", tr("Commands and their keys"), headings, numbers=False)
        self._listed: list[str] = []
        self.editor = named(QKeySequenceEdit(), "shortcuts_keys", tr("New keys of the chosen command"))
        self.editor.setMaximumSequenceLength(1)
        self.editor.setClearButtonEnabled(True)
        self.change, self.default, self.all_defaults = (
            QPushButton(words) for words in (tr("Change"), tr("Default keys"), tr("All default keys"))
        )
        for button, name in (
            (self.change, "change"),
            (self.default, "usual"),
            (self.all_defaults, "all_defaults"),
        ):
            button.setObjectName(f"shortcuts_{name}")
            button.setAutoDefault(False)
        self.sentence = hint_label(role="warning")
        self._arrange()
        self.search.textChanged.connect(lambda _: self._fill())
        self.table.chosen.connect(lambda _: self._show_chosen())
        self.change.clicked.connect(lambda: self._try(self.editor.keySequence().toString()))
        self.default.clicked.connect(lambda: self._try(self._shortcuts.defaults[self.chosen()]))
        self.all_defaults.clicked.connect(self._reset)
        self._fill()

    def chosen(self) -> str:
        """Name of the command that is chosen; empty for none."""
        row = self.table.selected()
        return "" if row is None else self._listed[row]

    def choose(self, name: str) -> None:
        """Choose a command by its name, if it is listed."""
        self.table.select(self._listed.index(name) if name in self._listed else None)
        self._show_chosen()

    def _fill(self) -> None:
        name, words = self.chosen(), self.search.text().lower().split()
        self._listed, rows, shortcuts = [], [], self._shortcuts
        for key, action in shortcuts.actions.items():
            title = f"{self._titles[key]}: {plain(action)}" if self._titles.get(key) else plain(action)
            keys = shown_keys(action.shortcut())
            if all(word in f"{title} {keys}".lower() for word in words):
                own = keys and shortcuts.defaults[key] != shortcuts.keys(key)
                self._listed.append(key)
                rows.append((title, f"{keys} *" if own else keys))
        self.table.set_rows(rows, [""] * len(rows))
        self.choose(name)

    def _show_chosen(self) -> None:
        name = self.chosen()
        for widget in (self.editor, self.change, self.default):
            widget.setEnabled(bool(name))
        self.editor.setKeySequence(QKeySequence(self._shortcuts.keys(name) if name else ""))
        self.sentence.setText("")

    def _try(self, keys: str) -> None:
        try:
            self._shortcuts.change(self.chosen(), keys)
        except InputError as error:
            self.sentence.setText(str(error))
            return
        self._fill()

    def _reset(self) -> None:
        self._shortcuts.reset()
        self._fill()

    def _arrange(self) -> None:
        mouse = QFormLayout()
        mouse.setHorizontalSpacing(24)
        for gesture, meaning in MOUSE:
            mouse.addRow(tr(gesture), QLabel(tr(meaning)))
        buttons = dialog_buttons(self)
        buttons.button(QDialogButtonBox.StandardButton.Close).setAutoDefault(False)  # Enter searches
        vbox(
            self.search,
            (self.table, 1),
            hbox(QLabel(tr("Keys:")), (self.editor, 1), self.change, self.default, self.all_defaults),
            self.sentence,
            heading(tr("Mouse in the views")),
            mouse,
            buttons,
            parent=self,
            margins=None,
        )
