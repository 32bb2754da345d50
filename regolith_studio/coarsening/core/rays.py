"""Crossings of rays from the origin with a mesh, by cells of a cube around the origin.

Rays and triangles are projected onto the cube from its middle: a triangle that keeps to one side stays a
triangle, and only rays in the cells under its bounds are tested.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel, kernel_noalloc
from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.geometry.vectors import cross, dot, row

RAYS_IN_CELL = 1.5
REACH = 1e-9
"""Bounds of triangles on the cube's sides, of half width 1, are widened by this."""
NEARLY_BEHIND = 1e-6
"""Corners that rise less over the middle, as a share of their other coordinates, are not projected."""


class RayBundle(NamedTuple):
    """Rays sorted by cells of the cube's sides.

    Parameters
    ----------
    directions
        In the order asked for, shape (k, 3).
    sorted_directions, order
        Cell by cell, shape (k, 3), and where each stands in `directions`, shape (k,).
    first
        Rays of cell c are ``first[c]:first[c + 1]``, shape (6 cells^2 + 1,).
    cells
        Along the edge of a side.
    """

    directions: FloatArray
    sorted_directions: FloatArray
    order: IntArray
    first: IntArray
    cells: int


@lru_cache(maxsize=8)
def fibonacci_bundle(n: int) -> RayBundle:
    """`n` Fibonacci directions, sorted once in a process."""
    return bundle_of(np.ascontiguousarray(fibonacci_directions(n)))


def bundle_of(directions: FloatArray) -> RayBundle:
    """Sort unit `directions`, shape (k, 3), by cells."""
    k = len(directions)
    cells = max(1, int(np.sqrt(k / (6.0 * RAYS_IN_CELL))))
    first, order = np.zeros(6 * cells * cells + 1, np.int64), np.empty(k, np.int64)
    _fill_order(directions, cells, first, order)
    return RayBundle(directions, directions[order], order, first, cells)


@kernel
def _fill_order(directions: FloatArray, cells: int, first: IntArray, order: IntArray) -> None:
    """Fill `first`, which must be 0, and `order` of :class:`RayBundle`."""
    cell = np.empty(len(directions), np.int64)
    for i in range(len(directions)):
        side, u, v = on_cube(directions, i)
        cell[i] = (side * cells + step_of(u, cells)) * cells + step_of(v, cells)
        first[cell[i] + 1] += 1
    for c in range(6 * cells * cells):
        first[c + 1] += first[c]
    filled = first.copy()
    for i in range(len(directions)):
        order[filled[cell[i]]] = i
        filled[cell[i]] += 1


@kernel_noalloc
def on_cube(points: FloatArray, i: int) -> tuple[int, float, float]:
    """Side of the cube on which point i is seen from the middle, and where; side -1 for the middle itself."""
    axis = 0
    for c in (1, 2):
        if abs(points[i, c]) > abs(points[i, axis]):
            axis = c
    high = abs(points[i, axis])
    if high == 0.0:
        return -1, 0.0, 0.0
    side = 2 * axis + (1 if points[i, axis] < 0.0 else 0)
    return side, points[i, (axis + 1) % 3] / high, points[i, (axis + 2) % 3] / high


@kernel_noalloc
def step_of(u: float, cells: int) -> int:
    """Cell along one edge of a side for a coordinate from -1 to 1; others are brought there."""
    return min(cells - 1, max(0, int((u + 1.0) * 0.5 * cells)))


def cast(points: FloatArray, faces: IntArray, rays: RayBundle) -> tuple[IntArray, FloatArray, FloatArray]:
    """All crossings, sorted by ray and distance, in compressed rows.

    Parameters
    ----------
    points, faces
        Mesh with vertices (n, 3) and triangles (m, 3).

    Returns
    -------
    first
        Crossings of ray k are ``first[k]:first[k + 1]``, shape (k + 1,).
    distance, sign
        Of each crossing; sign +1 where the ray leaves, -1 where it enters.
    """
    size = 3 * len(rays.order) + 16
    ray, crossings = np.empty(size, np.int64), np.empty((2, size))
    found = _fill_crossings(points, faces, rays, ray, crossings[0], crossings[1])
    if found > size:
        ray, crossings = np.empty(found, np.int64), np.empty((2, found))
        _fill_crossings(points, faces, rays, ray, crossings[0], crossings[1])
    first, (distance, sign) = np.zeros(len(rays.order) + 1, np.int64), np.empty((2, found))
    _sort_by_ray(ray[:found], crossings[0], crossings[1], first, distance, sign)
    return first, distance, sign


@kernel
def _fill_crossings(
    points: FloatArray,
    faces: IntArray,
    rays: RayBundle,
    ray: IntArray,
    distance: FloatArray,
    sign: FloatArray,
) -> int:
    """Number of crossings; fills ray, distance and sign of those that there is room for, face by face."""
    side, place = np.empty(len(points), np.int64), np.empty((len(points), 2))
    for i in range(len(points)):
        side[i], place[i, 0], place[i, 1] = on_cube(points, i)
    found = 0
    for f in range(len(faces)):
        found = crossed_by(points, faces[f], side, place, rays, ray, distance, sign, found)
    return found


