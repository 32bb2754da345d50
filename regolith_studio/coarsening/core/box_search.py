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
    turned_frame,
)
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel

SAMPLE_ANGLE = float(np.radians(13.0))
"""Step along the arcs that misses few boxes, in radians."""
FINE_ANGLE = float(np.radians(8.0))
"""Step that missed none of 383 boxes of random spiky polyhedra with 12 facets (13 degrees missed 3)."""
DENSE_ANGLE = float(np.radians(2.0))
"""Step that is fine enough for a verdict, in radians."""
PROMISING = 1.12
"""Normals whose box is larger than this many times the least are not looked into."""
SLACK = 1.02
NO_ARC = 1e-7
BESIDE = 1e-7
NO_FACET = 1e-13
SAME_SIDE = 0.99
NEAR = float(np.cos(np.radians(7.0)))
WINDOW = float(np.radians(7.0))
MOST = 64
"""Largest number of boxes returned."""
STATIONARY, ON_FACET, SEVERAL = -1, -2, -3
"""In place of the slot of a third contact: none, the volume is stationary along the arc; or the second side
rests on a facet, and that facet's own box is the same; or more than one contact changes at once."""


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


class OnFacets(NamedTuple):
    """Boxes with one side on a facet, worked out when asked for: NaN volume before, infinity if too large.

    Parameters
    ----------
    volume, frame, extents, piece
        Shapes (n,), (n, 3, 3), (n, 3), (n, 7).
    resting
        1 while no turn away from the facet is known to make the box smaller, 0 after, shape (n,).
    """

    volume: FloatArray
    frame: FloatArray
    extents: FloatArray
    piece: IntArray
    resting: IntArray


@kernel
def local_boxes(solid: Solid, margin: float, sample_angle: float, near: FloatArray) -> Boxes:
    """Locally minimal boxes with a volume of at most (1 + margin) times the least.

    Parameters
    ----------
    solid
        Of a size of about 1.
    margin
        Share of the least volume.
    sample_angle
        Largest step between samples along an arc, in radians.
    near
        Frames of boxes, shape (k, 3, 3): only boxes within about 7 degrees of one of them are looked for.
        None (k = 0): everywhere.
    """
    boxes = Boxes(np.empty(MOST), np.empty((MOST, 3, 3)), np.empty((MOST, 3)), np.empty((MOST, 11), np.int64))
    scratch, touch = scratch_for(solid), empty_touch()
    n = len(solid.normals)
    facets = OnFacets(
        np.full(n, np.nan),
        np.empty((n, 3, 3)),
        np.empty((n, 3)),
        np.empty((n, 7), np.int64),
        np.ones(n, np.int64),
    )
    best = np.inf
    if len(near) == 0:
        for f in range(n):
            if solid.areas[f] > NO_FACET:
                best = min(best, box_on_facet(f, facets, solid, best, scratch, touch))
    count = 0
    fallback, lowest = empty_touch(), np.inf
    one, two = Sample(np.empty(3), np.empty(7, np.int64)), Sample(np.empty(3), np.empty(7, np.int64))
    for e in range(len(solid.edges)):
        arc = arc_between(solid, e)
        if arc.angle < NO_ARC:
            continue
        low, high = window_on(arc, near)
        if high < low:
            continue
        steps = max(1, int(np.ceil((high - low) / sample_angle)))
        for i in range(steps + 1):
            angle = low + (high - low) * i / steps
            best = sampled(arc, angle, solid, best, e, facets, scratch, touch, two)
            if two.number[1] < lowest:
                lowest = two.number[1]
                kept_aside(touch, fallback)
            if i > 0 and worth_a_look(one, two, best * (1.0 + margin) * SLACK):
                slot, partner, volume = arc_minimum(arc, one, two, solid, scratch, touch)
                best = min(best, volume)
                if slot != ON_FACET and volume <= best * (1.0 + margin):
                    count = kept(count, boxes, volume, touch, slot, arc.start, arc.end, partner)
            one, two = two, one
    for f in range(n):
        if (
            facets.resting[f] == 1
            and facets.volume[f] <= best * (1.0 + margin)
            and is_near(solid.normals[f], near)
        ):
            p, q, partner = corner_of(f, solid.edges)
            if p >= 0:
                recalled(facets, f, touch)
                touch.piece[0] = p
                count = kept(count, boxes, facets.volume[f], touch, 0, p, q, partner)
    if count == 0 and lowest < np.inf:
        count = kept(0, boxes, np.exp(lowest), fallback, STATIONARY, fallback.piece[0], fallback.piece[0], -1)
    return ranked(boxes, count, best * (1.0 + margin))


