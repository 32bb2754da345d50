"""Rate of a batch and its remaining time, as text."""

import time
from collections import deque
from collections.abc import Callable

_SPAN = 60.0
"""Seconds over which the rate is averaged: long enough to be steady, short enough to follow changes."""


class ProgressRate:
    """Counts items that are done and estimates their rate.

    Parameters
    ----------
    total
        Items in all.
    done
        Items that were done in an earlier run; they do not count for the rate.
    clock
        Seconds; any start.
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
