"""From coefficients to radii, a surface and its volume (Eq. 4), with cached harmonics of icospheres."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.radius_function import Ellipsoid
from regolith_studio.harmonics.sphere_grid import (
    fill_legendre,
    harmonics,
    legendre_factors,
    ring_nodes,
    synthesise_rings,
)
from regolith_studio.harmonics.transform import evaluate_on_grid, ray_grid

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
        # Between radii r and s along u and v the ray in the middle meets the chord at |u + v| r s / (r + s).
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
    # The mean of three middles for a triangle, and of its triangles for a vertex.
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


DEFAULT_LEVEL = 4
"""Icosphere level of reconstructed meshes: 2,562 vertices, 5,120 faces."""

LEVEL_BY_DEGREE = ((4, 3), (10, 4), (30, 5))
"""Highest degree and the icosphere level that is enough up to there: five vertices a wave or more."""

Expansion = HarmonicFit | ShCoefficients
"""A fit, or bare coefficients about the origin."""


def level_for(l_max: int) -> int:
    """Icosphere level of meshes of this degree: the default one or, above l = 10, the next finer."""
    return next((level for last, level in LEVEL_BY_DEGREE[1:] if l_max <= last), LEVEL_BY_DEGREE[-1][1])


def reconstruct(expansion: Expansion, l_max: int | None = None, level: int = DEFAULT_LEVEL) -> Mesh:
    """Closed mesh of the expansion cut at `l_max`, in the frame of the particle.

    The vertices lie along those of an icosphere. They stand out a little from the smooth surface, by as
    much as the triangles round them cut it short on average: so the mesh follows the surface in the mean
    and not from inside. It has exactly the volume of the smooth surface.

    Raises
    ------
    GeometryError
        If the expansion has a negative radius.
    InputError
        If `l_max` is out of range.
    """
    fit = as_fit(expansion, l_max)
    radius = radii_on_icosphere(fit.coefficients, level)
    return _meshed(fit, radius, radii_between(fit.coefficients, level), level)


def gallery(
    expansion: Expansion, degrees: Iterable[int], level: int = DEFAULT_LEVEL
) -> Iterator[tuple[int, Mesh | None]]:
    """The expansion cut at each of `degrees` (Fig. 2), or ``None`` where a radius is negative.

    Much cheaper than as many calls of :func:`reconstruct`: the sums are carried from degree to degree.
    """
    wanted = list(degrees)
    fit = as_fit(expansion, max(wanted, default=0))
    radius, between = radii_by_degree(fit.coefficients, level)
    for degree in wanted:
        cut = as_fit(fit, degree)
        try:
            yield degree, _meshed(cut, radius[degree], between[degree], level)
        except GeometryError:
            yield degree, None


def radii(expansion: Expansion, directions: ArrayLike, l_max: int | None = None) -> FloatArray:
    """Radius of the expansion along unit `directions` (n, 3), shape (n,); it may be negative."""
    fit = as_fit(expansion, l_max)
    rays = np.ascontiguousarray(directions, dtype=np.float64)
    lengths = radii_along(fit.coefficients, rays)
    return lengths if fit.reference is None else lengths * fit.reference.radii(rays)


def as_fit(expansion: Expansion, l_max: int | None = None) -> HarmonicFit:
    """The expansion cut at `l_max`; bare coefficients get the origin as star point.

    Raises InputError if `l_max` is out of range.
    """
    if isinstance(expansion, ShCoefficients):
        return HarmonicFit(expansion if l_max is None else expansion.truncated(l_max), np.zeros(3))
    return expansion if l_max is None else expansion.truncated(l_max)


def _meshed(fit: HarmonicFit, radius: FloatArray, between: FloatArray, level: int) -> Mesh:
    """The mesh of the radii at the icosphere's vertices (n,) and in the middles of its edges (e,)."""
    edges = icosphere_edges(level)
    if fit.reference is not None:
        radius = radius * fit.reference.radii(icosphere(level).vertices)
        between = between * fit.reference.radii(edges.middles)
    _refuse_negative(fit, radius)
    _refuse_negative(fit, between)
    sphere = icosphere(level)
    # In narrow pits the surface lies far inside of the chords: vertices would pass through the origin.
    lifted = np.maximum(radius + edges.chord_errors(radius, between), radius / 2)
    vertices = sphere.vertices * lifted[:, None]
    volume = enclosed_volume(fit.coefficients, fit.reference)
    factor = np.cbrt(volume / _flat_volume(vertices, sphere.faces))
    return Mesh(vertices * factor + fit.star_point, sphere.faces)


@kernel
def _flat_volume(vertices: FloatArray, faces: IntArray) -> float:
    """Volume of the cones from the origin to the triangles: that of the mesh, if it is closed."""
    total = 0.0
    for f in range(len(faces)):
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        total += a[0] * (b[1] * c[2] - b[2] * c[1])
        total += a[1] * (b[2] * c[0] - b[0] * c[2])
        total += a[2] * (b[0] * c[1] - b[1] * c[0])
    return total / 6.0


def _refuse_negative(fit: HarmonicFit, radius: FloatArray) -> None:
    if not (radius > 0.0).all():
        n_negative = int(np.count_nonzero(~(radius > 0.0)))
        raise GeometryError(
            f"The expansion up to l = {fit.l_max} has a negative radius in {n_negative} of {len(radius)} "
            f"directions (lowest {radius.min():.3g}) and bounds no solid: choose another l_max, star point "
            "or reference."
        )


def enclosed_volume(coefficients: ShCoefficients, reference: Ellipsoid | None = None) -> float:
    """Signed volume of the surface, the integral of r^3 / 3; exact to rounding without a reference.

    The quadrature is exact from a grid of degree 1.5 l_max on.
    """
    if reference is not None:
        # The radius of an ellipsoid has no highest degree: a finer grid than for the cube of the expansion
        # alone.
        return _volume_on_grid(coefficients, reference, max(60, 2 * coefficients.l_max))
    grid = ray_grid(max(1, 3 * coefficients.l_max // 2 + 1))
    return 4 * np.pi / 3 * grid.mean(evaluate_on_grid(grid, coefficients) ** 3)


def _volume_on_grid(coefficients: ShCoefficients, reference: Ellipsoid, degree: int) -> float:
    """Volume of expansion times reference, on a Gauss-Legendre grid of `degree`."""
    cosines, directions, solid_angles = _nodes(degree)
    radius = synthesise_rings(coefficients.values, cosines, 2 * degree + 1).ravel()
    return float(solid_angles @ (radius * reference.radii(directions)) ** 3) / 3


@lru_cache(maxsize=2)  # a study takes one degree after the other; at l_max = 500 each has 60 MB
def _nodes(degree: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Cosines of the rings (degree + 1,), directions (n, 3) and solid angles (n,) of a Gauss grid."""
    cosines, weights = np.polynomial.legendre.leggauss(degree + 1)
    return (cosines, *ring_nodes(cosines, weights, 2 * degree + 1))
