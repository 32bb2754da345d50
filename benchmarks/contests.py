"""The program and a plain program that do one thing in turns, as ratios, and their report."""

import gc
import json
import platform
import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot
from matplotlib.ticker import NullFormatter

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


def table(outcomes: Sequence[Outcome]) -> str:
    """One line a contest, for a terminal."""
    lines = [
        f"{'step':<17}{'what':<52}{'ours ms':>10}{'plain ms':>10}{'ratio':>9}"
        f"  {'80 % of rounds':<18}{'MiB':>6}"
    ]
    for each in outcomes:
        plain, ratio, spread = "", "", ""
        if each.ratio is not None and each.low is not None and each.high is not None:
            plain, ratio = f"{each.plain:.2f}", _ratio(each.ratio)
            spread = f"{_ratio(each.low)} to {_ratio(each.high)}"
        clock = " *" if each.clock == "wall" else ""
        lines.append(
            f"{each.step:<17}{each.title + clock:<52}{each.ours:>10.2f}{plain:>10}{ratio:>9}  {spread:<18}"
            f"{each.memory:>6.1f}"
        )
    lines.append(
        "* wall time; the others processor time of one thread. Ratios are plain / ours in the same round."
    )
    return "\n".join(lines)


def growth_table(growths: Sequence[Growth]) -> str:
    """One line a curve."""
    lines = [f"{'time of':<26}{'against':<26}{'exponent':>9}   milliseconds at each size"]
    for each in growths:
        points = ", ".join(f"{n:,}: {ms:.1f}" for n, ms in zip(each.sizes, each.milliseconds, strict=True))
        lines.append(f"{each.title:<26}{each.size:<26}{each.exponent:>9.2f}   {points}")
    return "\n".join(lines)


def document(outcomes: Sequence[Outcome], growths: Sequence[Growth], rounds: int) -> dict[str, Any]:
    """Everything, with the machine that it was measured on."""
    from regolith_studio.dataset.build import software_versions

    return {
        "format": "regolith-studio benchmarks",
        "version": 1,
        "machine": {
            "processor": platform.machine(),
            "system": platform.system(),
            "python": platform.python_version(),
        },
        "software": software_versions(),
        "rounds": rounds,
        "contests": [asdict(each) for each in outcomes],
        "growth": [asdict(each) | {"exponent": each.exponent} for each in growths],
    }


def write(
    folder: Path, outcomes: Sequence[Outcome], growths: Sequence[Growth], rounds: int
) -> tuple[Path, ...]:
    """Write ``benchmarks.json``, ``ratios`` and ``growth`` as PNG and SVG; returns the paths."""
    folder.mkdir(parents=True, exist_ok=True)
    text = folder / "benchmarks.json"
    text.write_text(json.dumps(document(outcomes, growths, rounds), indent=1) + "\n", encoding="utf-8")
    paths = [text]
    for name, figure in (("ratios", _ratios(outcomes)), ("growth", _growth(growths))):
        if figure is None:
            continue
        for suffix in (".png", ".svg"):
            paths.append(folder / f"{name}{suffix}")
            figure.savefig(paths[-1], dpi=150)
        pyplot.close(figure)
    return tuple(paths)


def _ratio(value: float) -> str:
    return f"{value:.1f}" if value < 99.95 else f"{value:,.0f}"


def _ratios(outcomes: Sequence[Outcome]) -> Any:
    rows = [each for each in outcomes if each.ratio is not None][::-1]
    if not rows:
        return None
    figure, axes = pyplot.subplots(figsize=(9, 0.32 * len(rows) + 1.2), layout="constrained")
    middle = np.array([each.ratio for each in rows], dtype=float)
    reach = np.abs(np.array([[each.low, each.high] for each in rows], dtype=float).T - middle)
    at = np.arange(len(rows))
    axes.barh(at, middle, color=["#4477aa" if value >= 1 else "#ee6677" for value in middle], height=0.7)
    axes.errorbar(middle, at, xerr=reach, fmt="none", ecolor="#222222", elinewidth=1, capsize=2)
    axes.set_xscale("log")
    axes.axvline(1.0, color="#222222", linewidth=1)
    axes.set_yticks(at, [f"{each.step}: {each.title}" for each in rows], fontsize=7)
    axes.set_xlabel("times faster than the plain program (bars: 80 % of the rounds)")
    return figure


def _growth(growths: Sequence[Growth]) -> Any:
    if not growths:
        return None
    kinds = list(dict.fromkeys(each.size for each in growths))
    figure, panels = pyplot.subplots(
        1, len(kinds), figsize=(3.4 * len(kinds), 3.4), layout="constrained", squeeze=False
    )
    for kind, axes in zip(kinds, panels[0], strict=True):
        for each in growths:
            if each.size == kind:
                label = f"{each.title}: {each.exponent:.2f}"
                axes.loglog(each.sizes, each.milliseconds, "o-", markersize=3, linewidth=1, label=label)
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel(kind)
        axes.set_ylabel("milliseconds")
        axes.legend(fontsize=7, title="exponents", title_fontsize=7)
    return figure
