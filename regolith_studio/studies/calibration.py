"""Calibration of contact parameters: from wanted results (an angle of repose, a bulk density) to parameters.

A Gaussian process for each result interpolates the runs, whose noise is part of it. The posterior density of
the parameters is uniform prior times the likelihood of the wanted results; the next run is where the weighted
variance of the prediction is expected to fall most (targeted integrated mean square error: Picheny et al.,
J. Mech. Des. 132 (2010) 071008).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import logsumexp
from scipy.stats import norm
from scipy.stats.qmc import Sobol

from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.geometry.arrays import FloatArray

N_POINTS = 1024
"""Quasi-random points that represent the range of the parameters."""
AMPLITUDES, LENGTHS, NOISES = (0.4, 1.0, 2.5), (0.25, 0.5, 1.0), (0.6, 1.0, 1.6)
"""Hyperparameters that are averaged over: amplitude in scales of the result, length in ranges of a parameter,
noise of a run relative to what the runs state."""
TREND_VARIANCE = 16.0
"""Of the constant and of the linear part of a result, in squares of its scale."""
# A whole range apart, a dataset without runs had a probability of 3 % beside one that fits; so it has 25 %.
CHOICE_DISTANCE = 0.1
"""Between choices in ranges of a parameter as the trend sees it: results differ by less from choice to choice
than from end to end of a range. For the smooth deviation their distance is a whole range."""
FAILED_DISTANCE = 0.1
"""From a run without a result, in ranges of a parameter, within which no further run is proposed."""
CONFIDENCE = 0.9
"""Of the intervals of the parameters."""


@dataclass(frozen=True)
class CalibrationParameter:
    """A parameter to be found.

    Parameters
    ----------
    name, low, high
        It lies between `low` and `high`.
    choices
        Names of the values 0, 1, ..., where it is no quantity but a choice, as of a dataset.

    Raises
    ------
    InputError
        If the range is empty.
    """

    name: str
    low: float
    high: float
    choices: tuple[str, ...] = ()

    @classmethod
    def of_choices(cls, name: str, choices: Sequence[str]) -> "CalibrationParameter":
        """One of several choices, all equally probable before the first run."""
        return cls(name, 0.0, len(choices) - 1.0, tuple(choices))

    def __post_init__(self) -> None:
        if not np.isfinite([self.low, self.high]).all() or not self.low < self.high:
            raise InputError(
                f"The range of {self.name} must go from a lower to a higher value, "
                f"got {self.low:g} to {self.high:g}."
            )


@dataclass(frozen=True)
class WantedResult:
    """A wanted result.

    Parameters
    ----------
    name, value
        What is wanted; the unit is that of the runs' results.
    error
        Standard error of `value`.
    scale
        Typical change of the result over the range of the parameters.
    noise
        Standard deviation of a single run, as long as no run states its own.

    Raises
    ------
    InputError
        If a number is out of its range.
    """

    name: str
    value: float
    error: float
    scale: float
    noise: float

    def __post_init__(self) -> None:
        if not np.isfinite(self.value):
            raise InputError(f"The wanted {self.name} must be a number, got {self.value:g}.")
        if not (np.isfinite(self.error) and self.error >= 0.0):
            raise InputError(f"The error of the {self.name} must not be negative, got {self.error:g}.")


@dataclass(frozen=True, eq=False)
class CalibrationRuns:
    """What the runs gave, NaN where a run has no such result.

    Parameters
    ----------
    values
        Of the parameters, shape (n, d).
    results, errors
        Results and their standard deviations, shape (n, k) for k targets.
    """

    values: FloatArray
    results: FloatArray
    errors: FloatArray

    @classmethod
    def of(
        cls, values: ArrayLike, results: ArrayLike, errors: ArrayLike, d: int, k: int
    ) -> "CalibrationRuns":
        """Runs of `d` parameters and `k` targets, perhaps none."""
        shapes = ((-1, d), (-1, k), (-1, k))
        arrays = (values, results, errors)
        return cls(*(np.asarray(a, dtype=np.float64).reshape(s) for a, s in zip(arrays, shapes, strict=True)))


@dataclass(frozen=True, eq=False)
class CalibrationPosterior:
    """What is known of the parameters.

    Parameters
    ----------
    points, weights
        Values of the parameters, shape (m, d), and their probabilities, shape (m,).
    best
        The point of the highest density within the intervals and of the most probable choices, shape (d,).
    intervals
        Of :data:`CONFIDENCE` for each parameter, shape (d, 2); all values of a choice.
    predicted, deviations
        Results and their standard deviations at all points without the noise of a run, shape (m, k).
    best_index
        Of `best` among the points.
    misfit
        Smallest distance between predicted and wanted results, in standard deviations: above 2 or so the
        target is out of reach.
    next_values
        Of the parameters for the next run, shape (d,).
    """

    points: FloatArray
    weights: FloatArray
    intervals: FloatArray
    predicted: FloatArray
    deviations: FloatArray
    best_index: int
    misfit: float
    next_values: FloatArray

    @property
    def best(self) -> FloatArray:
        return np.asarray(self.points[self.best_index])

    @property
    def effective_points(self) -> float:
        """Number of equally probable points with the same spread of weights: all before the first run."""
        return float(1.0 / (self.weights**2).sum())


def calibrate(
    parameters: Sequence[CalibrationParameter], targets: Sequence[WantedResult], runs: CalibrationRuns
) -> CalibrationPosterior:
    """Posterior of the parameters, given the runs so far, and the values of the next run.

    Raises
    ------
    MissingRequirement
        If scikit-learn is not installed.
    """
    points = _prior_points(parameters)
    (places, ranges), (trials, _) = (_coordinates(each, parameters) for each in (points, runs.values))
    log_likelihood, misfit, gains = np.zeros(len(points)), np.zeros(len(points)), []
    moments = []
    for k, target in enumerate(targets):
        # Results are taken as independent given the parameters: their likelihoods multiply.
        models = _fit(target, trials, ranges, runs.results[:, k], runs.errors[:, k])
        means, deviations = _predict(models, places, target)
        spread = np.hypot(deviations, target.error)
        density = norm.logpdf(target.value, means, spread)
        # Summed over the hyperparameters, not of the likeliest: with few runs several fit as well.
        log_likelihood += logsumexp(density, axis=0, b=models.weights[:, None])
        mean, deviation = _mixture(models.weights, means, deviations)
        misfit += ((mean - target.value) / np.hypot(deviation, target.error)) ** 2
        moments.append((mean, deviation))
        gains.append((models, target))
    weights = np.exp(log_likelihood - logsumexp(log_likelihood))
    failed = np.isnan(runs.results).any(axis=1)
    gain = sum(_variance_reduction(models, target, places, weights) for models, target in gains)
    intervals, inside = [], np.ones(len(points), dtype=bool)
    for column, parameter in zip(points.T, parameters, strict=True):
        low, high = ends = _interval(column, weights)
        if parameter.choices:
            ends = (parameter.low, parameter.high)
            # A choice has no order, so that an interval of its numbers would mean nothing.
            low = high = int(np.argmax(np.bincount(column.astype(int), weights)))
        intervals.append(ends)
        inside &= (column >= low) & (column <= high)
    return CalibrationPosterior(
        points=points,
        weights=weights,
        intervals=np.array(intervals),
        predicted=np.column_stack([mean for mean, _ in moments]),
        deviations=np.column_stack([deviation for _, deviation in moments]),
        best_index=int(np.argmax(np.where(inside, weights, -1.0))),
        misfit=float(np.sqrt(misfit.min())),
        next_values=points[
            # A run that failed would fail again beside its values, where the gain stays the largest.
            np.argmax(np.where(_near(places / ranges, trials[failed] / ranges), -np.inf, gain))
        ],
    )


def density_of(
    posterior: CalibrationPosterior, parameter: CalibrationParameter, index: int
) -> tuple[FloatArray, FloatArray]:
    """Places, shape (32,), and marginal posterior density of a parameter; 1 is that of the prior.

    Of a choice there is a place for each, whose density is its probability times their number.
    """
    beyond = 0.5 if parameter.choices else 0.0
    bins = len(parameter.choices) or 32
    height, edges = np.histogram(
        posterior.points[:, index],
        bins,
        (parameter.low - beyond, parameter.high + beyond),
        weights=posterior.weights * bins,
    )
    return (edges[1:] + edges[:-1]) / 2, height


def relative_width(posterior: CalibrationPosterior, parameter: CalibrationParameter, index: int) -> float:
    """Width of a parameter's interval over that of the prior; of a choice the effective share of choices."""
    if parameter.choices:
        chances = density_of(posterior, parameter, index)[1] / len(parameter.choices)
        return float(1.0 / (chances**2).sum() / len(parameter.choices))
    return float(np.ptp(posterior.intervals[index])) / (CONFIDENCE * (parameter.high - parameter.low))


