"""Values of an expansion at directions, with cached harmonics for the vertices and edges of icospheres."""

from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.sphere_grid import fill_legendre, harmonics, legendre_factors

Basis = NDArray[np.float64] | NDArray[np.float32]

MAX_CACHED_LEVEL = 5
CACHED_DEGREES = (10, 30)
"""Degrees up to which the harmonics of an icosphere are cached: 10 MB and 79 MB at level 5, 2.5 MB and
20 MB at level 4, 1.5 times as much in the middles of its edges."""
KEPT = 2
"""Pairs of level and degree, of those that were used last, whose harmonics are kept."""


@dataclass(frozen=True, eq=False)
class IcosphereEdges:
    """The edges of an icosphere with n vertices.

    - ``ends``: vertex indices, shape (e, 2).
    - ``middles``: directions of the edges' middles, shape (e, 3).
    - ``spans``: length of the sum of the two end directions, shape (e,).
    - ``weights``: weight of each edge in the mean over the triangles round each vertex, sparse, shape (n,
      e).
    """

    ends: IntArray
    middles: FloatArray
    spans: FloatArray
    weights: "csr_array[np.float64, tuple[int, int]]"

    def chord_errors(self, radius: FloatArray, between: FloatArray) -> FloatArray:
        """How far the flat triangles round each vertex stay inside the surface on average, shape (n,).

        Over a triangle the chord error is nearly quadratic and vanishes at the corners, so that its mean is
        that of its values in the middles of the three edges.

        ``radius``, ``between``: radius of the surface at the vertices (n,) and in the middles of the edges
        (e,).
        """
        start, end = radius[self.ends[:, 0]], radius[self.ends[:, 1]]
        chord = start * end / (start + end) * self.spans
        return np.asarray(self.weights @ (between - chord))


@cache
def icosphere_edges(level: int) -> IcosphereEdges:
    """Edges of ``icosphere(level)``, cached."""
    sphere = icosphere(level)
    sides = np.sort(sphere.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    ends, of_face = np.unique(sides, axis=0, return_inverse=True)
    sums = sphere.vertices[ends].sum(axis=1)
    spans = np.linalg.norm(sums, axis=1)
    n_triangles = np.bincount(sphere.faces.ravel())
    rows = np.repeat(sphere.faces, 3, axis=1).ravel()
    columns = np.tile(of_face.reshape(-1, 3), (1, 3)).ravel()
    shares = 1 / (3 * n_triangles[rows])
    weights = csr_array((shares, (rows, columns)), shape=(len(sphere.vertices), len(ends)))
    return IcosphereEdges(ends, sums / spans[:, None], spans, weights)


def radii_on_icosphere(coefficients: ShCoefficients, level: int) -> FloatArray:
    """Values at the vertices of ``icosphere(level)``, shape (n,)."""
    for degree in CACHED_DEGREES:
        if coefficients.l_max <= degree and level <= MAX_CACHED_LEVEL:
            return _weighted_sum(cached_harmonics(level, degree), coefficients.values)
    return radii_along(coefficients, icosphere(level).vertices)


def radii_along(coefficients: ShCoefficients, directions: FloatArray) -> FloatArray:
    """Values at unit `directions` (n, 3), shape (n,), without a cached matrix."""
    values = np.empty(len(directions))
    _evaluate(np.ascontiguousarray(directions), coefficients.values, coefficients.l_max, values)
    return values


def radii_between(coefficients: ShCoefficients, level: int) -> FloatArray:
    """Values in the middles of the edges of ``icosphere(level)``, shape (e,)."""
    for degree in CACHED_DEGREES:
        if coefficients.l_max <= degree and level <= MAX_CACHED_LEVEL:
            return _weighted_sum(_cached_middles(level, degree), coefficients.values)
    return radii_along(coefficients, icosphere_edges(level).middles)


def radii_by_degree(coefficients: ShCoefficients, level: int) -> tuple[FloatArray, FloatArray]:
    """Values of the expansion cut at each degree: row l holds degrees 0 to l.

    Shapes (l_max + 1, n) at the vertices of ``icosphere(level)`` and (l_max + 1, e) in the middles of
    its edges.
    """
    degree = max(coefficients.l_max, CACHED_DEGREES[-1])
    at_vertices = _running_sums(cached_harmonics(level, degree), coefficients.values, coefficients.l_max)
    return at_vertices, _running_sums(_cached_middles(level, degree), coefficients.values, coefficients.l_max)


@lru_cache(maxsize=KEPT)
def cached_harmonics(level: int, degree: int) -> FloatArray:
    """Y_lm at the vertices of ``icosphere(level)``, shape ((degree + 1)^2, n), read-only.

    Two threads that ask at once may both compute it; they get equal arrays.
    """
    basis = harmonics(icosphere(level).vertices, degree)
    basis.flags.writeable = False
    return basis


@lru_cache(maxsize=KEPT)
def _cached_middles(level: int, degree: int) -> NDArray[np.float32]:
    """Y_lm in the middles of the edges, shape ((degree + 1)^2, e); the small correction needs 7 digits."""
    basis = harmonics(icosphere_edges(level).middles, degree).astype(np.float32)
    basis.flags.writeable = False
    return basis


def _weighted_sum(basis: Basis, weights: FloatArray) -> FloatArray:
    """Sum of weights[k] * basis[k] over the first len(weights) rows, shape (n,)."""
    total = np.zeros(basis.shape[1])
    _add_weighted(basis, weights, total)
    return total


def _running_sums(basis: Basis, weights: FloatArray, l_max: int) -> FloatArray:
    """Row l: the sum of weights[k] * basis[k] over degrees 0 to l, shape (l_max + 1, n)."""
    sums = np.zeros((l_max + 1, basis.shape[1]))
    _add_by_degree(basis, weights, sums)
    return sums


@kernel
def _add_weighted(basis: Basis, weights: FloatArray, total: FloatArray) -> None:
    for k in range(len(weights)):
        for i in range(basis.shape[1]):
            total[i] += weights[k] * basis[k, i]


@kernel
def _add_by_degree(basis: Basis, weights: FloatArray, sums: FloatArray) -> None:
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
