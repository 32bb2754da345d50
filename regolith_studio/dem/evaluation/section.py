"""Both triangle models in one vertical section."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from regolith_studio.dem.evaluation.profile import Profile
from regolith_studio.dem.evaluation.settings import (
    MAX_ANGLE,
    MIN_R_SQUARED,
    EvaluationSettings,
)
from regolith_studio.dem.evaluation.slope_fit import (
    AsymmetricFit,
    SymmetricFit,
    fit_asymmetric,
    fit_symmetric,
    flank_curvature,
    silhouette_deficit,
)
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.messages import N_, Message, Number

SELECTIONS = 5
"""Times that the points between the cuts are chosen anew by the fitted lines."""


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
    curvature
        Of the left and the right flank: how much steeper it is at its foot than at its top, in units of its
        slope; 0 for a straight one.
    """

    azimuth: float
    profile: Profile
    used: BoolArray
    low: float
    high: float
    asymmetric: AsymmetricFit
    symmetric: SymmetricFit
    uncorrected: float
    curvature: tuple[float, float]

    @property
    def flanks(self) -> tuple[float, float]:
        """Angles of the left and the right flank in degrees."""
        return self.asymmetric.left.angle, self.asymmetric.right.angle

    @property
    def end_angles(self) -> tuple[float, float]:
        """Angles at the top and at the toe in degrees, of parabolas through the flanks, as a mean of both."""
        lines = (self.asymmetric.left, self.asymmetric.right)
        slopes = [(abs(line.slope), each / 2) for line, each in zip(lines, self.curvature, strict=True)]
        top = np.mean([np.arctan(slope * (1.0 - half)) for slope, half in slopes])
        toe = np.mean([np.arctan(slope * (1.0 + half)) for slope, half in slopes])
        return float(np.degrees(top)), float(np.degrees(toe))

    @property
    def has_tip(self) -> bool:
        """Whether the lines meet above the upper cut, within the heap, and between the points of both flanks.

        Beside the outermost of those points the apex may lie by one distance of the lines on which the
        surface is read. Rough heaps of few grains have fits that break somewhere on one flank; their angles
        are 4 degrees too flat in the mean.
        """
        profile, (place, height) = self.profile, self.asymmetric.apex
        u = profile.u[self.used]
        on_left, step = u < self.asymmetric.break_point, profile.u[1] - profile.u[0]
        between = u[on_left].max() - step <= place <= u[~on_left].min() + step
        within = profile.u[profile.first] < place < profile.u[profile.last]
        return bool(height > self.high and within and between)


Status = Literal[
    "pile", "too few particles", "layer", "column stands", "no flanks", "concave", "convex", "scattered"
]
"""Classification of particles at rest."""


class NotAPileError(InputError):
    """The particles form no pile whose angle could be measured.

    Parameters
    ----------
    sentence
        Reason, for the user.
    status
        Reason, for programs and tables.

    Attributes
    ----------
    base
        Level of the plate.
    profiles, sections
        The surface at each azimuth, and what could be fitted: as far as the evaluation came.
    """

    def __init__(self, sentence: str, status: Status = "no flanks") -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.status: Status = status
        self.base = 0.0
        self.profiles: Mapping[float, Profile] = {}
        self.sections: tuple[Section, ...] = ()

    def section_at(self, azimuth: float) -> Section | None:
        """The section at an azimuth in degrees, or ``None`` if nothing was fitted there."""
        return next((each for each in self.sections if each.azimuth == azimuth), None)


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
    fit = _fit_flanks(profile, used, mean_diameter, settings)
    for _ in range(SELECTIONS):
        if fit is None:
            break
        chosen = points_between(profile, fit.asymmetric, low, high)
        if np.array_equal(chosen, used):
            break
        used, fit = chosen, _fit_flanks(profile, chosen, mean_diameter, settings)
    symmetric = None if fit is None else fit_symmetric(profile.u[used], fit.surface, settings.min_points)
    if fit is None or symmetric is None:
        raise NotAPileError(
            Message(
                N_(
                    "The section at {azimuth} degrees has no two flanks: {points} surface points lie between "
                    "the cuts, and each flank needs {needed} that rise to an apex."
                ),
                azimuth=Number(azimuth, "g"),
                points=int(used.sum()),
                needed=settings.min_points,
            )
        )
    if fit.asymmetric.angle > MAX_ANGLE:
        raise NotAPileError(_column(fit.asymmetric.angle), "column stands")
    if fit.asymmetric.r_squared < MIN_R_SQUARED:
        raise NotAPileError(
            Message(
                N_(
                    "The section at {azimuth} degrees is no pile: two straight flanks explain only "
                    "{share} % of the variance of its surface."
                ),
                azimuth=Number(azimuth, "g"),
                share=Number(100 * max(fit.asymmetric.r_squared, 0.0), ".0f"),
            )
        )
    curvature = flank_curvature(profile.u[used], fit.surface, fit.asymmetric)
    return Section(azimuth, profile, used, low, high, fit.asymmetric, symmetric, fit.uncorrected, curvature)


@dataclass(frozen=True, eq=False)
class _FlankFit:
    """Flanks, heights of the used points that they were fitted to, shape (k,), and the angle without them."""

    asymmetric: AsymmetricFit
    surface: FloatArray
    uncorrected: float


def _fit_flanks(
    profile: Profile, used: BoolArray, mean_diameter: float, settings: EvaluationSettings
) -> _FlankFit | None:
    """Two lines through the used points, corrected for the size of grains; ``None`` if there are none."""
    u, z = profile.u[used], profile.height[used]
    seen = fit_asymmetric(u, z, settings.min_points)
    if seen is None or not settings.grain_correction or settings.slab > 0.0:
        return None if seen is None else _FlankFit(seen, z, seen.angle)
    lacking = silhouette_deficit(u, seen, mean_diameter)
    z = z + lacking - lacking.mean()  # the lines still run through what is seen
    asymmetric = fit_asymmetric(u, z, settings.min_points)
    return None if asymmetric is None else _FlankFit(asymmetric, z, seen.angle)


def points_between(profile: Profile, fit: AsymmetricFit, low: float, high: float) -> BoolArray:
    """The surface points of the heap at which the fitted lines lie between the cuts, shape (m,).

    The surface itself crosses the cuts where it is by chance too low at the tip and too high at the toe;
    flanks that end there are too flat.
    """
    lines = np.where(
        profile.u < fit.apex[0],
        fit.left.intercept + fit.left.slope * profile.u,
        fit.right.intercept + fit.right.slope * profile.u,
    )
    places = np.arange(len(profile.u))
    inside = (places >= profile.first) & (places <= profile.last)
    return np.asarray(inside & (low <= lines) & (lines < high))


def flank_points(profile: Profile, low: float, high: float) -> BoolArray:
    """Surface points for the first fit, shape (m,).

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
            Message(
                N_("The particles form a layer {height} mean diameters high; a pile has at least {needed}."),
                height=Number(layers, ".1f"),
                needed=Number(settings.min_height, "g"),
            ),
            "layer",
        )
    steepness = float(np.degrees(np.arctan2(2 * profile.top, profile.width)))
    if steepness > MAX_ANGLE:
        raise NotAPileError(_column(steepness), "column stands")


def _column(angle: float) -> Message:
    template = N_("The heap is {angle} degrees steep: the column still stands and has not become a pile.")
    return Message(template, angle=Number(angle, ".0f"))
