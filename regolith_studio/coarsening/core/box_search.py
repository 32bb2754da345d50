"""All local minimum-volume boxes of a convex solid that come near the smallest (O'Rourke 1985).

All Gauss arcs of the solid's edges are sampled; minima are found from values and slopes at the samples.
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
from regolith_studio.coarsening.core.box_arcs import (
    ON_FACET,
    ArcSample,
    Spare,
    arc_between,
    arc_minimum,
    box_on_arc,
    empty_sample,
    spare_samples,
    worth_a_look,
)
from regolith_studio.coarsening.core.box_contacts import (
    MAX_TURN,
    ROW,
    pose_of,
    touched,
    walk_to_minimum,
)
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import mixed, row

FINE_ANGLE = float(np.radians(8.0))
"""Step along the arcs that missed none of 383 boxes of random spiky polyhedra with 12 facets (13 degrees
missed 3), in radians."""
DENSE_ANGLE = float(np.radians(2.0))
"""Step that is fine enough for a verdict, in radians."""
PROMISING = 1.12
"""Normals whose box is larger than this many times the least are not looked into."""
SLACK = 1.02
NO_ARC = 1e-7
NO_FACET = 1e-13
MAX_BOXES = 64
"""Largest number of boxes returned."""
SAME_VOLUME, SAME_FRAME = 1e-6, 1.0 - 1e-9
"""Boxes that differ by less, as shares and by the cosine of the angle between their axes, are one."""


class LocalBoxes(NamedTuple):
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
        As in :mod:`regolith_studio.coarsening.core.box_contacts`, shape (k, 13); no ties where the box could
        not be brought to rest on them.
    """

    volumes: FloatArray
    frames: FloatArray
    extents: FloatArray
    contacts: IntArray

    def selected(self, which: IntArray | BoolArray) -> "LocalBoxes":
        """Some of the boxes, by index or mask."""
        volumes, frames, extents, contacts = self
        return LocalBoxes(volumes[which], frames[which], extents[which], contacts[which])


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


class BoxWorkspace(NamedTuple):
    """Memory that one search reuses."""

    scratch: Scratch
    touch: Touch
    fallback: Touch
    one: ArcSample
    two: ArcSample
    spare: Spare


def local_boxes(solid: Solid, margin: float, sample_angle: float) -> LocalBoxes:
    """Locally minimal boxes with a volume of at most (1 + margin) times the least.

    Parameters
    ----------
    solid
        Of a size of about 1.
    margin
        Share of the least volume.
    sample_angle
        Largest step between samples along an arc, in radians.
    """
    boxes, n = empty_boxes(MAX_BOXES), len(solid.normals)
    facets = OnFacets(
        np.full(n, np.nan),
        np.empty((n, 3, 3)),
        np.empty((n, 3)),
        np.empty((n, 7), np.int64),
        np.ones(n, np.int64),
    )
    work = BoxWorkspace(
        scratch_for(solid), empty_touch(), empty_touch(), empty_sample(), empty_sample(), spare_samples()
    )
    count, best = search(solid, margin, sample_angle, boxes, facets, work)
    order = np.argsort(boxes.volumes[:count])
    within = boxes.volumes[order] <= best * (1.0 + margin)
    boxes = boxes.selected(order[: max(1, np.count_nonzero(within))])
    kept = np.empty(len(boxes.volumes), np.bool_)
    settle_boxes(solid.vertices, boxes, np.empty((9, 3)), np.empty((3, 3)), np.empty((3, 3)), kept)
    boxes = boxes.selected(kept)
    return boxes if len(boxes.volumes) == 1 else boxes.selected(np.argsort(boxes.volumes))


def empty_boxes(k: int) -> LocalBoxes:
    """Room for k boxes."""
    return LocalBoxes(np.empty(k), np.empty((k, 3, 3)), np.empty((k, 3)), np.zeros((k, ROW), np.int64))


@kernel_noalloc
def settle_boxes(
    vertices: FloatArray,
    boxes: LocalBoxes,
    points: FloatArray,
    start: FloatArray,
    settled: FloatArray,
    kept: BoolArray,
) -> None:
    """Turn boxes to the minima next to them; kept are those that none before them came to.

    Boxes that do not settle are left without ties.

    Parameters
    ----------
    points, start, settled
        Scratch, shapes (9, 3), (3, 3) and (3, 3).
    kept
        Filled, shape (k,).
    """
    for k in range(len(boxes.frames)):
        kept[k] = True
        contact, frame = boxes.contacts[k], boxes.frames[k]
        touched(vertices, frame, contact, start)
        copy_frame(frame, settled)
        if not walk_to_minimum(vertices, contact, settled, points, start, MAX_TURN):
            contact[0] = 0
            continue
        copy_frame(settled, frame)
        pose = pose_of(points, contact, frame)
        boxes.extents[k, 0], boxes.extents[k, 1], boxes.extents[k, 2] = pose.extents
        boxes.volumes[k] = pose.extents[0] * pose.extents[1] * pose.extents[2]
        for i in range(k):
            kept[k] = kept[k] and not (kept[i] and is_same_box(boxes, i, boxes.volumes[k], frame))


@kernel_noalloc
def copy_frame(source: FloatArray, target: FloatArray) -> None:
    """Copy axes, shape (3, 3)."""
    for axis in range(3):
        target[axis, 0], target[axis, 1], target[axis, 2] = row(source, axis)


