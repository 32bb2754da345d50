"""Polygons of a file cut into triangles: fans where convex, ears where concave."""

import numpy as np
from numpy.typing import NDArray

MAX_EAR_CLIPPED = 2000
"""Concave polygons with more corners are cut fan-wise: ear clipping takes quadratic time."""
MAX_TRIALS = 20_000
"""Corners of one polygon that are looked at; the ears of simple ones are found long before."""


def triangulated(
    vertices: NDArray[np.float64], corners: NDArray[np.int64], sizes: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Triangles of polygons that are stored one after the other.

    - ``vertices``: shape (n, 3); every corner must index it.
    - ``corners``: vertex indices of all polygons, flat, shape (sum of sizes,).
    - ``sizes``: number of corners of each polygon, shape (k,). Those with fewer than three give nothing.

    Returns shape (m, 3), in the polygons' order for polygons of the same size.
    """
    starts = np.cumsum(sizes) - sizes
    parts = [
        _of_one_size(vertices, corners[starts[sizes == size][:, None] + np.arange(size)])
        for size in np.unique(sizes)
        if size >= 3
    ]
    return np.concatenate(parts) if parts else np.zeros((0, 3), dtype=np.int64)


def _of_one_size(vertices: NDArray[np.float64], polygons: NDArray[np.int64]) -> NDArray[np.int64]:
    size = polygons.shape[1]
    if size == 3:
        return polygons
    fan = np.column_stack([np.zeros(size - 2, dtype=np.int64), np.arange(1, size - 1), np.arange(2, size)])
    triangles = polygons[:, fan]
    if size <= MAX_EAR_CLIPPED:
        with np.errstate(all="ignore"):
            for index in np.flatnonzero(_concave(vertices[polygons])):
                triangles[index] = polygons[index][_ears(vertices[polygons[index]])]
    return triangles.reshape(-1, 3)


def _concave(points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which polygons, shape (k, size, 3), have a corner that turns against their normal."""
    ahead, behind = np.roll(points, -1, axis=1) - points, points - np.roll(points, 1, axis=1)
    turns = np.cross(behind, ahead)
    normal = np.cross(points, np.roll(points, -1, axis=1)).sum(axis=1, keepdims=True)
    along = (turns * normal).sum(axis=2)
    return np.asarray((along < -1e-12 * np.abs(along).max(axis=1, keepdims=True)).any(axis=1))


def _ears(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Ear clipping of one polygon, shape (size, 3), in the plane of its Newell normal.

    Each search begins where the last ear was. A polygon without ears crosses itself; the rest of it is cut
    fan-wise.
    """
    flat, ring = _in_its_plane(points).T.copy(), np.arange(len(points))
    size, triangles = len(ring), []
    place = misses = trials = 0
    while size > 3 and misses < size and trials < MAX_TRIALS:
        place, trials = place % size, trials + 1
        corners = [place - 1 if place else size - 1, place, (place + 1) % size]
        if not _is_ear(flat[:, :size], corners):
            place, misses = place + 1, misses + 1
            continue
        triangles.append(ring[corners])
        for row in (ring, *flat):
            row[place : size - 1] = row[place + 1 : size]
        size, misses = size - 1, 0
    rest = [(ring[0], ring[i], ring[i + 1]) for i in range(1, size - 1)]
    return np.array(triangles + rest, dtype=np.int64)


def _in_its_plane(points: NDArray[np.float64]) -> NDArray[np.float64]:
    normal = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
    dropped = int(np.argmax(np.abs(normal)))
    first, second = [axis for axis in range(3) if axis != dropped]
    # What is left without y, x and z, is left-handed.
    if (normal[dropped] < 0) != (dropped == 1):
        first, second = second, first
    return points[:, [first, second]]


def _is_ear(flat: NDArray[np.float64], corners: list[int]) -> bool:
    """Whether the middle one of three corners is convex and no other, shape (2, size), in its triangle."""
    a, b, c = flat[:, corners].T.tolist()
    if (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) <= 0:
        return False
    x, y = flat
    inside = np.ones(len(x), dtype=np.bool_)
    inside[corners] = False
    for start, stop in ((a, b), (b, c), (c, a)):
        left = (stop[0] - start[0]) * (y - start[1])
        left -= (stop[1] - start[1]) * (x - start[0])
        inside &= left >= 0
    return not inside.any()
