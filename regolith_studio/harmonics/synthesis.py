"""Values of an expansion at directions: fast on icospheres, whose harmonics are kept."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.icosphere_edges import icosphere_edges
from regolith_studio.harmonics.legendre import fill_legendre, harmonics, legendre_factors

Basis = NDArray[np.float64] | NDArray[np.float32]

HIGHEST_KEPT_LEVEL = 5
KEPT_DEGREES = (10, 30)
"""Degrees up to which the harmonics of an icosphere are kept: 10 MB and 79 MB at level 5, 2.5 MB and
20 MB at level 4."""


def radii_on_icosphere(coefficients: ShCoefficients, level: int) -> FloatArray:
    """Values at the vertices of ``icosphere(level)``, shape (n,)."""
    for degree in KEPT_DEGREES:
        if coefficients.l_max <= degree and level <= HIGHEST_KEPT_LEVEL:
            return weighted_sum(kept_harmonics(level, degree), coefficients.values)
    return radii_along(coefficients, icosphere(level).vertices)


def radii_along(coefficients: ShCoefficients, directions: FloatArray) -> FloatArray:
    """Values at unit `directions` (n, 3), shape (n,), without a kept matrix."""
    values = np.empty(len(directions))
    _evaluate(np.ascontiguousarray(directions), coefficients.values, coefficients.l_max, values)
    return values


def radii_between(coefficients: ShCoefficients, level: int) -> FloatArray:
    """Values in the middles of the edges of ``icosphere(level)``, shape (e,)."""
    for degree in KEPT_DEGREES:
        if coefficients.l_max <= degree and level <= HIGHEST_KEPT_LEVEL:
            return weighted_sum(_kept_middles(level, degree), coefficients.values)
    return radii_along(coefficients, icosphere_edges(level).middles)


def radii_by_degree(coefficients: ShCoefficients, level: int) -> tuple[FloatArray, FloatArray]:
    """Values of the expansion cut at each degree: row l holds degrees 0 to l.

    Shapes (l_max + 1, n) at the vertices of ``icosphere(level)`` and (l_max + 1, e) in the middles of
    its edges.
    """
    degree = max(coefficients.l_max, KEPT_DEGREES[-1])
    at_vertices = running_sums(kept_harmonics(level, degree), coefficients.values, coefficients.l_max)
    return at_vertices, running_sums(_kept_middles(level, degree), coefficients.values, coefficients.l_max)


@cache
def kept_harmonics(level: int, degree: int) -> FloatArray:
    """Y_lm at the vertices of ``icosphere(level)``, shape ((degree + 1)^2, n), read-only.

    Two threads that ask at once may both compute it; they get equal arrays.
    """
    basis = harmonics(icosphere(level).vertices, degree)
    basis.flags.writeable = False
    return basis


@cache
def _kept_middles(level: int, degree: int) -> NDArray[np.float32]:
    """Y_lm in the middles of the edges, shape ((degree + 1)^2, e); the small correction needs 7 digits."""
    basis = harmonics(icosphere_edges(level).middles, degree).astype(np.float32)
    basis.flags.writeable = False
    return basis


def weighted_sum(basis: Basis, weights: FloatArray) -> FloatArray:
    """Sum of weights[k] * basis[k] over the first len(weights) rows, shape (n,)."""
    total = np.zeros(basis.shape[1])
    _add_weighted(basis, weights, total)
    return total


@kernel
def _add_weighted(basis: Basis, weights: FloatArray, total: FloatArray) -> None:
    for k in range(len(weights)):
        for i in range(basis.shape[1]):
            total[i] += weights[k] * basis[k, i]


def running_sums(basis: Basis, weights: FloatArray, l_max: int) -> FloatArray:
    """Row l: the sum of weights[k] * basis[k] over degrees 0 to l, shape (l_max + 1, n)."""
    sums = np.zeros((l_max + 1, basis.shape[1]))
    _fill_running_sums(basis, weights, sums)
    return sums


@kernel
def _fill_running_sums(basis: Basis, weights: FloatArray, sums: FloatArray) -> None:
    for degree in range(len(sums)):
        if degree > 0:
            sums[degree] = sums[degree - 1]
        for k in range(degree * degree, (degree + 1) * (degree + 1)):
            for i in range(basis.shape[1]):
                sums[degree, i] += weights[k] * basis[k, i]


@kernel
def _evaluate(directions: FloatArray, weights: FloatArray, l_max: int, values: FloatArray) -> None:
    factors, p = legendre_factors(l_max), np.zeros((l_max + 1, l_max + 1))
    for i in range(len(directions)):
        x, y, z = directions[i, 0], directions[i, 1], directions[i, 2]
        sine = np.sqrt(x * x + y * y)
        fill_legendre(z, sine, factors, p)
        c1, s1 = (x / sine, y / sine) if sine > 0.0 else (1.0, 0.0)
        c, s, total = 1.0, 0.0, 0.0
        for m in range(l_max + 1):
            cosines, sines = 0.0, 0.0
            for degree in range(m, l_max + 1):
                k = degree * degree + degree
                cosines += weights[k + m] * p[degree, m]
                sines += weights[k - m] * p[degree, m]
            total += cosines * c + (sines * s if m > 0 else 0.0)
            c, s = c * c1 - s * s1, s * c1 + c * s1
        values[i] = total
