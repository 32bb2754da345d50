"""Are the intervals of a calibration honest, and what do its runs gain? docs/calibration.md.

    python -m benchmarks.calibration [CASES] [FIRST_SEED] [RESULT.json] [TABLES]

Surrogates of heaps with a known answer: random smooth curves of the angle of repose over one parameter, with
the noise of a heap of 1,000 particles. Runs are proposed one after the other, or equally spaced. Then three
datasets whose angles and bulk densities differ: which one was it, and at which value of the parameter? Then
CASES frictions in each part of the range, hidden as in benchmarks.blind_calibration, with the curve through
its heaps in place of heaps. TABLES (surrogates,datasets,frictions): all if omitted.
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest

from benchmarks.blind_calibration import HEAPS, HIGH, LOW, PARTS
from benchmarks.blind_calibration import N_RUNS as BLIND_RUNS
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.studies.calibration import (
    CONFIDENCE,
    CalibrationParameter,
    CalibrationRuns,
    WantedResult,
    calibrate,
    density_of,
)

NOISE, TARGET_ERROR = 1.7, 0.5
"""Degrees: standard deviation that heaps of 1,000 particles state, standard error of a mean of about 12."""
SCATTER = 2.2
"""Degrees: standard deviation of heaps of 1,000 particles that differ by their seed."""
N_RUNS = 12
DATASETS = ("a", "b", "c")
ANGLE_OFFSET, DENSITY_OFFSET = 2.0, 50.0
"""Standard deviations, in degrees and kg/m^3, of the datasets' angles and bulk densities about their mean."""
DENSITY, DENSITY_NOISE = 1600.0, 16.0
"""kg/m^3: mean of the datasets, and noise of a filling as well as standard error of the wanted density."""


@dataclass(frozen=True)
class SurrogateCase:
    """A calibration with a known answer: values of its runs, and its intervals, the first before any run."""

    truth: float
    values: tuple[float, ...]
    intervals: NDArray[np.float64]

    def covers(self, runs: int = N_RUNS) -> bool:
        """Whether the interval after so many runs holds the truth."""
        low, high = self.intervals[runs]
        return bool(low <= self.truth <= high)

    def shrinkage(self, runs: int = N_RUNS) -> float:
        """Width of the interval after so many runs over that of the prior."""
        low, high = self.intervals[runs]
        return float(high - low) / CONFIDENCE


def main(cases: int, seed: int, result: str, tables: Sequence[str]) -> None:
    """Print the rows of each table, and write them."""
    for name, table in (("surrogates", surrogates), ("datasets", datasets), ("frictions", frictions)):
        if name in tables:
            add_result(result, name, table(cases, seed), cases=cases, first_seed=seed)


def surrogates(cases: int, seed: int) -> Rows:
    """Coverage and width for each number of runs."""
    rows: Rows = {}
    found = [calibrate_surrogate(seed + k) for k in range(cases)]
    for n in range(0, N_RUNS + 1, 2):
        _show(rows, f"{n} runs", found, n)
    spaced = tuple((np.arange(N_RUNS) + 0.5) / N_RUNS)
    _show(rows, f"{N_RUNS} equally spaced", [calibrate_surrogate(seed + k, spaced) for k in range(cases)])
    _show(
        rows, f"{N_RUNS} that scatter", [calibrate_surrogate(seed + k, noise=SCATTER) for k in range(cases)]
    )
    return rows


def datasets(cases: int, seed: int) -> Rows:
    """The same with a choice of a dataset; probability of the right one, how often it is above a half."""
    rows: Rows = {}
    pairs = [calibrate_datasets(seed + k) for k in range(cases)]
    chances = np.array([chance for _, chance in pairs])
    numbers = [*_coverage([case for case, _ in pairs]), chances.mean(), (chances > 0.5).sum()]
    show_row(rows, f"{len(DATASETS)}, {N_RUNS} runs", numbers)
    return rows


def frictions(cases: int, seed: int) -> Rows:
    """By part of the range: calibrations, intervals that hold the friction, p-value of that, mean width."""
    rows: Rows = {}
    for number, (low, high) in enumerate(pairwise(PARTS)):
        ends = (low - LOW) / (HIGH - LOW), (high - LOW) / (HIGH - LOW)
        first = seed + 1000 * number
        found = [calibrate_surrogate(first + k, (), BLIND_RUNS, SCATTER, ends) for k in range(cases)]
        count = sum(case.covers(BLIND_RUNS) for case in found)
        width = float(np.mean([case.shrinkage(BLIND_RUNS) for case in found]))
        show_row(rows, f"{low} to {high}", [cases, count, binomtest(count, cases, CONFIDENCE).pvalue, width])
    return rows


def _show(rows: Rows, name: str, found: Sequence[SurrogateCase], runs: int = N_RUNS) -> None:
    show_row(rows, name, _coverage(found, runs))


