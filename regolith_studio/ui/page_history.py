"""Undo of what is set on the pages beside the choices of the session, in the order in which it was done."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol

from PySide6.QtCore import QObject, QTimer, Signal

INTERVAL = 300
"""Milliseconds between two looks at a page: what rests for one is a step."""


class ShownPages(Protocol):
    """The part of :class:`~regolith_studio.ui.page_stack.PageStack` that is followed."""

    changed: Any
    widgets: Any

    @property
    def current(self) -> str:
        """Key of the page that is seen."""

    def go(self, key: str) -> Any:
        """Show a page."""


@dataclass(frozen=True)
class PageStep:
    """One change of the settings of a page.

    - ``page``: its key.
    - ``before``, ``after``: settings of the page.
    - ``depth``: steps of the session that came before; -1 where other particles have been opened since.
    """

    page: str
    before: dict[str, Any]
    after: dict[str, Any]
    depth: int


class PageHistory(QObject):
    """Steps of the pages, taken back page by page.

    - ``depth``: number of steps that the session can take back.
    """

    changed = Signal()

    def __init__(self, depth: Callable[[], int], parent: QObject) -> None:
        super().__init__(parent)
        self._depth = depth
        self._pages: ShownPages | None = None
        self._timer = QTimer(self, interval=INTERVAL)
        self._timer.timeout.connect(self.look)
        self.restart()

    def watch(self, pages: ShownPages) -> None:
        """Follow the page that is seen."""
        self._pages = pages
        pages.changed.connect(lambda _: self.look())
        self._timer.start()

    def restart(self) -> None:
        """Forget every step: the pages show a project that was opened."""
        self._past: list[PageStep] = []
        self._future: list[PageStep] = []
        self._kept: dict[str, dict[str, Any]] = {}
        self._seen: dict[str, dict[str, Any]] = {}
        self.changed.emit()

    def stop(self) -> None:
        """Look at no page any more."""
        self._timer.stop()

    def note_opening(self) -> None:
        """Other particles are open: the steps so far are older than that."""
        self._past = [replace(step, depth=-1) for step in self._past]
        self._future.clear()

    def look(self, resting: bool = False) -> None:
        """Keep a change of the page that is seen once it rests, or at once."""
        key = self._pages.current if self._pages else ""
        now = self._pages.widgets[key].settings() if self._pages and key in self._pages.widgets else {}
        kept = self._kept.setdefault(key, now)
        if now != kept and (resting or self._seen.get(key) == now):
            self._past.append(PageStep(key, kept, now, self._depth()))
            self._future.clear()
            self._kept[key] = now
            self.changed.emit()
        self._seen[key] = now

    def undo_page(self, older: bool = False) -> str:
        """Page of the step to take back, if it is the newest of all or `older` ones count too."""
        last = self._past[-1] if self._past else None
        return last.page if last and (older or last.depth >= self._depth()) else ""

    def redo_page(self, newer: bool = False) -> str:
        """Page of the step to take again, if it is the next of all or `newer` ones count too."""
        last = self._future[-1] if self._future else None
        return last.page if last and (newer or last.depth <= self._depth()) else ""

    def undo(self) -> None:
        """Take the last step of a page back, on the page."""
        if self._past:
            step = self._past.pop()
            self._future.append(step)
            self._show(step.page, step.before)

    def redo(self) -> None:
        """Take it again."""
        if self._future:
            step = self._future.pop()
            self._past.append(step)
            self._show(step.page, step.after)

    def _show(self, page: str, settings: dict[str, Any]) -> None:
        if self._pages is not None:
            widget = self._pages.go(page)
            widget.restore(settings)
            self._kept[page] = self._seen[page] = widget.settings()
            self.changed.emit()
