"""A page of the window: its protocol, actions, context and place; see :mod:`regolith_studio.ui.pages`."""

import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from PySide6.QtCore import QEvent, QMargins, QObject, QRegularExpression, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QKeySequence, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QButtonGroup,
    QFrame,
    QScrollArea,
    QSizePolicy,
    QStackedWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.jobs.events import Failed, Job
from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.keyboard import with_keys
from regolith_studio.ui.layout import FoldingSplitter, hbox, restore_borders, scrolled
from regolith_studio.ui.theme import (
    Theme,
    current_theme,
    ensure_polished,
    font_size,
    icon,
    pass_theme,
    restyle,
)
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.toast import Toast

BREAK = "-"
PAGE_MENU, VIEW = N_("&Page"), N_("&View")
"""Menus of the commands of the page that is seen, and of what it shows."""


@dataclass(frozen=True)
class ActionSpec:
    """One row.

    - ``name``: of the command that it runs, and its object name; :data:`BREAK` for a line between actions.
    - ``text``: in the menu; "&" marks the letter.
    - ``icon``: file in ``resources/icons``; empty for none.
    - ``shortcut``: empty for none.
    - ``tip``: in the tool bar; the text if empty.
    - ``checked``: ``True`` or ``False`` for a switch, ``None`` for a command.
    - ``bar``: its place in the tool bar: ``words`` with its text, ``under`` with `label` below its icon,
      ``icon`` without, empty for none.
    - ``label``: one or two words for the tool bar; the text if empty.
    - ``menu``: title of its menu; those of :data:`regolith_studio.ui.actions.WITHIN_VIEW` are menus within
      View.
    """

    name: str
    text: str = ""
    icon: str = ""
    shortcut: str = ""
    tip: str = ""
    checked: bool | None = None
    bar: str = ""
    label: str = ""
    menu: str = PAGE_MENU


MIN_VIEW = 8, 3
"""Parts of width and height of a window that a 3-D view has at least."""


class ValuePanel(Protocol):
    """A panel whose values are plain JSON."""

    def value(self) -> dict[str, Any]: ...
    def setValue(self, value: Mapping[str, Any]) -> None: ...


