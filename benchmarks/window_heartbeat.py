"""Whether the thread of the window answers: a timer that should fire every five milliseconds."""

import signal
import time
from collections import Counter
from dataclasses import dataclass, field
from types import FrameType
from typing import Any

INTERVAL = 5
"""Milliseconds between two beats."""
DRAWS = "ImageView._render"
"""Where views draw; live views draw inside VTK's own widget and are not told apart."""
LATE = 0.050
"""Seconds after which somebody looks what the thread is doing, and again after :data:`LOOK`."""
LOOK = 0.010


@dataclass
class Gap:
    """A time without a beat.

    Parameters
    ----------
    began, seconds
        When (of :func:`time.perf_counter`), and how long.
    drawing
        How much of that views have drawn.
    places
        Functions of the program that the thread was seen in meanwhile, innermost first, and how often.
    """

    began: float
    seconds: float
    drawing: float = 0.0
    places: Counter[str] = field(default_factory=Counter)

    def __str__(self) -> str:
        where = next((place for place, _ in self.places.most_common() if DRAWS not in place), "")
        return f"{1e3 * self.apart:4.0f} ms (and {1e3 * self.drawing:.0f} ms of drawing)  {where}"

    @property
    def apart(self) -> float:
        """Seconds apart from drawing."""
        return self.seconds - self.drawing


class Heartbeat:
    """Beats in the main thread, that of the window, while an alarm looks whether it does; a context.

    The alarm is a signal: no other thread may hold frames, as a widget could lose its last reference there.
    Where there are no such signals the gaps have no places.
    """

    def __init__(self) -> None:
        from PySide6.QtCore import Qt, QTimer

        self._timer = QTimer(interval=INTERVAL, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._beat)
        self._last = time.perf_counter()
        self._seen: Counter[str] = Counter()
        self._drawing = 0.0
        self._gaps: list[Gap] = []

    def __enter__(self) -> "Heartbeat":
        from regolith_studio.ui.views.image_view import ImageView

        self._render: Any = ImageView._render

        def timed(view: ImageView) -> None:
            began = time.perf_counter()
            self._render(view)
            self._drawing += time.perf_counter() - began

        patched: Any = ImageView
        patched._render = timed
        self._timer.start()
        if hasattr(signal, "setitimer"):
            signal.signal(signal.SIGALRM, self._look)
        self.restart()
        return self

    def __exit__(self, *_error: object) -> None:
        from regolith_studio.ui.views.image_view import ImageView

        patched: Any = ImageView
        patched._render = self._render
        self._timer.stop()
        if hasattr(signal, "setitimer"):
            _set_alarm(0.0)
            signal.signal(signal.SIGALRM, signal.SIG_DFL)

    def restart(self) -> None:
        """Forget all gaps; a new one begins now."""
        self._gaps, self._last, self._drawing = [], time.perf_counter(), 0.0
        self._seen.clear()

    def gaps(self, longer: float = 0.0) -> list[Gap]:
        """The gaps since the restart longer than so many seconds apart from drawing, longest first."""
        found = [gap for gap in self._gaps if gap.apart > longer]
        return sorted(found, key=lambda gap: -gap.apart)

    @property
    def longest(self) -> Gap:
        """The longest gap since the restart."""
        return max(self._gaps, key=lambda gap: gap.seconds, default=Gap(self._last, 0.0))

    def _beat(self) -> None:
        now = time.perf_counter()
        self._gaps.append(Gap(self._last, now - self._last, self._drawing, Counter(self._seen)))
        self._seen.clear()
        self._last, self._drawing = now, 0.0

        _set_alarm(LATE)

    def _look(self, _number: int, frame: FrameType | None) -> None:
        self._seen[_place(frame)] += 1


def _set_alarm(seconds: float) -> None:
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, seconds, LOOK)


def _place(frame: FrameType | None) -> str:
    """The innermost three functions of the package on a stack, innermost first."""
    names: list[str] = []
    while frame is not None and len(names) < 3:
        code: Any = frame.f_code
        _, inside, path = code.co_filename.rpartition("regolith_studio/")
        if inside:
            names.append(f"{path.removesuffix('.py')}:{code.co_qualname}")
        frame = frame.f_back
    return " < ".join(names)
