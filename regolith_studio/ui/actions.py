"""The actions of menus, tool bar, keyboard and command palette, a row each; pages add their own."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QAction, QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QDialog,
    QLineEdit,
    QListWidget,
    QMainWindow,
    QMenu,
    QToolBar,
    QToolButton,
    QWidget,
)

from regolith_studio.messages import N_
from regolith_studio.ui.keyboard import plain, shown_keys, with_keys
from regolith_studio.ui.layout import named, vbox
from regolith_studio.ui.page import BREAK, PAGE_MENU, VIEW, ActionSpec, Page
from regolith_studio.ui.theme import Theme, font_share, icon
from regolith_studio.ui.translation import tr


@dataclass(frozen=True)
class Command:
    """A command: its menu, name and shortcut."""

    place: str
    text: str
    keys: str
    run: Callable[[], object]

    @property
    def title(self) -> str:
        return f"{self.place}: {self.text}" if self.place else self.text


def matches(commands: Sequence[Command], typed: str) -> list[Command]:
    """Commands that have every typed word, those that begin with it first."""
    words = typed.lower().split()
    matching = [each for each in commands if all(word in each.title.lower() for word in words)]
    first = words[0] if words else ""
    return sorted(matching, key=lambda each: not each.text.lower().startswith(first))


class CommandPalette(QDialog):
    """A text field and the commands that match it; Enter runs the selected one."""

    def __init__(self, commands: Sequence[Command], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Commands"))
        self.setObjectName("command_palette")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(round(560 * font_share()), 420)
        self._commands = tuple(commands)
        self.line = named(QLineEdit(), "command_line", tr("Command"))
        self.line.setPlaceholderText(tr("Type a command"))
        self.list = named(QListWidget(), spoken=tr("Commands that fit"))
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        vbox(self.line, self.list, parent=self, margins=None)
        self.line.textChanged.connect(self._fill)
        self.line.returnPressed.connect(self._run)
        self.list.itemActivated.connect(lambda _item: self._run())
        self.list.itemClicked.connect(lambda _item: self._run())
        self.line.installEventFilter(self)
        self._fill("")

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(event.key()), 0)
            if step and self.list.count():
                self.list.setCurrentRow((self.list.currentRow() + step) % self.list.count())
                return True
        return super().eventFilter(watched, event)

    def _fill(self, typed: str) -> None:
        self.list.clear()
        for command in matches(self._commands, typed):
            keys = f"   ({command.keys})" if command.keys else ""
            self.list.addItem(command.title + keys)
        self.list.setCurrentRow(0)

    def _run(self) -> None:
        matching = matches(self._commands, self.line.text())
        if not matching:
            return
        command = matching[max(0, self.list.currentRow())]
        self.accept()
        QTimer.singleShot(0, self.parent() or self, command.run)  # when this dialog is gone


FILE, EDIT, GO, HELP, THEME = N_("&File"), N_("&Edit"), N_("&Go"), N_("&Help"), N_("&Theme")
WITHIN_VIEW = (N_("Look &from"), THEME)
MENUS = (FILE, EDIT, VIEW, GO, PAGE_MENU, HELP)

ROWS: tuple[ActionSpec, ...] = (
    ActionSpec(
        "open",
        N_("&Open …"),
        icon="open",
        shortcut="Ctrl+O",
        tip=N_("Open files of any kind"),
        bar="words",
        menu=FILE,
    ),
    ActionSpec("open_folder", N_("Open &folder …"), shortcut="Ctrl+Shift+O", menu=FILE),
    ActionSpec(
        "open_sample",
        N_("Open &sample"),
        icon="sample",
        tip=N_("Open the shipped particles"),
        bar="words",
        label=N_("Shipped"),
        menu=FILE,
    ),
    ActionSpec("recent", N_("Open &recent"), menu=FILE),
    ActionSpec(
        "repair",
        N_("Repair &meshes on opening"),
        tip=N_("Report defects and repair them"),
        checked=True,
        menu=FILE,
    ),
    ActionSpec(BREAK, menu=FILE),
    ActionSpec(
        "export",
        N_("To &DEM …"),
        icon="export",
        shortcut="Ctrl+E",
        tip=N_("Write a dataset and files for DEM programs"),
        bar="words",
        label=N_("To DEM …"),
        menu=FILE,
    ),
    ActionSpec(
        "save_recipe",
        N_("Save re&cipe …"),
        icon="recipe",
        shortcut="Ctrl+Alt+S",
        tip=N_("For regolith-studio run"),
        menu=FILE,
    ),
    ActionSpec(
        "run_batch",
        N_("Run as a &batch …"),
        shortcut="Ctrl+Alt+R",
        tip=N_("On this computer or on a cluster"),
        menu=FILE,
    ),
    ActionSpec(
        "report",
        N_("Repor&t …"),
        tip=N_("Figures and tables of the paper for the open particles, as one page"),
        menu=FILE,
    ),
    ActionSpec(BREAK, menu=FILE),
    ActionSpec("save_project", N_("&Save project"), shortcut="Ctrl+S", menu=FILE),
    ActionSpec("save_project_as", N_("Save project &as …"), shortcut="Ctrl+Shift+S", menu=FILE),
    ActionSpec(BREAK, menu=FILE),
    ActionSpec("quit", N_("&Quit"), shortcut="Ctrl+Q", menu=FILE),
    ActionSpec("undo", N_("&Undo"), icon="undo", shortcut="Ctrl+Z", bar="icon", menu=EDIT),
    ActionSpec("redo", N_("&Redo"), icon="redo", shortcut="Ctrl+Shift+Z", bar="icon", menu=EDIT),
    ActionSpec(BREAK, menu=EDIT),
    ActionSpec(
        "copy_command", N_("Copy as co&mmand"), tip=N_("The command line that does the same"), menu=EDIT
    ),
    ActionSpec("copy_python", N_("Copy as &Python"), tip=N_("A script that does the same"), menu=EDIT),
    ActionSpec(BREAK, menu=EDIT),
    ActionSpec(
        "palette",
        N_("&Commands …"),
        shortcut="Ctrl+Shift+P",
        tip=N_("Any command by a few letters"),
        menu=EDIT,
    ),
    ActionSpec(
        "preferences",
        N_("P&references …"),
        shortcut="Ctrl+,",
        tip=N_("Language, theme, font size"),
        menu=EDIT,
    ),
    ActionSpec("next_page", N_("&Next page"), shortcut="Ctrl+PgDown", menu=GO),
    ActionSpec("previous_page", N_("&Previous page"), shortcut="Ctrl+PgUp", menu=GO),
    ActionSpec(BREAK, menu=GO),
    ActionSpec("theme_system", N_("As the &system"), menu=THEME),
    ActionSpec("theme_light", N_("&Light"), menu=THEME),
    ActionSpec("theme_dark", N_("&Dark"), menu=THEME),
    ActionSpec("tasks", N_("&Tasks"), shortcut="Ctrl+T", tip=N_("Running tasks"), menu=VIEW),
    ActionSpec("log", N_("L&og"), shortcut="Ctrl+Shift+L", tip=N_("Messages so far"), menu=VIEW),
    ActionSpec(
        "standard_layout",
        N_("Standard la&yout"),
        tip=N_("Restore the standard sizes of all panels"),
        menu=VIEW,
    ),
    ActionSpec(BREAK, menu=VIEW),
    ActionSpec("tour", N_("&Tour"), icon="tour", tip=N_("Tour of the window"), menu=HELP),
    ActionSpec("guide", N_("&Guide"), tip=N_("The manual of the program"), menu=HELP),
    ActionSpec(
        "explain",
        N_("&Explain this page"),
        icon="help",
        shortcut="F1",
        tip=N_("The chapter of the guide on this page"),
        menu=HELP,
    ),
    ActionSpec("shortcuts", N_("&Keyboard and mouse"), shortcut="Ctrl+F1", menu=HELP),
    ActionSpec("about", N_("&About Regolith Studio"), menu=HELP),
)


STYLES = {
    "icon": Qt.ToolButtonStyle.ToolButtonIconOnly,
    "words": Qt.ToolButtonStyle.ToolButtonTextBesideIcon,
    "under": Qt.ToolButtonStyle.ToolButtonTextUnderIcon,
}
"""How a button of the tool bar shows its words."""
KINDS = (
    ("scan", "open_volume", N_("Open &volume …")),
    ("dataset", "open_dataset", N_("Open &dataset …")),
    ("repose", "open_positions", N_("&Measure positions …")),
)
"""Page, command and text of what is opened on another page."""


STEPS = {"undo": N_("&Undo"), "redo": N_("&Redo")}
"""Titles where there is nothing to undo or redo."""


class Actions:
    """The actions as Qt actions in the menus and the tool bar of a window.

    - ``window``: gets the menus and the tool bar.
    - ``commands``: a function for each name; switches are called with their state.
    - ``pages``: their rows are seen, and their shortcuts work, while the page is seen.
    - ``run``: runs a command of a page: its key, the name of the command, the state of a switch.
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
        self.bar = named(QToolBar(tr("Tools")), "tool_bar")
        self.bar.setMovable(False)
        window.addToolBar(self.bar)
        for title in MENUS:
            self._menu(title)
        for row in ROWS:
            self._add(row, row.name, commands.get(row.name))
        self.recent = QMenu(tr("Open &recent"), window)
        self.by_name["recent"].setMenu(self.recent)
        self.bar.insertSeparator(self.by_name["undo"])
        self._offer_kinds(run)
        for number, page in enumerate(pages.values(), start=1):
            self._add_page(page, number, run, commands["go"])

    def offer_step(self, name: str, title: str) -> None:
        """Say what ``undo`` or ``redo`` would act on; nothing: it is disabled."""
        action = self.by_name[name]
        action.setEnabled(bool(title))
        action.setText(title or tr(STEPS[name]))
        action.setToolTip(action.text().replace("&", ""))

    def _offer_kinds(self, run: Callable[..., object]) -> None:
        """List beside the button *Open* what else can be opened."""
        button = self.bar.widgetForAction(self.by_name["open"])
        if not isinstance(button, QToolButton):
            return
        menu = QMenu(button)
        menu.addAction(self.by_name["open"])
        menu.addAction(self.by_name["open_folder"])
        for key, name, text in KINDS:
            if key in self._pages:
                menu.addAction(tr(text), partial(run, key, name))
        menu.addAction(self.by_name["recent"])
        button.setMenu(menu)
        button.setPopupMode(QToolButton.ToolButtonPopupMode.MenuButtonPopup)

    def show_page(self, key: str) -> None:
        """Show the rows of one page and hide those of the others."""
        for owner, actions in self._of_page.items():
            for action in actions:
                action.setVisible(owner == key)
                action.setEnabled(owner == key)
        for title in (PAGE_MENU, N_("Look &from")):
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
        entries = []
        for name, action in self.by_name.items():
            key, _, command = name.partition(".")
            place = tr(pages[key].title) if key in pages else action.data() or ""
            begin: Callable[[], object] = action.trigger
            if key in pages and not action.isEnabled() and not action.isCheckable():
                begin = partial(run, key, command)
            if action.menu() is None and name != "palette":
                entries.append(Command(place, plain(action), shown_keys(action.shortcut()), begin))
        return entries

    def set_theme(self, theme: Theme) -> None:
        for action, name in self._icons:
            action.setIcon(icon(name, theme.text, theme.muted))
        if (more := self.bar.findChild(QToolButton, "qt_toolbar_ext_button")) is not None:
            more.setIcon(icon("more", theme.text, theme.muted))  # Qt's is black in every theme

    def _add_page(
        self, page: Page, number: int, run: Callable[..., object], go: Callable[[str], object]
    ) -> None:
        words = f"&{number} {tr(page.title)}"
        row = ActionSpec(page.key, words, icon=page.icon, shortcut=f"Alt+{number}", tip=page.tip, menu=GO)
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
        if row.label:
            action.setIconText(tr(row.label))
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
            button.setToolButtonStyle(STYLES[row.bar])

    def _menu(self, title: str) -> QMenu:
        if title not in self._menus:
            parent = self._menus["&View"] if title in WITHIN_VIEW else None
            made = parent.addMenu(tr(title)) if parent else self._window.menuBar().addMenu(tr(title))
            self._menus[title] = made
        return self._menus[title]