class PageWidget(QWidget):
    """Base class of pages; every method may be overridden."""

    def build(self) -> None:
        """Make the parts of the page; called once, right after construction."""

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme, once after building and at every change; its parts have done so."""

    def commands(self) -> Mapping[str, Callable[..., object]]:
        """A function for each name in :attr:`Page.actions`; switches are called with their state."""
        return {}

    def on_show(self) -> None:
        """Called when the page becomes the current one."""

    def on_hide(self) -> None:
        """Called when another page becomes the current one."""

    def open_path(self, path: Path) -> None:
        """Open a file whose kind is one of :attr:`Page.opens`: dropped, chosen, or named at start."""

    def busy(self) -> str:
        """One sentence on what closing would lose or stop, or nothing; tasks need not be named."""
        return ""

    def panels(self) -> Mapping[str, ValuePanel]:
        """Panels of what is set on this page alone, by their names in :meth:`settings`."""
        return {}

    def settings(self) -> dict[str, Any]:
        """The part of :meth:`state` that undo takes back: what is set on this page alone."""
        return {name: panel.value() for name, panel in self.panels().items()}

    def step(self, name: str) -> Callable[[], None] | None:  # noqa: ARG002
        """What ``undo`` or ``redo`` does before all else while this page is seen, if there is something."""
        return None

    def state(self) -> dict[str, Any]:
        """What a project file keeps of this page, as plain JSON; under ``made``, what was computed here."""
        return self.settings()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Show what :meth:`state` returned once, maybe by another version: ignore what is not known."""
        for name, panel in self.panels().items():
            if isinstance(state.get(name), Mapping):
                panel.setValue(state[name])

    def resume(self, state: Mapping[str, Any]) -> None:
        """Show again what was made of the particles, which are open now; after :meth:`restore`."""

    def on_close(self) -> None:
        """Called when the window closes: release graphics memory, stop timers."""

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Let the page scroll before its 3-D views become small."""
        super().resizeEvent(event)
        window = self.window()
        for frame in self.findChildren(QFrame, QRegularExpression("^view_")):
            frame.setMinimumSize(window.width() // MIN_VIEW[0], window.height() // MIN_VIEW[1])


@dataclass(frozen=True)
class PageContext:
    """The context of a page: session, preferences and services of the window.

    - ``key``: of the page.
    - ``session``: particles, choices, results, events; see :mod:`regolith_studio.session`.
    - ``bindings``: the page's own: what it refreshes is refreshed while the page is seen, and at its next
      visit if something has changed meanwhile.
    - ``preferences``: what is remembered from one start to the next; see :meth:`recall`.
    - ``toast``: ``note(sentence)`` and ``problem(sentence, details)``.
    - ``commands``: opening, saving and exporting, with their dialogs.
    - ``views``: ``live`` or ``image``, for :func:`~regolith_studio.ui.views.image_view.make_view`.
    - ``go``: shows another page by its key, and returns its widget.
    """

    key: str
    session: Session
    bindings: Bindings
    preferences: Preferences
    toast: Toast
    commands: Commands
    views: str
    go: Callable[[str], PageWidget]

    def start(
        self,
        title: str,
        job: Job,
        finished: Callable[[Any], None],
        partial: Callable[[Any], None] | None = None,
        failed: Callable[[Failed], None] | None = None,
        stopped: Callable[[], None] | None = None,
        queue: str = "",
        *,
        repeats: bool = False,
        after_running: bool = False,
    ) -> int:
        """Run a job in the background, seen in the task list; returns the number for :meth:`Session.cancel`.

        - ``title``: on screen.
        - ``job``: a generator function with its arguments; see :mod:`regolith_studio.jobs.events`.
        - ``finished``, ``partial``, ``failed``, ``stopped``: called in the thread of the window, and only
          while no newer job has taken the queue. A failure that is not taken care of becomes a toast.
        - ``queue``: jobs of one queue of one page replace each other.
        - ``repeats``: the job starts by itself when the page is opened again: closing the window does not
          ask about it.
        - ``after_running``: let the running job of the queue end and be shown first: for controls that are
          dragged.
        """
        return self.session.run(
            f"{self.key}:{queue}",
            title,
            job,
            finished,
            partial,
            failed,
            stopped,
            repeats=repeats,
            after_running=after_running,
        )

    def stop(self, queue: str = "") -> None:
        """Stop what runs in a queue of this page, silently: its reactions are not called any more."""
        self.session.stop(f"{self.key}:{queue}")

    def recall(self, name: str, default: Any = None) -> Any:
        """What was remembered under this name by this page."""
        return self.preferences.window.get(f"page.{self.key}", {}).get(name, default)

    def remember(self, name: str, value: Any) -> None:
        """Remember plain JSON for the next start; written when the window closes."""
        kept = self.preferences.window.get(f"page.{self.key}", {}) | {name: value}
        self.preferences.window = self.preferences.window | {f"page.{self.key}": kept}


@dataclass(frozen=True)
class Page:
    """A page as a row of the sidebar.

    - ``key``: name of its package.
    - ``title``: in the sidebar: one word or two.
    - ``icon``: file in ``resources/icons``.
    - ``order``: place in the sidebar, from small to large.
    - ``tip``: one sentence on what can be done there.
    - ``make``: ``module:Class`` of the widget, called with its context; imported at the first visit, so that
      the window starts fast.
    - ``opens``: kinds of files that :meth:`PageWidget.open_path` of this page opens.
    - ``actions``: commands of the page, in menus and tool bar while it is seen, in the command palette
      always.
    """

    key: str
    title: str
    icon: str
    order: int
    tip: str
    make: str
    actions: tuple[ActionSpec, ...] = ()
    opens: tuple[FileKind, ...] = ()

    def build(self, context: PageContext) -> PageWidget:
        """Make the widget of the page with all its parts."""
        widget: PageWidget = pkgutil.resolve_name(self.make)(context)
        widget.build()
        return widget


ICON_SIZE = QSize(24, 24)
TITLE_MARGIN = 18
"""Pixels above and below icon and title of a page."""
MIN_CHARACTERS = 110
"""Width of a window in characters from which on the titles of its pages are shown."""


class Sidebar(QFrame):
    """One button a page, in the order of the pages.

    ``pages``: by key.
    """

    chosen = Signal(str)

    def __init__(self, pages: Mapping[str, Page]) -> None:
        super().__init__()
        self.setObjectName("sidebar")
        self.setProperty("role", "sidebar")
        self._pages = pages
        self._group = QButtonGroup(self)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(5, 8, 5, 8)
        self._column.setSpacing(3)
        self.buttons: dict[str, QToolButton] = {}
        for number, (key, page) in enumerate(pages.items(), start=1):
            button = self.buttons[key] = self._button(page, number)
            self._group.addButton(button)
            self._column.addWidget(button)
        self._column.addStretch(1)

    def set_current(self, key: str) -> None:
        """Check the button of a page; Tab comes to it alone, and the focus follows within the bar."""
        focused = any(button.hasFocus() for button in self.buttons.values())
        for name, button in self.buttons.items():
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus if name == key else Qt.FocusPolicy.NoFocus)
        self.buttons[key].setChecked(True)
        if focused:
            self.buttons[key].setFocus(Qt.FocusReason.OtherFocusReason)

    def fit_into(self, room: QSize) -> None:
        """Show the titles below the icons where a window has room for them; they are in the tool tips too."""
        metrics = self.fontMetrics()
        height = len(self.buttons) * (ICON_SIZE.height() + metrics.height() + TITLE_MARGIN)
        shown = room.width() >= MIN_CHARACTERS * metrics.averageCharWidth() and room.height() >= height
        style = Qt.ToolButtonStyle.ToolButtonTextUnderIcon if shown else Qt.ToolButtonStyle.ToolButtonIconOnly
        for button in self.buttons.values():
            button.setToolButtonStyle(style)

    def set_theme(self, theme: Theme) -> None:
        for key, page in self._pages.items():
            self.buttons[key].setIcon(icon(page.icon, theme.text, theme.muted))

    def _button(self, page: Page, number: int) -> QToolButton:
        button = QToolButton()
        button.clicked.connect(lambda: self.chosen.emit(page.key))
        button.setObjectName(f"page_{page.key}")
        button.setText(tr(page.title))
        button.setAccessibleName(tr("Page {title}", title=tr(page.title)))
        tip = f"{tr(page.title)}: {tr(page.tip)}"
        button.setToolTip(with_keys(tip, QKeySequence(f"Alt+{number}")))
        button.setIconSize(ICON_SIZE)
        button.setCheckable(True)
        button.setAutoRaise(True)
        button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        return button


MIN_SIZE = QSize(240, 160)
"""Minimum size of a page in pixels: a small screen must hold the whole window."""


class ScrollablePage(QScrollArea):
    """A page with scroll bars where it needs more room than there is."""

    def __init__(self, page: QWidget) -> None:
        super().__init__()
        self.setObjectName("scroll_area")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setWidgetResizable(True)
        self.setWidget(page)

    def minimumSizeHint(self) -> QSize:
        return MIN_SIZE

    def resizeEvent(self, event: QResizeEvent) -> None:
        self._fold()
        super().resizeEvent(event)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:
            self._fold()
        return super().eventFilter(watched, event)

    def _fold(self) -> None:
        """Let results and controls have the room without bars, less one at the right."""
        if (page := self.widget()) is not None:
            bar = QMargins(0, 0, self.verticalScrollBar().sizeHint().width(), 0)
            room = self.maximumViewportSize().shrunkBy(bar)
            for splitter in page.findChildren(FoldingSplitter):
                splitter.fold(room)


class PageStack(QWidget):
    """Shows one page at a time.

    ``pages``: in the order of the sidebar. ``context_of``: what a page is given, by its key.
    """

    changed = Signal(str)
    built = Signal(str)

    def __init__(self, pages: tuple[Page, ...], context_of: Callable[[str], PageContext]) -> None:
        super().__init__()
        self.pages = {page.key: page for page in pages}
        self.widgets: dict[str, PageWidget] = {}
        self._contexts: dict[str, PageContext] = {}
        self._context_of = context_of
        self._current = ""
        self._unthemed: set[str] = set()
        self._font_sizes: dict[str, float] = {}
        self._stack = QStackedWidget()
        self._scroll_areas: dict[str, ScrollablePage] = {}
        self._bar = Sidebar(self.pages)
        self.sidebar = scrolled(self._bar, whole_width=True)
        self.buttons = self._bar.buttons
        self._bar.chosen.connect(self.go)
        hbox(self.sidebar, (self._stack, 1), parent=self, spacing=0)

    @property
    def current(self) -> str:
        return self._current

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._bar.fit_into(event.size())

    def go(self, key: str) -> PageWidget:
        """Show a page; at the first visit it is built."""
        if key not in self.widgets:
            self._build(key)
        widget = self.widgets[key]
        if key != self._current:
            self._hide_current()
            self._apply_theme(key)
            self._current = key
            self._stack.setCurrentWidget(self._scroll_areas[key])
            self._restore_borders(key)
            self._bar.set_current(key)
            self._contexts[key].bindings.resume()
            widget.on_show()
            self.changed.emit(key)
        return widget

    def open_in(self, key: str, path: Path) -> None:
        self.go(key).open_path(path)

    def neighbour(self, step: int) -> None:
        """The next page, or the one before."""
        keys = list(self.pages)
        self.go(keys[(keys.index(self._current) + step) % len(keys)])

    def run(self, key: str, command: str, *arguments: object) -> None:
        """Run a command of a page, which is shown first."""
        self.go(key).commands()[command](*arguments)

    def busy(self) -> list[str]:
        """What the pages say about being closed now."""
        return [sentence for each in self.widgets.values() if (sentence := each.busy())]

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of the present theme; hidden pages take them when they are shown again."""
        self._bar.set_theme(theme)
        self._unthemed = set(self.widgets)
        if self._current:
            self._apply_theme(self._current)
            self._restore_borders(self._current)

    @property
    def scroll_areas(self) -> tuple[ScrollablePage, ...]:
        """One for each page; they take another theme by :meth:`set_theme`."""
        return tuple(self._scroll_areas.values())

    def refresh_hidden(self) -> None:
        """Let hidden pages forget particles that have been closed."""
        for key in self.widgets.keys() - {self._current}:
            self._contexts[key].bindings.refresh_hidden()

    def close_pages(self) -> None:
        """Disconnect all pages and let them release what they hold."""
        for key, widget in self.widgets.items():
            self._contexts[key].bindings.disconnect_all()
            widget.on_close()

    def _build(self, key: str) -> None:
        context = self._contexts[key] = self._context_of(key)
        widget = self.pages[key].build(context)
        context.bindings.pause()
        for view in widget.findChildren(QAbstractItemView):
            view.setTabKeyNavigation(False)  # Tab leaves a table; arrows move in it
        self._scroll_areas[key] = ScrollablePage(widget)
        self._stack.addWidget(self._scroll_areas[key])
        ensure_polished(widget)
        pass_theme(widget, current_theme())
        self.widgets[key], self._font_sizes[key] = widget, font_size()
        self.built.emit(key)

    def _apply_theme(self, key: str) -> None:
        if key in self._unthemed:
            self._unthemed.remove(key)
            restyle(self._scroll_areas[key])
            pass_theme(self.widgets[key], current_theme())

    def _restore_borders(self, key: str) -> None:
        """Give borders their places back in a smaller font: parts that a large one has widened stay so."""
        if font_size() < self._font_sizes[key]:
            widget = self.widgets[key]  # whose parts ask for less room once they have taken the font
            timer = QTimer(widget, singleShot=True)  # a call that is due would keep a page that is deleted
            timer.timeout.connect(lambda: restore_borders(widget))
            timer.timeout.connect(timer.deleteLater)
            timer.start(0)
        self._font_sizes[key] = font_size()

    def _hide_current(self) -> None:
        if self._current:
            self._contexts[self._current].bindings.pause()
            self.widgets[self._current].on_hide()
