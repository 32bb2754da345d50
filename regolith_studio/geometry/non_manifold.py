"""Split non-manifold edges, where more than two triangles meet, so that each edge has two."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.topology import EdgeTable, edge_table, neighbours

MIN_ROUNDS = 10
MAX_FACES_IN_ROUNDS = 2_000_000
"""Faces of all rounds together after the first ones: a few seconds."""


def split_non_manifold_edges(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Mesh data in which each pair of triangles at a non-manifold edge has an edge of its own.

    The pairs are those that bound a wedge of the solid; the surface in space stays the same.
    Vertices are doubled where that parts the pairs; where the surface closes again about both ends
    of the edge, each pair gets its own vertex in the middle of it. The faces must run
    counter-clockwise seen from outside. A triangle that finds no partner is left with an open edge.

    Raises
    ------
    GeometryError
        If that would take too much work.
    """
    vertices, faces = _split_vertices(vertices, faces)
    rounds = work = 0
    while (table := edge_table(faces, len(vertices))).non_manifold_edges:
        rounds, work = rounds + 1, work + len(faces)
        if rounds > MIN_ROUNDS and work > MAX_FACES_IN_ROUNDS:
            raise GeometryError("The mesh is a tangle: too many of its faces meet at the same edges.")
        vertices, faces = _insert_midpoints(vertices, faces, table)
    return vertices, faces


def wedge_neighbours(vertices: FloatArray, faces: IntArray, table: EdgeTable, across: IntArray) -> IntArray:
    """`across` with the triangles at non-manifold edges paired so that each pair bounds a wedge of the solid.

    The triangles must run counter-clockwise seen from outside. About an edge, in the order of their
    angle, a triangle that runs along the edge has the solid behind it, so its partner is the one
    before it, if that runs the other way.
    """
    across = across.copy()
    halves = np.argsort(table.edge, kind="stable")
    halves = halves[table.uses[table.edge[halves]] > 2]
    edge = table.edge[halves]
    low, high = vertices[table.ends[edge, 0]], vertices[table.ends[edge, 1]]
    thirds = vertices[faces.ravel()[halves - halves % 3 + (halves + 2) % 3]] - low
    halves = halves[np.lexsort((_angles(high - low, thirds), edge))]
    rings = np.split(halves, np.flatnonzero(np.diff(edge)) + 1)
    pairs = [pair for ring in rings for pair in _wedges(ring.tolist(), table.forward[ring].tolist())]
    half, behind = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    across[half], across[behind] = behind, half
    return across


def _wedges(ring: list[int], forward: list[bool]) -> list[tuple[int, int]]:
    """Forward half-edges of a ring in angular order, each with the backward one before it.

    They pair as brackets do, a backward one opening and a forward one closing, around the ring.
    """
    pairs, early, opened = [], [], []
    for half, closes in zip(ring, forward, strict=True):
        if not closes:
            opened.append(half)
        elif opened:
            pairs.append((half, opened.pop()))
        else:
            early.append(half)
    return pairs + list(zip(early, reversed(opened), strict=False))


def _angles(axes: FloatArray, spokes: FloatArray) -> FloatArray:
    """Angle of each spoke about its axis, counter-clockwise seen against it; all of shape (n, 3)."""
    first = np.cross(axes, np.eye(3)[np.argmin(np.abs(axes), axis=1)])
    second = np.cross(axes, first)
    return np.asarray(
        np.arctan2(
            (spokes * second).sum(axis=1) * np.linalg.norm(first, axis=1),
            (spokes * first).sum(axis=1) * np.linalg.norm(second, axis=1),
        )
    )


def _split_vertices(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    table = edge_table(faces, len(vertices))
    corner = _fans(faces, wedge_neighbours(vertices, faces, table, neighbours(table)))
    _, first, inverse = np.unique(corner, return_index=True, return_inverse=True)
    return vertices[faces.ravel()[first]], inverse.reshape(-1, 3).astype(np.int64)


def _fans(faces: IntArray, across: IntArray) -> IntArray:
    """A number for each corner, shape (3 m,): equal for corners at a vertex joined by neighbours."""
    half = np.flatnonzero(across >= 0)
    other = across[half]
    onward = half - half % 3 + (half + 1) % 3
    other_onward = other - other % 3 + (other + 1) % 3
    same = faces.ravel()[half] == faces.ravel()[other]
    rows = np.concatenate([half, onward])
    columns = np.concatenate([np.where(same, other, other_onward), np.where(same, other_onward, other)])
    links = coo_array((np.ones(len(rows)), (rows, columns)), (faces.size,) * 2)
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def _insert_midpoints(vertices: FloatArray, faces: IntArray, table: EdgeTable) -> tuple[FloatArray, IntArray]:
    """Halve the triangles at non-manifold edges, at most one edge of each triangle at a time."""
    across = wedge_neighbours(vertices, faces, table, neighbours(table))
    touched: set[int] = set()
    points: list[FloatArray] = []
    halves: list[tuple[int, int, int]] = []
    order = np.argsort(table.edge, kind="stable")
    first = np.cumsum(table.uses) - table.uses
    for edge in np.flatnonzero(table.uses > 2):
        around = order[first[edge] : first[edge] + table.uses[edge]]
        if touched.intersection((around // 3).tolist()):
            continue
        touched.update((around // 3).tolist())
        middle = vertices[table.ends[edge]].mean(axis=0)
        number: dict[int, int] = {}
        for half in around.tolist():
            number[half] = number.get(int(across[half]), len(vertices) + len(points))
            if number[half] == len(vertices) + len(points):
                points.append(middle)
            halves += _split_triangle(faces, half, number[half])
    kept = np.delete(faces, sorted(touched), axis=0)
    return np.concatenate([vertices, points]), np.concatenate([kept, np.array(halves, dtype=np.int64)])


def _split_triangle(faces: IntArray, half: int, middle: int) -> list[tuple[int, int, int]]:
    """The two triangles of a face whose half-edge gets a vertex in its middle."""
    face = faces[half // 3].tolist()
    a, b, c = (face[(half + step) % 3] for step in range(3))
    return [(a, middle, c), (middle, b, c)]
