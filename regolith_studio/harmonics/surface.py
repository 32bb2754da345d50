"""From coefficients back to a closed surface: radii, mesh, volume and area (Eq. 4)."""

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics import quadrature
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.icosphere_edges import icosphere_edges
from regolith_studio.harmonics.quadrature import SurfaceMeasures
from regolith_studio.harmonics.radius_function import DEFAULT_RULE, sample_radius
from regolith_studio.harmonics.synthesis import (
    radii_along,
    radii_between,
    radii_by_degree,
    radii_on_icosphere,
)

DEFAULT_LEVEL = 4
"""Icosphere level of reconstructed meshes: 2,562 vertices, 5,120 faces."""

Expanded = HarmonicFit | ShCoefficients
"""What describes a surface: a fit, or bare coefficients about the origin."""


def reconstruct(expanded: Expanded, l_max: int | None = None, level: int = DEFAULT_LEVEL) -> Mesh:
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
    fit = as_fit(expanded, l_max)
    radius = radii_on_icosphere(fit.coefficients, level)
    return _meshed(fit, radius, radii_between(fit.coefficients, level), level)


def gallery(
    expanded: Expanded, degrees: Iterable[int], level: int = DEFAULT_LEVEL
) -> Iterator[tuple[int, Mesh | None]]:
    """The expansion cut at each of `degrees` (Fig. 2), or ``None`` where a radius is negative.

    Much cheaper than as many calls of :func:`reconstruct`: the sums are carried from degree to degree.
    """
    wanted = list(degrees)
    fit = as_fit(expanded, max(wanted, default=0))
    radius, between = radii_by_degree(fit.coefficients, level)
    for degree in wanted:
        cut = as_fit(fit, degree)
        try:
            yield degree, _meshed(cut, radius[degree], between[degree], level)
        except GeometryError:
            yield degree, None


def radii(expanded: Expanded, directions: ArrayLike, l_max: int | None = None) -> FloatArray:
    """Radius of the expansion along unit `directions` (n, 3), shape (n,); it may be negative."""
    fit = as_fit(expanded, l_max)
    rays = np.ascontiguousarray(directions, dtype=np.float64)
    found = radii_along(fit.coefficients, rays)
    return found if fit.reference is None else found * fit.reference.radii(rays)


def measures(expanded: Expanded, l_max: int | None = None) -> SurfaceMeasures:
    """Volume and area of the smooth surface of the expansion cut at `l_max`."""
    fit = as_fit(expanded, l_max)
    return quadrature.measure(fit.coefficients, fit.reference)


def error_map(
    fit: HarmonicFit, mesh: Mesh, l_max: int | None = None, level: int = DEFAULT_LEVEL
) -> FloatArray:
    """Radius of the fit minus radius of its particle, at the vertices of ``reconstruct(fit, l_max, level)``.

    Shape (n,), in the unit of the mesh; positive where the fit stands out. For a slider cast the rays
    once (:func:`particle_radii`) and subtract.
    """
    return radii(fit, icosphere(level).vertices, l_max) - particle_radii(fit, mesh, level)


def particle_radii(fit: HarmonicFit, mesh: Mesh, level: int = DEFAULT_LEVEL) -> FloatArray:
    """Radius function of the particle along the vertices of ``icosphere(level)``, shape (n,)."""
    rule = fit.rule or DEFAULT_RULE
    return sample_radius(mesh, fit.star_point, icosphere(level).vertices, rule).radii


def as_fit(expanded: Expanded, l_max: int | None = None) -> HarmonicFit:
    """The expansion cut at `l_max`; bare coefficients get the origin as star point.

    Raises
    ------
    InputError
        If `l_max` is out of range.
    """
    if isinstance(expanded, ShCoefficients):
        return HarmonicFit(expanded if l_max is None else expanded.truncated(l_max), np.zeros(3))
    return expanded if l_max is None else expanded.truncated(l_max)


def _meshed(fit: HarmonicFit, radius: FloatArray, between: FloatArray, level: int) -> Mesh:
    """The mesh of the radii at the icosphere's vertices (n,) and in the middles of its edges (e,)."""
    edges = icosphere_edges(level)
    if fit.reference is not None:
        radius = radius * fit.reference.radii(icosphere(level).vertices)
        between = between * fit.reference.radii(edges.middles)
    _refuse_negative(fit, radius)
    _refuse_negative(fit, between)
    sphere = icosphere(level)
    lifted = np.maximum(radius + edges.shortfalls(radius, between), radius / 2)
    vertices = sphere.vertices * lifted[:, None]
    volume = quadrature.enclosed_volume(fit.coefficients, fit.reference)
    factor = np.cbrt(volume / flat_volume(vertices, sphere.faces))
    return Mesh(vertices * factor + fit.star_point, sphere.faces)


@kernel
def flat_volume(vertices: FloatArray, faces: IntArray) -> float:
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
