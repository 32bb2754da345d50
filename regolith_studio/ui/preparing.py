"""Loads in the background what pages need: one that is visited or that the mouse comes near, then all.

The one that the mouse comes near is also built, step by step between the events of the window. Not at the
start: many a visit ends on the page where it began, and what the others need is memory.
"""

from PySide6.QtCore import QObject, QTimer

from regolith_studio.jobs.events import Event, Failed, Job, Progress, Started, Steps
from regolith_studio.jobs.runners.protocol import Runner
from regolith_studio.ui.page import Page
from regolith_studio.ui.page_stack import PageStack

LANE = "preparing pages"
PAUSE = 1500
"""Milliseconds from a visit until the others are loaded: loading takes the interpreter from who paints."""


class Preparing(QObject):
    """Hears from a stack of pages which one may be wanted next.

    Parameters
    ----------
    stack
        Of the window.
    runner
        Works in the background.
    """

    def __init__(self, stack: PageStack, runner: Runner) -> None:
        super().__init__(stack)
        self._stack, self._runner = stack, runner
        self._ready: set[str] = set()
        self._next = ""
        self._wanted: list[str] = []
        stack.approached.connect(self._want_soon)
        stack.load = self._want_soon
        self._later = QTimer(self, singleShot=True, interval=PAUSE)
        self._later.timeout.connect(lambda: self.want(*stack.pages))
        stack.changed.connect(lambda _key: self._later.start())
        stack.ended.connect(self._end)

    def want(self, *keys: str) -> None:
        """Prepare these pages before all others that are waiting."""
        left = [key for key in (*keys, *self._wanted) if key not in self._ready | self._stack.widgets.keys()]
        if (wanted := list(dict.fromkeys(left))) != self._wanted:
            self._wanted = wanted
            pages = tuple(self._stack.pages[key] for key in wanted)
            self._runner.submit(Job(prepared, (pages, self._ready)), self._hear, LANE)

    def put_off(self) -> None:
        """Wait anew before all pages are loaded, where that has not begun: somebody is at work."""
        if self._later.isActive():
            self._later.start()

    def _end(self) -> None:
        """Want nothing any more: the runner is closed next."""
        self._later.stop()
        self._stack.approached.disconnect(self._want_soon)

    def _want_soon(self, key: str) -> None:
        self._next = key
        if key not in self._ready:
            self.want(key)
        self._build_next()

    def _hear(self, event: Event) -> None:
        self._build_next()
        if isinstance(event, Failed) and self._stack.awaited:
            self._stack.prepare(self._stack.awaited)  # which says what is wrong

    def _build_next(self) -> None:
        """What somebody waits for, and the page whose button the mouse is at."""
        for key in {self._next, self._stack.awaited} & self._ready:
            self._stack.prepare(key)
            self._next = "" if key == self._next else self._next


def prepared(pages: tuple[Page, ...], ready: set[str]) -> Steps:
    """Load what these pages need, one after the other; `ready` takes the keys of those that are done."""
    yield Started("Preparing pages", len(pages))
    for number, page in enumerate(pages, start=1):
        page.load()
        ready.add(page.key)
        yield Progress(number, len(pages))
    return tuple(ready)
