"""Crossings of parallel lines with a particle: three bundles at right angles, on square grids."""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.mesh import Mesh

# Particles lie in their principal axes: lines along these would run within flat sides.
TURN = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0
"""Directions of the bundles, one a row: far from the principal axes."""
MARGIN = 1e-6


class ScanLines(NamedTuple):
    """Lines and where they cross a particle of unit volume.

    Parameters
    ----------
    directions
        Of the three bundles, one a row, (3, 3).
    bundle, points
        Of each line: its bundle, (m,), and a point on it, (m, 3).
    first
        Crossings of line i are ``first[i]:first[i + 1]``, shape (m + 1,).
    distance, sign
        Of each crossing from the line's point, rising along each line; sign +1.0 where the line leaves the
        particle, -1.0 where it enters.
    weight
        Volume that a unit of length stands for, so that the particle's own volume is 1.
    """

    directions: FloatArray
    bundle: IntArray
    points: FloatArray
    first: IntArray
    distance: FloatArray
    sign: FloatArray
    weight: float


def scan_lines(mesh: Mesh, n_lines: int) -> ScanLines:
    """Lines as dense as `n_lines` that meet a ball of the volume of a closed mesh, which is 1."""
    low, high = mesh.bounds
    centre = (low + high) / 2.0
    mesh = mesh.moved(shift=-centre)
    radius = float(np.linalg.norm(mesh.vertices, axis=1).max()) * (1.0 + MARGIN)
    # Each of the three bundles has pi r^2 / step^2 lines through the ball of unit volume.
    step = np.sqrt(3.0 * np.pi / n_lines) * (3.0 / (4.0 * np.pi)) ** (1.0 / 3.0)
    per_side = int(2.0 * radius / step) + 1
    grid = (np.arange(per_side) + 0.5) * step - 0.5 * per_side * step
    bundles = [_crossings(mesh, TURN[b], TURN[(b + 1) % 3], TURN[(b + 2) % 3], grid) for b in range(3)]
    lines, distances, signs = (np.concatenate(each) for each in zip(*bundles, strict=True))
    lines = lines + np.repeat(np.arange(3), [len(each[0]) for each in bundles]) * per_side**2
    used, counts = np.unique(lines, return_counts=True)
    bundle, place = np.divmod(used, per_side**2)
    u, v = TURN[(bundle + 1) % 3], TURN[(bundle + 2) % 3]
    points = centre + grid[place // per_side, None] * u + grid[place % per_side, None] * v
    order = np.lexsort((distances, lines))
    distances, signs = distances[order], signs[order]
    first = np.concatenate([[0], np.cumsum(counts)])
    weight = 1.0 / float(np.sum(signs * distances))
    return ScanLines(TURN.copy(), bundle, points, first, distances, signs, weight)


def _crossings(
    mesh: Mesh, along: FloatArray, across: FloatArray, third: FloatArray, grid: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Line, distance and sign of each crossing of one bundle, in no order."""
    flat = np.stack([_heights(mesh.vertices, each) for each in (across, third, along)], axis=1)
    faces = np.array(mesh.faces)
    room = 8 * len(grid) ** 2
    while True:
        line, distance, sign = np.empty(room, dtype=np.int64), np.empty(room), np.empty(room)
        found = _fill_crossings(flat, faces, grid, line, distance, sign)
        if found <= room:
            return line[:found], distance[:found], sign[:found]
        room = found


def _heights(points: FloatArray, axis: FloatArray) -> FloatArray:
    """Coordinates of points along an axis, added up in one order on every processor."""
    x, y, z = points.T
    return np.asarray(x * axis[0] + y * axis[1] + z * axis[2])


@kernel_noalloc
def _fill_crossings(
    flat: FloatArray,
    faces: IntArray,
    grid: FloatArray,
    line: IntArray,
    distance: FloatArray,
    sign: FloatArray,
) -> int:
    """Number of crossings; fills as many as there is room for.

    Two triangles with a common edge work out the same number for it but for its sign, so no line slips
    through between them.

    Parameters
    ----------
    flat
        Vertices in the frame of the bundle, its direction last, shape (v, 3).
    grid
        Coordinates of the lines on either axis, shape (g,); line (i, j) has the number g i + j.
    """
    found, g = 0, len(grid)
    step = grid[1] - grid[0]
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        low_u, high_u = min(flat[i, 0], flat[j, 0], flat[k, 0]), max(flat[i, 0], flat[j, 0], flat[k, 0])
        low_v, high_v = min(flat[i, 1], flat[j, 1], flat[k, 1]), max(flat[i, 1], flat[j, 1], flat[k, 1])
        from_u, to_u = int(np.floor((low_u - grid[0]) / step)), int(np.ceil((high_u - grid[0]) / step))
        from_v, to_v = int(np.floor((low_v - grid[0]) / step)), int(np.ceil((high_v - grid[0]) / step))
        for a in range(max(from_u, 0), min(to_u, g - 1) + 1):
            for b in range(max(from_v, 0), min(to_v, g - 1) + 1):
                u, v = grid[a], grid[b]
                e0 = (flat[i, 0] - u) * (flat[j, 1] - v) - (flat[i, 1] - v) * (flat[j, 0] - u)
                e1 = (flat[j, 0] - u) * (flat[k, 1] - v) - (flat[j, 1] - v) * (flat[k, 0] - u)
                e2 = (flat[k, 0] - u) * (flat[i, 1] - v) - (flat[k, 1] - v) * (flat[i, 0] - u)
                total = e0 + e1 + e2
                way = 1.0 if total > 0.0 else -1.0
                if way * e0 < 0.0 or way * e1 < 0.0 or way * e2 < 0.0 or total == 0.0:
                    continue
                if way < 0.0 and (e0 == 0.0 or e1 == 0.0 or e2 == 0.0):
                    continue
                if found < len(line):
                    line[found], sign[found] = g * a + b, way
                    distance[found] = (e1 * flat[i, 2] + e2 * flat[j, 2] + e0 * flat[k, 2]) / total
                found += 1
    return found
