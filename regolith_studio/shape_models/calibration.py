"""Calibration of the hull field: which features to ask for so that drawn particles have those of the sample.

Moving a surface towards its hull and cutting it at l_max shift the features of
:mod:`~regolith_studio.shape_models.shape_features`, so that others have to be asked for. The powers from the
third degree on are shifted together until the mean sphericity is the sample's; between them, and in their
deviations, they follow the sample's powers. Those of the first two degrees belong to the star point and the
ellipsoid and stay as they are, as does the form, which is set exactly.

Gaussian copula: a joint distribution of d numbers from their quantiles and correlations.

Sklar (1959): a joint distribution is its marginal distributions and a copula. The marginals are tables of
quantiles with linear interpolation; the copula is that of a normal law with the correlations of the sample's
normal scores. Realizations are conditional on the first number, which is given.

Degrees above those of a hull field: power by a particle's features, with random phases.

Size, form, roughness and hull ratio of a particle tell most of the power of its higher degrees: ln P_l is
linear in the features, and what is left is a normal law over the degrees, correlated.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, locked_floats
from regolith_studio.shape_models.shape_features import (
    CONVEXITY,
    MIN_POWER,
    POWERS,
    SPHERICITY,
    log_shape_features,
    outer_features_of_log_radii,
    outer_features_of_radii,
    powers,
    shape_features,
    with_powers,
)

RIDGE = 0.1
"""Of the regression, as a share of the number of particles, on standardised features."""


@dataclass(frozen=True, eq=False)
class FineDegrees:
    """ln P_l of the degrees above the hull field's: offset + slopes features + factor normal numbers.

    - ``offset``: shape (m,), one for each degree.
    - ``slopes``: shape (m, d).
    - ``factor``: lower triangular, of the covariance that is left, shape (m, m).

    Raises InputError if a number is not finite.
    """

    offset: FloatArray
    slopes: FloatArray
    factor: FloatArray

    def __post_init__(self) -> None:
        m = len(self.offset)
        for name, shape in (("offset", (m,)), ("slopes", (m, None)), ("factor", (m, m))):
            values = locked_floats(getattr(self, name), shape, name)
            if not np.isfinite(values).all():
                raise InputError(f"The {name} of the fine degrees must be finite.")
            object.__setattr__(self, name, values)

    def __reduce__(self) -> tuple[Callable[..., "FineDegrees"], tuple[Any, ...]]:
        return FineDegrees, (self.offset, self.slopes, self.factor)

    def __len__(self) -> int:
        return len(self.offset)

    @classmethod
    def of(cls, rows: FloatArray, equivalent_radii: FloatArray, base: int) -> "FineDegrees":
        """From expansions of ln r of measured particles, shape (n, (l_max + 1)^2), above degree `base`."""
        table = log_shape_features(rows[:, : (base + 1) ** 2], equivalent_radii)
        fine = np.log(np.maximum(powers(rows)[:, base + 1 :], MIN_POWER))
        # Of a feature that all particles share the deviation is 0.
        middle, spread = table.mean(axis=0), np.maximum(table.std(axis=0), 1e-9)
        standard = (table - middle) / spread
        normal = standard.T @ standard + RIDGE * len(table) * np.eye(table.shape[1])
        slopes = np.linalg.solve(normal, standard.T @ (fine - fine.mean(axis=0))).T / spread
        left = fine - table @ slopes.T
        # np.cov makes a number of a single degree, and a singular matrix of fewer particles than degrees,
        # which has no Cholesky factor.
        covariance = np.cov(left.T).reshape(2 * [fine.shape[1]]) + 1e-9 * np.eye(fine.shape[1])
        return cls(left.mean(axis=0), slopes, np.asarray(np.linalg.cholesky(covariance), dtype=np.float64))

    def first(self, count: int) -> "FineDegrees":
        """The lowest `count` of the degrees, at least one."""
        return FineDegrees(self.offset[:count], self.slopes[:count], self.factor[:count, :count])

    def scaled(self, change: float) -> "FineDegrees":
        """The same with ln P_l larger by `change` at all degrees."""
        return replace(self, offset=np.asarray(self.offset) + change)

    def added(self, rows: FloatArray, equivalent_radii: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Expansions of ln r of the lower degrees (n, k) with the higher ones."""
        n, base = len(rows), round(rows.shape[1] ** 0.5) - 1
        normal = rng.standard_normal((n, len(self)))
        wanted = log_shape_features(rows, equivalent_radii) @ self.slopes.T + normal @ self.factor.T
        field = rng.standard_normal((n, (base + len(self) + 1) ** 2))
        field[:, : rows.shape[1]] = rows
        power = np.hstack([powers(rows), np.exp(wanted + self.offset)])
        return with_powers(field, power)

    def stored(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {name: getattr(self, name).tolist() for name in self.__dataclass_fields__}

    @classmethod
    def restored(cls, values: Mapping[str, Any]) -> "FineDegrees":
        """From its stored values."""
        return cls(*(np.array(values[name], dtype=np.float64) for name in cls.__dataclass_fields__))


N_QUANTILES = 65
REACH = 3.2
"""Normal score of the outermost quantile in the tables."""


@dataclass(frozen=True, eq=False)
class GaussianCopula:
    """The joint distribution of d numbers.

    ``quantiles``: of each number at even normal scores from -3.2 to 3.2, ascending, shape (q, d).
    ``correlations``: of the normal scores, positive definite, shape (d, d).

    Raises InputError if the numbers do not define a distribution.
    """

    quantiles: FloatArray
    correlations: FloatArray

    def __post_init__(self) -> None:
        quantiles = locked_floats(self.quantiles, (None, None), "quantiles")
        shape = (quantiles.shape[1], quantiles.shape[1])
        correlations = locked_floats(self.correlations, shape, "correlations")
        if len(quantiles) < 2 or not np.isfinite(quantiles).all() or (np.diff(quantiles, axis=0) < 0).any():
            raise InputError("Quantiles must be finite and ascend.")
        if not (np.isfinite(correlations).all() and np.linalg.eigvalsh(correlations).min() > 0):
            raise InputError("Correlations must be a positive definite matrix.")
        object.__setattr__(self, "quantiles", quantiles)
        object.__setattr__(self, "correlations", correlations)

    def __reduce__(self) -> tuple[Callable[..., "GaussianCopula"], tuple[Any, ...]]:
        return GaussianCopula, (self.quantiles, self.correlations)

    @classmethod
    def of(cls, table: FloatArray) -> "GaussianCopula":
        """Fit to a table (n, d), n >= 2.

        Correlations are shrunk towards zero by d / (n + d), so that few particles are enough.
        """
        n, d = table.shape
        ranks = np.argsort(np.argsort(table, axis=0, kind="stable"), axis=0, kind="stable")
        scores = ndtri((ranks + 0.5) / n)
        # All columns hold the same n scores in other orders, so that one sum of squares divides them all.
        correlations = np.clip(scores.T @ scores / (scores[:, 0] @ scores[:, 0]), -1.0, 1.0)
        shrunk = (n * correlations + d * np.eye(d)) / (n + d)
        return cls(np.quantile(table, ndtr(_places(N_QUANTILES)), axis=0), shrunk)

    def draw(self, first: FloatArray, rng: np.random.Generator) -> FloatArray:
        """A row of numbers for each given first one, shape (n, d).

        First numbers beyond the table are treated as its outermost ones.
        """
        places = _places(len(self.quantiles))
        normal = rng.standard_normal((len(first), len(self.correlations)))
        # Equal sizes have equal quantiles, and np.interp needs places that ascend.
        normal[:, 0] = np.interp(first, _rising(self.quantiles[:, 0]), places)
        scores = normal @ self._factor.T
        columns = [np.interp(scores[:, j], places, self.quantiles[:, j]) for j in range(1, scores.shape[1])]
        return np.column_stack([first, *columns])

    @cached_property
    def _factor(self) -> FloatArray:
        scale = np.sqrt(np.diag(self.correlations))
        return np.asarray(np.linalg.cholesky(self.correlations / np.outer(scale, scale)))

    def stored(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {"quantiles": self.quantiles.tolist(), "correlations": self.correlations.tolist()}


def _places(count: int) -> FloatArray:
    return np.linspace(-REACH, REACH, count)


def _rising(values: FloatArray) -> FloatArray:
    """The values, made strictly ascending by negligible steps."""
    step = 1e-12 * max(float(np.abs(values).max()), 1.0)
    return values + step * np.arange(len(values))


RATE = 0.8
"""Share of a difference that is corrected in each round."""
SPHERICITY_RATE = 3.0
"""Change of ln P_l for a difference in ln(s / (1 - s)) of the sphericity."""
MAX_SHIFT = 2.0
SPREADS = (0.5, 2.0)
_ROUGHNESS = slice(POWERS.start + 2, POWERS.stop)
_QUANTILES = np.linspace(0.01, 0.99, 50)


@dataclass(frozen=True, eq=False)
class CalibrationOffset:
    """Features to ask for instead of drawn ones: median + shift + spread (drawn - median).

    ``shift``, ``spread``: shape (d,).
    """

    shift: FloatArray
    spread: FloatArray


@dataclass(frozen=True, eq=False)
class CalibrationTarget:
    """Features that drawn particles should have.

    ``mean``, ``deviation``: of the features, shape (d,). ``outer``: outer features of the measured
    particles, shape (n, 3).
    """

    mean: FloatArray
    deviation: FloatArray
    outer: FloatArray

    @classmethod
    def of(cls, coefficients: FloatArray, numbers: FloatArray) -> "CalibrationTarget":
        """From measured particles: radius functions (n, (l_max + 1)^2) and their features (n, d)."""
        return cls(
            numbers.mean(axis=0),
            numbers.std(axis=0),
            outer_features_of_radii(coefficients, numbers[:, CONVEXITY]),
        )

    def distance(self, outer: FloatArray) -> float:
        """Mean difference of quantiles over the standard deviation, summed over the outer features."""
        wanted, quantiles = (np.quantile(table, _QUANTILES, axis=0) for table in (self.outer, outer))
        return float((np.abs(quantiles - wanted).mean(axis=0) / (self.outer.std(axis=0) + 1e-9)).sum())

    def corrected(
        self, offset: CalibrationOffset, numbers: FloatArray, outer: FloatArray
    ) -> CalibrationOffset:
        """The next offset, where the last one gave features (m, d) and outer features (m, 3)."""
        shift = RATE * (self.mean - numbers.mean(axis=0))
        too_round = outer[:, SPHERICITY].mean() - self.outer[:, SPHERICITY].mean()
        # Between the degrees the shift follows the powers of the sample, in its mean the sphericity instead.
        shift[_ROUGHNESS] += SPHERICITY_RATE * too_round - shift[_ROUGHNESS].mean()
        ratio = ((self.deviation + 1e-9) / (numbers.std(axis=0) + 1e-9)) ** RATE
        shift[: _ROUGHNESS.start], ratio[: _ROUGHNESS.start], ratio[CONVEXITY] = 0.0, 1.0, 1.0
        return CalibrationOffset(
            np.clip(offset.shift + shift, -MAX_SHIFT, MAX_SHIFT), np.clip(offset.spread * ratio, *SPREADS)
        )


def measured_features(rows: FloatArray, equivalent_radii: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Features (m, d) and outer features (m, 3) of drawn particles: expansions of ln r with these sizes."""
    numbers = log_shape_features(rows, equivalent_radii)
    return numbers, outer_features_of_log_radii(rows, numbers[:, CONVEXITY])


def features_and_target(coefficients: FloatArray) -> tuple[FloatArray, CalibrationTarget]:
    """The features (n, d) of measured particles, and the calibration target that they define."""
    numbers = shape_features(coefficients)
    return numbers, CalibrationTarget.of(coefficients, numbers)
