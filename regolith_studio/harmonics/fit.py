"""From a mesh to the spherical-harmonics coefficients of its radius function (sections 2.3 and 3.1)."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.arrays import FloatArray, LockedRecord, locked_floats
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle, solid_of
from regolith_studio.harmonics.coefficients import ShCoefficients, checked_degree
from regolith_studio.harmonics.radius_function import (
    DEFAULT_RULE,
    REFERENCES,
    Ellipsoid,
    RadiusFunction,
    require_solid,
    sample_radius,
)
from regolith_studio.harmonics.star_point import (
    STAR_POINT_RULES,
    centre_of_mass,
    hidden_surface_share,
    least_hidden_volume,
)
from regolith_studio.harmonics.transform import SAMPLING_DEGREE, RayGrid, analyse, band_limited, ray_grid
from regolith_studio.messages import N_, Message, Number

HIDDEN_TOLERANCE = 0.01
"""Hidden share of the surface from which on a fit carries a warning."""
RADIAL_TOLERANCE = 0.05
"""Root-mean-square radial error, as a share of the mean radius, from which on a fit carries a warning."""
MISSES = N_(
    "RMS radius error up to l = {degree}: {error}; a higher l_max comes closer, and on flat or long grains so"
    " does an ellipsoid as reference."
)
MISSES_AT_MOST = N_(
    "RMS radius error up to l = {degree}: {error}, at most {most}; a higher l_max comes closer, and on flat"
    " or long grains so does an ellipsoid as reference."
)
UNUSABLE = N_("RMS radius error up to l = {degree}: {error}, so that the fit cannot be used.")
"""Where the error is as large as the radius."""


@dataclass(frozen=True, eq=False)
class HarmonicFit(LockedRecord):
    """Expansion of a particle in spherical harmonics, and its errors.

    Parameters
    ----------
    coefficients
        Of the radius, or of the radius divided by the reference's.
    star_point
        Shape (3,), in the frame of the particle.
    hidden_surface_share
        Share of the surface that is not visible from the star point, which no radius function represents.
    unrepresentable_volume_share
        Share of the volume behind the first crossing of a ray. By the default rule it is kept in sum
        but not in place.
    radial_error
        Root mean square over all directions of the difference between the expansion and the radius
        function, as a share of the mean radius (with a reference: of radius over reference):
        truncation, and oscillations on flat particles. Known at every lower degree by Parseval.
    largest_radial_error
        Maximum error of the expansion as a share of the local radius; ``None`` where it was not computed, as
        for a truncated fit.
    reference
        Ellipsoid that the radius was divided by, or ``None``.
    rule
        Radius rule where a ray crosses the surface more than once.
    sampling_degree
        Degree of the ray grid.
    notes
        Sentences about the particle that a user should know.
    """

    coefficients: ShCoefficients
    star_point: FloatArray
    hidden_surface_share: float = 0.0
    unrepresentable_volume_share: float = 0.0
    radial_error: float = 0.0
    largest_radial_error: float | None = None
    reference: Ellipsoid | None = None
    rule: str = DEFAULT_RULE
    sampling_degree: int = SAMPLING_DEGREE
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "star_point", locked_floats(self.star_point, (3,), "star_point"))

    @property
    def l_max(self) -> int:
        """Highest degree."""
        return self.coefficients.l_max

    @property
    def star_shaped(self) -> bool:
        """Whether every ray from the star point crosses the surface once."""
        return self.hidden_surface_share == 0.0

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notes, and a sentence with the number where the expansion misses the radius."""
        if not self.radial_error > RADIAL_TOLERANCE:
            return self.notes
        if self.radial_error >= 1.0:
            return (
                *self.notes,
                Message(UNUSABLE, degree=self.l_max, error=Number(self.radial_error, ",.0%")),
            )
        values = {"degree": self.l_max, "error": Number(self.radial_error, ".1%")}
        if self.largest_radial_error is None:
            return (*self.notes, Message(MISSES, **values))
        return (*self.notes, Message(MISSES_AT_MOST, most=Number(self.largest_radial_error, ".0%"), **values))

    def truncated(self, l_max: int) -> "HarmonicFit":
        """The fit cut at `l_max`, with the radial error that it has there.

        Raises InputError if `l_max` is negative or above the degree of this fit.
        """
        if l_max == self.l_max:
            return self
        low = self.coefficients.truncated(l_max)
        # Harmonics are orthogonal, so that mean squares of what was missing and of what is dropped add up.
        dropped = float((self.coefficients.values[len(low) :] ** 2).sum()) / (4 * np.pi)
        error = np.sqrt(self.radial_error**2 + dropped / low.mean_radius**2)
        return replace(self, coefficients=low, radial_error=float(error), largest_radial_error=None)


