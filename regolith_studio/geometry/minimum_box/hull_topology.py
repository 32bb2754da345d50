"""Half-edges and plane facets of a convex solid, and which of its edges its minimum-volume box can touch."""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import inline_kernel, kernel, kernel_noalloc
from regolith_studio.geometry.minimum_box.edge_pair import unit
from regolith_studio.geometry.minimum_box.extents import (
    SpanTable,
    between,
    extreme_vertices_of_each,
    span_near,
)
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed, row

SLIVER = 1e-9
"""A triangle of less height, at solid size 1, has no normal of its own."""

EPSILON = 1e-15
"""Rounding of coordinates, at solid size 1, with some reserve."""

COPLANAR = 1e-9
"""Neighbouring faces whose normals differ by less, in radians, are one facet."""
QUARTER_TURNS = 24
MAX_TILT = 0.1
"""Square of the sine of the angle beyond which a bound on the third side is not worth its time."""


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


class Facets(NamedTuple):
    """A convex solid of size about 1 near the origin.

    Parameters
    ----------
    points
        Vertices, shape (3, v).
    normals
        Of the facets, shape (n, 3); no two neighbours lie in one plane.
    edges
        Rows (from, to, facet, other facet), shape (e, 4).
    """

    points: FloatArray
    normals: FloatArray
    edges: IntArray


