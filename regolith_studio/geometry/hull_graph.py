"""Walks over the surface of a triangulated convex solid.

Extreme vertices by hill climbing (on a convex solid no other maximum can stop it), and the shadow's
outline by walking along the edges between faces that look up and faces that look down. Both take about
the square root of the number of faces.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.inlined import Vector, inlined

SLIVER = 1e-14
"""A triangle of less area, at solid size 1, has no normal of its own."""

COPLANAR = 1e-9
"""Neighbouring faces whose normals differ by less, in radians, are one facet."""


class HullGraph(NamedTuple):
    """A closed triangulated convex solid as half-edges; half-edge 3 f + k starts at corner k of face f.

    Parameters
    ----------
    points
        Vertices, shape (n, 3).
    normals
        Outward unit normals of the faces, shape (m, 3); the same for all faces of a plane facet.
    facet
        First face of the facet that each face belongs to, shape (m,).
    origin
        Vertex at which each half-edge starts, shape (3 m,).
    twin
        The same edge run the other way, shape (3 m,); -1 where there is none.
    outgoing
        One half-edge that starts at each vertex, shape (n,).
    """

    points: FloatArray
    normals: FloatArray
    facet: IntArray
    origin: IntArray
    twin: IntArray
    outgoing: IntArray


@kernel
def hull_graph(points: FloatArray, faces: IntArray) -> HullGraph:
    """Half-edges of outward triangles, faces of shape (m, 3)."""
    origin = faces.copy().reshape(-1)
    first = np.zeros(len(points) + 1, np.int64)
    for h in range(len(origin)):
        first[origin[h] + 1] += 1
    for v in range(len(points)):
        first[v + 1] += first[v]
    bucket = np.empty(len(origin), np.int64)
    filled = first.copy()
    for h in range(len(origin)):
        bucket[filled[origin[h]]] = h
        filled[origin[h]] += 1
    twin = np.full(len(origin), -1)
    for h in range(len(origin)):
        v = origin[after(h)]
        for i in range(first[v], first[v + 1]):
            if origin[after(bucket[i])] == origin[h]:
                twin[h] = bucket[i]
    outgoing = np.full(len(points), -1)
    for h in range(len(origin)):
        outgoing[origin[h]] = h
    normals = _face_normals(points, faces, twin)
    facet = _facets(normals, twin)
    return HullGraph(points, normals, facet, origin, twin, outgoing)


@kernel
def _face_normals(points: FloatArray, faces: IntArray, twin: IntArray) -> FloatArray:
    """Unit normals; a sliver takes that of the neighbour across its longest edge."""
    normals = np.zeros((len(faces), 3))
    slivers = 0
    for f in range(len(faces)):
        vector = np.cross(
            points[faces[f, 1]] - points[faces[f, 0]], points[faces[f, 2]] - points[faces[f, 0]]
        )
        length = np.sqrt(np.sum(vector**2))
        if length > 2.0 * SLIVER:
            normals[f] = vector / length
        else:
            slivers += 1
    for _ in range(slivers):
        for f in range(len(faces)):
            if not normals[f].any():
                longest = 0.0
                for k in range(3):
                    length = np.sum((points[faces[f, (k + 1) % 3]] - points[faces[f, k]]) ** 2)
                    if length > longest and twin[3 * f + k] >= 0:
                        longest = length
                        normals[f] = normals[twin[3 * f + k] // 3]
    return normals


@kernel
def _facets(normals: FloatArray, twin: IntArray) -> IntArray:
    """First face of the facet of each face; all faces of a facet get its normal."""
    facet = np.full(len(normals), -1)
    stack = np.empty(len(normals), np.int64)
    for seed in range(len(normals)):
        if facet[seed] >= 0:
            continue
        facet[seed], stack[0], n = seed, seed, 1
        while n > 0:
            n -= 1
            face = stack[n]
            for h in range(3 * face, 3 * face + 3):
                f = twin[h] // 3
                if f >= 0 and facet[f] < 0 and np.sum((normals[f] - normals[seed]) ** 2) < COPLANAR**2:
                    facet[f], stack[n], normals[f] = seed, f, normals[seed]
                    n += 1
    return facet


@inlined
def after(h: int) -> int:
    """The next half-edge around the face of half-edge `h`."""
    return h - 2 if h % 3 == 2 else h + 1


@inlined
def along(rows: FloatArray, i: int, direction: Vector) -> float:
    """Scalar product of row `i` of an array of shape (n, 3) with `direction`."""
    return float(rows[i, 0] * direction[0] + rows[i, 1] * direction[1] + rows[i, 2] * direction[2])


@inlined
def extreme_vertex(graph: HullGraph, direction: Vector, start: int) -> int:
    """Vertex farthest along `direction`, by hill climbing from vertex `start`."""
    here = start
    height = along(graph.points, here, direction)
    climbing = True
    while climbing:
        climbing = False
        first = graph.outgoing[here]
        h = first
        while True:
            there = graph.origin[after(h)]
            value = along(graph.points, there, direction)
            if value > height:
                here, height, climbing = there, value, True
                break
            h = graph.twin[after(after(h))]
            if h == first:
                break
    return here


@inlined
def walk_rim(graph: HullGraph, axis: Vector, start: int, rim: IntArray) -> int:
    """Outline of the shadow along `axis`, counter-clockwise seen from its tip.

    Parameters
    ----------
    start
        A vertex of the outline.
    rim
        Receives the vertices; as long as there are vertices.

    Returns
    -------
    int
        Number of vertices, 0 where rounding hides the outline (an edge-on sliver).
    """
    h = graph.outgoing[start]
    while not _on_rim(graph, axis, h):
        h = graph.twin[after(after(h))]
        if h == graph.outgoing[start]:
            return 0
    first = h
    n = 0
    while n < len(rim):
        rim[n] = graph.origin[h]
        n += 1
        h = after(h)
        turns = 0
        while not _on_rim(graph, axis, h):
            h = after(graph.twin[h])
            turns += 1
            if turns > len(rim):
                return 0
        if h == first:
            return n
    return 0


@inlined
def _on_rim(graph: HullGraph, axis: Vector, h: int) -> bool:
    """Whether the face of half-edge `h` looks up and the one beyond looks down."""
    up = along(graph.normals, h // 3, axis) > 0.0
    return bool(up and not along(graph.normals, graph.twin[h] // 3, axis) > 0.0)
