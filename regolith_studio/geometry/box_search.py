"""Search for the minimum-volume box of a convex solid.

O'Rourke (1985): two adjacent sides of a minimum-volume box are each flush with an edge of the hull. So every
pair of edges is asked: the boxes flush with both are a curve or two
(:mod:`regolith_studio.geometry.box_curve`), and branch and bound along it either proves that no box is
smaller than the best so far or finds it. The ends of the curves are boxes with a side on a facet; these are
looked at first.

The vertices held fast for a bound come from a table by direction; they need not be the farthest.
"""

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.box_curve import scaled
from regolith_studio.geometry.box_facets import (
    Facets,
    arcs_of,
    facets_of,
    least_third,
    nothing_on_facet,
    with_all_edges,
    worth_asking,
)
from regolith_studio.geometry.box_lanes import (
    AREA,
    DIRECTION,
    LANES,
    LEVER,
    NORMALS,
    NUMBER,
    SIDES,
    WHICH,
    bounds_on_facet,
)
from regolith_studio.geometry.box_record import TIE, Found, keep, nothing_below
from regolith_studio.geometry.box_sieve import (
    MOST_WAITING,
    PAIRS,
    Sieve,
    add_pair,
    add_pairs,
    empty_sieve,
    orthogonal,
    records_of,
    whole_curves,
    work_off,
)
from regolith_studio.geometry.box_widths import (
    SpanTable,
    between,
    ends_along,
    span_table,
)
from regolith_studio.geometry.eights import (
    WIDTH,
    count_bits,
    least,
    load,
    most,
    positive,
    splat,
    store_some,
)
from regolith_studio.geometry.hull_graph import hull_graph
from regolith_studio.geometry.kernels import inline_kernel, kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector, cross, dot, length, row

SIDEWAYS = 1e-9
"""Scalar products of unit normals below this are 0: the facets are at right angles."""


MANY_FACETS, FIRST_FACETS = 100, 16
"""Of solids with more facets, edges are first ruled out one by one, after so many facets were looked at, and
once more after all facets that are left."""
FEW_EDGES = 150
"""With more edges, pairs are first ruled out one by one."""
MANY_EDGES, LEAST_SLACK, MOST_SLACK = 8000, 1e-7, 1e-3
"""With more edges left, boxes smaller by a share of 1e-6 to 1e-3 are given up: see `minimum_box`."""


@kernel
def minimum_box(points: FloatArray, faces: IntArray) -> FloatArray:
    """Axes of the minimum-volume box, one a row, shape (3, 3); zeros if the faces do not close.

    No box is smaller by a share of 1e-8. Only of fine and nearly perfect balls, of which more than 8,000
    edges cannot be ruled out one by one, some box may be smaller by 1e-6, or by as much more, up to 1e-3, as
    rules out enough of them: their boxes are all alike, and pairs of edges would be many millions.

    Parameters
    ----------
    points
        Vertices of a convex solid of size about 1 near the origin, shape (n, 3); each on a face.
    faces
        Its outward triangles, shape (m, 3).
    """
    graph = hull_graph(points, faces)
    if not graph.closed:
        return np.zeros((3, 3))
    return least_box(facets_of(graph), np.inf).axes


