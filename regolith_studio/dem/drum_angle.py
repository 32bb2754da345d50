"""The dynamic angle of repose in a rotating drum: slope of the free surface, upper and lower angle."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.stats import norm, theilslopes

from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.rotating_drum import RUN_UP, rotation_of
from regolith_studio.dem.snapshot import TURN, ParticleState
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_, Message, Number

CELL, STRIP = 0.5, 2.0
"""Width of a cell along the surface and along the axis, in mean diameters: the surface at a place is the
median over strips, so that single grains that fly count little."""
MIDDLE = 0.6
"""Part of the surface, about its middle, through which the line is fitted: it curves near the wall."""
MIN_CELLS, MIN_MOMENTS = 8, 10
LEVELLED = 0.01
"""Slope below which the frame of the surface needs no further turn."""
MAX_UNSEEN = 1.1
"""Moments over those that have a surface, above which there is no angle."""
MIN_SWING = 1.0
"""Degrees by which the angle must fall and rise, at least, for an avalanche."""
NOISE_SWING = 4.0
"""The same in standard deviations of the measurement of a moment."""
MIN_AVALANCHES = 4
MAX_BEND = 6.0
"""Degrees between the two ends of the fitted part above which the surface is called curved."""
MAX_SLIP = 0.1
"""Part of the wall's speed by which grains at the wall may lag behind it."""
CONFIDENCE, N_RESAMPLES = 0.95, 2000
Interval = tuple[float, float]


@dataclass(frozen=True, eq=False)
class DrumMeasurement:
    """Angles of the surface in a rotating drum, in degrees; intervals of 95 %.

    - ``angle``, ``interval``: mean over the moments; the interval is a bootstrap of blocks, since moments
      that follow each other are alike.
    - ``upper``, ``lower``: mean angle at which avalanches begin and end, with interval; ``None`` where
      there are too few.
    - ``n_avalanches``: number of falls of the angle.
    - ``times``, ``angles``: of the moments: seconds and degrees, shape (m,).
    - ``bend``: mean difference of the slope at the upper and the lower end of the fitted part.
    - ``slip``: part of the wall's speed by which grains at the wall lag behind it.
    - ``froude``: centripetal over gravitational acceleration at the wall.
    - ``warnings``: sentences.
    """

    angle: float
    interval: Interval
    upper: tuple[float, Interval] | None
    lower: tuple[float, Interval] | None
    n_avalanches: int
    times: FloatArray
    angles: FloatArray
    bend: float
    slip: float
    froude: float
    warnings: tuple[str, ...] = ()


def measure_drum(prepared: PreparedCase, moments: Iterable[ParticleState]) -> DrumMeasurement:
    """Evaluate the moments of a run that has turned its drum, in the order of time.

    Raises NotAPileError if there is no surface to measure.
    """
    test, drum = prepared.case.test, rotation_of(prepared)
    period = 60.0 / drum.rpm
    times, surfaces, slips = [], [], []
    begun, before, problem = None, None, None
    for state in moments:
        if state.phase != TURN:
            continue
        begun = state.time if begun is None else begun
        if state.time - begun < RUN_UP * period:
            continue
        try:
            surfaces.append(surface_slope(state.points, state.diameters, test.diameter / 2))
        except NotAPileError as refusal:
            problem = refusal
        else:
            times.append(state.time)
        if before is not None:
            slips.append(wall_slip(before, state, drum.angular_speed, test))
        before = state
    if problem is not None and len(slips) + 1 > MAX_UNSEEN * len(times):
        raise problem
    if len(times) < MIN_MOMENTS:
        template = N_("The surface was seen at {count} moments; at least {needed} are needed.")
        raise NotAPileError(Message(template, count=len(times), needed=MIN_MOMENTS), "too few moments")
    angles, bends = np.array(surfaces).T
    upper, lower = avalanches(angles)
    falls = min(len(upper), len(lower))
    bend, slip = float(bends.mean()), float(np.median(slips))
    enough = falls >= MIN_AVALANCHES
    return DrumMeasurement(
        angle=float(angles.mean()),
        interval=block_bootstrap(angles),
        upper=_mean_of(upper) if enough else None,
        lower=_mean_of(lower) if enough else None,
        n_avalanches=falls,
        times=np.array(times),
        angles=angles,
        bend=bend,
        slip=slip,
        froude=drum.froude(test),
        warnings=tuple(_warnings(falls, bend, slip)),
    )


