"""From coefficients to a closed surface: radii, mesh and volume (Eq. 4)."""

from collections.abc import Iterable, Iterator
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.radius_function import Ellipsoid
from regolith_studio.harmonics.sphere_grid import ring_nodes, synthesise_rings
from regolith_studio.harmonics.synthesis import (
    icosphere_edges,
    radii_along,
    radii_between,
    radii_by_degree,
    radii_on_icosphere,
)
from regolith_studio.harmonics.transform import evaluate_on_grid, ray_grid

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