@kernel_noalloc
def crossed_by(
    points: FloatArray,
    face: IntArray,
    side: IntArray,
    place: FloatArray,
    rays: RayBundle,
    ray: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    found: int,
) -> int:
    """Note the crossings with one triangle, from number `found` on; how many there are now.

    Two triangles with a common edge work out the same number for it but for its sign, so no ray slips
    through between them.
    """
    a, b, c = row(points, face[0]), row(points, face[1]), row(points, face[2])
    ab, bc, ca = cross(a, b), cross(b, c), cross(c, a)
    six = dot(ab, c)
    way = 1.0 if six > 0.0 else -1.0
    cells = rays.cells
    together = side[face[0]] == side[face[1]] == side[face[2]] and side[face[0]] >= 0
    for at in range(6):
        if together:
            if at != side[face[0]]:
                continue
            low_u, high_u, low_v, high_v = bounds_of(place, face)
        else:
            low_u, high_u, low_v, high_v = bounds_on(points, face, at)
            if low_u > high_u:
                continue
        low, high = step_of(low_v - REACH, cells), step_of(high_v + REACH, cells)
        for i in range(step_of(low_u - REACH, cells), step_of(high_u + REACH, cells) + 1):
            cell = (at * cells + i) * cells
            for m in range(rays.first[cell + low], rays.first[cell + high + 1]):
                u = row(rays.sorted_directions, m)
                e0 = way * dot(ab, u)
                if e0 < 0.0 or (e0 == 0.0 and way < 0.0):
                    continue
                e1 = way * dot(bc, u)
                if e1 < 0.0 or (e1 == 0.0 and way < 0.0):
                    continue
                e2 = way * dot(ca, u)
                # All three vanish for a triangle that is seen edge-on.
                if e2 < 0.0 or (e2 == 0.0 and way < 0.0) or e0 + e1 + e2 <= 0.0:
                    continue
                if found < len(ray):
                    ray[found], distance[found], sign[found] = rays.order[m], way * six / (e0 + e1 + e2), way
                found += 1
    return found


@kernel_noalloc
def bounds_of(place: FloatArray, face: IntArray) -> tuple[float, float, float, float]:
    """Bounds of a triangle whose corners are seen on one side of the cube."""
    i, j, k = face[0], face[1], face[2]
    return (
        min(place[i, 0], place[j, 0], place[k, 0]),
        max(place[i, 0], place[j, 0], place[k, 0]),
        min(place[i, 1], place[j, 1], place[k, 1]),
        max(place[i, 1], place[j, 1], place[k, 1]),
    )


@kernel_noalloc
def bounds_on(points: FloatArray, face: IntArray, side: int) -> tuple[float, float, float, float]:
    """Bounds of any triangle on one side of the cube; the first above the second if it is not seen there."""
    axis, way = side // 2, 1.0 - 2.0 * (side % 2)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    low_u, high_u, low_v, high_v = np.inf, -np.inf, np.inf, -np.inf
    behind, nearly, right, left, above, below = 0, 0, 0, 0, 0, 0
    for corner in range(3):
        w = way * points[face[corner], axis]
        u, v = points[face[corner], first], points[face[corner], second]
        behind += w < 0.0
        margin = REACH * (abs(u) + abs(v) + abs(w))
        right, left = right + (u - w > margin), left + (-u - w > margin)
        above, below = above + (v - w > margin), below + (-v - w > margin)
        if w <= NEARLY_BEHIND * (abs(u) + abs(v)):
            nearly += 1
            continue
        low_u, high_u, low_v, high_v = (
            min(low_u, u / w),
            max(high_u, u / w),
            min(low_v, v / w),
            max(high_v, v / w),
        )
    # All corners lie beyond one plane through the middle and an edge of the side.
    if max(behind, max(max(right, left), max(above, below))) == 3:
        return 1.0, -1.0, 1.0, -1.0
    # A corner nearly beside the middle would be projected far out: the triangle may lie anywhere on the side.
    return (low_u, high_u, low_v, high_v) if nearly == 0 else (-1.0, 1.0, -1.0, 1.0)


@kernel
def _sort_by_ray(
    ray: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    first: IntArray,
    placed_distance: FloatArray,
    placed_sign: FloatArray,
) -> None:
    """Fill `first`, 0 before, and the crossings in the order of their rays, each by rising distance."""
    for i in range(len(ray)):
        first[ray[i] + 1] += 1
    for k in range(len(first) - 1):
        first[k + 1] += first[k]
    filled = first[:-1].copy()
    for i in range(len(ray)):
        k = ray[i]
        j = filled[k]
        filled[k] += 1
        while j > first[k] and placed_distance[j - 1] > distance[i]:
            placed_distance[j], placed_sign[j] = placed_distance[j - 1], placed_sign[j - 1]
            j -= 1
        placed_distance[j], placed_sign[j] = distance[i], sign[i]
