"""Boxes along the Gauss arc of one edge: the arc between the normals of the two facets that meet there.

A side of a locally minimal box is flush with an edge, so its normal lies on the edge's arc (O'Rourke 1985).
Along an arc the volume is piecewise smooth; a minimum lies where its slope turns from falling to rising.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box import Scratch, Solid, Touch, box_at, from_to, slope_at, turned_frame
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import Vector, dot, length, mixed, row

BESIDE = 1e-7
SAME_SIDE = 0.99
STATIONARY, ON_FACET, SEVERAL = -1, -2, -3
"""In place of the slot of a third contact: none, the volume is stationary along the arc; or the second side
rests on a facet, and that facet's own box is the same; or more than one contact changes at once."""


class Arc(NamedTuple):
    """Normals cos(t) one + sin(t) across between two facets, 0 <= t <= angle; the edge (start, end)."""

    one: Vector
    across: Vector
    angle: float
    start: int
    end: int


class ArcSample(NamedTuple):
    """Angle, log volume and slope (3,) of a box on an arc, and its piece (7,)."""

    number: FloatArray
    piece: IntArray


class Spare(NamedTuple):
    """Memory for :func:`arc_minimum`."""

    low: ArcSample
    high: ArcSample
    here: ArcSample


def empty_sample() -> ArcSample:
    """A sample to be filled."""
    return ArcSample(np.zeros(3), np.zeros(7, np.int64))


def spare_samples() -> Spare:
    """Three samples to be filled."""
    return Spare(empty_sample(), empty_sample(), empty_sample())


@kernel_noalloc
def copied(source: ArcSample, target: ArcSample) -> None:
    """Copy a sample."""
    for c in range(3):
        target.number[c] = source.number[c]
    for c in range(7):
        target.piece[c] = source.piece[c]


@kernel_noalloc
def arc_between(solid: Solid, e: int) -> Arc:
    """Gauss arc of edge e."""
    one, two = row(solid.normals, solid.edges[e, 2]), row(solid.normals, solid.edges[e, 3])
    cosine = min(1.0, max(-1.0, dot(one, two)))
    across = mixed(two, 1.0, one, -cosine)
    sine = length(across)
    if sine > 0.0:
        across = mixed(across, 1.0 / sine, across, 0.0)
    return Arc(one, across, np.arctan2(sine, cosine), solid.edges[e, 0], solid.edges[e, 1])


@kernel_noalloc
def box_on_arc(
    arc: Arc, angle: float, solid: Solid, limit: float, scratch: Scratch, touch: Touch, sample: ArcSample
) -> float:
    """Volume of the box at an angle of the arc; fills `touch` and `sample`."""
    cosine, sine = np.cos(angle), np.sin(angle)
    axis = mixed(arc.one, cosine, arc.across, sine)
    turn = mixed(arc.across, cosine, arc.one, -sine)
    volume = box_at(axis, solid, limit, scratch, touch)
    sample.number[0], sample.number[1], sample.number[2] = angle, np.inf, 0.0
    if volume < np.inf:
        touch.piece[0] = arc.start
        sample.number[1] = np.log(volume)
        sample.number[2] = slope_at(turn, solid, touch)
        for c in range(7):
            sample.piece[c] = touch.piece[c]
    return volume


@kernel_noalloc
def worth_a_look(one: ArcSample, two: ArcSample, limit: float) -> bool:
    """Whether the volume turns from falling to rising, and the tangents meet below `limit`."""
    if not (one.number[2] < 0.0 and two.number[2] > 0.0):
        return False
    lowest = one.number[1] + one.number[2] * (meeting(one, two) - one.number[0])
    return bool(lowest <= np.log(limit))


@kernel_noalloc
def meeting(one: ArcSample, two: ArcSample) -> float:
    """Angle at which the tangents of the log volume meet."""
    gap = two.number[0] - one.number[0]
    rise = two.number[1] - one.number[1]
    return float(one.number[0] + (rise - two.number[2] * gap) / (one.number[2] - two.number[2]))