@kernel_noalloc
def search(
    solid: Solid,
    margin: float,
    sample_angle: float,
    boxes: LocalBoxes,
    facets: OnFacets,
    work: BoxWorkspace,
) -> tuple[int, float]:
    """Fill `boxes`; how many there are, and the least volume."""
    scratch, touch, fallback, one, two, spare = work
    n, best, lowest = len(solid.normals), np.inf, np.inf
    for f in range(n):
        if solid.areas[f] > NO_FACET:
            best = min(best, box_on_facet(f, facets, solid, best, scratch, touch))
    count = 0
    for e in range(len(solid.edges)):
        arc = arc_between(solid, e)
        if arc.angle < NO_ARC:
            continue
        steps = max(1, int(np.ceil(arc.angle / sample_angle)))
        for i in range(steps + 1):
            angle = arc.angle * i / steps
            best = sampled(arc, angle, solid, best, e, facets, scratch, touch, two)
            if two.number[1] < lowest:
                lowest = two.number[1]
                kept_aside(touch, fallback)
            if i > 0 and worth_a_look(one, two, best * (1.0 + margin) * SLACK):
                slot, _, volume = arc_minimum(arc, one, two, solid, scratch, touch, spare)
                best = min(best, volume)
                if slot != ON_FACET and volume <= best * (1.0 + margin):
                    count = kept(count, boxes, volume, touch)
            one, two = two, one
    for f in range(n):
        if facets.resting[f] == 1 and facets.volume[f] <= best * (1.0 + margin):
            recalled(facets, f, touch)
            count = kept(count, boxes, facets.volume[f], touch)
    if count == 0 and lowest < np.inf:
        count = kept(0, boxes, np.exp(lowest), fallback)
    return count, best


@kernel_noalloc
def kept_aside(touch: Touch, aside: Touch) -> None:
    """Copy a box."""
    for a in range(3):
        aside.extents[a] = touch.extents[a]
        for c in range(3):
            aside.frame[a, c] = touch.frame[a, c]
    for c in range(7):
        aside.piece[c] = touch.piece[c]


@kernel_noalloc
def remembered(facets: OnFacets, f: int, touch: Touch) -> None:
    """Copy a box into the memory of facet f."""
    for a in range(3):
        facets.extents[f, a] = touch.extents[a]
        for c in range(3):
            facets.frame[f, a, c] = touch.frame[a, c]
    for c in range(7):
        facets.piece[f, c] = touch.piece[c]


@kernel_noalloc
def recalled(facets: OnFacets, f: int, touch: Touch) -> None:
    """Copy the box of facet f into `touch`."""
    for a in range(3):
        touch.extents[a] = facets.extents[f, a]
        for c in range(3):
            touch.frame[a, c] = facets.frame[f, a, c]
    for c in range(7):
        touch.piece[c] = facets.piece[f, c]


@kernel_noalloc
def box_on_facet(
    f: int, facets: OnFacets, solid: Solid, best: float, scratch: Scratch, touch: Touch
) -> float:
    """Volume of the box with one side on facet f; it is remembered."""
    if np.isnan(facets.volume[f]):
        facets.volume[f] = box_at(row(solid.normals, f), solid, PROMISING * best, scratch, touch)
        remembered(facets, f, touch)
    return facets.volume[f]  # type: ignore[no-any-return]


@kernel_noalloc
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
        turn = mixed(arc.across, np.cos(angle), arc.one, -np.sin(angle))
        recalled(facets, f, touch)
        touch.piece[0] = arc.start
        for c in range(7):
            sample.piece[c] = touch.piece[c]
        sample.number[1] = np.log(volume)
        sample.number[2] = slope_at(turn, solid, touch)
        away = sample.number[2] if angle <= 0.0 else -sample.number[2]
        if away < -1e-12:
            facets.resting[f] = 0
    return min(best, volume)  # type: ignore[no-any-return]


@kernel_noalloc
def kept(count: int, boxes: LocalBoxes, volume: float, touch: Touch) -> int:
    """Add a box unless the same one is there; the new number of boxes."""
    for i in range(count):
        if is_same_box(boxes, i, volume, touch.frame):
            return count
    at = count
    if count == MAX_BOXES:
        at = int(np.argmax(boxes.volumes))
        if boxes.volumes[at] <= volume:
            return count
        count -= 1
    boxes.volumes[at] = volume
    for a in range(3):
        boxes.extents[at, a] = touch.extents[a]
        for c in range(3):
            boxes.frames[at, a, c] = touch.frame[a, c]
    return count + 1


@kernel_noalloc
def is_same_box(boxes: LocalBoxes, i: int, volume: float, frame: FloatArray) -> bool:
    """Whether box `i` has the same volume and axes."""
    near = abs(boxes.volumes[i] - volume) < SAME_VOLUME * volume
    return near and likeness_of(boxes.frames[i], frame) > SAME_FRAME


@kernel_noalloc
def likeness_of(one: FloatArray, two: FloatArray) -> float:
    """Cosine of the largest angle between the axes of two frames (3, 3), in any order and direction."""
    least = 1.0
    for a in range(3):
        most = 0.0
        for b in range(3):
            dot = one[a, 0] * two[b, 0] + one[a, 1] * two[b, 1] + one[a, 2] * two[b, 2]
            most = max(most, abs(dot))
        least = min(least, most)
    return float(least)
