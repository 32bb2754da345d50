"""Both triangle models in one vertical section."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import minimize_scalar

from regolith_studio.dem.evaluation import (
    MAX_ANGLE,
    MIN_R_SQUARED,
    EvaluationSettings,
)
from regolith_studio.dem.evaluation.profile import Profile
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.messages import N_, Message, Number


@dataclass(frozen=True)
class Line:
    """z = slope u + intercept."""

    slope: float
    intercept: float

    @property
    def angle(self) -> float:
        """arctan |slope| in degrees."""
        return float(np.degrees(np.arctan(abs(self.slope))))


@dataclass(frozen=True)
class AsymmetricFit:
    """Two independent lines.

    - ``left``, ``right``: the flanks.
    - ``break_point``: where the points are divided: half-way between the last of the left and the first of
      the right.
    - ``apex``: (u, z) where the lines meet.
    - ``r_squared``: share of the points' variance that the two lines explain.
    """

    left: Line
    right: Line
    break_point: float
    apex: tuple[float, float]
    r_squared: float

    @property
    def angle(self) -> float:
        """Mean of the two flanks' angles, in degrees."""
        return (self.left.angle + self.right.angle) / 2


@dataclass(frozen=True)
class SymmetricFit:
    """z = apex_z - slope |u - apex_u|: one angle for both flanks.

    - ``slope``: positive for a pile.
    - ``apex``: (u, z).
    - ``r_squared``: share of the points' variance that is explained.
    """

    slope: float
    apex: tuple[float, float]
    r_squared: float

    @property
    def angle(self) -> float:
        """arctan |slope| in degrees."""
        return float(np.degrees(np.arctan(abs(self.slope))))


def fit_asymmetric(u: FloatArray, z: FloatArray, min_points: int) -> AsymmetricFit | None:
    """Two lines with the break point at the least sum of squared residuals, tried exhaustively.

    ``u``, ``z``: surface points with ascending u, shape (m,). ``min_points``: points that each flank keeps.

    Returns ``None`` where the points are too few or the lines do not rise and fall.
    """
    breaks = np.arange(min_points, len(u) - min_points + 1)
    if not len(breaks):
        return None
    # Running sums give the loss of every break at once: a fit at each would take quadratic time.
    forward, backward = _running_lines(u, z), _running_lines(u[::-1], z[::-1])
    losses = forward.losses[breaks - 1] + backward.losses[len(u) - breaks - 1]
    best = int(breaks[losses.argmin()])
    left, right = forward.line(best - 1), backward.line(len(u) - best - 1)
    if left.slope <= 0.0 or right.slope >= 0.0:
        return None
    # The slopes differ in sign here, so that the divisor is not 0.
    meeting = (right.intercept - left.intercept) / (left.slope - right.slope)
    return AsymmetricFit(
        left=left,
        right=right,
        break_point=float(u[best - 1] + u[best]) / 2,
        apex=(float(meeting), float(left.slope * meeting + left.intercept)),
        r_squared=_explained(float(losses.min()), z),
    )


def fit_symmetric(u: FloatArray, z: FloatArray, min_points: int) -> SymmetricFit | None:
    """One angle for both flanks, the apex position varied to minimise the residual.

    Returns ``None`` where the points are too few or form no roof.
    """
    if len(u) < 2 * min_points:
        return None
    # The loss has several minima over the apex on rough surfaces: the best of a grid comes first.
    candidates = np.linspace(u[min_points - 1], u[-min_points], 64)
    losses = [_roof(place, u, z)[0] for place in candidates]
    best = int(np.argmin(losses))
    step = candidates[1] - candidates[0]
    if step <= 0.0:
        return None
    refined = minimize_scalar(
        lambda place: _roof(place, u, z)[0],
        bounds=(candidates[best] - step, candidates[best] + step),
        method="bounded",
        # Far below the distance of the points, where the loss no longer changes.
        options={"xatol": 1e-6 * float(step)},
    )
    place = float(refined.x)
    loss, slope, height = _roof(place, u, z)
    if slope <= 0.0:
        return None
    return SymmetricFit(slope, (place, height), _explained(loss, z))


@dataclass(frozen=True, eq=False)
class _Running:
    """Regressions over the first k + 1 points for every k."""

    losses: FloatArray
    slopes: FloatArray
    intercepts: FloatArray

    def line(self, k: int) -> Line:
        return Line(float(self.slopes[k]), float(self.intercepts[k]))


def _running_lines(u: FloatArray, z: FloatArray) -> _Running:
    """Least-squares lines through the first 1, 2, ... points, from running sums about the mean."""
    # Sums of squares of places far from the origin would cancel in the differences below.
    shift_u, shift_z = u.mean(), z.mean()
    x, y = u - shift_u, z - shift_z
    n = np.arange(1, len(u) + 1)
    sx, sy = np.cumsum(x), np.cumsum(y)
    sxx = np.cumsum(x * x) - sx**2 / n
    sxy = np.cumsum(x * y) - sx * sy / n
    syy = np.cumsum(y * y) - sy**2 / n
    slope = np.divide(sxy, sxx, out=np.zeros_like(sxy), where=sxx > 0.0)
    # Rounding makes the loss of points on one line slightly negative.
    losses = np.maximum(syy - slope * sxy, 0.0)
    return _Running(losses, slope, sy / n - slope * sx / n + shift_z - slope * shift_u)


