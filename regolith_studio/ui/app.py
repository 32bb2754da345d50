"""Makes the window with its session, and says what went wrong in it."""

import gc
import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.runners.thread import ThreadRunner
from regolith_studio.jobs.thrift import give_back, load_runtime_of_kernels, pack_loaded_kernels
from regolith_studio.jobs.warming import warm_up
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.session import Session
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.posting import Poster
from regolith_studio.ui.preparing import Preparing
from regolith_studio.ui.tour import TOUR_SEEN
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.factory import best_kind
from regolith_studio.ui.views.loading import load_pyvista

REST = 3_000
"""Milliseconds without work after which memory is handed back."""
ASIDE = 1_000
"""Milliseconds after a page was built at which it is set aside."""


def welcome(window: MainWindow) -> None:
    """Bring back what a crash has left; show who is new around."""
    window.projects.offer_recovery()
    if not window.preferences.window.get(TOUR_SEEN):
        window.show_round()


def open_window(
    paths: Sequence[str | Path] = (),
    unit: str | None = None,
    views: str | None = None,
    preferences: Preferences | None = None,
) -> MainWindow:
    """A window with its own session; the particles arrive a moment later."""
    pack_loaded_kernels()
    load_runtime_of_kernels()
    poster = Poster()
    runner = ThreadRunner(poster.post)
    session = Session(runner)
    found = [Path(path) for path in paths]
    if not found:
        session.open_sample()  # is read while the window is built
    load_pyvista()
    window = MainWindow(session, preferences or Preferences.load(), views or best_kind())
    poster.setParent(window)
    if found:
        QTimer.singleShot(0, window, lambda: window.commands.open_paths(found, unit))
    _warm_up_later(session, runner)
    _give_back_at_rest(window)
    preparing = Preparing(window.pages, runner)
    window.wiring.hear("choices", lambda *_: preparing.put_off())
    return window


def set_aside_what_stays(window: MainWindow) -> None:
    """Let nobody look for garbage in what the window is made of, nor in a page some time after it is built.

    Python looks through all objects now and then, and nothing runs meanwhile: with all pages for 82 to 95 ms.
    Of what is there at these few moments only rings that are given up later will not be found.
    """
    timer = QTimer(window, singleShot=True, interval=ASIDE)

    def set_aside() -> None:
        gc.collect()  # only what has been made since the last time: what is garbage by now would stay
        gc.freeze()

    timer.timeout.connect(set_aside)
    window.pages.built.connect(lambda _key: timer.start())
    gc.freeze()


def _warm_up_later(session: Session, runner: ThreadRunner) -> None:
    """Compile, or load, what the other methods need, but not before the first polyhedron is there."""

    def begin() -> None:
        if session.results.coarsened is not None:
            session.events.coarsening.disconnect(begin)
            runner.submit(Job(warm_up, (1,)), lambda _event: None, "warm-up")

    session.events.coarsening.connect(begin)


def _give_back_at_rest(window: MainWindow) -> None:
    """Hand memory back when nothing has been computed for a while, also that of closed particles."""
    timer = QTimer(window, singleShot=True, interval=REST)
    timer.timeout.connect(window.pages.let_go)
    timer.timeout.connect(give_back)
    window.wiring.hear("tasks", lambda *_: timer.stop() if window.session.tasks else timer.start())


Hook = Callable[[type[BaseException], BaseException, TracebackType | None], Any]


def telling_hook(tell: Callable[[str, str], None]) -> Hook:
    """An excepthook that says one sentence and keeps the program alive."""

    def hook(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if issubclass(kind, KeyboardInterrupt):
            QApplication.quit()
            return
        details = "".join(traceback.format_exception(kind, error, trace))
        print(details, file=sys.stderr)  # noqa: T201
        if isinstance(error, RegolithError):
            tell(str(error), details)
        else:
            name = kind.__name__
            tell(tr("Something went wrong in the program ({name}); the work goes on.", name=name), details)

    return hook
