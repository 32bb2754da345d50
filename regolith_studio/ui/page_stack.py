"""The sidebar and the current page; a page is built when it is first opened."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import (
    QAbstractItemView,
    QButtonGroup,
    QFrame,
    QHBoxLayout,
    QScrollArea,
    QSizePolicy,
    QStackedWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.ui.icons import icon
from regolith_studio.ui.layout import scrolled
from regolith_studio.ui.page import Page, PageContext, PageWidget
from regolith_studio.ui.shortcuts import with_keys
from regolith_studio.ui.theme import Theme, current_theme, ensure_polished, pass_theme, restyle
from regolith_studio.ui.translation import tr

ICON_SIZE = QSize(24, 24)


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

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        for key, page in self._pages.items():
            self.buttons[key].setIcon(icon(page.icon, theme.text, theme.muted))

    def _button(self, page: Page, number: int) -> QToolButton:
        button = QToolButton()
        button.clicked.connect(partial(self._clicked, page.key))
        button.setObjectName(f"page_{page.key}")
        button.setText(tr(page.title))
        button.setAccessibleName(tr("Page {title}", title=tr(page.title)))
        button.setToolTip(with_keys(tr(page.tip), QKeySequence(f"Alt+{number}")))
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
        button.setIconSize(ICON_SIZE)
        button.setCheckable(True)
        button.setAutoRaise(True)
        button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        return button

    def _clicked(self, key: str) -> None:
        self.chosen.emit(key)


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
        self._stack = QStackedWidget()
        self._scroll_areas: dict[str, ScrollablePage] = {}
        self._bar = Sidebar(self.pages)
        self.buttons = self._bar.buttons
        self._bar.chosen.connect(self.go)
        self._arrange()

    @property
    def current(self) -> str:
        """Key of the page that is seen."""
        return self._current

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
            self._bar.set_current(key)
            self._contexts[key].bindings.resume()
            widget.on_show()
            self.changed.emit(key)
        return widget

    def open_in(self, key: str, path: Path) -> None:
        """Show a page and open a file there."""
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
        self.widgets[key] = widget
        self.built.emit(key)

    def _apply_theme(self, key: str) -> None:
        if key in self._unthemed:
            self._unthemed.remove(key)
            restyle(self._scroll_areas[key])
            pass_theme(self.widgets[key], current_theme())

    def _hide_current(self) -> None:
        if self._current:
            self._contexts[self._current].bindings.pause()
            self.widgets[self._current].on_hide()

    def _arrange(self) -> None:
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(scrolled(self._bar, whole_width=True))
        row.addWidget(self._stack, 1)
