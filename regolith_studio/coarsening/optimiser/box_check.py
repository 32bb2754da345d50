"""The proven minimum box inside compiled code: is any box smaller than the one that is known?

The steps of :func:`regolith_studio.geometry.minimum_box.minimum_box` in memory that is made once, with
the known volume as the first bound: it rules out most pairs of edges at once.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.minimum_box import (
    FIRST_FACETS,
    MANY_FACETS,
    BestBox,
    Work,
    empty_record,
    search_facets,
    search_pairs,
)
from regolith_studio.geometry.minimum_box.hull_topology import (
    BLOCK,
    QUARTER_TURNS,
    Facets,
    SpanTable,
    cell_directions,
    extreme_vertices,
    fill_edges_that_may_bound,
    fill_extreme_vertices,
    n_cells,
)
from regolith_studio.geometry.vectors import dot, length, mixed, row

NO_EDGE = 1e-8
"""Edges of a polyhedron of about unit volume that are shorter bear no box."""


class BoxMemory(NamedTuple):
    """Memory of a search for n half-spaces, in the terms of :mod:`regolith_studio.geometry.minimum_box`."""

    points: FloatArray
    directions: FloatArray
    spans: FloatArray
    ends: IntArray
    block: FloatArray
    edges: IntArray
    arcs: FloatArray
    may_bound: BoolArray
    wanted: BoolArray
    turns: FloatArray
    work: Work
    best: BestBox


def box_memory(n: int, n_vertices: int) -> BoxMemory:
    """Memory for polyhedra with so many facets and vertices."""
    n_edges = n + n_vertices  # Euler's formula
    directions = cell_directions(n_cells(n_vertices))
    angles = np.linspace(0.0, np.pi / 2.0, QUARTER_TURNS, endpoint=False)
    return BoxMemory(
        np.empty((3, n_vertices)),
        directions,
        np.empty((directions.shape[1], 3)),
        np.empty((2, directions.shape[1]), np.int64),
        np.empty((4, BLOCK)),
        np.empty((n_edges, 4), np.int64),
        np.empty((n_edges, 11)),
        np.empty(n_edges, np.bool_),
        np.empty(n, np.bool_),
        np.array([np.cos(angles), np.sin(angles)]),
        Work(np.empty((2, n)), np.empty(n, np.int64), np.empty((2, 2, 2))),
        empty_record(np.inf),
    )


@kernel_noalloc
def find_smaller_box(
    vertices: FloatArray,
    normals: FloatArray,
    edges: IntArray,
    known: float,
    memory: BoxMemory,
) -> bool:
    """Whether a box is smaller than `known`; then its axes are in ``memory.best.axes``.

    Parameters
    ----------
    vertices, normals, edges
        Of a convex polyhedron: (v, 3), (n, 3), and rows (from, to, facet, facet), (e, 4).
    """
    best, n, v = memory.best, len(normals), len(vertices)
    points = memory.points[:, :v]
    table = SpanTable(memory.spans, int(np.sqrt(len(memory.spans) / 3.0) + 0.5))
    for i in range(v):
        for c in range(3):
            points[c, i] = vertices[i, c]
    fill_extreme_vertices(points, memory.directions, memory.block, memory.ends)
    for k in range(len(memory.spans)):
        for c in range(3):
            memory.spans[k, c] = points[c, memory.ends[0, k]] - points[c, memory.ends[1, k]]
    count = _fill_arcs(vertices, normals, edges, points, memory)
    best.record[0], best.record[1] = known, np.inf
    memory.wanted[:] = True
    facets = Facets(points, normals, memory.edges[:count])
    arcs = memory.arcs[:count]
    if n > MANY_FACETS:
        search_facets(facets, arcs, table, memory.work, memory.wanted, n // FIRST_FACETS, 0.0, best)
        count = _drop_edges(facets, arcs, table, count, memory)
        facets, arcs = Facets(points, normals, memory.edges[:count]), memory.arcs[:count]
    search_facets(facets, arcs, table, memory.work, memory.wanted, 1, 0.0, best)
    if n > MANY_FACETS:
        count = _drop_edges(facets, arcs, table, count, memory)
        facets, arcs = Facets(points, normals, memory.edges[:count]), memory.arcs[:count]
    search_pairs(facets, arcs, table, memory.work, 0.0, best)
    return bool(best.record[0] < known)


@kernel_noalloc
def _fill_arcs(
    vertices: FloatArray, normals: FloatArray, edges: IntArray, points: FloatArray, memory: BoxMemory
) -> int:
    """Edges with a direction, and their arcs as from ``hull_topology.arcs_of``; how many there are."""
    count = 0
    for e in range(len(edges)):
        one, two = row(normals, edges[e, 2]), row(normals, edges[e, 3])
        start, end = row(vertices, edges[e, 0]), row(vertices, edges[e, 1])
        along = mixed(end, 1.0, start, -1.0)
        if length(along) < NO_EDGE:
            continue
        along = mixed(along, 1.0 / length(along), along, 0.0)
        middle = mixed(one, 1.0, two, 1.0)
        middle = mixed(middle, 1.0 / length(middle), middle, 0.0)
        span = mixed(start, 1.0, row(vertices, extreme_vertices(points, middle)[1]), -1.0)
        for c in range(4):
            memory.edges[count, c] = edges[e, c]
        for c in range(3):
            memory.arcs[count, c], memory.arcs[count, 3 + c] = along[c], span[c]
            memory.arcs[count, 7 + c] = middle[c]
        memory.arcs[count, 6] = min(dot(span, one), dot(span, two))
        memory.arcs[count, 10] = length(mixed(one, 1.0, middle, -1.0))
        count += 1
    return count


@kernel_noalloc
def _drop_edges(facets: Facets, arcs: FloatArray, table: SpanTable, count: int, memory: BoxMemory) -> int:
    """Leave out edges that no box below the best can be flush with, and facets that have such an edge."""
    memory.may_bound[:count] = False
    fill_edges_that_may_bound(
        facets, arcs, table, memory.best.record[0], memory.turns[0], memory.turns[1], memory.may_bound
    )
    left = 0
    for e in range(count):
        if not memory.may_bound[e]:
            memory.wanted[memory.edges[e, 2]] = memory.wanted[memory.edges[e, 3]] = False
            continue
        for c in range(4):
            memory.edges[left, c] = memory.edges[e, c]
        for c in range(11):
            memory.arcs[left, c] = memory.arcs[e, c]
        left += 1
    return left