@kernel
def least_box(facets: Facets, known: float) -> Found:
    """The least box of all.

    Parameters
    ----------
    known
        Volume of some box; infinite if none is known. Only smaller ones are kept.
    """
    found, margin = nothing_below(known), TIE
    points, normals, edges = facets
    table, arcs, n = span_table(points), arcs_of(facets), len(normals)
    records, sieve = records_of(facets, arcs), empty_sieve()
    asked = np.full(n, True)
    if n > MANY_FACETS:
        _on_facets(facets, arcs, records, table, asked, n // FIRST_FACETS, margin, found, sieve.lanes)
        worth = worth_asking(facets, arcs, table, found.record[0] * (1.0 + margin))
        slack = LEAST_SLACK
        while worth.sum() > MANY_EDGES and slack < MOST_SLACK:
            slack *= 10.0
            margin = -slack
            worth = worth_asking(facets, arcs, table, found.record[0] * (1.0 + margin))
        asked = with_all_edges(facets, worth)
        facets, arcs = Facets(points, normals, edges[worth]), arcs[worth]
        records = records_of(facets, arcs)
    _on_facets(facets, arcs, records, table, asked, 1, margin, found, sieve.lanes)
    if n > MANY_FACETS:
        worth = worth_asking(facets, arcs, table, found.record[0] * (1.0 + margin))
        facets, arcs = Facets(points, normals, facets.edges[worth]), arcs[worth]
        records = records_of(facets, arcs)
    _on_curves(facets, arcs, records, table, margin, found, sieve)
    return found


@kernel_noalloc
def _on_curves(
    facets: Facets,
    arcs: FloatArray,
    records: FloatArray,
    table: SpanTable,
    margin: float,
    found: Found,
    sieve: Sieve,
) -> None:
    """Boxes flush with any two edges."""
    points, normals, edges = facets
    least_width = np.inf
    for e in range(len(edges)):
        least_width = min(least_width, arcs[e, 6])
    for i in range(len(edges)):
        with_itself = dot(row(normals, edges[i, 2]), row(normals, edges[i, 3])) < 0.0
        k = i if with_itself else i + 1
        while k < len(edges):
            limit = found.record[0] * (1.0 + margin) / arcs[i, 6]
            k = _put_down(records, arcs, table, i, k, limit, least_width, sieve)
            while sieve.filled[PAIRS] > LANES - WIDTH:
                _sift(records, points, table, margin, found, sieve)
    while sieve.filled[PAIRS] > 0:
        _sift(records, points, table, margin, found, sieve)
    work_off(points, table, margin, found, sieve)


@kernel_noalloc
def _put_down(
    records: FloatArray,
    arcs: FloatArray,
    table: SpanTable,
    i: int,
    first: int,
    limit: float,
    least_width: float,
    sieve: Sieve,
) -> int:
    """Put down the pairs of edge i with edges from `first` on that have orthogonal normals.

    Of solids with many edges those are left out that no box below the limit, a volume over the width at
    edge i, could be flush with. Returns the first edge that was not asked since the lanes are full.
    """
    for k in range(first, len(arcs), WIDTH):
        if sieve.filled[PAIRS] > LANES - WIDTH:
            return k
        bits = orthogonal(records, i, k) & ((1 << min(WIDTH, len(arcs) - k)) - 1)
        if len(arcs) > FEW_EDGES:
            for other in range(k, min(len(arcs), k + WIDTH)):
                width = arcs[other, 6]
                if bits >> (other - k) & 1 and not (
                    width * least_width < limit and width * least_third(arcs, table, i, other) < limit
                ):
                    bits ^= 1 << (other - k)
        if bits != 0:
            add_pairs(records, i, k, bits, sieve)
    return len(arcs)


@kernel_noalloc
def _sift(
    records: FloatArray, points: FloatArray, table: SpanTable, margin: float, found: Found, sieve: Sieve
) -> None:
    """Take the curves out of the lanes; second curves of the same pairs take their place."""
    broken = whole_curves(table, found.record[0] * (1.0 + margin), sieve)
    if sieve.filled[0] > MOST_WAITING - LANES:
        work_off(points, table, margin, found, sieve)
    for at in range(broken):
        add_pair(records, sieve.broken[0, at], sieve.broken[1, at], True, sieve)


@kernel_noalloc
def _on_facets(
    facets: Facets,
    arcs: FloatArray,
    records: FloatArray,
    table: SpanTable,
    asked: BoolArray,
    stride: int,
    margin: float,
    found: Found,
    lanes: FloatArray,
) -> None:
    """Boxes with one side on a facet, each `stride`-th of the asked, and one on a shadow's edge."""
    points, normals, edges = facets
    for f in range(0, len(normals), stride):
        if not asked[f]:
            continue
        a = row(normals, f)
        top, bottom = ends_along(points, a)
        height = dot(between(points, top, bottom), a)
        limit = found.record[0] * (1.0 + margin)
        if len(normals) > MANY_FACETS and nothing_on_facet(table, a, height, limit):
            continue
        first = 0
        while first < len(edges):
            first, count = _on_shadow(records, a, first, len(edges), lanes)
            bounds_on_facet(lanes, count, a, table)
            for k in range(count):
                limit = found.record[0] * (1.0 + margin) / height
                if lanes[AREA * LANES + k] < limit * lanes[LEVER * LANES + k]:
                    _on_edge(points, row(arcs, int(lanes[WHICH * LANES + k])), a, height, found)


@inline_kernel
def _on_shadow(
    records: FloatArray, axis: Vector, first: int, last: int, lanes: FloatArray
) -> tuple[int, int]:
    """Fill the lanes with edges of the shadow along an axis, `first` or later; where to go on, how many."""
    n, count = records.shape[1], 0
    x, y, z, sideways = splat(axis[0]), splat(axis[1]), splat(axis[2]), splat(SIDEWAYS)
    while first < last and count <= LANES - WIDTH:
        one, two = NORMALS * n + first, (NORMALS + 3) * n + first
        up = load(records, one) * x + load(records, one + n) * y + load(records, one + 2 * n) * z
        down = load(records, two) * x + load(records, two + n) * y + load(records, two + 2 * n) * z
        inside = positive(up * down)
        up, down = most(up, splat(0.0) - up), most(down, splat(0.0) - down)
        inside &= positive(least(up, down) - sideways)
        bits = ~inside & ((1 << min(WIDTH, last - first)) - 1)
        if bits != 0:
            store_some(lanes, WHICH * LANES + count, load(records, NUMBER * n + first), bits)
            for c in range(3):
                direction = load(records, (DIRECTION + c) * n + first)
                store_some(lanes, (SIDES + c) * LANES + count, direction, bits)
            count += count_bits(bits)
        first += WIDTH
    return first, count


@kernel_noalloc
def _on_edge(points: FloatArray, edge: Vector, a: Vector, height: float, found: Found) -> None:
    """The box with one side normal to a, and one along an edge."""
    b = cross(edge, a)
    lever = length(b)
    if lever >= SIDEWAYS:
        b = scaled(b, 1.0 / lever)
        c = cross(a, b)
        top, bottom = ends_along(points, b)
        wide = dot(between(points, top, bottom), b)
        top, bottom = ends_along(points, c)
        keep(height, wide, dot(between(points, top, bottom), c), a, b, c, found)
