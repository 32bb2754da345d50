"""Polygons of a file cut into triangles: fans where convex, ears where concave."""

import numpy as np
from numpy.typing import NDArray

LARGEST_EARED = 2000
"""Concave polygons with more corners are cut fan-wise: ear clipping takes quadratic time."""
MOST_TRIALS = 20_000
"""Corners of one polygon that are looked at; the ears of simple ones are found long before."""


def triangulated(
    vertices: NDArray[np.float64], corners: NDArray[np.int64], sizes: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Triangles of polygons that are stored one after the other.

    Parameters
    ----------
    vertices
        Shape (n, 3); every corner must index it.
    corners
        Vertex indices of all polygons, flat, shape (sum of sizes,).
    sizes
        Number of corners of each polygon, shape (k,). Those with fewer than three give nothing.

    Returns
    -------
    NDArray[np.int64]
        Shape (m, 3), in the polygons' order for polygons of the same size.
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
    if size <= LARGEST_EARED:
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
    flat = _in_its_plane(points)
    ring, triangles = list(range(len(flat))), []
    place = misses = trials = 0
    while len(ring) > 3 and misses < len(ring) and trials < MOST_TRIALS:
        place, trials = place % len(ring), trials + 1
        if not _is_ear(flat, ring, place):
            place, misses = place + 1, misses + 1
            continue
        triangles.append((ring[place - 1], ring[place], ring[(place + 1) % len(ring)]))
        del ring[place]
        misses = 0
    rest = [(ring[0], ring[i], ring[i + 1]) for i in range(1, len(ring) - 1)]
    return np.array(triangles + rest, dtype=np.int64)


def _in_its_plane(points: NDArray[np.float64]) -> NDArray[np.float64]:
    normal = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
    dropped = int(np.argmax(np.abs(normal)))
    first, second = [axis for axis in range(3) if axis != dropped]
    if (normal[dropped] < 0) != (dropped == 1):
        first, second = second, first
    return points[:, [first, second]]


def _is_ear(flat: NDArray[np.float64], ring: list[int], place: int) -> bool:
    """Whether the corner is convex and no other vertex lies in its triangle."""
    triangle = (ring[place - 1], ring[place], ring[(place + 1) % len(ring)])
    a, b, c = flat[list(triangle)]
    if _cross(b - a, c - b) <= 0:
        return False
    others = flat[[index for index in ring if index not in triangle]]
    inside = np.ones(len(others), dtype=np.bool_)
    for start, stop in ((a, b), (b, c), (c, a)):
        edge, spoke = stop - start, others - start
        inside &= edge[0] * spoke[:, 1] - edge[1] * spoke[:, 0] >= 0
    return not inside.any()


def _cross(first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
    return float(first[0] * second[1] - first[1] * second[0])
