"""Boxes that are followed during a descent: the measured one, and rivals that a proven search finds.

The search takes the steps of :func:`regolith_studio.geometry.minimum_box.minimum_box` in memory that is made
once, with the known volume as the first bound: it rules out most pairs of edges at once.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.parts import N_FACES, Parts
from regolith_studio.coarsening.optimiser.body import (
    GONE,
    LONGEST,
    MAX_BOXES,
    N_BOXES,
    N_VERTICES,
    RATIO,
    SHORTEST,
    Body,
    BodyScratch,
    Prices,
    box_volume,
    fill_box_terms,
    is_same_box,
    set_box,
    settle_box,
)
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel
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
    """Memory of a search for n half-spaces, in the terms of :mod:`regolith_studio.geometry.minimum_box`.

    The coordinates of up to v vertices take 3 v numbers.
    """

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
        np.empty(3 * n_vertices),
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


@inner_kernel
def find_smaller_box(
    vertices: FloatArray,
    normals: FloatArray,
    edges: IntArray,
    known: float,
    memory: BoxMemory,
) -> bool:
    """Whether a box is smaller than `known`; then its axes are in ``memory.best.axes``.

    Of a convex polyhedron: vertices (v, 3), normals (n, 3), edges (from, to, facet, facet), (e, 4).
    """
    best, n, v = memory.best, len(normals), len(vertices)
    # contiguous, as in the search of a particle's box, which is else compiled once more for other arrays
    points = memory.points[: 3 * v].reshape((3, v))
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


@inner_kernel
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


@inner_kernel
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


UNDERCUT = 1e-7
"""A box smaller by more becomes a rival."""


@inner_kernel
def check_boxes(
    body: Body, prices: Prices, start_axes: FloatArray, memory: BoxMemory, scratch: BodyScratch
) -> bool:
    """Look for a box that is smaller than those that are followed; whether there is one.

    Of a body without boxes the least one is found, and the one that lies as the particle's. The measured box
    is the one that is nearest to the wanted size and to the least.
    """
    n_boxes, known = body.counts[N_BOXES], np.inf
    for b in range(n_boxes):
        if body.slack[b] != GONE:
            known = min(known, box_volume(body, b) * (1.0 - UNDERCUT))
    if not _find_smaller(body, body.parts, known, memory):
        return False
    add_box(body, memory.best.axes, scratch)
    if n_boxes == 0:
        add_box(body, start_axes, scratch)
    choose_box(body, prices)
    fill_box_terms(body, prices.wanted, scratch)
    return True


@inner_kernel
def _find_smaller(body: Body, parts: Parts | None, known: float, memory: BoxMemory) -> bool:
    """Whether a box around the body, or the hull of its parts, is smaller than `known`."""
    vertices = body.vertices[: body.counts[N_VERTICES]]
    if parts is None:
        edges = body.edges[: 3 * len(vertices) // 2]
        found = find_smaller_box(vertices, body.normals, edges, known, memory)
    else:
        hull, m = parts.hull, parts.counts[N_FACES]
        found = find_smaller_box(vertices, hull.normals[:m], hull.edges[: 3 * m // 2], known, memory)
    return found


@inner_kernel
def add_box(body: Body, axes: FloatArray, scratch: BodyScratch) -> None:
    """Follow the box next to these axes too, unless it is followed; the largest rival may go for it."""
    n_boxes, at = body.counts[N_BOXES], body.counts[N_BOXES]
    for b in range(1, n_boxes):
        if body.slack[b] == GONE:
            at = b
    if at == MAX_BOXES:
        at = 1
        for b in range(2, n_boxes):
            at = b if body.slack[b] > body.slack[at] else at
    for axis in range(3):
        for c in range(3):
            body.frames[at, axis, c] = axes[axis, c]
    settle_box(body, at, scratch)
    set_box(body, at, scratch)
    body.slack[at] = 0.0
    for b in range(n_boxes):
        if b != at and body.slack[b] != GONE and is_same_box(body, b, at):
            body.slack[at] = GONE
    if at == n_boxes and body.slack[at] != GONE:
        body.counts[N_BOXES] += 1


@inner_kernel
def choose_box(body: Body, prices: Prices) -> None:
    """Put the box first that is to be measured."""
    least = np.inf
    for b in range(body.counts[N_BOXES]):
        if body.slack[b] != GONE:
            least = min(least, box_volume(body, b))
    nearest, at = np.inf, 0
    for b in range(body.counts[N_BOXES]):
        if body.slack[b] == GONE:
            continue
        short = min(body.extents[b, 0], body.extents[b, 1], body.extents[b, 2])
        long = max(body.extents[b, 0], body.extents[b, 1], body.extents[b, 2])
        off = box_volume(body, b) / least - 1.0
        for r in range(SHORTEST, RATIO + 1):
            if prices.low[r] < prices.high[r]:
                value = short if r == SHORTEST else (long if r == LONGEST else long / short)
                off += abs(value / prices.wanted[r] - 1.0)
        if off < nearest - 1e-9:
            nearest, at = off, b
    if at > 0:
        swap_boxes(body, at)


@inner_kernel
def swap_boxes(body: Body, b: int) -> None:
    """Exchange the first box with box `b`."""
    for axis in range(3):
        body.extents[0, axis], body.extents[b, axis] = body.extents[b, axis], body.extents[0, axis]
        for c in range(3):
            frames = body.frames
            frames[0, axis, c], frames[b, axis, c] = frames[b, axis, c], frames[0, axis, c]
    for c in range(body.contacts.shape[1]):
        body.contacts[0, c], body.contacts[b, c] = body.contacts[b, c], body.contacts[0, c]
    for i in range(9):
        for c in range(3):
            planes = body.planes
            planes[0, i, c], planes[b, i, c] = planes[b, i, c], planes[0, i, c]
    body.slack[0] = body.slack[b] = 0.0
