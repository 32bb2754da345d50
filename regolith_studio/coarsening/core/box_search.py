"""All local minimum-volume boxes of a convex solid that come near the smallest (O'Rourke 1985).

A side of a locally minimal box is flush with an edge, so its normal lies on the edge's Gauss arc between
the normals of the two facets that meet there. Along an arc the volume is piecewise smooth; its minima are
found from values and slopes at samples.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box import (
    Scratch,
    Solid,
    Touch,
    box_at,
    empty_touch,
    scratch_for,
    slope_at,
)
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel

SAMPLE_ANGLE = float(np.radians(13.0))
"""Step along the arcs that misses few boxes, in radians."""
DENSE_ANGLE = float(np.radians(2.0))
"""Step that is fine enough for a verdict, in radians."""
PROMISING = 1.15
"""Normals whose box is larger than this many times the least are not looked into."""
SLACK = 1.02
NO_ARC = 1e-7
MOST = 64
"""Largest number of boxes returned."""
STATIONARY, ON_FACET = -1, -2
"""In place of the slot of a third contact: none, the volume is stationary along the arc; or the second side
rests on a facet, and that facet's own box is the same."""


class Boxes(NamedTuple):
    """Locally minimal boxes, the least first.

    Parameters
    ----------
    volumes
        Shape (k,).
    frames
        Axes as rows, shape (k, 3, 3).
    extents
        Edge lengths along the axes, shape (k, 3).
    contacts
        Slot of the third contact, the edge that is flush with the first side (from, to), the seven of the
        piece, the vertex that ties with that in the slot: shape (k, 11).
    """

    volumes: FloatArray
    frames: FloatArray
    extents: FloatArray
    contacts: IntArray


class Arc(NamedTuple):
    """Normals cos(t) one + sin(t) across between two facets, 0 <= t <= angle; the edge (start, end)."""

    one: FloatArray
    across: FloatArray
    angle: float
    start: int
    end: int


class Sample(NamedTuple):
    """Angle, log volume and slope (3,) of a box on an arc, and its piece (7,)."""

    number: FloatArray
    piece: IntArray


@kernel
def local_boxes(solid: Solid, margin: float, sample_angle: float, hint: FloatArray) -> Boxes:
    """Locally minimal boxes with a volume of at most (1 + margin) times the least.

    Parameters
    ----------
    solid
        Of a size of about 1.
    margin
        Share of the least volume.
    sample_angle
        Largest step between samples along an arc, in radians.
    hint
        An axis whose box is likely to be small, shape (3,), or zeros.
    """
    boxes = Boxes(np.empty(MOST), np.empty((MOST, 3, 3)), np.empty((MOST, 3)), np.empty((MOST, 11), np.int64))
    scratch, touch = scratch_for(solid), empty_touch()
    n = len(solid.normals)
    volumes, touches, best = boxes_on_facets(solid, scratch, hint)
    resting = np.ones(n, np.bool_)
    count = 0
    one, two = Sample(np.empty(3), np.empty(7, np.int64)), Sample(np.empty(3), np.empty(7, np.int64))
    for e in range(len(solid.edges)):
        f, g = solid.edges[e, 2], solid.edges[e, 3]
        arc = arc_between(solid, e)
        if arc.angle < NO_ARC:
            continue
        steps = max(1, int(np.ceil(arc.angle / sample_angle)))
        for i in range(steps + 1):
            known = f if i == 0 else (g if i == steps else -1)
            best = sampled(
                arc, arc.angle * i / steps, solid, best, known, volumes, touches, scratch, touch, two
            )
            if i == 0 and two.number[2] < -1e-12:
                resting[f] = False
            if i == steps and two.number[2] > 1e-12:
                resting[g] = False
            if i > 0 and worth_a_look(one, two, best * (1.0 + margin) * SLACK):
                slot, partner, volume = arc_minimum(arc, one, two, solid, scratch, touch)
                best = min(best, volume)
                if slot != ON_FACET and volume <= best * (1.0 + margin):
                    count = kept(count, boxes, volume, touch, slot, arc.start, arc.end, partner)
            one.number[:] = two.number
            one.piece[:] = two.piece
    for f in range(n):
        if resting[f] and volumes[f] <= best * (1.0 + margin):
            p, q, partner = corner_of(f, solid.edges)
            if p >= 0:
                touches[f].piece[0] = p
                count = kept(count, boxes, volumes[f], touches[f], 0, p, q, partner)
    return ranked(boxes, count, best * (1.0 + margin))


