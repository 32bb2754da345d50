"""Events of a job: small frozen records, the same for the window, the command line and the tests.

A job is a generator function with picklable arguments. It yields :class:`Started`,
:class:`Progress` and :class:`Partial`, and returns its result. The runner reports how it ended with exactly
one :class:`Finished`, :class:`Failed` or :class:`Stopped`, which always comes last.
"""

import time
from collections import deque
from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from regolith_studio.steps import as_events

_Result = TypeVar("_Result")


@dataclass(frozen=True)
class Started:
    """The job has begun; `total` is its number of steps, 0 where that is not known."""

    title: str
    total: int = 0


@dataclass(frozen=True)
class Progress:
    """`done` of `total` steps are done; the message names the last one."""

    done: int
    total: int
    message: str = ""


@dataclass(frozen=True)
class Partial:
    """An intermediate result, such as the best polyhedron so far; a runner may leave out all but the last."""

    value: Any


@dataclass(frozen=True)
class Finished:
    """The job returned `value`."""

    value: Any


@dataclass(frozen=True)
class Failed:
    """The job raised: a message for the user, and the traceback."""

    sentence: str
    details: str = ""


@dataclass(frozen=True)
class Stopped:
    """The job was cancelled, or replaced by a newer one of its queue; `reason` if not by the user."""

    reason: str = ""


Step = Started | Progress | Partial
JobResult = Finished | Failed | Stopped
Event = Step | JobResult
Listener = Callable[[Event], None]
Steps = Generator[Step, None, Any]


@dataclass(frozen=True)
class Job:
    """A generator function with the arguments that it will be called with.

    ``function``: module-level generator function; yields :data:`Step`, returns the result. ``arguments``,
    ``options``: positional and keyword arguments; picklable, so that any runner can take the job.
    """

    function: Callable[..., Steps]
    arguments: tuple[Any, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)

    def steps(self) -> Steps:
        """A fresh run of the job."""
        return self.function(*self.arguments, **self.options)


def as_progress(steps: Generator[tuple[int, int], None, _Result]) -> Generator[Step, None, _Result]:
    """Do steps that yield how many of how many are done."""
    return as_events(steps, lambda count: (Progress(*count),))


_SPAN = 60.0
"""Seconds over which the rate is averaged: long enough to be steady, short enough to follow changes."""


class ProgressRate:
    """Counts items that are done and estimates their rate.

    - ``total``: items in all.
    - ``done``: items that were done in an earlier run; they do not count for the rate.
    - ``clock``: seconds; any start.
    """

    def __init__(self, total: int, done: int = 0, clock: Callable[[], float] = time.monotonic) -> None:
        self.total, self.done, self.failed = total, done, 0
        self._clock = clock
        self._seen: deque[tuple[float, int]] = deque([(clock(), done)])

    def advance(self, count: int, failed: int = 0) -> None:
        """So many more items are done; `failed` of them have failed."""
        self.done += count
        self.failed += failed
        now = self._clock()
        self._seen.append((now, self.done))
        while len(self._seen) > 2 and self._seen[1][0] < now - _SPAN:
            self._seen.popleft()

    @property
    def rate(self) -> float:
        """Items a second over the last minute; 0 before the first item."""
        (begun, before), (now, after) = self._seen[0], self._seen[-1]
        return (after - before) / (now - begun) if now > begun else 0.0

    @property
    def seconds_left(self) -> float | None:
        """Until everything is done, at the present rate."""
        return (self.total - self.done) / self.rate if self.rate > 0 else None

    def __str__(self) -> str:
        parts = []
        if self.rate > 0:
            parts.append(f"{self.rate:.3g} a second" if self.rate >= 1 else f"{1 / self.rate:.3g} s each")
        if (left := self.seconds_left) is not None and self.done < self.total:
            parts.append(f"{format_duration(left)} left")
        if self.failed:
            parts.append(f"{self.failed:,} failed")
        return ", ".join(parts)


def format_duration(seconds: float) -> str:
    """Seconds as text: 8 s, 3 min 20 s, 2 h 5 min."""
    whole = round(seconds)
    if whole < 100:
        return f"{whole} s"
    minutes, rest = divmod(whole, 60)
    if minutes < 100:
        return f"{minutes} min {rest} s" if minutes < 10 else f"{minutes} min"
    return f"{minutes // 60} h {minutes % 60} min"