@dataclass(frozen=True, eq=False)
class _Models:
    """Gaussian processes of one result, one for each set of hyperparameters, with their probabilities."""

    processes: tuple[Any, ...]
    weights: FloatArray
    noises: FloatArray
    """Standard deviation of a run, in scales of the result."""


def _fit(
    target: WantedResult, places: FloatArray, ranges: FloatArray, results: FloatArray, errors: FloatArray
) -> _Models:
    try:
        from sklearn.gaussian_process import GaussianProcessRegressor
        from sklearn.gaussian_process.kernels import RBF, ConstantKernel, DotProduct
    except ImportError:
        raise MissingRequirement(
            "The calibration needs scikit-learn, which is not installed: "
            "pip install regolith-studio[classifier]."
        ) from None

    there = np.isfinite(results)
    deviations = (results[there] - target.value) / target.scale
    stated = errors[there & np.isfinite(errors)]
    # What a single run states of its noise is noisy itself: the mean of all runs is taken.
    noise = float(np.sqrt(np.mean(stated**2))) if len(stated) else target.noise
    trend = ConstantKernel(TREND_VARIANCE) * DotProduct(1.0)
    processes, evidence, noises = [], [], []
    for amplitude, length, factor in product(AMPLITUDES, LENGTHS, NOISES):
        kernel = trend + ConstantKernel(amplitude**2) * RBF(length * ranges)
        noises.append(factor * noise / target.scale)
        process = GaussianProcessRegressor(kernel, alpha=noises[-1] ** 2, optimizer=None)
        if len(deviations):
            process.fit(places[there], deviations)
        processes.append(process)
        evidence.append(process.log_marginal_likelihood_value_ if len(deviations) else 0.0)
    weights = np.exp(np.array(evidence) - logsumexp(evidence))
    return _Models(tuple(processes), weights, np.array(noises))