@kernel
def boxes_on_facets(
    solid: Solid, scratch: Scratch, hint: FloatArray
) -> tuple[FloatArray, list[Touch], float]:
    """Volume (infinity where too large) and box with one side on each facet, and the least volume."""
    volumes = np.full(len(solid.normals), np.inf)
    touches = [empty_touch() for _ in range(len(solid.normals))]
    best = np.inf
    if hint.any():
        best = box_at(hint, solid, np.inf, scratch, touches[0])
    for f in range(len(solid.normals)):
        if solid.areas[f] > 1e-13:
            volumes[f] = box_at(solid.normals[f], solid, PROMISING * best, scratch, touches[f])
            best = min(best, volumes[f])
    return volumes, touches, best


@kernel
def arc_between(solid: Solid, e: int) -> Arc:
    """Gauss arc of edge e."""
    one, two = solid.normals[solid.edges[e, 2]], solid.normals[solid.edges[e, 3]]
    cosine = min(1.0, max(-1.0, one[0] * two[0] + one[1] * two[1] + one[2] * two[2]))
    across = two - cosine * one
    sine = np.sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2])
    if sine > 0.0:
        across /= sine
    return Arc(one, across, np.arctan2(sine, cosine), solid.edges[e, 0], solid.edges[e, 1])


@kernel
def box_on_arc(
    arc: Arc, angle: float, solid: Solid, limit: float, scratch: Scratch, touch: Touch, sample: Sample
) -> float:
    """Volume of the box at an angle of the arc; fills `touch` and `sample`."""
    axis, turn = np.empty(3), np.empty(3)
    cosine, sine = np.cos(angle), np.sin(angle)
    for c in range(3):
        axis[c] = cosine * arc.one[c] + sine * arc.across[c]
        turn[c] = cosine * arc.across[c] - sine * arc.one[c]
    volume = box_at(axis, solid, limit, scratch, touch)
    sample.number[0], sample.number[1], sample.number[2] = angle, np.inf, 0.0
    if volume < np.inf:
        touch.piece[0] = arc.start
        sample.number[1] = np.log(volume)
        sample.number[2] = slope_at(turn, solid, touch, scratch.work)
        sample.piece[:] = touch.piece
    return volume


@kernel
def sampled(  # type: ignore[no-untyped-def]
    arc, angle, solid, best, known, volumes, touches, scratch, touch, sample
) -> float:
    """Fill `sample` at an angle of the arc, or at the facet `known` at its end; the least volume so far."""
    if known < 0:
        return min(best, box_on_arc(arc, angle, solid, PROMISING * best, scratch, touch, sample))  # type: ignore[no-any-return]
    sample.number[0], sample.number[1], sample.number[2] = angle, np.inf, 0.0
    if volumes[known] < np.inf:
        turn = np.cos(angle) * arc.across - np.sin(angle) * arc.one
        sample.piece[:] = touches[known].piece
        touches[known].piece[0] = arc.start
        sample.piece[0] = arc.start
        sample.number[1] = np.log(volumes[known])
        sample.number[2] = slope_at(turn, solid, touches[known], scratch.work)
    return best  # type: ignore[no-any-return]


@kernel
def worth_a_look(one: Sample, two: Sample, limit: float) -> bool:
    """Whether the volume turns from falling to rising, and the tangents meet below `limit`."""
    if not (one.number[2] < 0.0 and two.number[2] > 0.0):
        return False
    lowest = one.number[1] + one.number[2] * (meeting(one, two) - one.number[0])
    return bool(lowest <= np.log(limit))


@kernel
def meeting(one: Sample, two: Sample) -> float:
    """Angle at which the tangents of the log volume meet."""
    gap = two.number[0] - one.number[0]
    rise = two.number[1] - one.number[1]
    return float(one.number[0] + (rise - two.number[2] * gap) / (one.number[2] - two.number[2]))