def _coverage(found: Sequence[SurrogateCase], runs: int = N_RUNS) -> tuple[float, float, float]:
    """Percentage of intervals that hold the truth, and their width: mean and median."""
    widths = [case.shrinkage(runs) for case in found]
    covered = 100.0 * np.mean([case.covers(runs) for case in found])
    return float(covered), float(np.mean(widths)), float(np.median(widths))


def random_curve(rng: np.random.Generator) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """Degrees over 0 to 1: it rises by 8 to 25, more or less saturated, with ripples of up to a degree."""
    begin, rise, length = rng.uniform(8, 18), rng.uniform(8, 25), rng.uniform(0.2, 2.0)
    phase, height, frequency = rng.uniform(0, 2 * np.pi), rng.uniform(0, 1), rng.uniform(2, 6)

    def curve(x: NDArray[np.float64]) -> NDArray[np.float64]:
        saturated = (1 - np.exp(-x / length)) / (1 - np.exp(-1 / length))
        return np.asarray(begin + rise * saturated + height * np.sin(frequency * x + phase))

    return curve


def heap_curve(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Degrees over the range of friction as 0 to 1, through the heaps of benchmarks.blind_calibration.

    Their standard deviation about it is 1.8.
    """
    return np.asarray(3.6 + 29.9 * (1 - np.exp(-(LOW + (HIGH - LOW) * x) / 0.25)))


def calibrate_surrogate(
    seed: int,
    spaced: Sequence[float] = (),
    runs: int = N_RUNS,
    noise: float = NOISE,
    part: tuple[float, float] | None = None,
) -> SurrogateCase:
    """Each run states :data:`NOISE` as a heap does: from seven degrees of freedom.

    Parameters
    ----------
    spaced
        Values of the runs, where they are not proposed.
    noise
        Standard deviation of the runs.
    part
        Of the range, where the curve is that of friction and the wanted angle the mean of so many heaps.
    """
    rng = np.random.default_rng(seed)
    if part is None:
        curve, truth, error = random_curve(rng), rng.uniform(), TARGET_ERROR
    else:
        curve, truth, error = heap_curve, rng.uniform(*part), noise / HEAPS**0.5
    wanted = float(curve(np.array(truth)) + error * rng.normal())
    target = WantedResult("angle", wanted, error, scale=5.0, noise=NOISE)
    parameter = CalibrationParameter("x", 0.0, 1.0)
    made = np.empty((0, 3))
    intervals = []
    for k in range(runs + 1):
        found = calibrate([parameter], [target], CalibrationRuns.of(*made.T, 1, 1))
        intervals.append(found.intervals[0])
        if k < runs:
            x = spaced[k] if spaced else float(found.next_values[0])
            angle = curve(np.array(x)) + noise * rng.normal()
            made = np.vstack([made, [x, angle, NOISE * np.sqrt(rng.chisquare(7) / 7)]])
    return SurrogateCase(truth, tuple(made[:, 0].tolist()), np.array(intervals))


def calibrate_datasets(seed: int) -> tuple[SurrogateCase, float]:
    """One parameter and one of three datasets, from an angle and a bulk density; with the probability that
    is given to the right dataset."""
    rng = np.random.default_rng(seed)
    curve, x, number = random_curve(rng), rng.uniform(), int(rng.integers(len(DATASETS)))
    offsets = rng.normal(size=(len(DATASETS), 2)) * [ANGLE_OFFSET, DENSITY_OFFSET]

    def results(x: float, number: int) -> NDArray[np.float64]:
        return np.array([curve(np.array(x)), DENSITY]) + offsets[number]

    wanted = results(x, number) + rng.normal(size=2) * [TARGET_ERROR, DENSITY_NOISE]
    targets = [
        WantedResult("angle", wanted[0], TARGET_ERROR, scale=5.0, noise=NOISE),
        WantedResult("bulk_density", wanted[1], DENSITY_NOISE, 0.05 * wanted[1], 0.01 * wanted[1]),
    ]
    parameters = [CalibrationParameter("x", 0.0, 1.0), CalibrationParameter.of_choices("dataset", DATASETS)]
    values, made, errors, intervals = [], [], [], []
    for k in range(N_RUNS + 1):
        found = calibrate(parameters, targets, CalibrationRuns.of(values, made, errors, 2, 2))
        intervals.append(found.intervals[0])
        if k < N_RUNS:
            values.append(found.next_values)
            one, which = float(found.next_values[0]), int(found.next_values[1])
            made.append(results(one, which) + rng.normal(size=2) * [SCATTER, DENSITY_NOISE])
            errors.append([NOISE * np.sqrt(rng.chisquare(7) / 7), np.nan])
    chance = density_of(found, parameters[1], 1)[1][number] / len(DATASETS)
    return SurrogateCase(x, tuple(float(each[0]) for each in values), np.array(intervals)), float(chance)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("100", "0", "", "surrogates,datasets,frictions")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2], words[3].split(","))