def _predict(models: _Models, places: FloatArray, target: WantedResult) -> tuple[FloatArray, FloatArray]:
    """Means and standard deviations of each process in the unit of the result, shape (h, m)."""
    predictions = [process.predict(places, return_std=True) for process in models.processes]
    means = np.array([mean for mean, _ in predictions])
    return target.value + target.scale * means, target.scale * np.array([spread for _, spread in predictions])


def _mixture(weights: FloatArray, means: FloatArray, deviations: FloatArray) -> tuple[FloatArray, FloatArray]:
    mean = weights @ means
    return mean, np.sqrt(weights @ (deviations**2 + (means - mean) ** 2))


def _variance_reduction(
    models: _Models, target: WantedResult, places: FloatArray, weights: FloatArray
) -> FloatArray:
    """By a run at each point: of the variance of the prediction relative to the error of the comparison,
    weighted by the posterior; of the most probable process; shape (m,)."""
    chosen = int(np.argmax(models.weights))
    if not hasattr(models.processes[chosen], "X_train_"):
        chosen = len(models.processes) // 2
    _, covariance = models.processes[chosen].predict(places, return_cov=True)
    variance = np.diag(covariance)
    # 1e-12: a target without error and a process without variance at a run would divide by 0.
    relative = weights / (variance + (target.error / target.scale) ** 2 + 1e-12)
    return np.asarray(relative @ covariance**2 / (variance + models.noises[chosen] ** 2))


def _prior_points(parameters: Sequence[CalibrationParameter]) -> FloatArray:
    # Half a cell on: the first point of the sequence is the corner of the ranges.
    unit = Sobol(len(parameters), scramble=False).random(N_POINTS) + 0.5 / N_POINTS
    columns = []
    for u, parameter in zip(unit.T, parameters, strict=True):
        column = parameter.low + u * (parameter.high - parameter.low)
        if count := len(parameter.choices):
            column = np.minimum(np.floor(u * count), count - 1.0)
        columns.append(column)
    return np.column_stack(columns)


def _coordinates(
    values: FloatArray, parameters: Sequence[CalibrationParameter]
) -> tuple[FloatArray, FloatArray]:
    """Of the Gaussian process, shape (m, c), and the distance along each that counts as a range, shape (c,).

    Quantities have one from -.5 to .5. Choices are the corners of a regular simplex of edge
    :data:`CHOICE_DISTANCE`, since none is closer to one than to another.
    """
    columns, ranges = [], []
    for column, parameter in zip(values.T, parameters, strict=True):
        if count := len(parameter.choices):
            corners = CHOICE_DISTANCE * (np.eye(count) - 1 / count) / np.sqrt(2)
            columns.append(corners[column.astype(int)])
            ranges += [CHOICE_DISTANCE] * count
        else:
            columns.append(((column - parameter.low) / (parameter.high - parameter.low) - 0.5)[:, None])
            ranges.append(1.0)
    return np.hstack(columns), np.array(ranges)


def _near(places: FloatArray, failed: FloatArray) -> FloatArray:
    """Whether each point is close to a run without a result, shape (m,)."""
    apart = np.linalg.norm(places[:, None] - failed[None], axis=2)
    return np.asarray((apart < FAILED_DISTANCE).any(axis=1))


def _interval(values: FloatArray, weights: FloatArray) -> tuple[float, float]:
    """The shortest interval that holds the probability; the middle one of equally short ones."""
    # Not equal tails: a second small maximum of the density made those twice as wide.
    order = np.argsort(values, kind="stable")
    ordered, total = values[order], np.cumsum(weights[order])
    first = np.flatnonzero(total <= 1.0 - CONFIDENCE + weights[order])
    before = total[first] - weights[order][first]
    last = np.minimum(np.searchsorted(total, before + CONFIDENCE), len(values) - 1)
    width = ordered[last] - ordered[first]
    shortest = np.flatnonzero(width <= 1.001 * width.min())
    chosen = shortest[len(shortest) // 2]
    return float(ordered[first[chosen]]), float(ordered[last[chosen]])
