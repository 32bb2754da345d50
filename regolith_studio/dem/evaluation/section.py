"""Both triangle models in one vertical section."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.dem.evaluation.errors import MAX_ANGLE, MIN_R_SQUARED, NotAPileError
from regolith_studio.dem.evaluation.profile import Profile
from regolith_studio.dem.evaluation.settings import EvaluationSettings
from regolith_studio.dem.evaluation.slope_fit import (
    AsymmetricFit,
    SymmetricFit,
    fit_asymmetric,
    fit_symmetric,
    silhouette_deficit,
)
from regolith_studio.geometry.arrays import BoolArray


@dataclass(frozen=True, eq=False)
class Section:
    """The evaluation of one vertical plane.

    Parameters
    ----------
    azimuth
        Degrees from the x axis: 0 is x-z, 90 is y-z.
    profile
        The surface.
    used
        Whether a point is within the regression range, shape (m,).
    low, high
        The cuts, as heights above the base.
    asymmetric, symmetric
        The fitted models.
    uncorrected
        Asymmetric angle in degrees before the correction for particle size.
    """

    azimuth: float
    profile: Profile
    used: BoolArray
    low: float
    high: float
    asymmetric: AsymmetricFit
    symmetric: SymmetricFit
    uncorrected: float


def evaluate_section(
    profile: Profile, azimuth: float, mean_diameter: float, settings: EvaluationSettings
) -> Section:
    """Cut the surface and fit both models.

    Parameters
    ----------
    azimuth
        In degrees.

    Raises
    ------
    NotAPileError
        If the particles form a layer, a standing column, or a surface without two straight flanks.
    """
    _check_shape(profile, mean_diameter, settings)
    low = max(settings.cut_bottom * profile.top, settings.toe * mean_diameter)
    high = (1.0 - settings.cut_top) * profile.top
    used = flank_points(profile, low, high)
    u, z = profile.u[used], profile.height[used]
    asymmetric = fit_asymmetric(u, z, settings.min_points)
    uncorrected = None if asymmetric is None else asymmetric.angle
    if asymmetric is not None and settings.grain_correction and settings.slab == 0.0:
        lacking = silhouette_deficit(u, asymmetric, mean_diameter)
        z = z + lacking - lacking.mean()  # the lines still run through what is seen
        asymmetric = fit_asymmetric(u, z, settings.min_points)
    symmetric = fit_symmetric(u, z, settings.min_points)
    if asymmetric is None or symmetric is None or uncorrected is None:
        raise NotAPileError(
            f"The section at {azimuth:g} degrees has no two flanks: {len(u)} surface points lie between the "
            f"cuts, and each flank needs {settings.min_points} that rise to an apex."
        )
    if asymmetric.angle > MAX_ANGLE:
        raise NotAPileError(_column(asymmetric.angle), "column stands")
    if asymmetric.r_squared < MIN_R_SQUARED:
        raise NotAPileError(
            f"The section at {azimuth:g} degrees is no pile: two straight flanks explain only "
            f"{100 * max(asymmetric.r_squared, 0.0):.0f} % of its surface."
        )
    return Section(azimuth, profile, used, low, high, asymmetric, symmetric, uncorrected)


def flank_points(profile: Profile, low: float, high: float) -> BoolArray:
    """Which surface points the regression uses, shape (m,).

    On each side of the peak they run from the last point at or above `high` to the first below `low`.
    Points are selected by position, not by their own height, so that the noise of single particles does not
    bias the line: points would be missing above it at the top and below it at the toe.
    """
    places = np.arange(len(profile.u))
    inside = (places >= profile.first) & (places <= profile.last)
    above = np.flatnonzero(inside & (profile.height >= high))
    below_low = profile.height < low
    left, right = int(above[0]), int(above[-1])
    toes_left = np.flatnonzero(below_low & (places < left))
    toes_right = np.flatnonzero(below_low & (places > right))
    start = max(int(toes_left[-1]) + 1 if len(toes_left) else 0, profile.first)
    stop = min(int(toes_right[0]) - 1 if len(toes_right) else len(places) - 1, profile.last)
    return ((places >= start) & (places < left)) | ((places > right) & (places <= stop))


def _check_shape(profile: Profile, mean_diameter: float, settings: EvaluationSettings) -> None:
    layers = profile.top / mean_diameter
    if layers < settings.min_height:
        raise NotAPileError(
            f"The particles lie in a layer {layers:.1f} mean diameters high; a pile has at least "
            f"{settings.min_height:g}.",
            "layer",
        )
    steepness = float(np.degrees(np.arctan2(2 * profile.top, profile.width)))
    if steepness > MAX_ANGLE:
        raise NotAPileError(_column(steepness), "column stands")


def _column(angle: float) -> str:
    return f"The heap is {angle:.0f} degrees steep: the column still stands and has not become a pile."