@kernel
def kept_aside(touch: Touch, aside: Touch) -> None:
    """Copy a box."""
    for a in range(3):
        aside.extents[a] = touch.extents[a]
        for c in range(3):
            aside.frame[a, c] = touch.frame[a, c]
    for c in range(7):
        aside.piece[c] = touch.piece[c]


@kernel
def copied(source: Sample, target: Sample) -> None:
    """Copy a sample."""
    for c in range(3):
        target.number[c] = source.number[c]
    for c in range(7):
        target.piece[c] = source.piece[c]


@kernel
def remembered(facets: OnFacets, f: int, touch: Touch) -> None:
    """Copy a box into the memory of facet f."""
    for a in range(3):
        facets.extents[f, a] = touch.extents[a]
        for c in range(3):
            facets.frame[f, a, c] = touch.frame[a, c]
    for c in range(7):
        facets.piece[f, c] = touch.piece[c]


@kernel
def recalled(facets: OnFacets, f: int, touch: Touch) -> None:
    """Copy the box of facet f into `touch`."""
    for a in range(3):
        touch.extents[a] = facets.extents[f, a]
        for c in range(3):
            touch.frame[a, c] = facets.frame[f, a, c]
    for c in range(7):
        touch.piece[c] = facets.piece[f, c]


@kernel
def box_on_facet(
    f: int, facets: OnFacets, solid: Solid, best: float, scratch: Scratch, touch: Touch
) -> float:
    """Volume of the box with one side on facet f; it is remembered."""
    if np.isnan(facets.volume[f]):
        facets.volume[f] = box_at(solid.normals[f], solid, PROMISING * best, scratch, touch)
        remembered(facets, f, touch)
    return facets.volume[f]  # type: ignore[no-any-return]


@kernel
def window_on(arc: Arc, near: FloatArray) -> tuple[float, float]:
    """Part of an arc that lies near an axis of the frames `near` (k, 3, 3); empty if the second is less."""
    if len(near) == 0:
        return 0.0, arc.angle
    low, high = arc.angle + 1.0, -1.0
    for k in range(len(near)):
        for a in range(3):
            axis = near[k, a]
            x = axis[0] * arc.one[0] + axis[1] * arc.one[1] + axis[2] * arc.one[2]
            y = axis[0] * arc.across[0] + axis[1] * arc.across[1] + axis[2] * arc.across[2]
            for way in range(2):
                if way == 1:
                    x, y = -x, -y
                at = min(arc.angle, max(0.0, np.arctan2(y, x)))
                if np.cos(at) * x + np.sin(at) * y > NEAR:
                    low, high = min(low, max(0.0, at - WINDOW)), max(high, min(arc.angle, at + WINDOW))
    return low, high


@kernel
def is_near(normal: FloatArray, near: FloatArray) -> bool:
    """Whether all arcs around a facet have been searched."""
    for k in range(len(near)):
        for a in range(3):
            axis = near[k, a]
            if abs(axis[0] * normal[0] + axis[1] * normal[1] + axis[2] * normal[2]) > NEAR:
                return True
    return len(near) == 0


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
    axis, turn = scratch.work[4], scratch.work[5]
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
        for c in range(7):
            sample.piece[c] = touch.piece[c]
    return volume