def _roof(place: float, u: FloatArray, z: FloatArray) -> tuple[float, float, float]:
    """Loss, slope and apex height of the best symmetric roof with its apex at `place`."""
    away = np.abs(u - place)
    spread = away - away.mean()
    slope = -float(spread @ z) / float(spread @ spread)
    height = float(z.mean() + slope * away.mean())
    return float(((z - height + slope * away) ** 2).sum()), slope, height


def _explained(loss: float, z: FloatArray) -> float:
    total = float(((z - z.mean()) ** 2).sum())
    return 1.0 - loss / total if total > 0.0 else 0.0


def flank_curvature(u: FloatArray, z: FloatArray, fit: AsymmetricFit) -> tuple[float, float]:
    """How much steeper each flank is at its foot than at its top, in units of its slope, by a parabola."""

    def relative(side: BoolArray, line: Line) -> float:
        x = u[side] - u[side].mean()
        return float(-2 * np.polyfit(x, z[side], 2)[0] * np.ptp(x) / abs(line.slope))

    left = u < fit.break_point
    return relative(left, fit.left), relative(~left, fit.right)


SOLID_FRACTION = 0.58
"""Of the grains in the pile."""


def silhouette_deficit(u: FloatArray, fit: AsymmetricFit, mean_diameter: float) -> FloatArray:
    """Mean height by which the surface is seen too low, because a heap consists of grains, shape (m,).

    The silhouette of a cone at the distance x from its axis is a single line on its surface. A heap has a
    grain there only by chance, so the highest visible grain lies a little lower. Grains that reach up to less
    than delta below the silhouette have their centres in the volume

        V(delta) = pi delta^2 sqrt(rho x / tan alpha),   rho = r cos^3 alpha

    (the cone falls away across the section as y^2 tan alpha / 2x, a grain's disc along it as w^2 / 2 rho).
    If the grains are placed independently with number density n, the highest is too low on average by

        delta(x) = 1/2 n^(-1/2) (rho x / tan alpha)^(-1/4).

    This is more near the apex than at the toe, so that every slope is measured too flat. On cones cut out of
    dense random packings (15 to 45 degrees) the bias without this correction is -0.7 to -1.0 degree for 1,000
    grains and -0.3 to -0.5 for 4,000; with it -0.3 and -0.15. For the paper's 378,000 grains it is below 0.1.

    ``u``: places, shape (m,). ``fit``: apex and flanks, as first estimated.
    """
    slope = np.where(u < fit.apex[0], fit.left.slope, -fit.right.slope)
    # The formula diverges on the axis; half a grain is the least distance of a grain beside it.
    away = np.maximum(np.abs(u - fit.apex[0]) / mean_diameter, 0.5)
    number_density = SOLID_FRACTION / (np.pi / 6)
    curvature = 0.5 * (1.0 + slope**2) ** -1.5
    deficit = 0.5 * number_density**-0.5 * (curvature * away / slope) ** -0.25
    return np.asarray(mean_diameter * deficit)


SELECTIONS = 5
"""Times that the points between the cuts are chosen anew by the fitted lines."""


@dataclass(frozen=True, eq=False)
class Section:
    """The evaluation of one vertical plane.

    - ``azimuth``: degrees from the x axis: 0 is x-z, 90 is y-z.
    - ``profile``: the surface.
    - ``used``: whether a point is within the regression range, shape (m,).
    - ``low``, ``high``: the cuts, as heights above the base.
    - ``asymmetric``, ``symmetric``: the fitted models.
    - ``uncorrected``: asymmetric angle in degrees before the correction for particle size.
    - ``curvature``: of the left and the right flank: how much steeper it is at its foot than at its top, in
      units of its slope; 0 for a straight one.
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
    "pile",
    "too few particles",
    "layer",
    "column stands",
    "no flanks",
    "concave",
    "convex",
    "scattered",
    "no surface",
    "too few moments",
]
"""Classification of particles at rest."""


class NotAPileError(InputError):
    """The particles form no heap whose angle could be measured.

    ``sentence``: reason, for the user. ``status``: reason, for programs and tables.

    ``base``: level of the plate. ``profiles``, ``sections``: the surface at each azimuth, and what could be
    fitted: as far as the evaluation came.
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

    ``azimuth``: in degrees.

    Raises NotAPileError if the particles form a layer, a standing column, or a surface without two straight
    flanks.
    """
    _check_shape(profile, mean_diameter, settings)
    low = max(settings.cut_bottom * profile.top, settings.toe * mean_diameter)
    high = (1.0 - settings.cut_top) * profile.top
    used = flank_points(profile, low, high)
    fit = _fit_flanks(profile, used, mean_diameter, settings)
    for _ in range(SELECTIONS):
        if fit is None:
            break
        # Lines choose points and points give lines; two selections may alternate, hence the limit of rounds.
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
                N_("The particles form a layer {height} mean diameters high; a heap has at least {needed}."),
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