@kernel_noalloc
def arc_minimum(
    arc: Arc, one: ArcSample, two: ArcSample, solid: Solid, scratch: Scratch, touch: Touch, spare: Spare
) -> tuple[int, int, float]:
    """Minimum of the volume between two samples of an arc, where the slope turns from falling to rising.

    Secant steps on the slope where both ends belong to the same piece; where they differ in one vertex, the
    angle at which the two vertices tie; else the meeting point of the two tangents. The angle is found to
    about 1e-7. Fills `touch`.

    Returns
    -------
    slot
        Slot of the piece that has a third contact, STATIONARY or ON_FACET.
    partner
        For a third contact, the vertex that ties with that of the piece.
    volume
        At the minimum.
    """
    low, high, here = spare.low, spare.high, spare.here
    copied(one, low)
    copied(two, high)
    volume, smallest = np.inf, (two.number[0] - one.number[0]) / 8.0
    for _ in range(40):
        gap = high.number[0] - low.number[0]
        slot = differing_slot(low.piece, high.piece)
        if slot == STATIONARY:
            angle = low.number[0] - low.number[2] * gap / (high.number[2] - low.number[2])
        elif slot >= 0:
            tie = tie_angle(arc, slot, low.piece[slot], high.piece[slot], low, solid.vertices)
            angle = tie - BESIDE if low.number[0] < tie - 1.5 * BESIDE else tie + BESIDE
        else:
            angle = meeting(low, high)
        guard = 0.0 if slot == STATIONARY else 0.2 * min(BESIDE, gap)
        if not (low.number[0] + guard <= angle <= high.number[0] - guard):
            angle = 0.5 * (low.number[0] + high.number[0])
        volume = box_on_arc(arc, angle, solid, np.inf, scratch, touch, here)
        end = low if here.number[2] < 0.0 else high
        copied(here, end)
        gap = high.number[0] - low.number[0]
        if abs(here.number[2]) < 1e-8 or gap < 3.0 * BESIDE:
            break
        if (
            gap < smallest
            and differing_slot(low.piece, high.piece) == ON_FACET
            and same_side(low.piece, high.piece, touch.frame[0], solid.vertices)
        ):
            return ON_FACET, -1, volume
    if abs(here.number[2]) < 1e-6:
        return STATIONARY, -1, volume
    slot = differing_slot(low.piece, high.piece)
    if slot < 0:
        return STATIONARY, -1, volume
    return slot, low.piece[slot] if here.piece[slot] == high.piece[slot] else high.piece[slot], volume


@kernel_noalloc
def differing_slot(one: IntArray, two: IntArray) -> int:
    """The slot in which two pieces differ, or STATIONARY (none), ON_FACET (flush edge), SEVERAL."""
    if one[2] != two[2] or one[3] != two[3]:
        return ON_FACET
    found = STATIONARY
    for slot in (1, 4, 5, 6):
        if one[slot] != two[slot]:
            if found != STATIONARY:
                return SEVERAL
            found = slot
    return found


@kernel_noalloc
def same_side(one: IntArray, two: IntArray, axis: FloatArray, vertices: FloatArray) -> bool:
    """Whether the flush edges of two pieces lie in the same side of the box, as on a facet along `axis`."""
    dot, first, second = 0.0, 0.0, 0.0
    for c in range(3):
        i, j = (c + 1) % 3, (c + 2) % 3
        u = (vertices[one[3], i] - vertices[one[2], i]) * axis[j]
        u -= (vertices[one[3], j] - vertices[one[2], j]) * axis[i]
        v = (vertices[two[3], i] - vertices[two[2], i]) * axis[j]
        v -= (vertices[two[3], j] - vertices[two[2], j]) * axis[i]
        dot, first, second = dot + u * v, first + u * u, second + v * v
    return bool(dot > SAME_SIDE * np.sqrt(first * second))


@kernel_noalloc
def tie_angle(arc: Arc, slot: int, i: int, j: int, sample: ArcSample, vertices: FloatArray) -> float:
    """Angle near a sample at which vertices i and j lie in one side of the box, by the secant method."""
    edge, apart = from_to(vertices, sample.piece[2], sample.piece[3]), from_to(vertices, j, i)
    before, angle, last = 0.0, sample.number[0], 0.0
    for k in range(8):
        axis = mixed(arc.one, np.cos(angle), arc.across, np.sin(angle))
        _, second, third = turned_frame(axis, edge)
        residual = dot(axis, apart) if slot == 1 else (dot(second, apart) if slot == 4 else dot(third, apart))
        if k == 0:
            last, before, angle = angle, residual, angle + 1e-3
            continue
        if residual == before or abs(residual) < 1e-13:
            break
        step = -residual * (angle - last) / (residual - before)
        last, before = angle, residual
        angle += min(0.5, max(-0.5, step))
    return float(angle)
