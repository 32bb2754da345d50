"""What can be done from menus, tool bar and keyboard: one row each; pages bring rows of their own."""

from collections.abc import Callable, Mapping
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMainWindow, QMenu, QToolBar, QToolButton

from regolith_studio.ui.action_spec import BREAK, PAGE_MENU, ActionSpec
from regolith_studio.ui.dialogs.command_palette import Command
from regolith_studio.ui.icons import icon
from regolith_studio.ui.page import Page
from regolith_studio.ui.shortcuts import plain, shown_keys, with_keys
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import mark, tr

WITHIN_VIEW = (mark("Look &from"), mark("&Theme"))
MENUS = (mark("&File"), mark("&Edit"), mark("&View"), mark("&Go"), PAGE_MENU, mark("&Help"))

ROWS: tuple[ActionSpec, ...] = (
    ActionSpec("&File", "open", "&Open …", "open", "Ctrl+O", "Open mesh files", None, "words"),
    ActionSpec("&File", "open_folder", "Open &folder …", "", "Ctrl+Shift+O"),
    ActionSpec(
        "&File", "open_sample", "Open &sample", "sample", "", "Open the shipped particles", bar="words"
    ),
    ActionSpec("&File", "recent", "Open &recent"),
    ActionSpec(
        "&File", "repair", "&Mend meshes on opening", "", "", "Say, and mend, what is wrong", checked=True
    ),
    ActionSpec("&File", BREAK, ""),
    ActionSpec(
        "&File", "export", "&Export dataset …", "export", "Ctrl+E", "Export a DEM dataset", None, "words"
    ),
    ActionSpec("&File", "save_recipe", "Save re&cipe …", "recipe", "Ctrl+Alt+S", "For regolith-studio run"),
    ActionSpec("&File", "run_batch", "Run as a &batch …", "", "Ctrl+Alt+R", "Here or on a cluster"),
    ActionSpec("&File", BREAK, ""),
    ActionSpec("&File", "save_project", "&Save project", "", "Ctrl+S"),
    ActionSpec("&File", "save_project_as", "Save project &as …", "", "Ctrl+Shift+S"),
    ActionSpec("&File", BREAK, ""),
    ActionSpec("&File", "quit", "&Quit", "", "Ctrl+Q"),
    ActionSpec("&Edit", "undo", "&Undo", "undo", "Ctrl+Z", bar="icon"),
    ActionSpec("&Edit", "redo", "&Redo", "redo", "Ctrl+Shift+Z", bar="icon"),
    ActionSpec("&Edit", BREAK, ""),
    ActionSpec("&Edit", "copy_command", "Copy as co&mmand", "", "", "The command line that does the same"),
    ActionSpec("&Edit", "copy_python", "Copy as &Python", "", "", "A script that does the same"),
    ActionSpec("&Edit", BREAK, ""),
    ActionSpec("&Edit", "palette", "&Commands …", "", "Ctrl+Shift+P", "Any command by a few letters"),
    ActionSpec("&Edit", "preferences", "P&references …", "", "Ctrl+,", "Language, theme, size of letters"),
    ActionSpec("&Go", "next_page", "&Next page", "", "Ctrl+PgDown"),
    ActionSpec("&Go", "previous_page", "&Previous page", "", "Ctrl+PgUp"),
    ActionSpec("&Go", BREAK, ""),
    ActionSpec("&Theme", "theme_system", "As the &system"),
    ActionSpec("&Theme", "theme_light", "&Light"),
    ActionSpec("&Theme", "theme_dark", "&Dark"),
    ActionSpec("&View", "tasks", "&Tasks", "", "Ctrl+T", "What is running"),
    ActionSpec("&View", "log", "L&og", "", "Ctrl+Shift+L", "What was said"),
    ActionSpec("&View", "standard_layout", "Standard la&yout", "", "", "Forget sizes and borders"),
    ActionSpec("&View", BREAK, ""),
    ActionSpec("&Help", "tour", "&Tour", "tour", "", "A walk through the window"),
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
    pages
        Their rows are seen, and their shortcuts work, while the page is seen.
    run
        Runs a command of a page: its key, the name of the command, the state of a switch.
    """

    def __init__(
        self,
        window: QMainWindow,
        commands: Mapping[str, Callable[..., object]],
        pages: Mapping[str, Page],
        run: Callable[..., object],
    ) -> None:
        self._window, self._pages = window, pages
        self._menus: dict[str, QMenu] = {}
        self._icons: list[tuple[QAction, str]] = []
        self._of_page: dict[str, list[QAction]] = {key: [] for key in pages}
        self.by_name: dict[str, QAction] = {}
        self.bar = QToolBar(tr("Tools"))
        self.bar.setObjectName("tool_bar")
        self.bar.setMovable(False)
        window.addToolBar(self.bar)
        for title in MENUS:
            self._menu(title)
        for row in ROWS:
            self._add(row, row.name, commands.get(row.name))
        self.recent = QMenu(tr("Open &recent"), window)
        self.by_name["recent"].setMenu(self.recent)
        self.bar.insertSeparator(self.by_name["undo"])
        for number, page in enumerate(pages.values(), start=1):
            self._add_page(page, number, run, commands["go"])

    def show_page(self, key: str) -> None:
        """Show the rows of one page and hide those of the others."""
        for owner, actions in self._of_page.items():
            for action in actions:
                action.setVisible(owner == key)
                action.setEnabled(owner == key)
        for title in (PAGE_MENU, "Look &from"):
            if menu := self._menus.get(title):
                menu.menuAction().setVisible(any(each.isVisible() for each in menu.actions()))

    def places(self) -> dict[str, str]:
        """Where each command belongs: its page, or its menu."""
        titles = {key: tr(page.title) for key, page in self._pages.items()}
        return {
            name: titles.get(name.split(".")[0]) or each.data() or "" for name, each in self.by_name.items()
        }

    def palette(self, pages: Mapping[str, Page], run: Callable[..., object]) -> list[Command]:
        """Every command of the window and of all pages, for the palette."""
        found = []
        for name, action in self.by_name.items():
            key, _, command = name.partition(".")
            place = tr(pages[key].title) if key in pages else action.data() or ""
            begin: Callable[[], object] = action.trigger
            if key in pages and not action.isEnabled() and not action.isCheckable():
                begin = partial(run, key, command)
            if action.menu() is None and name != "palette":
                found.append(Command(place, plain(action), shown_keys(action.shortcut()), begin))
        return found

    def set_theme(self, theme: Theme) -> None:
        """Draw the icons in the colours of a theme."""
        for action, name in self._icons:
            action.setIcon(icon(name, theme.text, theme.muted))

    def _add_page(
        self, page: Page, number: int, run: Callable[..., object], go: Callable[[str], object]
    ) -> None:
        words = f"&{number} {tr(page.title)}"
        row = ActionSpec("&Go", page.key, words, page.icon, f"Alt+{number}", page.tip)
        self._add(row, f"go.{page.key}", partial(go, page.key))
        mine = self._of_page[page.key]
        if any(each.bar for each in page.actions):
            mine.append(self.bar.addSeparator())
        for each in page.actions:
            mine.append(self._add(each, f"{page.key}.{each.name}", partial(run, page.key, each.name)))

    def _add(self, row: ActionSpec, name: str, command: Callable[..., object] | None) -> QAction:
        menu = self._menu(row.menu)
        if row.name == BREAK:
            return menu.addSeparator()
        action = QAction(tr(row.text), self._window)
        action.setObjectName(name)
        action.setData(tr(row.menu).replace("&", ""))
        if row.shortcut:
            action.setShortcut(QKeySequence(row.shortcut))
        action.setToolTip(with_keys(tr(row.tip) or plain(action), action.shortcut()))
        if row.checked is not None and command:
            action.setCheckable(True)
            action.setChecked(row.checked)
            action.toggled.connect(command)
        elif command:
            action.triggered.connect(lambda _checked=False, run=command: run())
        menu.addAction(action)
        self.by_name[name] = action
        if row.icon:
            self._icons.append((action, row.icon))
        if row.bar:
            self._place(row, action)
        return action

    def _place(self, row: ActionSpec, action: QAction) -> None:
        self.bar.addAction(action)
        button = self.bar.widgetForAction(action)
        if isinstance(button, QToolButton):
            button.setAccessibleName(tr(row.tip) or plain(action))
            words, only = Qt.ToolButtonStyle.ToolButtonTextBesideIcon, Qt.ToolButtonStyle.ToolButtonIconOnly
            button.setToolButtonStyle(words if row.bar == "words" else only)

    def _menu(self, title: str) -> QMenu:
        if title not in self._menus:
            parent = self._menus["&View"] if title in WITHIN_VIEW else None
            made = parent.addMenu(tr(title)) if parent else self._window.menuBar().addMenu(tr(title))
            self._menus[title] = made
        return self._menus[title]