@kernel
def facets_of(graph: HullGraph) -> Facets:
    """Facets and the edges between them; triangles in one plane are one facet."""
    number, n = np.full(len(graph.facet), -1), 0
    for f in range(len(graph.facet)):
        if graph.facet[f] == f:
            number[f] = n
            n += 1
    normals, edges, count = np.empty((n, 3)), np.empty((len(graph.twin) // 2, 4), np.int64), 0
    for f in range(len(graph.facet)):
        if number[f] >= 0:
            normals[number[f]] = graph.normals[f]
    for h in range(len(graph.twin)):
        one, two = graph.facet[h // 3], graph.facet[graph.twin[h] // 3]
        if h < graph.twin[h] and one != two:
            edges[count, 0], edges[count, 1] = graph.origin[h], graph.origin[after(h)]
            edges[count, 2], edges[count, 3] = number[one], number[two]
            count += 1
    return Facets(np.ascontiguousarray(graph.points.T), normals, edges[:count])


@kernel
def arcs_of(facets: Facets) -> FloatArray:
    """For each edge its unit direction, a span across the solid, and a bound on the width along its arc.

    The span runs from the vertex opposite to the edge to the edge. Last the middle of the arc, and how far
    its ends are from there; shape (e, 11).
    """
    points, normals, edges = facets
    arcs, between_facets = np.empty((len(edges), 11)), np.empty((3, len(edges)))
    for e in range(len(edges)):
        for c in range(3):
            between_facets[c, e] = normals[edges[e, 2], c] + normals[edges[e, 3], c]
    lowest = extreme_vertices_of_each(points, between_facets)[1]
    for e in range(len(edges)):
        one, two = row(normals, edges[e, 2]), row(normals, edges[e, 3])
        direction = unit(between(points, edges[e, 1], edges[e, 0]))
        span = between(points, edges[e, 0], lowest[e])
        middle = unit(mixed(one, 1.0, two, 1.0))
        for c in range(3):
            arcs[e, c], arcs[e, 3 + c], arcs[e, 7 + c] = direction[c], span[c], middle[c]
        arcs[e, 6], arcs[e, 10] = min(dot(span, one), dot(span, two)), length(mixed(one, 1.0, middle, -1.0))
    return arcs


@kernel_noalloc
def min_third_extent(arcs: FloatArray, table: SpanTable, i: int, k: int) -> float:
    """A bound on the width across two sides that are flush with edges i and k; 0 where there is no use in it.

    The third axis is normal to one axis on either arc, so its products with the middles m of the arcs are at
    most their half widths h, and the part of it that lies in the plane of the middles is at most
    sqrt((h_i^2 + h_k^2 + 2 |m_i m_k| h_i h_k) / (1 - (m_i m_k)^2)).
    """
    one, two = (arcs[i, 7], arcs[i, 8], arcs[i, 9]), (arcs[k, 7], arcs[k, 8], arcs[k, 9])
    h, g, cosine = arcs[i, 10], arcs[k, 10], abs(dot(one, two))
    apart = 1.0 - cosine * cosine
    tilt = h * h + g * g + 2.0 * cosine * h * g
    if not tilt < MAX_TILT * apart:
        return 0.0
    third = cross(one, two)
    span = span_near(table, third)
    tilt, squared = tilt / apart, dot(span, third) ** 2 / apart
    across = max(0.0, dot(span, span) - squared)
    return float(np.sqrt(squared * (1.0 - tilt)) - np.sqrt(across * tilt))


@kernel
def edges_that_may_bound(facets: Facets, arcs: FloatArray, table: SpanTable, limit: float) -> BoolArray:
    """Which edges some box below the limit could be flush with, shape (e,).

    With its first side normal to an axis of the edge's arc, the other two directions of a box are nearly
    those of a quarter turn in steps about the arc's middle. A turn of angle t shortens a distance at most to
    its cos t-fold, less sin t times what the span is long across.
    """
    _, normals, edges = facets
    worth = np.zeros(len(edges), np.bool_)
    cosines, sines = np.empty(QUARTER_TURNS), np.empty(QUARTER_TURNS)
    for step in range(QUARTER_TURNS):
        angle = np.pi / 2.0 / QUARTER_TURNS * step
        cosines[step], sines[step] = np.cos(angle), np.sin(angle)
    for e in range(len(edges)):
        one, two = row(normals, edges[e, 2]), row(normals, edges[e, 3])
        axis, first = unit(mixed(one, 1.0, two, 1.0)), row(arcs, e)
        second = cross(axis, first)
        turn = np.arccos(min(1.0, dot(axis, one))) + np.pi / 4.0 / QUARTER_TURNS
        cosine, sine = np.cos(turn), np.sin(turn)
        for step in range(QUARTER_TURNS):
            b = mixed(first, cosines[step], second, sines[step])
            c = mixed(first, -sines[step], second, cosines[step])
            wide = _after_turn(span_near(table, b), b, cosine, sine)
            high = _after_turn(span_near(table, c), c, cosine, sine)
            if min(wide, high) <= 0.0 or arcs[e, 6] * wide * high < limit:
                worth[e] = True
                break
    return worth


@kernel_noalloc
def facet_excluded(table: SpanTable, axis: Vector, height: float, limit: float) -> bool:
    """Whether no box below the limit has a side normal to an axis, along which the solid is `height` wide.

    As in :func:`edges_that_may_bound`, for one axis only.
    """
    first = unit(cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.6 else (0.0, 1.0, 0.0)))
    second, half = cross(axis, first), np.pi / 4.0 / QUARTER_TURNS
    cosine, sine = np.cos(half), np.sin(half)
    step_cosine, step_sine = np.cos(2.0 * half), np.sin(2.0 * half)
    for _ in range(QUARTER_TURNS):
        wide = _after_turn(span_near(table, first), first, cosine, sine)
        high = _after_turn(span_near(table, second), second, cosine, sine)
        if min(wide, high) <= 0.0 or height * wide * high < limit:
            return False
        first, second = (
            mixed(first, step_cosine, second, step_sine),
            mixed(first, -step_sine, second, step_cosine),
        )
    return True


@kernel
def facets_with_all_edges(facets: Facets, worth: BoolArray) -> BoolArray:
    """Facets of which every edge is worth asking, shape (n,): a box on one is flush with all its edges."""
    asked = np.full(len(facets.normals), True)
    for e in range(len(worth)):
        if not worth[e]:
            asked[facets.edges[e, 2]] = asked[facets.edges[e, 3]] = False
    return asked


@inline_kernel
def _after_turn(span: Vector, direction: Vector, cosine: float, sine: float) -> float:
    """Least length of a span along a direction that turns by at most an angle of this cosine and sine."""
    here = abs(dot(span, direction))
    across = np.sqrt(max(0.0, dot(span, span) - here * here))
    return float(here * cosine - sine * across)
