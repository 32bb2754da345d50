"""Gaussian copula: a joint distribution of d numbers from their quantiles and correlations.

Sklar (1959): a joint distribution is its marginal distributions and a copula. The marginals are tables of
quantiles with linear interpolation; the copula is that of a normal law with the correlations of the sample's
normal scores. Realizations are conditional on the first number, which is given.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, locked_floats

N_QUANTILES = 65
REACH = 3.2
"""Normal score of the outermost quantile in the tables."""


@dataclass(frozen=True, eq=False)
class GaussianCopula:
    """The joint distribution of d numbers.

    Parameters
    ----------
    quantiles
        Of each number at even normal scores from -3.2 to 3.2, ascending, shape (q, d).
    correlations
        Of the normal scores, positive definite, shape (d, d).

    Raises
    ------
    InputError
        If the numbers do not define a distribution.
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
        correlations = np.clip(scores.T @ scores / (scores[:, 0] @ scores[:, 0]), -1.0, 1.0)
        shrunk = (n * correlations + d * np.eye(d)) / (n + d)
        return cls(np.quantile(table, ndtr(_places(N_QUANTILES)), axis=0), shrunk)

    def draw(self, first: FloatArray, rng: np.random.Generator) -> FloatArray:
        """A row of numbers for each given first one, shape (n, d).

        First numbers beyond the table are treated as its outermost ones.
        """
        places = _places(len(self.quantiles))
        normal = rng.standard_normal((len(first), len(self.correlations)))
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
