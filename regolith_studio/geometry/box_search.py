"""Search for the minimum-volume box of a convex solid.

O'Rourke (1985): two adjacent sides of a minimum-volume box are each flush with an edge of the hull. So every
pair of edges is asked: the boxes flush with both are a curve or two
(:mod:`regolith_studio.geometry.box_curve`), and branch and bound along it either proves that no box is
smaller than the best so far or finds it. The ends of the curves are boxes with a side on a facet; these are
looked at first.

The vertices held fast for a bound come from a table by direction; they need not be the farthest.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.box_facets import (
    Facets,
    arcs_of,
    facets_of,
    least_third,
    nothing_on_facet,
    with_all_edges,
    worth_asking,
)
from regolith_studio.geometry.box_lanes import LANES
from regolith_studio.geometry.box_record import TIE, Found, keep, nothing_below
from regolith_studio.geometry.box_sieve import (
    MOST_WAITING,
    PAIRS,
    Sieve,
    add_pair,
    empty_sieve,
    records_of,
    whole_curves,
    work_off,
)
from regolith_studio.geometry.box_widths import (
    SpanTable,
    between,
    ends_along,
    span_near,
    span_table,
)
from regolith_studio.geometry.compiled import kernel, leaf
from regolith_studio.geometry.hull_graph import hull_graph
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed, row

SIDEWAYS = 1e-9
"""Scalar products of unit normals below this are 0: the facets are at right angles."""


MANY_FACETS, FIRST_FACETS = 100, 16
"""Of solids with more facets, edges are first ruled out one by one, after so many facets were looked at, and
once more after all facets that are left."""
FEW_EDGES = 150
"""With more edges, pairs are first ruled out one by one."""
MANY_EDGES, LEAST_SLACK, MOST_SLACK = 8000, 1e-7, 1e-3
"""With more edges left, boxes smaller by a share of 1e-6 to 1e-3 are given up: see `minimum_box`."""


class Work(NamedTuple):
    """Scratch.

    Parameters
    ----------
    dots
        Scalar products of two normals with those of all n facets, shape (2, n).
    side
        How many of them are not negative, shape (n,).
    normals
        Shape (3, n).
    """

    dots: FloatArray
    side: IntArray
    normals: FloatArray


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
    work = Work(np.empty((2, n)), np.empty(n, np.int8), np.ascontiguousarray(normals.T))
    asked = np.full(n, True)
    if n > MANY_FACETS:
        _on_facets(facets, arcs, table, work, asked, n // FIRST_FACETS, margin, found)
        worth = worth_asking(facets, arcs, table, found.record[0] * (1.0 + margin))
        slack = LEAST_SLACK
        while worth.sum() > MANY_EDGES and slack < MOST_SLACK:
            slack *= 10.0
            margin = -slack
            worth = worth_asking(facets, arcs, table, found.record[0] * (1.0 + margin))
        asked = with_all_edges(facets, worth)
        facets, arcs = Facets(points, normals, edges[worth]), arcs[worth]
    _on_facets(facets, arcs, table, work, asked, 1, margin, found)
    if n > MANY_FACETS:
        worth = worth_asking(facets, arcs, table, found.record[0] * (1.0 + margin))
        facets, arcs = Facets(points, normals, facets.edges[worth]), arcs[worth]
    _on_curves(facets, arcs, records_of(facets, arcs), table, work, margin, found, empty_sieve())
    return found


@leaf
def _on_curves(
    facets: Facets,
    arcs: FloatArray,
    records: FloatArray,
    table: SpanTable,
    work: Work,
    margin: float,
    found: Found,
    sieve: Sieve,
) -> None:
    """Boxes flush with any two edges."""
    points, normals, edges = facets
    dots, side, _ = work
    least_width = np.inf
    for e in range(len(edges)):
        least_width = min(least_width, arcs[e, 6])
    for i in range(len(edges)):
        _along_all(work.normals, row(normals, edges[i, 2]), dots[0])
        _along_all(work.normals, row(normals, edges[i, 3]), dots[1])
        for g in range(len(normals)):
            side[g] = (dots[0, g] >= 0.0) + (dots[1, g] >= 0.0)
        k = i + 1 if dots[0, edges[i, 3]] >= 0.0 else i
        while k < len(edges):
            last = min(len(edges), k + LANES - sieve.filled[PAIRS])
            limit = found.record[0] * (1.0 + margin) / arcs[i, 6]
            _put_down(edges, arcs, table, side, i, k, last, limit, least_width, sieve)
            k = last
            while sieve.filled[PAIRS] == LANES:
                _sift(records, points, table, margin, found, sieve)
    while sieve.filled[PAIRS] > 0:
        _sift(records, points, table, margin, found, sieve)
    work_off(points, table, margin, found, sieve)


@leaf
def _put_down(
    edges: IntArray,
    arcs: FloatArray,
    table: SpanTable,
    side: IntArray,
    i: int,
    first: int,
    last: int,
    limit: float,
    least_width: float,
    sieve: Sieve,
) -> None:
    """Put down the pairs of edge i with edges `first` to `last` that have orthogonal normals.

    Of solids with many edges those are left out that no box below the limit, a volume over the width at
    edge i, could be flush with.
    """
    pairs, at = sieve.pairs, np.uintp(sieve.filled[PAIRS])
    for k in range(first, last):
        one, other = side[np.uintp(edges[k, 2])], side[np.uintp(edges[k, 3])]
        pairs[0, at], pairs[1, at], pairs[2, at] = i, k, 0
        at += np.uintp((one != other) | (one == 1))
    if len(edges) > FEW_EDGES:
        put_down, at = at, np.uintp(sieve.filled[PAIRS])
        for j in range(at, put_down):
            k = pairs[1, j]
            pairs[1, at] = k
            width = arcs[k, 6]
            at += np.uintp(width * least_width < limit and width * least_third(arcs, table, i, k) < limit)
    sieve.filled[PAIRS] = at


@leaf
def _sift(
    records: FloatArray, points: FloatArray, table: SpanTable, margin: float, found: Found, sieve: Sieve
) -> None:
    """Take the curves out of the lanes; second curves of the same pairs take their place."""
    whole_curves(records, table, found.record[0] * (1.0 + margin), sieve)
    if sieve.filled[0] > MOST_WAITING - LANES:
        work_off(points, table, margin, found, sieve)
    broken = sieve.filled[PAIRS]
    sieve.filled[PAIRS] = 0
    for at in range(broken):
        add_pair(sieve.pairs[0, at], sieve.pairs[1, at], True, sieve)


@leaf
def _along_all(normals: FloatArray, direction: Vector, dots: FloatArray) -> None:
    """Scalar products of all normals (3, n) with a direction."""
    x, y, z = direction
    for g in range(normals.shape[1]):
        dots[g] = normals[0, g] * x + normals[1, g] * y + normals[2, g] * z


@leaf
def _on_facets(
    facets: Facets,
    arcs: FloatArray,
    table: SpanTable,
    work: Work,
    asked: BoolArray,
    stride: int,
    margin: float,
    found: Found,
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
        _along_all(work.normals, a, work.dots[0])
        for e in range(len(edges)):
            one, two = work.dots[0, edges[e, 2]], work.dots[0, edges[e, 3]]
            if one * two > 0.0 and min(abs(one), abs(two)) > SIDEWAYS:
                continue
            b = cross(row(arcs, e), a)
            lever = length(b)
            if lever < SIDEWAYS:
                continue
            b = mixed(b, 1.0 / lever, b, 0.0)
            c = cross(a, b)
            limit = found.record[0] * (1.0 + margin) / height
            if abs(dot(span_near(table, b), b) * dot(span_near(table, c), c)) < limit:
                top, bottom = ends_along(points, b)
                wide = dot(between(points, top, bottom), b)
                top, bottom = ends_along(points, c)
                keep(height, wide, dot(between(points, top, bottom), c), a, b, c, found)
