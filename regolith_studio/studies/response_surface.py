"""Response surface: a polynomial of one or more factors through scattered results, with intervals.

Least squares (Box and Wilson, *J. R. Stat. Soc. B* 13 (1951) 1): linear, or with all squares and products
where there are twice as many different points as terms.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np
from scipy.stats import t as student_t

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray

CONFIDENCE = 0.95
INDEPENDENT = 0.02
"""Smallest singular value of the terms of a surface, for factors of range 1."""


@dataclass(frozen=True, eq=False)
class ResponseSurface:
    """A fitted polynomial in factors that are centred and divided by their ranges.

    Parameters
    ----------
    factors
        Names.
    centre, width
        Mean and range of each factor, shape (k,).
    powers
        Indices of the factors that each term multiplies; none for the constant.
    coefficients, covariance
        Of the terms, shapes (p,) and (p, p).
    degrees_of_freedom
        Results less terms.
    residual_deviation
        Standard deviation of the results about the surface.
    """

    factors: tuple[str, ...]
    centre: FloatArray
    width: FloatArray
    powers: tuple[tuple[int, ...], ...]
    coefficients: FloatArray
    covariance: FloatArray
    degrees_of_freedom: int
    residual_deviation: float

    @property
    def is_quadratic(self) -> bool:
        return max(map(len, self.powers)) > 1

    def predict(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean results at `values`, shape (m, k), and half widths of their intervals of 95 %, shape (m,)."""
        terms = _terms((values - self.centre) / self.width, self.powers)
        variance = np.einsum("ij,jk,ik->i", terms, self.covariance, terms)
        return terms @ self.coefficients, self._quantile * np.sqrt(variance)

    def effects(self) -> tuple[FloatArray, FloatArray]:
        """Change of the result over the range of each factor at the centre, and half widths, shape (k,)."""
        own = [self.powers.index((k,)) for k in range(len(self.factors))]
        return self.coefficients[own], self._quantile * np.sqrt(np.diag(self.covariance)[own])

    @property
    def _quantile(self) -> float:
        return float(student_t.ppf((1.0 + CONFIDENCE) / 2, self.degrees_of_freedom))


def fit_response_surface(factors: Sequence[str], values: FloatArray, results: FloatArray) -> ResponseSurface:
    """Fit a surface.

    Parameters
    ----------
    values, results
        Of the factors, shape (n, k), and what they gave, shape (n,).

    Raises
    ------
    InputError
        If there are too few different points, or the factors do not vary independently of each other.
    """
    n_points, n_linear = len(np.unique(values, axis=0)), len(factors) + 1
    if n_points <= n_linear:
        raise InputError(
            f"A response surface of {', '.join(factors)} needs results at {n_linear + 1} different points "
            f"or more, got {n_points}."
        )
    centre, width = values.mean(axis=0), np.ptp(values, axis=0)
    scaled = (values - centre) / np.where(width > 0.0, width, 1.0)
    linear: list[tuple[int, ...]] = [(), *((k,) for k in range(len(factors)))]
    quadratic = [*linear, *combinations_with_replacement(range(len(factors)), 2)]
    powers = quadratic if n_points >= 2 * len(quadratic) and _independent(scaled, quadratic) else linear
    if not _independent(scaled, powers):
        raise InputError(f"{', '.join(factors)} do not vary independently of each other; leave one out.")
    terms = _terms(scaled, powers)
    coefficients = np.asarray(np.linalg.lstsq(terms, results, rcond=None)[0], dtype=np.float64)
    freedom = len(results) - len(powers)
    variance = float(((results - terms @ coefficients) ** 2).sum() / freedom)
    covariance = np.asarray(variance * np.linalg.inv(terms.T @ terms), dtype=np.float64)
    return ResponseSurface(
        tuple(factors), centre, width, tuple(powers), coefficients, covariance, freedom, variance**0.5
    )


def _independent(scaled: FloatArray, powers: Sequence[tuple[int, ...]]) -> bool:
    return bool(np.linalg.matrix_rank(_terms(scaled, powers), tol=INDEPENDENT) == len(powers))


def _terms(scaled: FloatArray, powers: Sequence[tuple[int, ...]]) -> FloatArray:
    """Products of the factors, shape (n, p)."""
    return np.column_stack([scaled[:, list(each)].prod(axis=1) for each in powers])
