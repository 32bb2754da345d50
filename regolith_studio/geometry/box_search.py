"""Search for the minimum-volume box of a convex solid.

O'Rourke (1985): two adjacent sides of a minimum-volume box are each flush with an edge of the hull. A
side that is flush with an edge has its normal on the edge's Gauss arc, the arc between the normals of
the two faces that meet there. For a fixed normal the best box is its height times the smallest
rectangle around the shadow, which is flush with an edge of the shadow (rotating calipers).

So all arcs are searched, by branch and bound: turning a box of edges w and h by an angle t can change
the logarithm of its volume by t (w/h + h/w) at most, so an arc is halved only while that, times
`STEEPNESS`, could bring it below the best box so far; the last `FINEST` of arc is left to golden section.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.hull_graph import HullGraph, climb, hull_graph, walk_rim
from regolith_studio.geometry.inlined import inlined
from regolith_studio.geometry.rectangle import TIE, outline, polygon_area, smallest_rectangle
from regolith_studio.geometry.vectors import Vector, along, dot, frame, length, mixed, row

STEEPNESS = 0.6
"""Slope of ln(volume) against the angle in radians, as a share of h/w + w/h, the most it could be.

Of 1,600 polyhedra of 12 to 50 facets none is missed from 0.5 on, at 0.4 two, at 0.3 seventeen."""

STEEPNESS_FINE = 0.35
FINE = 150
"""Solids of more triangles than this are rounder and their slopes flatter: none is missed from 0.2 on."""

SAFETY = 3.0
MANY_ARCS = 200
SHORT_ARC = np.radians(15.0)
"""With so many arcs so short, no slope is steeper than SAFETY times the steepest between facets."""

PASSES = 8
"""Faces are searched in so many passes, each spread over the solid, so that the best is known soon."""

FINEST = np.radians(2.0)
"""Piece of an arc that golden section searches."""

EXACT_BELOW = np.log(1.3)
"""A rectangle is worked out only where ln(height times shadow) is at most this above the best volume."""

GOLDEN = (5.0**0.5 - 1.0) / 2.0
DEPTH = 64
SHARPEST = 1e-9
SAME_NORMAL = 1e-8
ROUNDING = 1e-12


class Search(NamedTuple):
    """Scratch space and the best box so far.

    Parameters
    ----------
    near
        Vertices at which the next hill climbs start: up, down, right and left, shape (4,).
    rim, x, y
        Outline of the last shadow.
    record
        Logarithm of the least volume so far and the longest edge of its box, shape (2,).
    axes
        Of the best box, one a row, shape (3, 3).
    todo
        Pieces of an arc still to be searched: its ends, and volume and slope at each end,
        shape (DEPTH, 6).
    """

    near: IntArray
    rim: IntArray
    x: FloatArray
    y: FloatArray
    record: FloatArray
    axes: FloatArray
    todo: FloatArray


@kernel
def minimum_box(points: FloatArray, faces: IntArray) -> FloatArray:
    """Axes of the minimum-volume box, one a row, shape (3, 3); zeros if the faces do not close.

    Parameters
    ----------
    points
        Vertices of a convex solid of size about 1 near the origin, shape (n, 3); each on a face.
    faces
        Its outward triangles, shape (m, 3).
    """
    graph = hull_graph(points, faces)
    n = len(points)
    near = np.zeros(4, np.int64)
    rim, x, y = np.empty(n, np.int64), np.empty(n), np.empty(n)
    search = Search(near, rim, x, y, np.full(2, np.inf), np.zeros((3, 3)), np.empty((DEPTH, 6)))
    if not graph.closed:
        return search.axes
    at_face = _search_faces(graph, search)
    steepest = _steepest(graph, at_face)
    for h in range(len(graph.twin)):
        if h < graph.twin[h]:
            search_arc(graph, h // 3, graph.twin[h] // 3, at_face, steepest, search)
    return search.axes


@kernel
def _search_faces(graph: HullGraph, search: Search) -> FloatArray:
    """Volume and slope of :func:`best_volume` for each face normal, shape (m, 2).

    A face beside one so bad that it cannot win gets the lower bound that follows from that.
    """
    at_face = np.empty((len(graph.normals), 2))
    for f in range(len(at_face)):
        at_face[f, 0] = -np.inf
    for start in range(PASSES):
        for f in range(start, len(at_face), PASSES):
            if graph.facet[f] == f:
                at_face[f, 0], at_face[f, 1] = _bound_from_neighbours(graph, f, at_face)
                if at_face[f, 0] < search.record[0]:
                    at_face[f, 0], at_face[f, 1] = best_volume(graph, row(graph.normals, f), search)
    for f in range(len(at_face)):
        at_face[f, 0], at_face[f, 1] = at_face[graph.facet[f], 0], at_face[graph.facet[f], 1]
    return at_face


@inlined
def _bound_from_neighbours(graph: HullGraph, f: int, at_face: FloatArray) -> tuple[float, float]:
    """The highest lower bound for face `f` from volumes and slopes of its neighbours, and that slope."""
    bound, slope = -np.inf, 0.0
    for h in range(3 * f, 3 * f + 3):
        g = graph.facet[graph.twin[h] // 3]
        angle = length(mixed(row(graph.normals, f), 1.0, row(graph.normals, g), -1.0))
        if at_face[g, 0] - at_face[g, 1] * angle > bound:
            bound, slope = at_face[g, 0] - at_face[g, 1] * angle, at_face[g, 1]
    return bound, slope


@kernel
def _steepest(graph: HullGraph, at_face: FloatArray) -> float:
    """For solids with many facets a bound on all slopes, from those seen between neighbouring facets."""
    steepest, arcs, least = 0.0, 0, np.inf
    for f in range(len(at_face)):
        least = min(least, at_face[f, 0])
    for h in range(len(graph.twin)):
        f, g = h // 3, graph.twin[h] // 3
        if f < g and max(at_face[f, 0], at_face[g, 0]) < least + EXACT_BELOW:
            angle = length(mixed(row(graph.normals, f), 1.0, row(graph.normals, g), -1.0))
            if SAME_NORMAL < angle < SHORT_ARC:
                steepest = max(steepest, abs(at_face[f, 0] - at_face[g, 0]) / angle)
                arcs += 1
    return SAFETY * steepest if arcs > MANY_ARCS else np.inf


@kernel
def search_arc(
    graph: HullGraph, f: int, g: int, at_face: FloatArray, steepest: float, search: Search
) -> None:
    """Branch and bound along the Gauss arc between the normals of faces `f` and `g`."""
    start, end = row(graph.normals, f), row(graph.normals, g)
    cosine = dot(start, end)
    across = mixed(end, 1.0, start, -cosine)
    sine = length(across)
    if sine < SAME_NORMAL:
        return
    across = mixed(across, 1.0 / sine, start, 0.0)
    todo = search.todo
    todo[0, 0], todo[0, 1] = 0.0, np.arctan2(sine, cosine)
    todo[0, 2], todo[0, 3] = at_face[f, 0], at_face[f, 1]
    todo[0, 4], todo[0, 5] = at_face[g, 0], at_face[g, 1]
    n = 1
    while n > 0:
        n -= 1
        low, high, at_low, at_high, steep_high = todo[n, 0], todo[n, 1], todo[n, 2], todo[n, 4], todo[n, 5]
        steepness = min(max(todo[n, 3], steep_high), steepest)
        if (at_low + at_high - steepness * (high - low)) / 2.0 >= search.record[0]:
            continue
        if high - low <= FINEST:
            golden_section(graph, start, across, low, high, steepness, search)
            continue
        middle = (low + high) / 2.0
        at, steep = best_volume(graph, mixed(start, np.cos(middle), across, np.sin(middle)), search)
        todo[n, 1], todo[n, 4], todo[n, 5] = middle, at, steep
        n += 1
        todo[n, 0], todo[n, 1], todo[n, 2], todo[n, 3] = middle, high, at, steep
        todo[n, 4], todo[n, 5] = at_high, steep_high
        n += 1


@kernel
def golden_section(
    graph: HullGraph,
    start: Vector,
    across: Vector,
    low: float,
    high: float,
    steepness: float,
    search: Search,
) -> None:
    """Least volume on a short piece of an arc, given up once it cannot win."""
    a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_a = best_volume(graph, mixed(start, np.cos(a), across, np.sin(a)), search)[0]
    at_b = best_volume(graph, mixed(start, np.cos(b), across, np.sin(b)), search)[0]
    while high - low > SHARPEST:
        if min(at_a, at_b) - steepness * (1.0 - GOLDEN) * (high - low) >= search.record[0]:
            return
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = high - GOLDEN * (high - low)
            at_a = best_volume(graph, mixed(start, np.cos(a), across, np.sin(a)), search)[0]
        else:
            low, a, at_a = a, b, at_b
            b = low + GOLDEN * (high - low)
            at_b = best_volume(graph, mixed(start, np.cos(b), across, np.sin(b)), search)[0]


@kernel
def best_volume(graph: HullGraph, axis: Vector, search: Search) -> tuple[float, float]:
    """Logarithm of the least volume of a box with a side normal to `axis`, and a bound on its slope.

    Far above the best so far it is only a lower bound. A new best box is kept in `search`; of two that
    tie, the one with the shorter longest edge.
    """
    first, second = frame(axis)
    points, near = graph.points, search.near
    steepness = STEEPNESS_FINE if len(graph.normals) > FINE else STEEPNESS
    climb(graph, axis, first, near)
    height = along(points, near[0], axis) - along(points, near[1], axis)
    n = shadow(graph, axis, first, second, search)
    area = polygon_area(search.x, search.y, n)
    longer = along(points, near[2], first) - along(points, near[3], first)
    bound = np.log(height * area)
    if bound > search.record[0] + EXACT_BELOW:
        return bound, steepness * _slope(height, longer, area / longer)
    area, cosine, sine, longer = smallest_rectangle(search.x, search.y, n)
    volume, longest = np.log(height * area), max(height, longer)
    gain, shorter = search.record[0] - volume, search.record[1] - longest
    if gain > TIE or (gain > -TIE and (shorter > TIE or (gain > 0.0 and shorter > -TIE))):
        search.record[0], search.record[1] = volume, longest
        for k in range(3):
            search.axes[0, k] = axis[k]
            search.axes[1, k] = cosine * first[k] + sine * second[k]
            search.axes[2, k] = cosine * second[k] - sine * first[k]
    return volume, steepness * _slope(height, longer, area / longer)


@inlined
def _slope(height: float, wide: float, high: float) -> float:
    """How fast turning a box of these edges could at most change the logarithm of its volume."""
    return max(height / wide + wide / height, height / high + high / height)


@inlined
def shadow(graph: HullGraph, axis: Vector, first: Vector, second: Vector, search: Search) -> int:
    """Outline of the shadow along `axis` in `search`, in coordinates along `first` and `second`."""
    points, near, x, y = graph.points, search.near, search.x, search.y
    way = walk_rim(graph, axis, near[2], search.rim)
    n = abs(way)
    leftmost = np.inf
    for i in range(n):
        x[i] = along(points, search.rim[i], first)
        y[i] = along(points, search.rim[i], second)
        leftmost = min(leftmost, x[i])
    lowest = along(points, near[3], first)
    if n < 3 or leftmost > lowest + ROUNDING or (way < 0 and max(_reversals(x, n), _reversals(y, n)) > 2):
        for i in range(len(points)):
            x[i], y[i] = along(points, i, first), along(points, i, second)
        corners = outline(x, y)
        n = len(corners)
        for i in range(n):
            x[i], y[i] = along(points, corners[i], first), along(points, corners[i], second)
    return n


@inlined
def _reversals(x: FloatArray, n: int) -> int:
    """How often a closed sequence turns from rising to falling or back; 2 for a convex polygon."""
    count, rising = 0, 0
    first = 0
    for i in range(n):
        step = x[i] - x[i - 1 if i > 0 else n - 1]
        way = 1 if step > ROUNDING else (-1 if step < -ROUNDING else rising)
        if way != rising:
            count += 1 if rising != 0 else 0
            first = way if rising == 0 else first
            rising = way
    return count + (1 if rising != first else 0)
