"""The angle of repose of particles at rest: :func:`measure_repose` (section 3.3)."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.dem.evaluation.errors import HEAP_SHARE, NotAPileError
from regolith_studio.dem.evaluation.profile import base_level, project, surface_profile
from regolith_studio.dem.evaluation.section import Section, evaluate_section
from regolith_studio.dem.evaluation.settings import EvaluationSettings
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray

RELIABLE_N = 1000
"""Number of particles above which the bias of the evaluation is below half a degree."""


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
        The first is x-z, the second y-z, further azimuths follow.
    paper_asymmetric, paper_symmetric
        Over the two sections of the paper: four flanks, two roofs.
    asymmetric, symmetric
        Over all sections.
    interval
        Bootstrap interval of the asymmetric mean over all sections.
    n_particles, mean_diameter, height, width, base
        Of the pile; `height` and `width` averaged over the sections, `base` is the level of the plate.
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


def measure_repose(
    points: ArrayLike,
    diameters: ArrayLike,
    settings: EvaluationSettings | None = None,
    base: float | None = None,
) -> ReposeMeasurement:
    """Evaluate the surface of a pile at rest.

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
    if len(where) < settings.min_particles:
        raise NotAPileError(
            f"{len(where)} particles are too few for a pile; at least {settings.min_particles} are needed.",
            "too few particles",
        )
    mean_diameter = float(sizes.mean())
    level = base_level(where, sizes) if base is None else base
    warnings: list[str] = []
    sections: list[Section] = []
    azimuths = azimuths_of(settings)
    for number, azimuth in enumerate(azimuths):
        try:
            sections.append(_section(where, sizes, level, azimuth, mean_diameter, settings))
        except NotAPileError as refusal:
            if number < 2:
                raise
            warnings.append(f"Left out: {refusal}")
    if len(where) < RELIABLE_N:
        warnings.append(
            f"{len(where)} particles make a coarse pile; from {RELIABLE_N} on the angle is reliable."
        )
    return _summary(sections, len(azimuths), len(where), mean_diameter, level, settings, warnings)


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


def _section(
    points: FloatArray,
    diameters: FloatArray,
    base: float,
    azimuth: float,
    mean_diameter: float,
    settings: EvaluationSettings,
) -> Section:
    discs = project(points, diameters, base, np.radians(azimuth), settings.slab * mean_diameter)
    if not len(discs.u):
        raise NotAPileError(f"The slice at {azimuth:g} degrees holds no particle.", "scattered")
    profile = surface_profile(discs, mean_diameter, settings)
    inside = (discs.u >= profile.u[profile.first]) & (discs.u <= profile.u[profile.last])
    if inside.mean() < HEAP_SHARE:
        raise NotAPileError(
            f"The particles lie scattered: only {100 * inside.mean():.0f} % of them are in the heap.",
            "scattered",
        )
    return evaluate_section(profile, azimuth, mean_diameter, settings)


def _summary(
    sections: Sequence[Section],
    n_asked: int,
    n_particles: int,
    mean_diameter: float,
    base: float,
    settings: EvaluationSettings,
    warnings: Sequence[str],
) -> ReposeMeasurement:
    by_azimuth = sorted(sections, key=lambda section: section.azimuth)
    around = np.array(
        [each.asymmetric.right.angle for each in by_azimuth]
        + [each.asymmetric.left.angle for each in by_azimuth]
    )
    if len(sections) < n_asked / 2:
        raise NotAPileError(
            f"Only {len(sections)} of {n_asked} sections through the heap have two straight flanks."
        )
    return ReposeMeasurement(
        sections=tuple(sections),
        paper_asymmetric=_spread(_flanks(sections[:2])),
        paper_symmetric=_spread([each.symmetric.angle for each in sections[:2]]),
        asymmetric=_spread(_flanks(sections)),
        symmetric=_spread([each.symmetric.angle for each in sections]),
        interval=bootstrap_interval(around, settings.confidence, settings.seed),
        n_particles=n_particles,
        mean_diameter=mean_diameter,
        height=float(np.mean([each.profile.top for each in sections])),
        width=float(np.mean([each.profile.width for each in sections])),
        base=base,
        settings=settings,
        warnings=tuple(warnings),
    )


def _flanks(sections: Sequence[Section]) -> list[float]:
    return [flank.angle for each in sections for flank in (each.asymmetric.left, each.asymmetric.right)]


def _spread(angles: Sequence[float]) -> Spread:
    return Spread(float(np.mean(angles)), float(np.std(angles, ddof=1)) if len(angles) > 1 else 0.0)


def measurement_document(measurement: ReposeMeasurement) -> dict[str, Any]:
    """The measurement as plain JSON; angles in degrees, lengths in the unit of the positions."""
    return {
        "status": "pile",
        "angle_deg": measurement.angle,
        "interval_deg": list(measurement.interval),
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


RESAMPLES = 2000
NEIGHBOURHOOD = 45.0
"""Size of a block in degrees: sections closer than this contain largely the same particles."""


def bootstrap_interval(flanks: FloatArray, confidence: float, seed: int) -> tuple[float, float]:
    """Interval of the mean angle by a circular block bootstrap.

    Parameters
    ----------
    flanks
        Angle of the flank in each of equally spaced directions around the full circle, shape (k,);
        neighbours are correlated, hence the blocks.
    confidence
        Such as 0.95.

    Returns
    -------
    tuple
        Lower and upper end.
    """
    n = len(flanks)
    block = max(1, min(n, round(NEIGHBOURHOOD / 360.0 * n)))
    generator = np.random.default_rng(np.random.SeedSequence(seed))
    starts = generator.integers(n, size=(RESAMPLES, -(-n // block)))
    picks = ((starts[:, :, None] + np.arange(block)) % n).reshape(RESAMPLES, -1)[:, :n]
    tail = (1.0 - confidence) / 2
    low, high = np.quantile(flanks[picks].mean(axis=1), [tail, 1.0 - tail])
    return float(low), float(high)
