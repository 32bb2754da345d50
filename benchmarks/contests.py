"""Two ways to do one thing, side by side: the program and a plain program, in turns, as ratios."""

import gc
import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

Work = Callable[[], object]


@dataclass(frozen=True)
class Contest:
    """One thing that is done.

    Parameters
    ----------
    step
        Which of the heavy steps it belongs to.
    title
        What is done, with its size.
    ours, plain
        The program, and the straightforward program; the latter may be missing.
    by
        What the plain one is made of.
    whole
        Whether wall time counts, because disks or other processes have a part in it; else processor time
        of one thread, which a busy machine disturbs less.
    """

    step: str
    title: str
    ours: Work
    plain: Work | None = None
    by: str = ""
    whole: bool = False


@dataclass(frozen=True)
class Outcome:
    """What was measured; times in milliseconds, ratios plain / ours of each round.

    Parameters
    ----------
    low, high
        Between them lie the middle 80 % of the ratios.
    memory, plain_memory
        Peak of what Python and numpy allocated during one call, MiB.
    """

    step: str
    title: str
    by: str
    clock: str
    ours: float
    plain: float | None
    ratio: float | None
    low: float | None
    high: float | None
    memory: float
    plain_memory: float | None


def held(contest: Contest, rounds: int) -> Outcome:
    """Let both do it once to warm up, then `rounds` times in turns."""
    sides = [side for side in (contest.ours, contest.plain) if side is not None]
    memory = [_peak(side) for side in sides]
    clock = time.perf_counter if contest.whole else time.process_time
    times = 1e3 * np.array([[_seconds(side, clock) for side in sides] for _ in range(rounds)])
    ours, *plain = np.median(times, axis=0).tolist()
    low = middle = high = None
    if plain:
        ratios = times[:, 1] / np.maximum(times[:, 0], 1e-4)
        low, middle, high = np.quantile(ratios, [0.1, 0.5, 0.9]).tolist()
    return Outcome(
        contest.step,
        contest.title,
        contest.by,
        "wall" if contest.whole else "processor",
        ours,
        plain[0] if plain else None,
        middle,
        low,
        high,
        memory[0],
        memory[1] if plain else None,
    )


@dataclass(frozen=True)
class Growth:
    """How long something takes for several sizes.

    Parameters
    ----------
    title, size
        What is done, and what `sizes` count.
    milliseconds
        Least of several processor times at each size.
    """

    title: str
    size: str
    sizes: tuple[int, ...]
    milliseconds: tuple[float, ...]

    @property
    def exponent(self) -> float:
        """Slope of the straight line through the logarithms: time grows as size to this power."""
        return float(np.polyfit(np.log(self.sizes), np.log(self.milliseconds), 1)[0])


def grown(title: str, size: str, sizes: Sequence[int], work: Callable[[int], Work], rounds: int) -> Growth:
    """Measure the work for each of the sizes."""
    jobs = [work(each) for each in sizes]
    for job in jobs:
        job()
    times = np.array([[_seconds(job, time.process_time) for job in jobs] for _ in range(rounds)])
    return Growth(title, size, tuple(sizes), tuple((1e3 * times.min(axis=0)).tolist()))


def _seconds(work: Work, clock: Callable[[], float]) -> float:
    """Seconds of a call; short ones are repeated until there is something to measure."""
    begun, count = clock(), 0
    while count == 0 or clock() - begun < 0.02:
        work()
        count += 1
    return (clock() - begun) / count


def _peak(work: Work) -> float:
    work()
    gc.collect()
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1] / 2**20
    finally:
        tracemalloc.stop()