def fit_harmonics(
    particle: Particle | Mesh,
    l_max: int = 30,
    star_point: ArrayLike | str | None = None,
    sampling_degree: int = SAMPLING_DEGREE,
    rule: str = DEFAULT_RULE,
    reference: str = "sphere",
) -> HarmonicFit:
    """Expand the radius function of a particle or a closed mesh.

    The radius is sampled at `sampling_degree` and the expansion cut at `l_max`, because sampling at
    l_max itself folds finer shape into the coefficients. A lower l_max later needs no new fit.

    Parameters
    ----------
    star_point
        Coordinates (3,), a key of ``STAR_POINT_RULES``, or ``None``: the centre of mass, and where that
        lies outside the particle the nearest good point, with a warning.
    rule
        Key of ``radius_function.RULES``.
    reference
        Key of ``radius_function.REFERENCES``.

    Raises
    ------
    GeometryError
        If the mesh is open or inside out, or the star point lies outside.
    InputError
        If `l_max`, a rule or a degree is out of range.
    """
    checked_degree(l_max, sampling_degree)
    if reference not in REFERENCES:
        raise InputError(f"The reference must be one of {', '.join(REFERENCES)}, got {reference!r}.")
    rays = ray_grid(sampling_degree)
    solid = require_solid(solid_of(particle))
    radius, notes = _sampled(solid, star_point, rays, rule)
    ellipsoid = REFERENCES[reference](solid)
    fit = expand_radius(radius, rays, l_max, ellipsoid)
    hidden = hidden_surface_share(solid, radius.star_point)
    fit = replace(fit, hidden_surface_share=hidden)
    return replace(fit, notes=(*notes, *_about_hidden(fit)))


def expand_radius(
    radius: RadiusFunction, rays: RayGrid, l_max: int, reference: Ellipsoid | None = None
) -> HarmonicFit:
    """The expansion of a radius function that was sampled on a grid; needs no mesh."""
    unit = 1.0 if reference is None else reference.radii(rays.directions)
    samples = radius.radii / unit
    coefficients = analyse(rays, samples, l_max)
    # Not from the coefficients, which would have to be rotated back by the tilt of the grid.
    difference = band_limited(rays, samples, l_max) - samples
    return HarmonicFit(
        coefficients,
        radius.star_point,
        unrepresentable_volume_share=rays.mean(radius.hidden_cubes) / rays.mean(radius.volume**3),
        radial_error=float(np.sqrt(rays.mean(difference**2))) / coefficients.mean_radius,
        largest_radial_error=float(np.abs(difference / samples).max()),
        reference=reference,
        rule=radius.rule,
        sampling_degree=rays.degree,
    )


def _sampled(
    mesh: Mesh, star_point: ArrayLike | str | None, rays: RayGrid, rule: str
) -> tuple[RadiusFunction, tuple[str, ...]]:
    """The radius function about the requested star point, and notes on it."""
    # A rule or point that was asked for is never replaced by another: outside of the particle it is an error.
    if isinstance(star_point, str):
        if star_point not in STAR_POINT_RULES:
            choices = ", ".join(STAR_POINT_RULES)
            raise InputError(f"The star point must be one of {choices}, got {star_point!r}.")
        return sample_radius(mesh, STAR_POINT_RULES[star_point](mesh), rays.directions, rule), ()
    if star_point is not None:
        return sample_radius(mesh, star_point, rays.directions, rule), ()
    try:
        return sample_radius(mesh, centre_of_mass(mesh), rays.directions, rule), ()
    except GeometryError:
        point = least_hidden_volume(mesh)
    note = N_("The centre of mass lies outside the particle; the point with the least hidden volume is used.")
    return sample_radius(mesh, point, rays.directions, rule), (note,)


def _about_hidden(fit: HarmonicFit) -> tuple[str, ...]:
    if not fit.hidden_surface_share > HIDDEN_TOLERANCE:
        return ()
    template = N_(
        "Hidden from the star point and not represented: {surface} of the surface, {volume} of the volume."
    )
    surface, volume = Number(fit.hidden_surface_share, ".1%"), Number(fit.unrepresentable_volume_share, ".1%")
    return (Message(template, surface=surface, volume=volume),)