def surface_slope(points: FloatArray, diameters: FloatArray, radius: float) -> tuple[float, float]:
    """Angle in degrees of the surface of a bed in a drum, and how much steeper its upper end is.

    Theil and Sen's line through the surface, in the middle of the chord that it makes itself.

    ``points``: centres, shape (n, 3), z up; the drum's axis is x = 0, z = radius.

    Raises NotAPileError if there is no surface.
    """
    offsets = points - np.array([0.0, 0.0, radius])
    middle = offsets.mean(axis=0)
    angle, bend = float(np.arctan2(middle[0], -middle[2])), 0.0  # a bed hangs at right angles to its surface
    for _ in range(4):
        turned = Rotation.from_euler("y", angle).apply(offsets)  # so that the surface is level
        x, z = free_surface(turned, diameters)
        half = MIDDLE * radius
        for _ in range(2):
            used = np.abs(x) <= half
            if np.count_nonzero(used) < MIN_CELLS:
                template = N_("The bed has no free surface of {count} or more cells of half a diameter.")
                raise NotAPileError(Message(template, count=MIN_CELLS), "no surface")
            half = MIDDLE * float(np.sqrt(max(radius**2 - np.median(z[used]) ** 2, 0.0)))
        slope = theilslopes(z[used], x[used])[0]
        curve = np.polynomial.Polynomial.fit(x[used], z[used], 2).deriv()
        ends = np.degrees(np.arctan(curve(np.array([x[used].min(), x[used].max()]))))
        angle, bend = angle + float(np.arctan(slope)), float(ends[1] - ends[0])
        if abs(slope) < LEVELLED:
            break
    return float(np.degrees(angle)), bend