@kernel
def arc_minimum(
    arc: Arc, one: Sample, two: Sample, solid: Solid, scratch: Scratch, touch: Touch
) -> tuple[int, int, float]:
    """Minimum of the volume between two samples of an arc, where the slope turns from falling to rising.

    Secant steps on the slope where both ends belong to the same piece, else the meeting point of the two
    tangents. Fills `touch`.

    Returns
    -------
    slot
        Slot of the piece that has a third contact, STATIONARY or ON_FACET.
    partner
        For a third contact, the vertex that ties with that of the piece.
    volume
        At the minimum.
    """
    low = Sample(one.number.copy(), one.piece.copy())
    high = Sample(two.number.copy(), two.piece.copy())
    here = Sample(np.zeros(3), np.zeros(7, np.int64))
    volume = np.inf
    for _ in range(60):
        same = True
        for c in range(1, 7):
            same = same and low.piece[c] == high.piece[c]
        gap = high.number[0] - low.number[0]
        guard = 0.0 if same else 1e-3 * gap
        if same:
            angle = low.number[0] - low.number[2] * gap / (high.number[2] - low.number[2])
        else:
            angle = meeting(low, high)
        if not (low.number[0] + guard <= angle <= high.number[0] - guard):
            angle = 0.5 * (low.number[0] + high.number[0])
        volume = box_on_arc(arc, angle, solid, np.inf, scratch, touch, here)
        end = low if here.number[2] < 0.0 else high
        gone = abs(end.number[0] - angle)
        end.number[:] = here.number
        end.piece[:] = here.piece
        if high.number[0] - low.number[0] < 1e-9 or abs(here.number[2]) < 1e-11 or (same and gone < 1e-10):
            break
    if abs(here.number[2]) < 1e-6:
        return STATIONARY, -1, volume
    if low.piece[2] != high.piece[2] or low.piece[3] != high.piece[3]:
        return ON_FACET, -1, volume
    for slot in (1, 4, 5, 6):
        if low.piece[slot] != high.piece[slot]:
            other = low.piece[slot] if here.piece[slot] == high.piece[slot] else high.piece[slot]
            return slot, other, volume
    return STATIONARY, -1, volume


@kernel
def corner_of(facet: int, edges: IntArray) -> tuple[int, int, int]:
    """Three vertices of a facet: the ends of one of its edges and another one."""
    p = q = -1
    for e in range(len(edges)):
        if edges[e, 2] == facet or edges[e, 3] == facet:
            if p < 0:
                p, q = edges[e, 0], edges[e, 1]
            elif edges[e, 0] != p and edges[e, 0] != q:
                return p, q, edges[e, 0]
            elif edges[e, 1] != p and edges[e, 1] != q:
                return p, q, edges[e, 1]
    return -1, -1, -1


@kernel
def kept(  # type: ignore[no-untyped-def]
    count, boxes, volume, touch, slot, start, end, partner
) -> int:
    """Add a box unless the same one is there; the new number of boxes."""
    for i in range(count):
        if (
            abs(boxes.volumes[i] - volume) < 1e-6 * volume
            and likeness(boxes.frames[i], touch.frame) > 1.0 - 1e-9
        ):
            return count  # type: ignore[no-any-return]
    at = count
    if count == MOST:
        at = np.argmax(boxes.volumes)
        if boxes.volumes[at] <= volume:
            return count  # type: ignore[no-any-return]
        count -= 1
    boxes.volumes[at], boxes.frames[at], boxes.extents[at] = volume, touch.frame, touch.extents
    boxes.contacts[at, 0], boxes.contacts[at, 1], boxes.contacts[at, 2] = slot, start, end
    boxes.contacts[at, 3:10] = touch.piece
    boxes.contacts[at, 10] = partner
    return count + 1  # type: ignore[no-any-return]


@kernel
def likeness(one: FloatArray, two: FloatArray) -> float:
    """Cosine of the largest angle between the axes of two frames (3, 3), in any order and direction."""
    least = 1.0
    for a in range(3):
        most = 0.0
        for b in range(3):
            dot = one[a, 0] * two[b, 0] + one[a, 1] * two[b, 1] + one[a, 2] * two[b, 2]
            most = max(most, abs(dot))
        least = min(least, most)
    return least


@kernel
def ranked(boxes: Boxes, count: int, limit: float) -> Boxes:
    """The boxes up to the volume `limit`, the least first; at least one if there is any."""
    order = np.argsort(boxes.volumes[:count])
    total = min(1, count)
    while total < count and boxes.volumes[order[total]] <= limit:
        total += 1
    order = order[:total]
    return Boxes(boxes.volumes[order], boxes.frames[order], boxes.extents[order], boxes.contacts[order])
