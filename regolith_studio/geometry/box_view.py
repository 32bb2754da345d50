"""A convex solid seen along an axis: the rectangles around its shadow, and how small a box can be nearby.

The shadow's outline is a polygon, and a box with a side normal to the axis stands on a rectangle around it.
As the rectangle turns, the corners that it touches change only where one of its sides is flush with a side of
the polygon, at an *event*; the least rectangle is at one of them (Freeman and Shapira 1975).

For any other axis, the distance of two given vertices along a direction is at most the width of the solid
along it. So with the touched corners held fast, a view bounds all boxes from below whose axes lie nearby. The
three distances are, where positive, concave functions of the angle in the plane and of the angle by which the
axis turns; so their product is least where both are at an end of their range.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.hull_graph import HullGraph, climb, walk_rim
from regolith_studio.geometry.inlined import inlined
from regolith_studio.geometry.outline import outline
from regolith_studio.geometry.vectors import Vector, along

ROUNDING = 1e-12
TIE = 1e-8
"""Areas and volumes that differ by a smaller share are equal; the sum of the edges decides."""

SHORTEST = 1e-12
"""Sides of an outline shorter than this, at solid size 1, have no direction of their own."""

SLACK = 1e-13
"""Rounding that a caliper may climb over, at solid size 1."""
PARALLEL = 1e-9
"""Corners whose distances from a side differ by less, at solid size 1, are touched together."""


class View(NamedTuple):
    """One view of a solid of n vertices; filled in place.

    Parameters
    ----------
    near
        Extreme vertices along the axis, against it, along the first direction and against it, shape (4,).
    rim
        Half-edges of the outline, counter-clockwise, shape (n,); vertices where a face is seen edge-on.
    x, y, z
        Corners of the outline along the two directions of the plane and the axis, shape (n,).
    dx, dy
        Direction of the side from each corner to the next; 0 where it is too short, shape (n,).
    touch
        Corners that a rectangle on that side touches: right, up, left; then for each of them the corner
        before it if that ties with it, else the same again; shape (n, 6).
    tall
        Vector from the bottom vertex to the top vertex in the frame of the view, shape (3,).
    turned, spare
        Scratch, shape (n,).
    """

    near: IntArray
    rim: IntArray
    x: FloatArray
    y: FloatArray
    z: FloatArray
    dx: FloatArray
    dy: FloatArray
    touch: IntArray
    tall: FloatArray
    turned: FloatArray
    spare: FloatArray


@kernel
def empty_view(n: int) -> View:
    """Memory for views of a solid with `n` vertices."""
    return View(
        np.zeros(4, np.int64),
        np.empty(n, np.int64),
        np.empty(n),
        np.empty(n),
        np.empty(n),
        np.empty(n),
        np.empty(n),
        np.empty((n, 6), np.int64),
        np.empty(3),
        np.empty(n),
        np.empty(n),
    )


@kernel
def look(graph: HullGraph, axis: Vector, first: Vector, second: Vector, view: View) -> int:
    """Fill `view` for an axis; (first, second, axis) is a right-handed frame.

    Returns
    -------
    int
        Number of corners of the outline; negative where a face is seen edge-on.
    """
    points, near, rim, x, y = graph.points, view.near, view.rim, view.x, view.y
    climb(graph, axis, first, near)
    way = walk_rim(graph, axis, near[2], rim)
    n = abs(way)
    leftmost = np.inf
    for i in range(n):
        v = graph.origin[rim[i]]
        x[i], y[i], view.z[i] = along(points, v, first), along(points, v, second), along(points, v, axis)
        leftmost = min(leftmost, x[i])
    if way <= 0 or n < 3 or leftmost > along(points, near[3], first) + ROUNDING:
        way = -1
        for i in range(len(points)):
            x[i], y[i] = along(points, i, first), along(points, i, second)
        corners = outline(x, y)
        n = len(corners)
        for i in range(n):
            v = corners[i]
            x[i], y[i], view.z[i] = along(points, v, first), along(points, v, second), along(points, v, axis)
    for k in range(3):
        direction = first if k == 0 else (second if k == 1 else axis)
        view.tall[k] = along(points, near[0], direction) - along(points, near[1], direction)
    turn_calipers(view, n)
    return n if way > 0 else -n


@kernel
def turn_calipers(view: View, n: int) -> None:
    """Fill the directions of the sides and the corners that the rectangle on each side touches."""
    x, y, dx, dy, touch = view.x, view.y, view.dx, view.dy, view.touch
    a, b = view.turned, view.spare
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        a[i], b[i] = x[j] - x[i], y[j] - y[i]
        squared = a[i] * a[i] + b[i] * b[i]
        shrink = 1.0 / np.sqrt(squared) if squared > SHORTEST**2 else 0.0
        dx[i], dy[i] = a[i] * shrink, b[i] * shrink
    right = up = left = -1
    for i in range(n):
        c, s = dx[i], dy[i]
        if c == 0.0 and s == 0.0:
            continue
        right = i if right < 0 else right
        before = right - 1 if right > 0 else n - 1
        steps = 0
        while a[right] * c + b[right] * s >= -SLACK and steps < n:
            before, right = right, right + 1 if right + 1 < n else 0
            steps += 1
        touch[i, 0] = right
        touch[i, 3] = before if a[before] * c + b[before] * s < PARALLEL else right
        up = right if up < 0 else up
        before = up - 1 if up > 0 else n - 1
        steps = 0
        while b[up] * c - a[up] * s >= -SLACK and steps < n:
            before, up = up, up + 1 if up + 1 < n else 0
            steps += 1
        touch[i, 1] = up
        touch[i, 4] = before if b[before] * c - a[before] * s < PARALLEL else up
        left = up if left < 0 else left
        before = left - 1 if left > 0 else n - 1
        steps = 0
        while a[left] * c + b[left] * s <= SLACK and steps < n:
            before, left = left, left + 1 if left + 1 < n else 0
            steps += 1
        touch[i, 2] = left
        touch[i, 5] = before if -a[before] * c - b[before] * s < PARALLEL else left


@inlined
def extents(view: View, n: int, dx: float, dy: float) -> tuple[float, float]:
    """Width along (dx, dy) and height across it of the outline."""
    low, high, bottom, top = np.inf, -np.inf, np.inf, -np.inf
    for i in range(n):
        s, t = view.x[i] * dx + view.y[i] * dy, view.y[i] * dx - view.x[i] * dy
        low, high, bottom, top = min(low, s), max(high, s), min(bottom, t), max(top, t)
    return high - low, top - bottom


@kernel
def least_rectangle(view: View, n: int) -> tuple[float, float, int]:
    """Width and height of the least rectangle, and the side that it stands on.

    Of two that tie, the one with the shorter longest edge; -1 if all sides are too short.
    """
    x, y, touch = view.x, view.y, view.touch
    least, longest, at = np.inf, np.inf, -1
    wide = high = 0.0
    for i in range(n):
        dx, dy = view.dx[i], view.dy[i]
        if dx == 0.0 and dy == 0.0:
            continue
        right, up, left = touch[i, 0], touch[i, 1], touch[i, 2]
        w = (x[right] - x[left]) * dx + (y[right] - y[left]) * dy
        h = (y[up] - y[i]) * dx - (x[up] - x[i]) * dy
        if w * h < least * (1.0 + TIE):
            w, h = extents(view, n, dx, dy)
            if w * h < least * (1.0 - TIE) or max(w, h) < longest * (1.0 - TIE):
                least, longest, at = w * h, max(w, h), i
                wide, high = w, h
    return wide, high, at


@kernel
def bound_after_turn(view: View, n: int, cosine: float, sine: float) -> float:
    """Least product of distances between touched vertices after the axis has turned towards `second`.

    The lesser of the values for both ends of a range of angles that holds 0 is a lower bound for the volume
    of all boxes with a side normal to an axis in it. Minus infinity where a distance is not positive.
    """
    x, y, z, turned, touch = view.x, view.y, view.z, view.turned, view.touch
    height = view.tall[2] * cosine + view.tall[1] * sine
    for i in range(n):
        turned[i] = y[i] * cosine - z[i] * sine
    least = np.inf
    for i in range(n):
        dx, dy = view.dx[i], view.dy[i]
        if dx == 0.0 and dy == 0.0:
            continue
        j = i + 1 if i + 1 < n else 0
        right, up, left = touch[i, 0], touch[i, 1], touch[i, 2]
        east, west = x[right] * dx + turned[right] * dy, x[left] * dx + turned[left] * dy
        north = turned[up] * dx - x[up] * dy
        if touch[i, 3] != right:
            east = min(east, x[touch[i, 3]] * dx + turned[touch[i, 3]] * dy)
        if touch[i, 4] != up:
            north = min(north, turned[touch[i, 4]] * dx - x[touch[i, 4]] * dy)
        if touch[i, 5] != left:
            west = max(west, x[touch[i, 5]] * dx + turned[touch[i, 5]] * dy)
        south = max(turned[i] * dx - x[i] * dy, turned[j] * dx - x[j] * dy)
        if east <= west or north <= south:
            return -np.inf
        least = min(least, (east - west) * (north - south))
    return height * least if height > 0.0 else -np.inf


@kernel
def flush_after_turn(view: View, n: int, i: int, cosine: float, sine: float) -> tuple[float, float]:
    """Volume with the touched vertices held fast but side i kept flush, after the axis has turned.

    Also the squared length of that side in the turned plane; 0 where it has no direction.
    """
    x, y, z, touch = view.x, view.y, view.z, view.touch
    if view.dx[i] == 0.0 and view.dy[i] == 0.0:
        return 0.0, 0.0
    j = i + 1 if i + 1 < n else 0
    dx, dy = x[j] - x[i], (y[j] - y[i]) * cosine - (z[j] - z[i]) * sine
    squared = dx * dx + dy * dy
    if squared < SHORTEST**2:
        return 0.0, 0.0
    foot = y[i] * cosine - z[i] * sine
    east, north, west = np.inf, np.inf, -np.inf
    for tie in range(0, 6, 3):
        k = touch[i, tie]
        east = min(east, x[k] * dx + (y[k] * cosine - z[k] * sine) * dy)
        k = touch[i, tie + 1]
        north = min(north, (y[k] * cosine - z[k] * sine - foot) * dx - (x[k] - x[i]) * dy)
        k = touch[i, tie + 2]
        west = max(west, x[k] * dx + (y[k] * cosine - z[k] * sine) * dy)
    height = view.tall[2] * cosine + view.tall[1] * sine
    return height * (east - west) * north / squared, squared


@kernel
def bound_within_cap(view: View, n: int, angle: float, limit: float, start: int) -> int:
    """-1 if all boxes with axes within `angle` have a volume of at least `limit`, else the event that fails.

    `start` is the event that is tried first.
    """
    x, y, z, touch = view.x, view.y, view.z, view.touch
    sine, loss = np.sin(angle), 1.0 - np.cos(angle)
    height = view.tall[2] * (1.0 - loss)
    height -= sine * np.sqrt(view.tall[0] * view.tall[0] + view.tall[1] * view.tall[1])
    if height <= 0.0:
        return start
    for step in range(n):
        i = start + step if start + step < n else start + step - n
        dx, dy = view.dx[i], view.dy[i]
        if dx == 0.0 and dy == 0.0:
            continue
        j = i + 1 if i + 1 < n else 0
        wide = high = np.inf
        for tie in range(0, 6, 3):
            right, up = touch[i, tie], touch[i, tie + 1]
            for other in range(2):
                left = touch[i, 2 + 3 * other]
                foot = j if other else i
                a, b = x[right] - x[left], y[right] - y[left]
                wide = min(wide, a * dx + b * dy - loss * (abs(a) + abs(b)) - sine * abs(z[right] - z[left]))
                a, b = x[up] - x[foot], y[up] - y[foot]
                high = min(high, b * dx - a * dy - loss * (abs(a) + abs(b)) - sine * abs(z[up] - z[foot]))
        if wide <= 0.0 or high <= 0.0 or height * wide * high < limit:
            return i
    return -1