@kernel
def sampled(  # type: ignore[no-untyped-def]
    arc, angle, solid, best, e, facets, scratch, touch, sample
) -> float:
    """Fill `sample` at an angle of the arc of edge e; the least volume so far."""
    if 0.0 < angle < arc.angle:
        volume = box_on_arc(arc, angle, solid, PROMISING * best, scratch, touch, sample)
        return min(best, volume)  # type: ignore[no-any-return]
    f = solid.edges[e, 2] if angle <= 0.0 else solid.edges[e, 3]
    sample.number[0], sample.number[1], sample.number[2] = angle, np.inf, 0.0
    volume = box_on_facet(f, facets, solid, best, scratch, touch)
    if volume < np.inf:
        turn = scratch.work[5]
        for c in range(3):
            turn[c] = np.cos(angle) * arc.across[c] - np.sin(angle) * arc.one[c]
        recalled(facets, f, touch)
        touch.piece[0] = arc.start
        for c in range(7):
            sample.piece[c] = touch.piece[c]
        sample.number[1] = np.log(volume)
        sample.number[2] = slope_at(turn, solid, touch, scratch.work)
        away = sample.number[2] if angle <= 0.0 else -sample.number[2]
        if away < -1e-12:
            facets.resting[f] = 0
    return min(best, volume)  # type: ignore[no-any-return]


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
    low = Sample(one.number.copy(), one.piece.copy())
    high = Sample(two.number.copy(), two.piece.copy())
    here = Sample(np.zeros(3), np.zeros(7, np.int64))
    volume, smallest = np.inf, (two.number[0] - one.number[0]) / 8.0
    for _ in range(40):
        gap = high.number[0] - low.number[0]
        slot = differing_slot(low.piece, high.piece)
        if slot == STATIONARY:
            angle = low.number[0] - low.number[2] * gap / (high.number[2] - low.number[2])
        elif slot >= 0:
            tie = tie_angle(
                arc, slot, low.piece[slot], high.piece[slot], low, solid.vertices, touch, scratch.work
            )
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


@kernel
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


@kernel
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


@kernel
def tie_angle(
    arc: Arc, slot: int, i: int, j: int, sample: Sample, vertices: FloatArray, touch: Touch, work: FloatArray
) -> float:
    """Angle near a sample at which vertices i and j lie in one side of the box, by the secant method.

    The frame of `touch` and `work` (6, 3) are overwritten.
    """
    axis, edge, frame = work[4], work[3], touch.frame
    for c in range(3):
        edge[c] = vertices[sample.piece[3], c] - vertices[sample.piece[2], c]
    row = 0 if slot == 1 else (1 if slot == 4 else 2)
    before, angle, last = 0.0, sample.number[0], 0.0
    for k in range(8):
        for c in range(3):
            axis[c] = np.cos(angle) * arc.one[c] + np.sin(angle) * arc.across[c]
        turned_frame(axis, edge, frame)
        residual = 0.0
        for c in range(3):
            residual += frame[row, c] * (vertices[i, c] - vertices[j, c])
        if k == 0:
            last, before, angle = angle, residual, angle + 1e-3
            continue
        if residual == before or abs(residual) < 1e-13:
            break
        step = -residual * (angle - last) / (residual - before)
        last, before = angle, residual
        angle += min(0.5, max(-0.5, step))
    return float(angle)


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
    return float(least)


@kernel
def ranked(boxes: Boxes, count: int, limit: float) -> Boxes:
    """The boxes up to the volume `limit`, the least first; at least one if there is any."""
    order = np.argsort(boxes.volumes[:count])
    total = min(1, count)
    while total < count and boxes.volumes[order[total]] <= limit:
        total += 1
    order = order[:total]
    return Boxes(boxes.volumes[order], boxes.frames[order], boxes.extents[order], boxes.contacts[order])
