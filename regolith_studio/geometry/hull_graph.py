"""How the triangles of a convex solid hang together, and which of them make up one plane facet."""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inline_kernel, kernel
from regolith_studio.geometry.vectors import cross, length, mixed, row

SLIVER = 1e-9
"""A triangle of less height, at solid size 1, has no normal of its own."""

EPSILON = 1e-15
"""Rounding of coordinates, at solid size 1, with some reserve."""

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
    closed
        Whether half-edges pair up as twins, every vertex has a face and every face a normal; nothing else
        works if not.
    """

    points: FloatArray
    normals: FloatArray
    facet: IntArray
    origin: IntArray
    twin: IntArray
    outgoing: IntArray
    closed: bool


@kernel
def hull_graph(points: FloatArray, faces: IntArray) -> HullGraph:
    """Half-edges of outward triangles, faces of shape (m, 3)."""
    origin = faces.reshape(-1)
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
    twin, outgoing = np.full(len(origin), -1), np.full(len(points), -1)
    closed = True
    for h in range(len(origin)):
        v = origin[after(h)]
        for i in range(first[v], first[v + 1]):
            if origin[after(bucket[i])] == origin[h]:
                twin[h] = bucket[i]
        closed = closed and twin[h] >= 0
        outgoing[origin[h]] = h
    for h in range(len(origin)):
        closed = closed and twin[twin[h]] == h
    for v in range(len(points)):
        closed = closed and outgoing[v] >= 0
    normals, blur = _face_normals(points, faces, twin)
    for f in range(len(faces)):
        closed = closed and length(row(normals, f)) > 0.0
    facet = _facets(normals, blur, twin)
    return HullGraph(points, normals, facet, origin, twin, outgoing, closed)


@kernel
def _face_normals(points: FloatArray, faces: IntArray, twin: IntArray) -> tuple[FloatArray, FloatArray]:
    """Unit normals, and how far rounding may tilt them.

    A sliver takes that of the neighbour across its longest edge.
    """
    normals, blur = np.zeros((len(faces), 3)), np.full(len(faces), EPSILON / SLIVER)
    slivers = 0
    for f in range(len(faces)):
        a = row(points, faces[f, 0])
        b, c = mixed(row(points, faces[f, 1]), 1.0, a, -1.0), mixed(row(points, faces[f, 2]), 1.0, a, -1.0)
        normal = cross(b, c)
        size = length(normal)
        height = size / max(length(b), length(c), length(mixed(c, 1.0, b, -1.0)))
        if height > SLIVER:
            blur[f] = EPSILON / height
            for k in range(3):
                normals[f, k] = normal[k] / size
        else:
            slivers += 1
    for attempt in range(2 * slivers):
        for f in range(len(faces)):
            if length(row(normals, f)) == 0.0:
                _take_normal(points, faces, twin, f, normals, attempt >= slivers)
    return normals, blur


@kernel
def _take_normal(
    points: FloatArray, faces: IntArray, twin: IntArray, f: int, normals: FloatArray, known: bool
) -> None:
    """Give face `f` the normal across its longest edge; if `known`, its longest to one that has a normal."""
    longest = 0.0
    for k in range(3):
        edge = mixed(row(points, faces[f, (k + 1) % 3]), 1.0, row(points, faces[f, k]), -1.0)
        neighbour = twin[3 * f + k] // 3
        if known and length(row(normals, neighbour)) == 0.0:
            continue
        if neighbour >= 0 and length(edge) > longest:
            longest = length(edge)
            for axis in range(3):
                normals[f, axis] = normals[neighbour, axis]


@kernel
def _facets(normals: FloatArray, blur: FloatArray, twin: IntArray) -> IntArray:
    """First face of the facet of each face; all its faces get the normal that rounding tilts least."""
    facet = np.full(len(normals), -1)
    stack = np.empty(len(normals), np.int64)
    for seed in np.argsort(blur):
        if facet[seed] >= 0:
            continue
        facet[seed], stack[0], n = seed, seed, 1
        while n > 0:
            n -= 1
            face = stack[n]
            for h in range(3 * face, 3 * face + 3):
                f = twin[h] // 3
                if f < 0 or facet[f] >= 0:
                    continue
                if length(mixed(row(normals, f), 1.0, row(normals, seed), -1.0)) < COPLANAR + blur[f]:
                    facet[f], stack[n] = seed, f
                    for k in range(3):
                        normals[f, k] = normals[seed, k]
                    n += 1
    return facet


@inline_kernel
def after(h: int) -> int:
    """The next half-edge around the face of half-edge `h`."""
    return h - 2 if h % 3 == 2 else h + 1
