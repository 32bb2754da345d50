"""Search for the minimum-volume box of a convex solid.

O'Rourke (1985): two adjacent sides of a minimum-volume box are each flush with an edge of the hull. A
side that is flush with an edge has its normal on the edge's Gauss arc, the arc between the normals of
the two faces that meet there. For a fixed normal the best box is its height times the smallest
rectangle around the shadow, which is flush with an edge of the shadow (rotating calipers).

So all arcs are searched, by branch and bound: turning the normal by an angle t changes the logarithm
of the best volume by at most about `STEEPEST` * t, so an arc is halved only while that could bring it
below the best box so far; the last `FINEST` of arc is left to golden section.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.hull_graph import HullGraph, Vector, along, extreme_vertex, hull_graph, walk_rim
from regolith_studio.geometry.inlined import inlined
from regolith_studio.geometry.rectangle import TIE, outline, polygon_area, smallest_rectangle

STEEPEST = 2.5
"""Change of the logarithm of the best volume for a normal, per radian that the normal turns."""

SAFETY = 3.0
"""The bound on the slope is this multiple of the steepest one seen between neighbouring faces, if less."""

FINEST = np.radians(1.0)
"""Piece of an arc that golden section searches."""

EXACT_BELOW = 1.3
"""A rectangle is worked out only where height times shadow is below this multiple of the best volume."""

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
    rectangle
        Of the last shadow, shape (4,).
    record
        Least volume so far and the longest edge of its box, shape (2,).
    axes
        Of the best box, one a row, shape (3, 3).
    todo
        Pieces of an arc still to be searched: both ends and both volumes, shape (4, DEPTH).
    """

    near: IntArray
    rim: IntArray
    x: FloatArray
    y: FloatArray
    rectangle: FloatArray
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
    search = Search(near, rim, x, y, np.empty(4), np.full(2, np.inf), np.zeros((3, 3)), np.empty((4, DEPTH)))
    if graph.twin.min() < 0 or graph.outgoing.min() < 0:
        return search.axes
    at_face = np.empty(len(faces))
    for f in range(len(faces)):
        g = graph.facet[f]
        at_face[f] = best_volume(graph, _row(graph.normals, f), search) if f == g else at_face[g]
    steepness = _steepness(graph, at_face, search.record[0])
    for h in range(len(graph.twin)):
        if h < graph.twin[h]:
            search_arc(graph, h // 3, graph.twin[h] // 3, at_face, steepness, search)
    return search.axes


@kernel
def _steepness(graph: HullGraph, at_face: FloatArray, least: float) -> float:
    """A bound on the slope of ln(volume) along all arcs, from the slopes between neighbouring faces."""
    steepest = 0.0
    for h in range(len(graph.twin)):
        f, g = h // 3, graph.twin[h] // 3
        if f < g and max(at_face[f], at_face[g]) < EXACT_BELOW * least:
            angle = np.sqrt(np.sum((graph.normals[f] - graph.normals[g]) ** 2))
            if angle > SAME_NORMAL:
                steepest = max(steepest, abs(np.log(at_face[f] / at_face[g])) / angle)
    return min(STEEPEST, SAFETY * steepest) if steepest > 0.0 else STEEPEST


@kernel
def search_arc(
    graph: HullGraph, f: int, g: int, at_face: FloatArray, steepness: float, search: Search
) -> None:
    """Branch and bound along the Gauss arc between the normals of faces `f` and `g`."""
    start, end = _row(graph.normals, f), _row(graph.normals, g)
    cosine = _dot(start, end)
    across = _mixed(end, 1.0, start, -cosine)
    sine = np.sqrt(_dot(across, across))
    if sine < SAME_NORMAL:
        return
    across = _mixed(across, 1.0 / sine, start, 0.0)
    todo = search.todo
    todo[0, 0], todo[1, 0], todo[2, 0], todo[3, 0] = 0.0, np.arctan2(sine, cosine), at_face[f], at_face[g]
    n = 1
    while n > 0:
        n -= 1
        low, high, at_low, at_high = todo[0, n], todo[1, n], todo[2, n], todo[3, n]
        if np.sqrt(at_low * at_high) * np.exp(-steepness * (high - low) / 2.0) >= search.record[0]:
            continue
        if high - low <= FINEST:
            golden_section(graph, start, across, low, high, steepness, search)
            continue
        middle = (low + high) / 2.0
        at_middle = best_volume(graph, _mixed(start, np.cos(middle), across, np.sin(middle)), search)
        todo[0, n], todo[1, n], todo[2, n], todo[3, n] = low, middle, at_low, at_middle
        n += 1
        todo[0, n], todo[1, n], todo[2, n], todo[3, n] = middle, high, at_middle, at_high
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
    at_a = best_volume(graph, _mixed(start, np.cos(a), across, np.sin(a)), search)
    at_b = best_volume(graph, _mixed(start, np.cos(b), across, np.sin(b)), search)
    while high - low > SHARPEST:
        reach = (1.0 - GOLDEN) * (high - low)
        if min(at_a, at_b) * np.exp(-steepness * reach) >= search.record[0]:
            return
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = high - GOLDEN * (high - low)
            at_a = best_volume(graph, _mixed(start, np.cos(a), across, np.sin(a)), search)
        else:
            low, a, at_a = a, b, at_b
            b = low + GOLDEN * (high - low)
            at_b = best_volume(graph, _mixed(start, np.cos(b), across, np.sin(b)), search)


@kernel
def best_volume(graph: HullGraph, axis: Vector, search: Search) -> float:
    """Least volume of a box with a side normal to `axis`, or a lower bound far above the best so far.

    A new best box is kept in `search`; of two that tie, the one with the shorter longest edge.
    """
    first, second = _frame(axis)
    points, near = graph.points, search.near
    near[0] = extreme_vertex(graph, axis, near[0])
    near[1] = extreme_vertex(graph, _mixed(axis, -1.0, axis, 0.0), near[1])
    height = along(points, near[0], axis) - along(points, near[1], axis)
    n = shadow(graph, axis, first, second, search)
    bound = height * polygon_area(search.x, search.y, n)
    if bound > EXACT_BELOW * search.record[0]:
        return float(bound)
    smallest_rectangle(search.x, search.y, n, search.rectangle)
    volume, longest = height * search.rectangle[0], max(height, search.rectangle[3])
    better = volume < search.record[0] * (1.0 - TIE)
    if better or (volume < search.record[0] * (1.0 + TIE) and longest < search.record[1] * (1.0 - TIE)):
        search.record[0], search.record[1] = volume, longest
        cosine, sine = search.rectangle[1], search.rectangle[2]
        for k in range(3):
            search.axes[0, k] = axis[k]
            search.axes[1, k] = cosine * first[k] + sine * second[k]
            search.axes[2, k] = cosine * second[k] - sine * first[k]
    return float(volume)


@inlined
def shadow(graph: HullGraph, axis: Vector, first: Vector, second: Vector, search: Search) -> int:
    """Outline of the shadow along `axis` in `search`, in coordinates along `first` and `second`."""
    points, near, x, y = graph.points, search.near, search.x, search.y
    near[2] = extreme_vertex(graph, first, near[2])
    near[3] = extreme_vertex(graph, _mixed(first, -1.0, first, 0.0), near[3])
    n = walk_rim(graph, axis, near[2], search.rim)
    leftmost = np.inf
    for i in range(n):
        x[i] = along(points, search.rim[i], first)
        y[i] = along(points, search.rim[i], second)
        leftmost = min(leftmost, x[i])
    lowest = along(points, near[3], first)
    if n < 3 or leftmost > lowest + ROUNDING or max(_reversals(x, n), _reversals(y, n)) > 2:
        for i in range(len(points)):
            x[i], y[i] = along(points, i, first), along(points, i, second)
        corners = outline(x, y)
        n = len(corners)
        x[:n], y[:n] = x[corners], y[corners]
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


@inlined
def _frame(axis: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors that make a right-handed frame with `axis`, in the order first, second, axis."""
    x, y, z = axis
    if abs(x) <= min(abs(y), abs(z)):
        length = np.sqrt(y * y + z * z)
        first = (0.0, z / length, -y / length)
    elif abs(y) <= abs(z):
        length = np.sqrt(x * x + z * z)
        first = (-z / length, 0.0, x / length)
    else:
        length = np.sqrt(x * x + y * y)
        first = (y / length, -x / length, 0.0)
    return first, (
        y * first[2] - z * first[1],
        z * first[0] - x * first[2],
        x * first[1] - y * first[0],
    )


@inlined
def _row(rows: FloatArray, i: int) -> Vector:
    return float(rows[i, 0]), float(rows[i, 1]), float(rows[i, 2])


@inlined
def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def _mixed(a: Vector, share: float, b: Vector, other: float) -> Vector:
    """``share * a + other * b``."""
    return share * a[0] + other * b[0], share * a[1] + other * b[1], share * a[2] + other * b[2]
