"""The angle of repose of particles at rest: :func:`measure_repose` (section 3.3)."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import t as student_t

from regolith_studio.dem.evaluation import HEAP_SHARE, MAX_CURVATURE, EvaluationSettings
from regolith_studio.dem.evaluation.profile import Profile, base_level, project, surface_profile
from regolith_studio.dem.evaluation.section import NotAPileError, Section, evaluate_section
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_, Message, Number

RELIABLE_N = 1000
"""Number of particles above which the bias of the evaluation is below half a degree."""
COARSE_PILE = Message(
    N_(
        "Fewer than {count} particles: the cut at the toe changes the angle by some degrees, included in the "
        "interval."
    ),
    count=Number(RELIABLE_N, ","),
)
"""Said of smaller heaps, before a run and with the angle."""
LEFT_OUT = N_("Left out: {reason}")
CONVEX = N_("Convex flanks: {top} degrees at the top, {toe} degrees at the toe; no single angle.")
CONCAVE = N_("Concave flanks: {top} degrees at the top, {toe} degrees at the toe; no single angle.")
ROUGH_SHARE = 0.3
"""Part of the scatter of a flank about its line by which a rough surface seems to rise from tip to toe, where
the silhouette is the highest of more grains. Measured: 0.28, on noisy cones of 5,000 balls."""
PAPER_AZIMUTHS = (0.0, 90.0)
"""Degrees of x-z and y-z."""
NO_TIP = N_(
    "The section at {azimuths} degrees has no two flanks: its two lines do not meet at a tip between them."
)
NO_TIPS = N_(
    "The sections at {azimuths} degrees have no two flanks: their two lines do not meet at a tip between "
    "them."
)
NOT_ROUND = N_(
    "The x-z and the y-z section give {paper} degrees, outside of the interval of all sections: "
    "the heap is not round, and its angle depends on the direction."
)


@dataclass(frozen=True)
class Spread:
    """Mean and standard deviation of angles, in degrees."""

    mean: float
    deviation: float


@dataclass(frozen=True, eq=False)
class ReposeMeasurement:
    """Angle of repose of one pile. Angles in degrees, lengths in the unit of the positions.

    Parameters
    ----------
    sections
        Those that have two flanks: x-z and y-z first, further azimuths follow.
    paper_asymmetric, paper_symmetric
        Over those of the paper's two sections that have two flanks.
    asymmetric, symmetric
        Over all sections.
    interval
        Of the asymmetric mean over all sections: Student's, from the scatter of the flanks, widened in
        quadrature by `cut_shift` and by the tilt of a rough surface (:data:`ROUGH_SHARE`).
    cut_shift
        Largest change of the angle when the lower cut is a third lower or higher.
    n_particles, mean_diameter, height, width, base
        Of the heap; `height` and `width` averaged over the sections, `base` is the level of the plate.
    settings
        Of the evaluation.
    warnings
        Sentences.
    """

    sections: tuple[Section, ...]
    paper_asymmetric: Spread
    paper_symmetric: Spread
    asymmetric: Spread
    symmetric: Spread
    interval: tuple[float, float]
    cut_shift: float
    n_particles: int
    mean_diameter: float
    height: float
    width: float
    base: float
    settings: EvaluationSettings
    warnings: tuple[str, ...] = ()

    @property
    def angle(self) -> float:
        """The asymmetric mean over all sections."""
        return self.asymmetric.mean

    def section_at(self, azimuth: float) -> Section | None:
        """The section at an azimuth in degrees, or ``None`` if it has no two flanks."""
        return next((each for each in self.sections if each.azimuth == azimuth), None)


def measure_repose(
    points: ArrayLike,
    diameters: ArrayLike,
    settings: EvaluationSettings | None = None,
    base: float | None = None,
) -> ReposeMeasurement:
    """Evaluate the surface of a heap at rest.

    Parameters
    ----------
    points
        Centres, shape (n, 3), z up, in any unit of length.
    diameters
        Equivalent diameters in the same unit, shape (n,), or one number for all.
    settings
        Parameters of the procedure.
    base
        Height of the plate; by default that of
        :func:`~regolith_studio.dem.evaluation.profile.base_level`: 0, or where the lowest particles reach to.

    Raises
    ------
    NotAPileError
        If the particles form no pile: too few, a layer, a column, scattered, without straight flanks.
    InputError
        If positions or diameters are invalid.
    """
    settings = settings or EvaluationSettings()
    where, sizes = _checked(points, diameters)
    check_number(len(where), settings)
    mean_diameter = float(sizes.mean())
    level = base_level(where, sizes) if base is None else base
    surfaces, left_out = _surfaces(where, sizes, level, mean_diameter, settings)
    fitted: list[Section] = []
    try:
        fitted, refused = _sections(surfaces, mean_diameter, settings)
        _check_straightness(fitted)
        sections, paper = _two_flanked(fitted, settings)
    except NotAPileError as refusal:
        refusal.base, refusal.profiles, refusal.sections = level, surfaces, tuple(fitted)
        raise
    warnings = [*left_out, *refused, *_without_tip([each for each in fitted if not each.has_tip])]
    if len(where) < RELIABLE_N:
        warnings.append(COARSE_PILE)
    flanks = _flanks(sections)
    shift = _cut_shift(sections, surfaces, mean_diameter, settings)
    terms = (standard_interval(flanks, settings.confidence), shift, rough_tilt(sections))
    half_width = float(np.linalg.norm(terms))
    if len(paper) == 2 and abs(np.mean(_flanks(paper)) - np.mean(flanks)) > half_width:
        warnings.append(Message(NOT_ROUND, paper=Number(float(np.mean(_flanks(paper))), ".1f")))
    return ReposeMeasurement(
        sections=tuple(sections),
        paper_asymmetric=_spread(_flanks(paper)),
        paper_symmetric=_spread([each.symmetric.angle for each in paper]),
        asymmetric=_spread(flanks),
        symmetric=_spread([each.symmetric.angle for each in sections]),
        interval=(float(np.mean(flanks)) - half_width, float(np.mean(flanks)) + half_width),
        cut_shift=shift,
        n_particles=len(where),
        mean_diameter=mean_diameter,
        height=float(np.mean([each.profile.top for each in sections])),
        width=float(np.mean([each.profile.width for each in sections])),
        base=level,
        settings=settings,
        warnings=tuple(warnings),
    )


def check_number(n: int, settings: EvaluationSettings) -> None:
    """Check before or after a run that there are enough particles.

    Raises NotAPileError if there are not.
    """
    if n < settings.min_particles:
        raise NotAPileError(
            Message(
                N_("{count} particles are too few for a heap; at least {needed} are needed."),
                count=n,
                needed=settings.min_particles,
            ),
            "too few particles",
        )


def azimuths_of(settings: EvaluationSettings) -> list[float]:
    """Degrees of the sections: x-z and y-z first, then the others in ascending order."""
    all_of_them = [180.0 * k / settings.azimuths for k in range(settings.azimuths)]
    return [0.0, 90.0, *(each for each in all_of_them if each not in (0.0, 90.0))]


def _checked(points: ArrayLike, diameters: ArrayLike) -> tuple[FloatArray, FloatArray]:
    where = np.asarray(points, dtype=np.float64)
    if where.ndim != 2 or where.shape[1] != 3 or not np.isfinite(where).all():
        raise InputError(f"Positions must be finite and have the shape (n, 3), got {where.shape}.")
    sizes = np.asarray(diameters, dtype=np.float64)
    if sizes.shape not in ((), (len(where),)) or not (np.isfinite(sizes) & (sizes > 0.0)).all():
        raise InputError("Diameters must be positive and finite, one a particle or one for all.")
    return where, np.broadcast_to(sizes, (len(where),)).astype(np.float64)


def _surfaces(
    points: FloatArray, diameters: FloatArray, base: float, mean_diameter: float, settings: EvaluationSettings
) -> tuple[dict[float, Profile], list[str]]:
    """The surface at each azimuth, x-z and y-z first, and why others are left out."""
    surfaces: dict[float, Profile] = {}
    left_out: list[str] = []
    for azimuth in azimuths_of(settings):
        try:
            surfaces[azimuth] = _surface(points, diameters, base, azimuth, mean_diameter, settings)
        except NotAPileError as refusal:
            if azimuth in PAPER_AZIMUTHS:
                raise
            left_out.append(Message(LEFT_OUT, reason=refusal.sentence))
    return surfaces, left_out


def _surface(
    points: FloatArray,
    diameters: FloatArray,
    base: float,
    azimuth: float,
    mean_diameter: float,
    settings: EvaluationSettings,
) -> Profile:
    discs = project(points, diameters, base, np.radians(azimuth), settings.slab * mean_diameter)
    if not len(discs.u):
        template = N_("The slice at {azimuth} degrees contains no particle.")
        raise NotAPileError(Message(template, azimuth=Number(azimuth, "g")), "scattered")
    profile = surface_profile(discs, mean_diameter, settings)
    inside = (discs.u >= profile.u[profile.first]) & (discs.u <= profile.u[profile.last])
    if inside.mean() < HEAP_SHARE:
        raise NotAPileError(
            Message(
                N_("The particles are scattered: only {share} % of them are in the heap."),
                share=Number(100 * inside.mean(), ".0f"),
            ),
            "scattered",
        )
    return profile


def _sections(
    surfaces: Mapping[float, Profile], mean_diameter: float, settings: EvaluationSettings
) -> tuple[list[Section], list[str]]:
    """The fits at each azimuth, and why others are left out: all that have no two flanks."""
    sections: list[Section] = []
    left_out: list[str] = []
    for azimuth, profile in surfaces.items():
        try:
            sections.append(evaluate_section(profile, azimuth, mean_diameter, settings))
        except NotAPileError as refusal:
            if azimuth in PAPER_AZIMUTHS and refusal.status != "no flanks":
                raise
            left_out.append(Message(LEFT_OUT, reason=refusal.sentence))
    return sections, left_out


def _two_flanked(
    fitted: Sequence[Section], settings: EvaluationSettings
) -> tuple[list[Section], list[Section]]:
    """The sections with two flanks, and those of the paper among them."""
    sections = [each for each in fitted if each.has_tip]
    if len(sections) < settings.azimuths / 2:
        raise NotAPileError(
            Message(
                N_("Only {count} of {total} sections through the heap have two straight flanks."),
                count=len(sections),
                total=settings.azimuths,
            )
        )
    paper = [each for each in sections if each.azimuth in PAPER_AZIMUTHS]
    if not paper:
        raise NotAPileError(Message(N_("Neither the x-z nor the y-z section has two straight flanks.")))
    return sections, paper


def _without_tip(sections: Sequence[Section]) -> list[str]:
    """One sentence about all of these, or none."""
    azimuths = ", ".join(f"{azimuth:g}" for azimuth in sorted(each.azimuth for each in sections))
    reason = Message(NO_TIP if len(sections) == 1 else NO_TIPS, azimuths=azimuths)
    return [Message(LEFT_OUT, reason=reason)] if sections else []


def _check_straightness(sections: Sequence[Section]) -> None:
    """Refuse convex and concave flanks, where their curvature is certain."""
    if not sections:
        return
    curvatures = [each for section in sections for each in section.curvature]
    mean = float(np.mean(curvatures))
    if abs(mean) > max(MAX_CURVATURE, standard_interval(curvatures, 0.99)):
        top, toe = np.mean([section.end_angles for section in sections], axis=0)
        sentence = CONVEX if mean > 0.0 else CONCAVE
        raise NotAPileError(
            Message(sentence, top=Number(float(top), ".0f"), toe=Number(float(toe), ".0f")),
            "convex" if mean > 0.0 else "concave",
        )


def _cut_shift(
    sections: Sequence[Section],
    surfaces: Mapping[float, Profile],
    mean_diameter: float,
    settings: EvaluationSettings,
) -> float:
    """Largest change of the angle in degrees when the lower cut is a third lower or higher."""
    angle = np.mean(_flanks(sections))
    shifts = [0.0]
    for factor in (2 / 3, 4 / 3):
        # Within the limits of the settings.
        toe, bottom = min(settings.toe * factor, 10.0), min(settings.cut_bottom * factor, 0.45)
        try:
            fitted, _ = _sections(surfaces, mean_diameter, replace(settings, toe=toe, cut_bottom=bottom))
        except NotAPileError:
            continue
        others = [each for each in fitted if each.has_tip]
        if not others:
            continue
        shifts.append(abs(float(np.mean(_flanks(others)) - angle)))
    return max(shifts)


def rough_tilt(sections: Sequence[Section]) -> float:
    """Mean angle in degrees by which flanks can be tilted because their surface is rough."""
    tilts = []
    for section in sections:
        u, z, fit = section.profile.u, section.profile.height, section.asymmetric
        for line, side in ((fit.left, u < fit.break_point), (fit.right, u >= fit.break_point)):
            run = u[side & section.used]
            scatter = np.std(z[side & section.used] - line.slope * run)
            # d arctan(s) = ds / (1 + s^2).
            tilts.append(ROUGH_SHARE * scatter / np.ptp(run) / (1.0 + line.slope**2))
    return float(np.degrees(np.mean(tilts)))


def _flanks(sections: Sequence[Section]) -> list[float]:
    return [angle for each in sections for angle in each.flanks]


def _spread(angles: Sequence[float]) -> Spread:
    return Spread(float(np.mean(angles)), float(np.std(angles, ddof=1)) if len(angles) > 1 else 0.0)


def measurement_document(measurement: ReposeMeasurement) -> dict[str, Any]:
    """The measurement as plain JSON; angles in degrees, lengths in the unit of the positions."""
    return {
        "status": "pile",
        "angle_deg": measurement.angle,
        "interval_deg": list(measurement.interval),
        "cut_shift_deg": measurement.cut_shift,
        "asymmetric": _spread_document(measurement.asymmetric),
        "symmetric": _spread_document(measurement.symmetric),
        "paper_sections": {
            "asymmetric": _spread_document(measurement.paper_asymmetric),
            "symmetric": _spread_document(measurement.paper_symmetric),
        },
        "sections": [_section_document(each) for each in measurement.sections],
        "n_particles": measurement.n_particles,
        "mean_diameter": measurement.mean_diameter,
        "height": measurement.height,
        "width": measurement.width,
        "base": measurement.base,
        "settings": asdict(measurement.settings),
        "warnings": list(measurement.warnings),
    }


def _spread_document(spread: Spread) -> dict[str, float]:
    return {"mean_deg": spread.mean, "standard_deviation_deg": spread.deviation}


def _section_document(section: Section) -> dict[str, Any]:
    plane = {0.0: "x-z", 90.0: "y-z"}.get(section.azimuth)
    two, one = section.asymmetric, section.symmetric
    return {
        "azimuth_deg": section.azimuth,
        "plane": plane,
        "asymmetric": {
            "left_deg": two.left.angle,
            "right_deg": two.right.angle,
            "mean_deg": two.angle,
            "break_point": two.break_point,
            "apex": list(two.apex),
            "r_squared": two.r_squared,
        },
        "symmetric": {"angle_deg": one.angle, "apex": list(one.apex), "r_squared": one.r_squared},
        "cuts": [section.low, section.high],
        "points_used": int(section.used.sum()),
    }


NEIGHBOURHOOD = 45.0
"""Degrees within which flanks count as one: sections closer than this contain largely the same particles."""


def standard_interval(flanks: Sequence[float], confidence: float) -> float:
    """Half width of Student's interval of the mean over flanks all around.

    Of flanks at equal steps around the circle, those within :data:`NEIGHBOURHOOD` are correlated and count as
    one value.

    ``flanks``: one value a flank. ``confidence``: such as 0.95.
    """
    independent = min(len(flanks), 360.0 / NEIGHBOURHOOD)
    quantile = float(student_t.ppf((1.0 + confidence) / 2, independent - 1))
    # The deviation over n flanks (ddof 0) over sqrt(m - 1) is the standard error of the mean of m independent
    # ones.
    return quantile * float(np.std(flanks) / np.sqrt(independent - 1))
