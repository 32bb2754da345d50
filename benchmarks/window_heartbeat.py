"""Whether the thread of the window answers: how long what comes from outside, as mouse and keys do, waits."""

import ctypes
import os
import signal
import time
from collections import Counter
from dataclasses import dataclass, field
from types import FrameType
from typing import Any

INTERVAL = 0.005
"""Seconds between two beats."""
DRAWS = "ImageView._render"
"""Where views draw; live views draw inside VTK's own widget and are not told apart."""
LATE = 0.050
"""Seconds after which somebody looks what the thread is doing, and again after :data:`LOOK`."""
LOOK = 0.010


@dataclass
class Gap:
    """The time for which a beat has waited.

    Parameters
    ----------
    began, seconds
        When it was due (of :func:`time.perf_counter`), and how long it waited.
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
    """Beats of a clock of the system that the main thread, the window's, hears when it answers; a context.

    Meanwhile an alarm looks what the thread does.

    They are heard as mouse and keys are, which come through a socket of the X server. A timer of the window
    may have to wait for others. The alarm is a signal: no other thread
    may hold frames, as a widget could lose its last reference there.
    """

    def __init__(self) -> None:
        self._seen: Counter[str] = Counter()
        self._drawing = self._since = 0.0
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
        if hasattr(signal, "setitimer"):
            signal.signal(signal.SIGALRM, self._look)
        self._begin()
        self.restart()
        return self

    def __exit__(self, *_error: object) -> None:
        from regolith_studio.ui.views.image_view import ImageView

        patched: Any = ImageView
        patched._render = self._render
        self._heard.setEnabled(False)
        os.close(self._clock)
        if hasattr(signal, "setitimer"):
            _set_alarm(0.0)
            signal.signal(signal.SIGALRM, signal.SIG_DFL)

    def restart(self) -> None:
        """Forget all gaps, and what has waited until now."""
        self._gaps, self._since, self._drawing = [], time.perf_counter(), 0.0
        self._seen.clear()

    def gaps(self, longer: float = 0.0) -> list[Gap]:
        """The gaps since the restart longer than so many seconds apart from drawing, longest first."""
        found = [gap for gap in self._gaps if gap.apart > longer]
        return sorted(found, key=lambda gap: -gap.apart)

    @property
    def longest(self) -> Gap:
        """The longest gap since the restart."""
        return max(self._gaps, key=lambda gap: gap.seconds, default=Gap(self._since, 0.0))

    def _begin(self) -> None:
        from PySide6.QtCore import QSocketNotifier

        self._clock, self._next = _clock(INTERVAL)
        self._heard = QSocketNotifier(self._clock, QSocketNotifier.Type.Read)
        self._heard.activated.connect(self._beat)

    def _beat(self) -> None:
        missed = int.from_bytes(os.read(self._clock, 8), "little")
        now, due = time.perf_counter(), self._next
        self._next += missed * INTERVAL
        began = max(due, self._since)
        self._gaps.append(Gap(began, max(0.0, now - began), self._drawing, Counter(self._seen)))
        self._seen.clear()
        self._drawing = 0.0
        _set_alarm(LATE)

    def _look(self, _number: int, frame: FrameType | None) -> None:
        self._seen[_place(frame)] += 1


def _clock(interval: float) -> tuple[int, float]:
    """A file of Linux that can be read after each interval, and when it can first (of its monotonic clock).

    What is read is the number of intervals that have passed since it was read last.
    """
    system: Any = ctypes.CDLL(None, use_errno=True)
    descriptor = int(system.timerfd_create(time.CLOCK_MONOTONIC, os.O_NONBLOCK))
    first = time.clock_gettime(time.CLOCK_MONOTONIC) + interval
    each, start = (divmod(round(1e9 * seconds), 1_000_000_000) for seconds in (interval, first))
    times = (ctypes.c_long * 4)(*each, *start)
    absolute = 1
    if descriptor < 0 or system.timerfd_settime(descriptor, absolute, times, None) < 0:
        raise OSError(ctypes.get_errno(), "there is no clock")
    return descriptor, first


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
