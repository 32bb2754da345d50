"""Holes of a surface: their rims, and triangles that close them with the least area."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.edges import edge_table, neighbours
from regolith_studio.geometry.kernels import kernel

LARGEST_EXACT_RIM = 300
"""Rims with more corners are closed by a fan about their middle: the best cover takes cubic time."""


@dataclass(frozen=True)
class FilledHoles:
    """A mesh whose holes are closed.

    Parameters
    ----------
    vertices, faces
        Those of the open mesh, then the new ones.
    count
        Number of holes.
    area
        Area of all new triangles, in the square of the mesh's unit.
    """

    vertices: FloatArray
    faces: IntArray
    count: int
    area: float


def rims(faces: IntArray, n_vertices: int) -> list[IntArray]:
    """Vertices around each hole, in the order in which the missing triangles run.

    The faces must be wound consistently. Where two holes touch in a vertex, each has its own rim.
    """
    table = edge_table(faces, n_vertices)
    lone = np.flatnonzero(neighbours(table) < 0)
    start, stop = np.roll(faces, -1, axis=1).ravel()[lone], faces.ravel()[lone]
    onward: dict[int, list[int]] = {}
    for a, b in zip(start.tolist(), stop.tolist(), strict=True):
        onward.setdefault(a, []).append(b)
    loops = []
    for seed in sorted(onward):
        while onward[seed]:
            loops += _walk(seed, onward)
    return [np.array(loop, dtype=np.int64) for loop in loops]


def _walk(seed: int, onward: dict[int, list[int]]) -> list[list[int]]:
    """Loops met on a walk from `seed` until no rim leads on; each is cut off as soon as it closes."""
    loops, path, place = [], [seed], {seed: 0}
    while onward.get(path[-1]):
        step = onward[path[-1]].pop()
        if step in place:
            cut = place[step]
            loops.append(path[cut:])
            for vertex in path[cut + 1 :]:
                del place[vertex]
            del path[cut + 1 :]
        else:
            place[step] = len(path)
            path.append(step)
    return loops


def filled(vertices: FloatArray, faces: IntArray, *, only_fans: bool = False) -> FilledHoles:
    """Close every hole of a consistently wound mesh.

    A hole gets the triangulation of its rim with the least area, which is exact for flat rims; a
    fan about the rim's middle where the rim is long or its triangulation would double an edge.
    """
    holes = [rim for rim in rims(faces, len(vertices)) if len(rim) >= 3]
    middles: list[FloatArray] = []
    patches = [faces]
    area = 0.0
    taken = _edges_between(holes, faces, len(vertices))
    for rim in holes:
        patch = None if only_fans else _tight(vertices, rim, taken)
        if patch is None:
            middle = vertices[rim].mean(axis=0)
            apex = np.full(len(rim), len(vertices) + len(middles))
            patch = np.column_stack([rim, np.roll(rim, -1), apex])
            area += _area(vertices[patch[:, 0]], vertices[patch[:, 1]], middle)
            middles.append(middle)
        else:
            area += _area(*np.moveaxis(vertices[patch], 1, 0))
        patches.append(patch)
    points = np.concatenate([vertices, middles]) if middles else vertices
    return FilledHoles(points, np.concatenate(patches), len(holes), area)


def _area(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def _edges_between(holes: list[IntArray], faces: IntArray, n_vertices: int) -> set[tuple[int, ...]]:
    """The edges of a mesh whose both ends lie on a rim, as pairs with the lower index first."""
    if not holes:
        return set()
    on_rim = np.zeros(n_vertices, dtype=np.bool_)
    on_rim[np.concatenate(holes)] = True
    ends = edge_table(faces, n_vertices).ends
    return {tuple(edge) for edge in ends[on_rim[ends].all(axis=1)].tolist()}


def _tight(vertices: FloatArray, rim: IntArray, taken: set[tuple[int, ...]]) -> IntArray | None:
    """Least-area triangles of a rim whose inner edges are new; adds those to `taken`."""
    n = len(rim)
    if n > LARGEST_EXACT_RIM:
        return None
    barred = np.zeros((n, n), dtype=np.bool_)
    for i in range(n):
        for k in range(i + 2, n - (i == 0)):
            barred[i, k] = (min(rim[i], rim[k]), max(rim[i], rim[k])) in taken
    places = least_area_triangles(vertices[rim], barred)
    if len(places) != n - 2:
        return None
    triangles = rim[places]
    for ends in np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2).tolist():
        taken.add((min(ends), max(ends)))
    return triangles


@kernel
def least_area_triangles(points: FloatArray, barred: BoolArray) -> IntArray:
    """Triangulation of a closed polygon in space with the least area, shape (n - 2, 3).

    Dynamic programming over the polygon's chords (Barequet and Sharir 1995); chords (i, k), i < k,
    with ``barred[i, k]`` are not used. The result is empty where no triangulation is left.
    """
    n = len(points)
    cost = np.full((n, n), np.inf)
    apex = np.full((n, n), -1, dtype=np.int64)
    for i in range(n - 1):
        cost[i, i + 1] = 0.0
    for span in range(2, n):
        for i in range(n - span):
            k = i + span
            if barred[i, k]:
                continue
            for j in range(i + 1, k):
                if cost[i, j] + cost[j, k] < cost[i, k]:
                    normal = np.cross(points[j] - points[i], points[k] - points[i])
                    value = cost[i, j] + cost[j, k] + np.sqrt((normal * normal).sum()) / 2
                    if value < cost[i, k]:
                        cost[i, k] = value
                        apex[i, k] = j
    if not np.isfinite(cost[0, n - 1]):
        return np.empty((0, 3), dtype=np.int64)
    triangles = np.empty((n - 2, 3), dtype=np.int64)
    stack = np.empty((n, 2), dtype=np.int64)
    stack[0, 0], stack[0, 1] = 0, n - 1
    height, found = 1, 0
    while height > 0:
        height -= 1
        i, k = stack[height]
        if k - i < 2:
            continue
        j = apex[i, k]
        triangles[found, 0], triangles[found, 1], triangles[found, 2] = i, j, k
        found += 1
        stack[height, 0], stack[height, 1] = i, j
        stack[height + 1, 0], stack[height + 1, 1] = j, k
        height += 2
    return triangles
