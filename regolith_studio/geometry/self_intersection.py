"""Triangles of a mesh that cross each other."""

import numpy as np
from numba import int64

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray, locked_integers
from regolith_studio.geometry.kernels import inner_kernel, kernel

# 16 MB of counts.
MAX_CELLS = 1 << 21
SLACK = 1e-12
"""Share of a triangle by which an edge must pass inside its boundary."""

MAX_CANDIDATES = 200
"""Mean number of triangles in a triangle's cells beyond which the search is given up."""


def count_self_intersections(vertices: FloatArray, faces: IntArray) -> int | None:
    """Number of pairs of triangles that cross, or ``None`` where the search would take too long.

    Two triangles cross where an edge of one passes through the inside of the other; triangles that
    touch in a shared edge, or overlap within one plane, do not count. Triangles are sorted into the
    cells of a grid as fine as they are; only those that share a cell are compared.
    """
    crossing = crossing_pairs(vertices, faces)
    return None if crossing is None else crossing[0]


def crossing_pairs(vertices: FloatArray, faces: IntArray) -> tuple[int, BoolArray] | None:
    """As `count_self_intersections`, with the triangles that cross another, shape (m,)."""
    if len(faces) < 2:
        return 0, np.zeros(len(faces), dtype=np.bool_)
    faces = locked_integers(faces, (None, 3), "faces")  # one kind of array, which is compiled ahead
    corners = np.ascontiguousarray(vertices[faces])
    low, high = corners.min(axis=1), corners.max(axis=1)
    origin, size = low.min(axis=0), (high.max(axis=0) - low.min(axis=0)).max()
    if not size > 0.0:
        return 0, np.zeros(len(faces), dtype=np.bool_)
    edge = max(float((high - low).max(axis=1).mean()), size / 4096)
    shape = np.maximum(np.ceil((high.max(axis=0) - origin) / edge), 1.0)
    while shape.prod() > MAX_CELLS:
        edge *= 1.3
        shape = np.maximum(np.ceil((high.max(axis=0) - origin) / edge), 1.0)
    cells = shape.astype(np.int64)
    first = np.minimum(((low - origin) / edge).astype(np.int64), cells - 1)
    last = np.minimum(((high - origin) / edge).astype(np.int64), cells - 1)
    entries = int((last - first + 1).prod(axis=1).sum())
    if entries > 64 * len(faces) + 4096:
        return None
    start, member = np.zeros(int(cells.prod()) + 1, dtype=np.int64), np.empty(entries, dtype=np.int64)
    fill_cells(first, last, cells, start, member)
    load = np.diff(start)
    if float((load.astype(np.float64) ** 2).sum()) > MAX_CANDIDATES * (len(faces) + 4096):
        return None
    crossing = np.zeros(len(faces), dtype=np.bool_)
    return int(mark_crossings(corners / size, faces, first, cells, start, member, crossing)), crossing


@kernel
def fill_cells(first: IntArray, last: IntArray, cells: IntArray, start: IntArray, member: IntArray) -> None:
    """Members of each cell: triangle numbers, and where each cell's begin (all 0 before)."""
    for stage in range(2):
        for t in range(len(first)):
            for i in range(first[t, 0], last[t, 0] + 1):
                for j in range(first[t, 1], last[t, 1] + 1):
                    for k in range(first[t, 2], last[t, 2] + 1):
                        cell = (i * cells[1] + j) * cells[2] + k
                        if stage == 0:
                            start[cell + 1] += 1
                        else:
                            member[start[cell]] = t
                            start[cell] += 1
        if stage == 0:
            for cell in range(len(start) - 1):
                start[cell + 1] += start[cell]
    for cell in range(len(start) - 1, 0, -1):
        start[cell] = start[cell - 1]
    start[0] = 0


@kernel
def mark_crossings(
    corners: FloatArray,
    faces: IntArray,
    first: IntArray,
    cells: IntArray,
    start: IntArray,
    member: IntArray,
    crossing: BoolArray,
) -> int:
    """Number of crossing pairs, each counted in the lowest cell that both reach; marks `crossing`."""
    count = int64(0)
    for cell in range(len(start) - 1):
        i = cell // (cells[1] * cells[2])
        j = cell // cells[2] % cells[1]
        k = cell % cells[2]
        for p in range(start[cell], start[cell + 1]):
            a = member[p]
            for q in range(p + 1, start[cell + 1]):
                b = member[q]
                if (
                    max(first[a, 0], first[b, 0]) == i
                    and max(first[a, 1], first[b, 1]) == j
                    and max(first[a, 2], first[b, 2]) == k
                    and cross(corners[a], corners[b], faces[a], faces[b])
                ):
                    crossing[a] = crossing[b] = True
                    count += 1
    return count  # type: ignore[return-value]


@inner_kernel
def cross(a: FloatArray, b: FloatArray, face_a: IntArray, face_b: IntArray) -> bool:
    """Whether an edge of one triangle passes through the other; shared corners are left out."""
    for axis in range(3):
        if max(a[0, axis], a[1, axis], a[2, axis]) < min(b[0, axis], b[1, axis], b[2, axis]):
            return False
        if max(b[0, axis], b[1, axis], b[2, axis]) < min(a[0, axis], a[1, axis], a[2, axis]):
            return False
    shared = 0
    for i in range(3):
        for j in range(3):
            if face_a[i] == face_b[j]:
                shared += 1
    # Triangles with a common edge meet in it and nowhere else.
    if shared > 1:
        return False
    return pierces(a, b, face_a, face_b) or pierces(b, a, face_b, face_a)


@inner_kernel
def pierces(a: FloatArray, b: FloatArray, face_a: IntArray, face_b: IntArray) -> bool:
    """Whether an edge of triangle `a` that has no corner in common with `b` passes through `b`."""
    ux, uy, uz = b[1, 0] - b[0, 0], b[1, 1] - b[0, 1], b[1, 2] - b[0, 2]
    vx, vy, vz = b[2, 0] - b[0, 0], b[2, 1] - b[0, 1], b[2, 2] - b[0, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    square = nx * nx + ny * ny + nz * nz
    if square == 0.0:
        return False
    slack = SLACK * np.sqrt(square)
    for i in range(3):
        j = (i + 1) % 3
        px, py, pz = a[i, 0] - b[0, 0], a[i, 1] - b[0, 1], a[i, 2] - b[0, 2]
        qx, qy, qz = a[j, 0] - b[0, 0], a[j, 1] - b[0, 1], a[j, 2] - b[0, 2]
        p = px * nx + py * ny + pz * nz
        q = qx * nx + qy * ny + qz * nz
        if not ((p > slack and q < -slack) or (p < -slack and q > slack)):
            continue
        # An edge with a common corner only touches the other triangle there.
        common = False
        for k in range(3):
            if face_a[i] == face_b[k] or face_a[j] == face_b[k]:
                common = True
        if common:
            continue
        share = p / (p - q)
        x, y, z = px + share * (qx - px), py + share * (qy - py), pz + share * (qz - pz)
        first = (uy * z - uz * y) * nx + (uz * x - ux * z) * ny + (ux * y - uy * x) * nz
        second = (y * vz - z * vy) * nx + (z * vx - x * vz) * ny + (x * vy - y * vx) * nz
        least = SLACK * square
        if first > least and second > least and square - first - second > least:
            return True
    return False
