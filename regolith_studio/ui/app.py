"""Make the main window with its session; bring events of worker threads and uncaught errors into it."""

import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from psygnal import EmitLoopError
from PySide6.QtCore import QObject, Qt, QTimer, Signal

from regolith_studio.errors import RegolithError
from regolith_studio.jobs.compile_kernels import TASKS, compile_first
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.session import Session
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.tour import TOUR_SEEN
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.factory import best_kind

FILLED_CHECK = 100
"""Milliseconds between two looks at whether the views of the first start are filled."""
FIRST_PAGE = "explore"
"""The page where the tour begins."""
IDLE, BUSY = 3_000, 60_000
"""Milliseconds without work, and at most, after which hidden pages forget closed particles."""


def show_recovery_and_tour(window: MainWindow) -> None:
    """Offer what a crash has left; start the tour at the first start, when there is something to see."""
    window.projects.offer_recovery()
    if window.preferences.window.get(TOUR_SEEN):
        return
    timer = QTimer(window, interval=FILLED_CHECK)

    def start_when_filled() -> None:
        if window.session.results.polyhedron is not None or not window.session.tasks:
            timer.stop()
            if window.pages.current == FIRST_PAGE:  # else its user is at work already
                window.show_tour()

    timer.timeout.connect(start_when_filled)
    timer.start()


def open_window(
    paths: Sequence[str | Path] = (),
    unit: str | None = None,
    views: str | None = None,
    preferences: Preferences | None = None,
) -> MainWindow:
    """A window with its own session; the particles arrive a moment later."""
    poster = MainThreadInvoker()
    runner = ThreadRunner(poster.post)
    _compile_in_background(runner)
    session = Session(runner)
    files = [Path(path) for path in paths]
    if not files:
        session.open_sample()  # is read while the window is built
    window = MainWindow(session, preferences or Preferences.load(), views or best_kind())
    poster.setParent(window)
    if files:
        QTimer.singleShot(0, window, lambda: window.commands.open_paths(files, unit))
    _release_memory(window)
    return window


def _compile_in_background(runner: ThreadRunner) -> None:
    """Compile what is not compiled yet in the order in which it is needed; who needs it says so meanwhile."""
    runner.submit(Job(compile_first, tuple(TASKS)), lambda _event: None, "compile")


def _release_memory(window: MainWindow) -> None:
    """Let hidden pages drop closed particles when nothing runs, so that their meshes are freed."""
    timer, latest = QTimer(window, singleShot=True, interval=IDLE), QTimer(window, interval=BUSY)
    for each in (timer, latest):
        each.timeout.connect(window.pages.refresh_hidden)
    latest.start()
    window.bindings.listen("tasks", lambda *_: timer.stop() if window.session.tasks else timer.start())


Hook = Callable[[type[BaseException], BaseException, TracebackType | None], Any]


def make_excepthook(report: Callable[[str, str], None]) -> Hook:
    """An excepthook that reports one sentence and keeps the program alive."""

    def hook(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        details = "".join(traceback.format_exception(kind, error, trace))
        print(details, file=sys.stderr)  # noqa: T201
        cause = error.__cause__ if isinstance(error, EmitLoopError) else None
        reason = cause or error  # psygnal wraps what a listener of the session raises
        if isinstance(reason, RegolithError):
            report(str(reason), details)
        else:
            name = type(reason).__name__
            report(tr("Internal error ({name}); the program continues.", name=name), details)

    return hook


Call = Callable[[], None]


class MainThreadInvoker(QObject):
    """``post`` may be called from any thread; the function runs soon, in order, where this object lives."""

    _posted = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._open = True
        self._posted.connect(self._run, Qt.ConnectionType.QueuedConnection)

    def post(self, call: Call) -> None:
        """Run `call` in the thread of the window; dropped when the window has closed."""
        if self._open:
            self._posted.emit(call)

    def close(self) -> None:
        """Run nothing any more."""
        self._open = False

    def _run(self, call: Call) -> None:
        if self._open:
            call()