def free_surface(points: FloatArray, diameters: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places along x and heights of the surface, shape (m,) each, from the tops of the highest grains."""
    mean = float(diameters.mean())
    width, radii = CELL * mean, diameters / 2
    strips = np.floor((points[:, 1] - points[:, 1].min()) / (STRIP * mean)).astype(np.int64)
    first = np.floor(points[:, 0].min() / width) - np.ceil(radii.max() / width)
    cells = np.floor(points[:, 0] / width - first).astype(np.int64)
    reach = int(np.ceil(radii.max() / width))
    tops = np.full((strips.max() + 1, cells.max() + reach + 1), np.nan)
    for shift in range(-reach, reach + 1):
        away = (cells + shift + first + 0.5) * width - points[:, 0]
        over = np.abs(away) < radii
        heights = points[over, 2] + np.sqrt(radii[over] ** 2 - away[over] ** 2)
        np.fmax.at(tops, (strips[over], cells[over] + shift), heights)
    known = np.isfinite(tops).mean(axis=0) >= 0.5
    places = (np.arange(tops.shape[1]) + first + 0.5) * width
    return places[known], np.nanmedian(tops[:, known], axis=0)


def wall_slip(before: ParticleState, after: ParticleState, speed: float, test: LiftingCylinderTest) -> float:
    """Part of the wall's speed by which grains that touch it in both moments lag behind it, by the median."""
    centre = np.array([0.0, test.diameter / 2])
    early, late = before.points[:, ::2] - centre, after.points[:, ::2] - centre
    # a grain that touches the wall has its centre half a diameter inside; a quarter more is let pass
    reach = test.diameter / 2 - 0.75 * after.diameters
    near = (
        (np.linalg.norm(early, axis=1) > reach) & (np.linalg.norm(late, axis=1) > reach) & (early[:, 1] < 0)
    )
    if not near.any():
        return 0.0
    turned = np.arctan2(
        early[near, 0] * late[near, 1] - early[near, 1] * late[near, 0],
        (early[near] * late[near]).sum(axis=1),
    )
    return float(1.0 - np.median(turned) / (speed * (after.time - before.time)))


def avalanches(angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Maxima from which the angle falls, and minima from which it rises, shape (k,) and (l,).

    Falls and rises count that exceed the larger of :data:`MIN_SWING` and
    :data:`NOISE_SWING` times the noise, which is known from second differences.
    """
    second = np.diff(angles, 2)
    # 0.6745: median deviation of a normal distribution in its standard deviation; 6 = 1 + 4 + 1: variance
    # of a second difference of independent values in theirs
    noise = float(np.median(np.abs(second)) / 0.6745 / np.sqrt(6.0)) if len(second) else 0.0
    swing = max(MIN_SWING, NOISE_SWING * noise)
    maxima: list[float] = []
    minima: list[float] = []
    rising: bool | None = None
    low = high = float(angles[0])
    for angle in angles.tolist():
        low, high = min(low, angle), max(high, angle)
        if rising is not False and high - angle >= swing:
            maxima += [high] if rising else []
            rising, low = False, angle
        elif rising is not True and angle - low >= swing:
            minima += [] if rising is None else [low]
            rising, high = True, angle
    return np.array(maxima), np.array(minima)


def block_bootstrap(values: FloatArray) -> Interval:
    """Interval of a mean of values that depend on those before them, by resampled blocks on a circle.

    Blocks are four times as long as the values' correlation, at least 1 and at most a quarter of all.
    """
    n = len(values)
    centred = values - values.mean()
    variance = float(centred @ centred)
    length = 1
    if variance > 0.0:
        correlation = np.correlate(centred, centred, "full")[n - 1 :] / variance
        negative = np.flatnonzero(correlation <= 0.0)
        known = correlation[1 : negative[0] if len(negative) else n]
        # later correlations are left out: beyond the first that is not positive they are noise
        length = int(np.clip(np.ceil(4.0 * (0.5 + known.sum())), 1, max(1, n // 4)))
    generator = np.random.default_rng(0)
    starts = generator.integers(0, n, (N_RESAMPLES, -(-n // length)))
    picks = (starts[:, :, None] + np.arange(length)).reshape(N_RESAMPLES, -1)[:, :n] % n
    low, high = np.quantile(values[picks].mean(axis=1), [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return float(low), float(high)


def _mean_of(extremes: FloatArray) -> tuple[float, Interval]:
    return float(extremes.mean()), block_bootstrap(extremes)


def _warnings(falls: int, bend: float, slip: float) -> list[str]:
    sentences: list[str] = []
    if falls < MIN_AVALANCHES:
        template = N_(
            "{count} avalanches are too few for an upper and a lower angle: turn longer, unless the "
            "surface flows steadily."
        )
        sentences.append(Message(template, count=falls))
    if abs(bend) > MAX_BEND:
        template = N_(
            "The surface is curved, by {bend} degrees over its middle; the angle is that of the middle."
        )
        sentences.append(Message(template, bend=Number(bend, ".0f")))
    if slip > MAX_SLIP:
        template = N_("The bed slips on the wall: grains there lag behind it by {slip} % of its speed.")
        sentences.append(Message(template, slip=Number(100 * slip, ".0f")))
    return sentences


def compare_angles(simulated: float, interval: Interval, angle: float, error: float) -> dict[str, Any]:
    """The simulated less a measured dynamic angle of standard error `error`, with interval, in degrees."""
    quantile = float(norm.ppf(0.5 + CONFIDENCE / 2))
    half = float(np.hypot(np.ptp(interval) / 2, quantile * error))
    difference = simulated - angle
    return {
        "angle_deg": angle,
        "standard_error_deg": error,
        "difference_deg": difference,
        "interval_deg": [difference - half, difference + half],
    }


def drum_document(measurement: DrumMeasurement) -> dict[str, Any]:
    """The measurement as plain JSON; angles in degrees, times in seconds."""

    def mean(value: tuple[float, Interval] | None) -> dict[str, Any] | None:
        return None if value is None else {"mean_deg": value[0], "interval_deg": list(value[1])}

    return {
        "status": "drum",
        "angle_deg": measurement.angle,
        "interval_deg": list(measurement.interval),
        "upper": mean(measurement.upper),
        "lower": mean(measurement.lower),
        "n_avalanches": measurement.n_avalanches,
        "froude": measurement.froude,
        "bend_deg": measurement.bend,
        "wall_slip": measurement.slip,
        "times_s": measurement.times.round(6).tolist(),
        "angles_deg": measurement.angles.round(4).tolist(),
        "confidence": CONFIDENCE,
        "warnings": list(measurement.warnings),
    }


def drum_in_words(document: dict[str, Any]) -> str:
    """The measurement in lines for a terminal."""
    low, high = document["interval_deg"]
    lines = [
        f"dynamic angle        {document['angle_deg']:.1f} deg ({low:.1f} to {high:.1f}, "
        f"{100 * document['confidence']:g} % interval, {len(document['angles_deg'])} moments, Froude number "
        f"{document['froude']:.2g})"
    ]
    for name, what in (("upper", "begin"), ("lower", "end")):
        if (angle := document[name]) is not None:
            low, high = angle["interval_deg"]
            lines.append(
                f"avalanches {what:10}{angle['mean_deg']:.1f} deg ({low:.1f} to {high:.1f}, "
                f"{document['n_avalanches']} avalanches)"
            )
    return "\n".join(lines)
