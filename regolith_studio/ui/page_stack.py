"""The sidebar and the page that is seen; a page is built when it is first visited."""

import time
from collections.abc import Callable, Iterator
from functools import partial

from PySide6.QtCore import QTimer, Signal
from PySide6.QtWidgets import QAbstractItemView, QHBoxLayout, QStackedWidget, QWidget

from regolith_studio.ui.page import Page, PageContext, PageWidget
from regolith_studio.ui.page_building import SLICE, PageBuilder, Steps, polish
from regolith_studio.ui.room import Room
from regolith_studio.ui.sidebar import Sidebar
from regolith_studio.ui.theme import Theme, current_theme, restyle, restyle_steps
from regolith_studio.ui.widgets.table import ListTable


class PageStack(QWidget):
    """Shows one page at a time.

    Parameters
    ----------
    pages
        In the order of the sidebar.
    context_of
        What a page is given, by its key.
    """

    changed = Signal(str)
    built = Signal(str)
    approached = Signal(str)
    """The mouse, or the keyboard, has come to the button of a page."""
    ended = Signal()
    """The window closes; no page will be wanted any more."""

    def __init__(self, pages: tuple[Page, ...], context_of: Callable[[str], PageContext]) -> None:
        super().__init__()
        self.pages = {page.key: page for page in pages}
        self.widgets: dict[str, PageWidget] = {}
        self._ended = False
        self.load: Callable[[str], object] | None = None
        """Loads what a page needs in the background and calls :meth:`prepare`; without, that is done here."""
        self._contexts: dict[str, PageContext] = {}
        self._context_of = context_of
        self._current = self._awaited = ""
        self._builder = PageBuilder(self._steps, self._take, self)
        self._unthemed: list[str] = []
        self._themes: dict[str, Iterator[None]] = {}
        self._theming = QTimer(self, interval=0)
        self._theming.timeout.connect(self._theme_next)
        self._stack = QStackedWidget()
        self._rooms: dict[str, Room] = {}
        self._bar = Sidebar(self.pages)
        self.buttons = self._bar.buttons
        self._bar.chosen.connect(self.visit)
        self._bar.approached.connect(self.approached)
        self._arrange()

    @property
    def current(self) -> str:
        """Key of the page that is seen."""
        return self._current

    def go(self, key: str) -> PageWidget:
        """Show a page, building it at once if need be."""
        widget = self.widgets.get(key) or self._builder.finish(key)
        self._awaited = ""
        if key != self._current:
            self._leave()
            self._theme(key)
            self._current = key
            self._stack.setCurrentWidget(self._rooms[key])
            self.buttons[key].setChecked(True)
            self._contexts[key].wiring.resume()
            widget.entered()
            self.changed.emit(key)
        return widget

    def visit(self, key: str) -> None:
        """Show a page as soon as it is built, step by step while the window goes on answering."""
        if key in self.widgets:
            self.go(key)
            return
        self._awaited = key
        if self.load is None:
            self._builder.want(key)
        else:
            self.load(key)

    def prepare(self, key: str) -> None:
        """Build a page that may be wanted soon, step by step."""
        if key not in self.widgets:
            self._builder.want(key)

    @property
    def awaited(self) -> str:
        """Key of the page that will be shown when it is built, or nothing."""
        return self._awaited

    def neighbour(self, step: int) -> None:
        """The next page, or the one before."""
        keys = list(self.pages)
        self.visit(keys[(keys.index(self._awaited or self._current) + step) % len(keys)])

    def run(self, key: str, command: str, *arguments: object) -> None:
        """Run a command of a page, which is shown first."""
        self.go(key).commands()[command](*arguments)

    def busy(self) -> list[str]:
        """What the pages say about being closed now."""
        return [sentence for each in self.widgets.values() if (sentence := each.busy())]

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of the present theme, one page after the other: the one that is seen first."""
        self._bar.set_theme(theme)
        self._themes.clear()
        self._unthemed = sorted(self.widgets, key=lambda key: key != self._current)
        if self._current:
            self._rooms[self._current].setUpdatesEnabled(False)  # not seen in both themes at once
        self._theming.start()

    @property
    def rooms(self) -> tuple[Room, ...]:
        """With a page in each; they take another theme by :meth:`set_theme`."""
        return tuple(self._rooms.values())

    def let_go(self) -> None:
        """Let hidden pages forget particles that have been closed."""
        for key in self.widgets.keys() - {self._current}:
            self._contexts[key].wiring.let_go()

    def release(self) -> None:
        """The window closes."""
        self.finish()
        for key, widget in self.widgets.items():
            self._contexts[key].wiring.cut()
            widget.release()

    def finish(self) -> None:
        """The window closes: let no page be half built, and wait for none."""
        self._awaited = ""
        if not self._ended:
            self._ended, self.load = True, None
            self.ended.emit()
        self._builder.finish_all()
        self._unthemed.clear()
        self._theming.stop()

    def _steps(self, key: str) -> Steps:
        begun = current_theme()
        context = self._contexts[key] = self._context_of(key)
        widget = yield from self.pages[key].steps(context, partial(self._make_room, key))
        context.wiring.pause()
        yield
        for view in widget.findChildren(QAbstractItemView):
            view.setTabKeyNavigation(False)  # Tab leaves a table; arrows move in it
        yield
        yield from polish(widget)
        theme = current_theme()
        if theme != begun:  # what was polished before has the colours of then
            restyle(widget)
        yield from widget.theme_steps(theme)
        for table in widget.findChildren(ListTable):
            yield from table.measure_unseen()
        if current_theme() != theme:
            restyle(widget)
            widget.set_theme(current_theme())
        return widget

    def _make_room(self, key: str, page: PageWidget) -> None:
        """Give a page its place while it is empty: its parts take their style one by one, not all at once."""
        if (abandoned := self._rooms.pop(key, None)) is not None:  # by an error on the way
            abandoned.deleteLater()
        self._rooms[key] = Room(page)
        self._stack.addWidget(self._rooms[key])

    def _theme_next(self) -> None:
        """Style and plots of one page, for no longer than a slice."""
        end = time.perf_counter() + SLICE
        if not self._unthemed:
            self._theming.stop()
            return
        key = self._unthemed[0]
        if key not in self._themes:
            self._themes[key] = self._theme_steps(key)
        for _ in self._themes[key]:
            if time.perf_counter() > end:
                return
        self._has_theme(key)

    def _theme(self, key: str) -> None:
        """Let a page have the present theme at once."""
        if key in self._unthemed:
            for _ in self._themes.get(key) or self._theme_steps(key):
                pass
            self._has_theme(key)

    def _theme_steps(self, key: str) -> Iterator[None]:
        yield from restyle_steps(self._rooms[key])
        yield from self.widgets[key].theme_steps(current_theme())

    def _has_theme(self, key: str) -> None:
        self._themes.pop(key, None)
        self._unthemed.remove(key)
        self._rooms[key].setUpdatesEnabled(True)

    def _take(self, key: str, widget: PageWidget) -> None:
        self.widgets[key] = widget
        self.built.emit(key)
        if key == self._awaited:
            self.go(key)

    def _leave(self) -> None:
        if self._current:
            self._contexts[self._current].wiring.pause()
            self.widgets[self._current].left()

    def _arrange(self) -> None:
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self._bar)
        row.addWidget(self._stack, 1)
