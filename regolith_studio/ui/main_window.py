"""The main window: places pages and menus."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import cast

from PySide6.QtCore import QEvent, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QGuiApplication
from PySide6.QtWidgets import QApplication, QMainWindow

from regolith_studio.session.file_kinds import FileKind
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.session import Session
from regolith_studio.ui.actions import Actions, CommandPalette
from regolith_studio.ui.activity import ActivityDock, TasksPanel
from regolith_studio.ui.appearance import STANDARD_SIZE, Appearance, WindowState, show_bars
from regolith_studio.ui.batch_runs import BatchRuns, ReportRuns
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.dialogs.help import CitationLinks, about_dialog, guide_dialog, start_tour
from regolith_studio.ui.keyboard import Shortcuts, ShortcutsDialog
from regolith_studio.ui.page import PageContext, PageStack, PageWidget
from regolith_studio.ui.pages import PAGES
from regolith_studio.ui.project_files import ProjectFiles, may_close, needs_confirmation
from regolith_studio.ui.theme import THEMES, apply_theme, current_theme
from regolith_studio.ui.widgets.toast import Toast, report_file_problems


class MainWindow(QMainWindow):
    """Sidebar, current page, menus, and the running task.

    - ``session``: shown and steered.
    - ``preferences``: recent files, units, and the layout of the window.
    - ``views``: ``live`` or ``image``.
    """

    closing = Signal()

    def __init__(self, session: Session, preferences: Preferences, views: str) -> None:
        super().__init__()
        self.setObjectName("main_window")
        self.setWindowTitle("Regolith Studio")
        self.setAcceptDrops(True)
        self.session, self.preferences = session, preferences
        self._views = views
        self.appearance = Appearance(preferences, self._apply_theme, self)
        self.toast = Toast(self)
        self.commands = Commands(session, preferences, self.toast, self)
        self.batches = BatchRuns(session, preferences, self.toast, self)
        self.reports = ReportRuns(session, preferences, self.toast, self)
        self.bindings = Bindings(session, self.toast.problem, self)
        self.pages = PageStack(tuple(PAGES.values()), self._context)
        self.commands.page_steps.watch(self.pages)
        self.projects = ProjectFiles(session, self.pages, self.commands.page_steps, self.toast, self)
        self.window_state = WindowState(preferences)
        self.tasks = TasksPanel()
        self.activity = ActivityDock(self)
        self.setCentralWidget(self.pages)
        self.statusBar().addWidget(self.tasks, 1)
        self.statusBar().setSizeGripEnabled(False)
        self.menus = Actions(self, self._command_table(), self.pages.pages, self.pages.run)
        CitationLinks(self.menus.by_name["about"].trigger, self)
        self.shortcuts = Shortcuts(self.menus.by_name, tuple(self.pages.pages), preferences)
        self.pages.changed.connect(self.menus.show_page)
        self._apply_theme()
        self.resize(*STANDARD_SIZE)
        self.window_state.restore_window(self)
        self.go(str(preferences.window.get("page", "")) or next(iter(self.pages.pages)))
        self._wire()
        self.toast.raise_()

    @property
    def page(self) -> PageWidget:
        return self.pages.widgets[self.pages.current]

    def go(self, key: str) -> PageWidget:
        """Show a page, the first one if there is none of this key."""
        return self.pages.go(key if key in self.pages.pages else next(iter(self.pages.pages)))

    def show_tour(self) -> None:
        self.pages.changed.connect(start_tour(self, self.go, self.preferences).follow)

    def _context(self, key: str) -> PageContext:
        bindings = Bindings(self.session, self.toast.problem, self)
        return PageContext(
            key, self.session, bindings, self.preferences, self.toast, self.commands, self._views, self.go
        )

    def _command_table(self) -> dict[str, Callable[..., object]]:
        ours = ("open", "open_folder", "open_sample", "save_recipe", "undo", "redo")
        copying = ("copy_command", "copy_python")
        return {
            **{name: getattr(self.commands, name) for name in (*ours, *copying)},
            **{f"theme_{name}": partial(self.appearance.choose, theme=name) for name in ("system", *THEMES)},
            **{name: partial(self.activity.show_tab, name) for name in ("tasks", "log")},
            "export": partial(self.pages.run, "dataset", "formats"),
            "run_batch": self.batches.ask,
            "report": self.reports.ask,
            "save_project": self.projects.save,
            "save_project_as": self.projects.save_as,
            "repair": lambda repair: self.session.choose(repair=repair),
            "palette": lambda: CommandPalette(
                self.menus.palette(self.pages.pages, self.pages.run), self
            ).open(),
            "preferences": self.appearance.ask,
            "standard_layout": partial(self.window_state.restore_standard, self),
            "tour": self.show_tour,
            "quit": self.close,
            "go": self.pages.go,
            "next_page": partial(self.pages.neighbour, 1),
            "previous_page": partial(self.pages.neighbour, -1),
            "guide": lambda: guide_dialog(self).show(),
            "explain": lambda: guide_dialog(self, self.pages.current).show(),
            "shortcuts": lambda: ShortcutsDialog(self.shortcuts, self.menus.places(), self).open(),
            "about": lambda: about_dialog(self, self._views).open(),
        }

    def _wire(self) -> None:
        session, bindings = self.session, self.bindings
        self.activity.wire(session, bindings, self.toast)
        self.toast.follow(session, bindings)
        self.commands.openers[FileKind.PROJECT] = self.projects.open
        for page in self.pages.pages.values():
            self.commands.openers |= dict.fromkeys(page.opens, partial(self.pages.open_in, page.key))
        self.pages.built.connect(lambda key: self.window_state.restore_parts(self.pages.widgets[key]))
        self.window_state.restore_parts(self)
        self.projects.changed.connect(lambda: self.setWindowTitle(self.projects.title()))
        bindings.refresh("tasks", lambda: self.tasks.setValue(session.tasks), slow=True)
        for show in (self.batches.show_tasks, self.reports.show_tasks):
            bindings.refresh("tasks", show, slow=True)
        for event in ("choices", "particles"):
            bindings.listen(event, self._show_choices)
        bindings.listen("particles", self.commands.page_steps.note_opening)
        self.commands.page_steps.changed.connect(self._show_choices)
        self._show_choices()
        bindings.listen("failed", lambda failure: self.toast.problem(failure.sentence, failure.details))
        bindings.listen("problems", lambda problems: report_file_problems(self.toast, problems))
        self.tasks.cancelRequested.connect(self.commands.stop)
        self.commands.stepped.connect(lambda: self.go("explore"))
        QGuiApplication.styleHints().colorSchemeChanged.connect(self._apply_theme)
        self.menus.recent.aboutToShow.connect(self._list_recent)

    def _show_choices(self) -> None:
        titles = {key: page.title for key, page in self.pages.pages.items()}
        for name in ("undo", "redo"):
            self.menus.offer_step(name, self.commands.step_title(name, titles))
        self.menus.by_name["repair"].setChecked(self.session.choices.repair)

    def _list_recent(self) -> None:
        self.menus.recent.clear()
        for name in self.preferences.recent:
            self.menus.recent.addAction(name, partial(self.commands.open_paths, [Path(name)]))

    def _apply_theme(self) -> None:
        theme = current_theme()
        apply_theme(cast(QApplication, QApplication.instance()), theme, self, self.pages.scroll_areas)
        for part in (self.menus, self.pages, self.tasks):
            part.set_theme(theme)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.WindowStateChange:
            show_bars(self, (self.pages.sidebar, self.statusBar()), shown=not self.isFullScreen())

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        paths = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
        event.acceptProposedAction()
        QTimer.singleShot(0, self, lambda: self.commands.open_paths(paths))

    def closeEvent(self, event: QCloseEvent) -> None:
        stopped = needs_confirmation(self.session.tasks, self.pages.busy())
        if not may_close(self, stopped, self.projects.unsaved(), self.projects.save):
            event.ignore()
            return
        self.window_state.keep(self)
        self.preferences.window = self.preferences.window | {"page": self.pages.current}
        self.preferences.save()
        QGuiApplication.styleHints().colorSchemeChanged.disconnect(self._apply_theme)
        self.hide()
        self.closing.emit()
        self.bindings.disconnect_all()
        self.commands.page_steps.stop()
        self.projects.close()
        self.session.close()
        self.pages.close_pages()
        event.accept()
