"""Search for the minimum-volume box of a convex solid.

O'Rourke (1985): two adjacent sides of a minimum-volume box are each flush with an edge of the hull. The boxes
flush with a pair of edges are a curve or two (:mod:`regolith_studio.geometry.minimum_box.edge_pair`); branch
and bound along each curve either proves that no box is smaller than the best so far or finds it. The ends of
the curves are boxes with a side on a facet; these are looked at first.

The vertices held fast for a bound come from a table by direction; they need not be the farthest.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel_noalloc
from regolith_studio.geometry.minimum_box.edge_pair import (
    Curve,
    Quartic,
    all_positive,
    argmin_ratio,
    crossing,
    curve_between,
    denominator,
    directions_on,
    factors_of,
    frame_on,
    is_above_limit,
    numerator,
    unit,
    value,
)
from regolith_studio.geometry.minimum_box.hull_topology import (
    Facets,
    SpanTable,
    arcs_of,
    between,
    edges_that_may_bound,
    extreme_vertices,
    facet_excluded,
    facets_with_all_edges,
    min_third_extent,
    span_near,
    span_table,
)
from regolith_studio.geometry.vectors import Vector, along, cross, dot, length, mixed, row

SIDEWAYS = 1e-9
"""Scalar products of unit normals below this are 0: the facets are at right angles."""
MANY_FACETS, FIRST_FACETS = 100, 16
"""Of solids with more facets, edges are first ruled out one by one, after so many facets were looked at, and
once more after all facets that are left."""
MANY_EDGES, MIN_SLACK, MAX_SLACK = 8000, 1e-7, 1e-3
"""With more edges left, boxes smaller by a share of 1e-6 to 1e-3 are given up: see `minimum_box`."""
TIE = 1e-8
SAME_BOX = 1e-4
"""Of boxes whose volumes differ by a share below TIE, the one with the lesser sum of edges is kept; where
that differs by less than SAME_BOX, it is one box, better placed."""
DEPTH = 256
EQUAL = 1e-11
"""Boxes whose volumes differ by a smaller share are not told apart."""
MIN_PIECE = 1e-9
"""Pieces of a curve, in radians, are not cut below this."""
FINE = 0.02
"""Longer pieces with a bound FAR above the limit in the middle are halved without a look at the vertices."""
FAR = 1.003
MANY_PIECES = 3000
"""After so many pieces of one curve, as where the volume hardly changes along it, the limit grows."""
Contacts = tuple[int, int, int, int]


class BestBox(NamedTuple):
    """The best box so far.

    - ``record``: the least volume, and the sum of the edges of its box, shape (2,).
    - ``axes``: one a row, shape (3, 3).
    - ``todo``: scratch: ends of the pieces of a curve still to be searched, shape (DEPTH, 2).
    """

    record: FloatArray
    axes: FloatArray
    todo: FloatArray


def empty_record(known: float) -> BestBox:
    """No box yet; only boxes smaller than `known` are to be kept."""
    return BestBox(np.array([known, np.inf]), np.zeros((3, 3)), np.empty((DEPTH, 2)))


@inner_kernel
def update_if_smaller(
    long: float, wide: float, high: float, a: Vector, b: Vector, c: Vector, best: BestBox
) -> float:
    """Volume of the box with these edges along these axes; it is recorded if it is the best so far."""
    volume, total = long * wide * high, long + wide + high
    least, shorter = best.record[0], total / best.record[1] - 1.0
    if (
        volume < least * (1.0 - TIE)
        or (abs(shorter) < SAME_BOX and volume < least)
        or (shorter < -SAME_BOX and volume < least * (1.0 + TIE))
    ):
        best.record[0], best.record[1] = volume, total
        for k in range(3):
            best.axes[0, k], best.axes[1, k], best.axes[2, k] = a[k], b[k], c[k]
    return float(volume)


class Work(NamedTuple):
    """Scratch.

    - ``dots``: scalar products of two normals with those of all n facets, shape (2, n).
    - ``side``: how many of them are not negative, shape (n,).
    - ``ends``: of at most two curves: curve, end, place on either arc; shape (2, 2, 2).
    """

    dots: FloatArray
    side: IntArray
    ends: FloatArray


class TooManyCurvesError(Exception):
    """The boxes flush with two edges are too many to be searched."""


def minimum_box(facets: Facets, max_turn: float = np.inf, known: FloatArray | None = None) -> FloatArray:
    """Axes of the minimum-volume box, one a row, shape (3, 3).

    No box is smaller by a share of 1e-8. Only of fine and nearly perfect balls, of which more than 8,000
    edges cannot be ruled out one by one, some box may be smaller by 1e-6, or by as much more, up to 1e-3, as
    rules out enough of them: their boxes are all alike, and pairs of edges would be many millions. The same
    holds, where a box is known, for solids with more than `max_turn`; where that is not enough, no box with a
    side on a facet is smaller.

    - ``max_turn``: half the sum, in radians, of the angles between neighbouring facets at edges that cannot
      be ruled out one by one. The search takes about 0.1 ms times its square: 20 for a rough particle, 1,800
      for a cone of 3,000 points.
    - ``known``: axes of a box that is nearly the least, which rules out most edges at once.

    Raises TooManyCurvesError if a solid of more than 100 facets has more, and no box is known.
    """
    best, margin = empty_record(np.inf), TIE
    points, normals, edges = facets
    table, arcs, n = span_table(points), arcs_of(facets), len(normals)
    work = Work(np.empty((2, n)), np.empty(n, np.int64), np.empty((2, 2, 2)))
    wanted = np.full(n, True)
    if known is not None:
        extents = np.ptp(known @ points, axis=1)
        best.record[:], best.axes[:] = (extents.prod(), extents.sum()), known
    if n > MANY_FACETS:
        stride = n // FIRST_FACETS if known is None else 1
        search_facets(facets, arcs, table, work, wanted, stride, margin, best)
        kept = edges_that_may_bound(facets, arcs, table, best.record[0] * (1.0 + margin))
        slack, most = MIN_SLACK, np.inf if known is None else max_turn
        while (kept.sum() > MANY_EDGES or arcs[kept, 10].sum() > most) and slack < MAX_SLACK:
            slack *= 10.0
            # From now on only boxes that are smaller by this share count.
            margin = -slack
            kept = edges_that_may_bound(facets, arcs, table, best.record[0] * (1.0 + margin))
        if arcs[kept, 10].sum() > max_turn:
            if known is None:
                raise TooManyCurvesError
            return best.axes
        wanted = facets_with_all_edges(facets, kept)
        facets, arcs = Facets(points, normals, edges[kept]), arcs[kept]
    search_facets(facets, arcs, table, work, wanted, 1, margin, best)
    if n > MANY_FACETS:
        # With the best box on a facet as the limit: of 797 edges of a hull 412 were left before, 276 now.
        kept = edges_that_may_bound(facets, arcs, table, best.record[0] * (1.0 + margin))
        facets, arcs = Facets(points, normals, facets.edges[kept]), arcs[kept]
    search_pairs(facets, arcs, table, work, margin, best)
    return best.axes


@kernel_noalloc
def search_facets(
    facets: Facets,
    arcs: FloatArray,
    table: SpanTable,
    work: Work,
    wanted: BoolArray,
    stride: int,
    margin: float,
    best: BestBox,
) -> None:
    """Boxes with one side on a facet, each `stride`-th of the wanted, and one on an edge of its shadow."""
    points, normals, edges = facets
    for f in range(0, len(normals), stride):
        if not wanted[f]:
            continue
        a = row(normals, f)
        top, bottom = extreme_vertices(points, a)
        height = dot(between(points, top, bottom), a)
        limit = best.record[0] * (1.0 + margin)
        if len(normals) > MANY_FACETS and facet_excluded(table, a, height, limit):
            continue
        for g in range(len(normals)):
            work.dots[0, g] = along(normals, g, a)
        for e in range(len(edges)):
            one, two = work.dots[0, edges[e, 2]], work.dots[0, edges[e, 3]]
            # The outline of the shadow along a consists of edges between a facet that faces a and one that
            # does not.
            if one * two > 0.0 and min(abs(one), abs(two)) > SIDEWAYS:
                continue
            b = cross(row(arcs, e), a)
            lever = length(b)
            if lever < SIDEWAYS:
                continue
            b = mixed(b, 1.0 / lever, b, 0.0)
            c = cross(a, b)
            limit = best.record[0] * (1.0 + margin) / height
            if abs(dot(span_near(table, b), b) * dot(span_near(table, c), c)) < limit:
                top, bottom = extreme_vertices(points, b)
                wide = dot(between(points, top, bottom), b)
                top, bottom = extreme_vertices(points, c)
                update_if_smaller(height, wide, dot(between(points, top, bottom), c), a, b, c, best)


@kernel_noalloc
def search_pairs(
    facets: Facets, arcs: FloatArray, table: SpanTable, work: Work, margin: float, best: BestBox
) -> None:
    """Boxes flush with any two edges."""
    _, normals, edges = facets
    dots, side, ends = work
    min_extent = np.inf
    for e in range(len(edges)):
        min_extent = min(min_extent, arcs[e, 6])
    for i in range(len(edges)):
        one, two = row(normals, edges[i, 2]), row(normals, edges[i, 3])
        for g in range(len(normals)):
            dots[0, g], dots[1, g] = along(normals, g, one), along(normals, g, two)
            side[g] = (dots[0, g] >= 0.0) + (dots[1, g] >= 0.0)
        for k in range(i, len(edges)):
            # No two normals of the arcs are orthogonal where all products of their ends have one sign; those
            # of one arc are not where its facets are less than a right angle apart.
            if side[edges[k, 2]] == side[edges[k, 3]] != 1 or (k == i and dots[0, edges[i, 3]] >= 0.0):
                continue
            limit = best.record[0] * (1.0 + margin)
            sides = arcs[i, 6] * arcs[k, 6]
            if sides * min_extent >= limit or sides * min_third_extent(arcs, table, i, k) >= limit:
                continue
            for number in range(_curve_ends(dots, edges[k, 2], edges[k, 3], ends)):
                _search_curve(facets, arcs, table, (i, k), ends[number], margin, best)


@inner_kernel
def _curve_ends(dots: FloatArray, three: int, four: int, ends: FloatArray) -> int:
    """Ends of the curves on which a of one arc and b of another are orthogonal; how many curves there are.

    With a = one + s (two - one) and b likewise with t, a . b is bilinear in (s, t): a hyperbola, that the
    square of (s, t) cuts into at most two pieces.
    `dots` are those of the first arc with all facets; `ends` is filled: curve, end, (s, t).
    """
    s00, s01, s10, s11 = dots[0, three], dots[0, four], dots[1, three], dots[1, four]
    p00, p01, p10, p11 = s00 >= 0.0, s01 >= 0.0, s10 >= 0.0, s11 >= 0.0
    n = 0
    both = p00 == p11 and p00 != p01 and p00 != p10
    around = both and ((s00 * s11 - s01 * s10) / (s00 + s11 - s01 - s10) >= 0.0) == p00
    for side in range(4):
        if side == 0:
            if p00 == p01:
                continue
            s, t, curve = 0.0, s00 / (s00 - s01), 0
        elif side == 1:
            if p10 == p11:
                continue
            s, t, curve = 1.0, s10 / (s10 - s11), 1
        elif side == 2:
            if p00 == p10:
                continue
            s, t, curve = s00 / (s00 - s10), 0.0, 1 if around else 0
        else:
            if p01 == p11:
                continue
            s, t, curve = s01 / (s01 - s11), 1.0, 0 if around else 1
        if both:
            end = 0 if side < 2 else 1
        else:
            curve, end = 0, n
        ends[curve, end, 0], ends[curve, end, 1] = s, t
        n += 1
    return n // 2


@inner_kernel
def _search_curve(
    facets: Facets,
    arcs: FloatArray,
    table: SpanTable,
    pair: tuple[int, int],
    ends: FloatArray,
    margin: float,
    best: BestBox,
) -> None:
    """The smallest box on one curve, if it is below the limit."""
    points, normals, edges = facets
    i, k = pair
    one, two, three, four = edges[i, 2], edges[i, 3], edges[k, 2], edges[k, 3]
    a_from = unit(mixed(row(normals, one), 1.0 - ends[0, 0], row(normals, two), ends[0, 0]))
    a_to = unit(mixed(row(normals, one), 1.0 - ends[1, 0], row(normals, two), ends[1, 0]))
    b_from = unit(mixed(row(normals, three), 1.0 - ends[0, 1], row(normals, four), ends[0, 1]))
    b_to = unit(mixed(row(normals, three), 1.0 - ends[1, 1], row(normals, four), ends[1, 1]))
    if dot(a_from, a_to) > dot(b_from, b_to):
        i, k, a_from, b_from, a_to, b_to = k, i, b_from, a_from, b_to, a_to
    curve = curve_between(row(arcs, i), row(arcs, k), a_from, b_from, a_to, b_to)
    if curve.q == 0.0 or curve.low >= curve.high:
        return
    first = (arcs[i, 3], arcs[i, 4], arcs[i, 5])
    second = (arcs[k, 3], arcs[k, 4], arcs[k, 5])
    factors = factors_of(curve, first, second, span_near(table, cross(curve.a, curve.b)), 0.0)
    limit = best.record[0] * (1.0 + margin)
    if not all_positive(factors, curve.low, curve.high) or not is_above_limit(
        numerator(factors), denominator(curve), limit, curve.low, curve.high
    ):
        min_on_curve(points, table, curve, edges[i, 0], edges[k, 0], margin, best)


@inner_kernel
def min_on_curve(
    points: FloatArray, table: SpanTable, curve: Curve, foot_a: int, foot_b: int, margin: float, best: BestBox
) -> tuple[float, float]:
    """Least volume on a curve and where it is; infinite if none is below (1 + margin) times the least.

    A piece is ruled out by a bound, or cut where the bound is least, or where the bound of the vertices
    touched in its middle meets that of the vertices touched there.
    `foot_a` and `foot_b` are a vertex of each edge.
    """
    bottom = denominator(curve)
    least, at = np.inf, 0.0
    todo = best.todo
    todo[0, 0], todo[0, 1] = curve.low, curve.high
    n, pieces, finest = 1, 0, MIN_PIECE
    while n > 0:
        n -= 1
        low, high = todo[n, 0], todo[n, 1]
        x = 0.5 * (low + high)
        cut = x
        pieces += 1
        if pieces % MANY_PIECES == 0:
            finest *= 100.0
        limit = _limit(best, margin, least)
        a, b, c = directions_on(curve, x)
        factors = factors_of(curve, span_near(table, a), span_near(table, b), span_near(table, c), x)
        top = numerator(factors)
        if all_positive(factors, low, high) and is_above_limit(top, bottom, limit, low, high):
            continue
        if high - low < FINE or value(top, x) < FAR * limit * value(bottom, x):
            volume, contacts = _look(points, curve, x, best)
            if volume < least:
                least, at = volume, x
            positive, top = _held(points, foot_a, foot_b, curve, contacts, x, low, high)
            if positive:
                if is_above_limit(top, bottom, _limit(best, margin, least), low, high):
                    continue
                cut = argmin_ratio(top, bottom, low, high)
                volume, others = _look(points, curve, cut, best)
                if volume < least:
                    least, at = volume, cut
                if others != contacts:
                    _, more = _held(points, foot_a, foot_b, curve, others, cut, low, high)
                    cut = crossing(top, more, min(x, cut), max(x, cut))
                    volume, _ = _look(points, curve, cut, best)
                    if volume < least:
                        least, at = volume, cut
                if is_above_limit(top, bottom, _limit(best, margin, least), low, high):
                    continue
        if high - low < finest or n + 2 > len(todo):
            continue
        # A cut near an end would leave nearly the whole piece.
        if not min(cut - low, high - cut) > FINE * (high - low):
            cut = x
        todo[n, 0], todo[n, 1], todo[n + 1, 0], todo[n + 1, 1] = low, cut, cut, high
        n += 2
    return least if least <= best.record[0] * (1.0 + margin) else np.inf, at


@inner_kernel
def _limit(best: BestBox, margin: float, least: float) -> float:
    """Boxes on this curve that are not smaller are of no interest."""
    return float(min(best.record[0] * (1.0 + margin), least * (1.0 - EQUAL)))


@inner_kernel
def _look(points: FloatArray, curve: Curve, x: float, best: BestBox) -> tuple[float, Contacts]:
    """Volume of the box at x, and the vertices across from the edges and at both ends of the third axis."""
    a, b, c = frame_on(curve, x)
    top_a, across_a = extreme_vertices(points, a)
    top_b, across_b = extreme_vertices(points, b)
    top, bottom = extreme_vertices(points, c)
    long, wide = dot(between(points, top_a, across_a), a), dot(between(points, top_b, across_b), b)
    volume = update_if_smaller(long, wide, dot(between(points, top, bottom), c), a, b, c, best)
    return volume, (across_a, across_b, max(top, bottom), min(top, bottom))


@inner_kernel
def _held(
    points: FloatArray,
    foot_a: int,
    foot_b: int,
    curve: Curve,
    contacts: Contacts,
    x: float,
    low: float,
    high: float,
) -> tuple[bool, Quartic]:
    """Whether the bound of these vertices holds on a piece, and its numerator."""
    across_a, across_b, top, bottom = contacts
    span_a, span_b = between(points, foot_a, across_a), between(points, foot_b, across_b)
    factors = factors_of(curve, span_a, span_b, between(points, top, bottom), x)
    return all_positive(factors, low, high), numerator(factors)
