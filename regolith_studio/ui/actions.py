"""What can be done from menus, tool bar and keyboard: one row each."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMainWindow, QMenu, QToolBar, QToolButton

from regolith_studio.scene.cameras import DIRECTIONS
from regolith_studio.ui.icons import icon
from regolith_studio.ui.theme import Theme


@dataclass(frozen=True)
class ActionSpec:
    """One row.

    Parameters
    ----------
    menu
        Title of its menu; those of :data:`WITHIN_VIEW` are menus within View.
    name
        Of the command that it runs, and its object name.
    text
        In the menu; "&" marks the letter.
    icon
        File in ``resources/icons``; empty for none.
    shortcut
        Empty for none.
    tip
        In the tool bar; the text if empty.
    checked
        ``True`` or ``False`` for a switch, ``None`` for a command.
    bar
        Its place in the tool bar: ``words`` with its text, ``icon`` without, empty for none.
    """

    menu: str
    name: str
    text: str
    icon: str = ""
    shortcut: str = ""
    tip: str = ""
    checked: bool | None = None
    bar: str = ""


BREAK = "-"
WITHIN_VIEW = ("Look &from", "&Theme")
_DIRECTION_KEYS = {"isometric": "Ctrl+0", "front": "Ctrl+1", "right": "Ctrl+3", "top": "Ctrl+7"}

ROWS: tuple[ActionSpec, ...] = (
    ActionSpec("&File", "open", "&Open …", "open", "Ctrl+O", "Open mesh files", None, "words"),
    ActionSpec("&File", "open_folder", "Open &folder …", "", "Ctrl+Shift+O"),
    ActionSpec(
        "&File", "open_sample", "Open &sample", "sample", "", "Open the shipped particles", bar="words"
    ),
    ActionSpec("&File", "recent", "Open &recent"),
    ActionSpec("&File", BREAK, ""),
    ActionSpec(
        "&File", "export", "&Export dataset …", "export", "Ctrl+E", "Export a DEM dataset", None, "words"
    ),
    ActionSpec("&File", "save_recipe", "Save re&cipe …", "recipe", "Ctrl+S", "Save the choices as a recipe"),
    ActionSpec("&File", BREAK, ""),
    ActionSpec("&File", "quit", "&Quit", "", "Ctrl+Q"),
    ActionSpec("&Edit", "undo", "&Undo", "undo", "Ctrl+Z", bar="icon"),
    ActionSpec("&Edit", "redo", "&Redo", "redo", "Ctrl+Shift+Z", bar="icon"),
    ActionSpec("&View", "link", "&Link cameras", "link", "Ctrl+L", "Turn all views together", True, "icon"),
    ActionSpec("&View", "reset", "&Reset cameras", "reset", "Ctrl+R", "Show the whole particle", bar="icon"),
    *(
        ActionSpec("Look &from", f"look_{key}", each.label, "", _DIRECTION_KEYS.get(key, ""))
        for key, each in DIRECTIONS.items()
    ),
    ActionSpec("&View", BREAK, ""),
    ActionSpec("&View", "wireframe", "&Wireframe", "wireframe", "Ctrl+M", "Show triangles", False, "icon"),
    ActionSpec("&View", "heat", "&Distance map", "heat", "Ctrl+D", "Show fitting errors", False, "icon"),
    ActionSpec("&View", BREAK, ""),
    ActionSpec("&Theme", "theme_system", "As the &system"),
    ActionSpec("&Theme", "theme_light", "&Light"),
    ActionSpec("&Theme", "theme_dark", "&Dark"),
    ActionSpec("&Help", "shortcuts", "&Keyboard and mouse", "help", "F1"),
    ActionSpec("&Help", "about", "&About Regolith Studio"),
)


class Actions:
    """The rows as Qt actions, in the menus and the tool bar of a window.

    Parameters
    ----------
    window
        Gets the menus and the tool bar.
    commands
        A function for each name; switches are called with their state.
    """

    def __init__(self, window: QMainWindow, commands: Mapping[str, Callable[..., object]]) -> None:
        self._window = window
        self._menus: dict[str, QMenu] = {}
        self.by_name: dict[str, QAction] = {}
        self.bar = QToolBar("Tools")
        self.bar.setObjectName("tool_bar")
        self.bar.setMovable(False)
        window.addToolBar(self.bar)
        for row in ROWS:
            self._add(row, commands)
        self.recent = QMenu("Open &recent", window)
        self.by_name["recent"].setMenu(self.recent)
        self.bar.insertSeparator(self.by_name["undo"])
        self.bar.insertSeparator(self.by_name["link"])

    def set_theme(self, theme: Theme) -> None:
        """Draw the icons in the colours of a theme."""
        for row in ROWS:
            if row.icon:
                self.by_name[row.name].setIcon(icon(row.icon, theme.text, theme.muted))

    def _add(self, row: ActionSpec, commands: Mapping[str, Callable[..., object]]) -> None:
        menu = self._menu(row.menu)
        if row.name == BREAK:
            menu.addSeparator()
            return
        action = QAction(row.text, self._window)
        action.setObjectName(row.name)
        if row.shortcut:
            action.setShortcut(QKeySequence(row.shortcut))
        keys = f" ({row.shortcut})" if row.shortcut else ""
        action.setToolTip((row.tip or row.text.replace("&", "").rstrip(" …")) + keys)
        command = commands.get(row.name)
        if row.checked is not None and command:
            action.setCheckable(True)
            action.setChecked(row.checked)
            action.toggled.connect(command)
        elif command:
            action.triggered.connect(lambda _checked=False, run=command: run())
        menu.addAction(action)
        self.by_name[row.name] = action
        if row.bar:
            self._place(row, action)

    def _place(self, row: ActionSpec, action: QAction) -> None:
        self.bar.addAction(action)
        button = self.bar.widgetForAction(action)
        if isinstance(button, QToolButton):
            button.setAccessibleName(row.tip or row.text.replace("&", ""))
            words, only = Qt.ToolButtonStyle.ToolButtonTextBesideIcon, Qt.ToolButtonStyle.ToolButtonIconOnly
            button.setToolButtonStyle(words if row.bar == "words" else only)

    def _menu(self, title: str) -> QMenu:
        if title not in self._menus:
            parent = self._menus["&View"] if title in WITHIN_VIEW else None
            made = parent.addMenu(title) if parent else self._window.menuBar().addMenu(title)
            self._menus[title] = made
        return self._menus[title]
