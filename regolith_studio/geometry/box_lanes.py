"""Curves of boxes, many side by side: the arithmetic of :mod:`regolith_studio.geometry.box_curve` in lanes.

A curve is a column of one flat array, so that the processor takes several at once. Rows start at fixed
places, and no function calls another that is not copied into it: only such loops become vector code.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.box_curve import (
    NO_LEVER,
    Curve,
    all_positive,
    denominator,
    directions_on,
    factors_of,
    nowhere_below,
    numerator,
    unit,
    value,
)
from regolith_studio.geometry.box_widths import SpanTable
from regolith_studio.geometry.compiled import leaf
from regolith_studio.geometry.eights import WIDTH, least, load, most, pick, splat, store
from regolith_studio.geometry.inlined import inlined
from regolith_studio.geometry.vectors import Vector, cross, dot, mixed

LANES = 64
"""Curves side by side."""
A, A_TURN, B, B_TURN, PQR, LOW, HIGH, FEET = 0, 3, 6, 9, 12, 15, 16, 17
"""Rows of a curve, as in :class:`regolith_studio.geometry.box_curve.Curve`; last a vertex of each edge."""
OF_A_CURVE = 19
"""Rows that go with a curve."""
SPANS, CELLS, X, RULED_OUT = 19, 28, 31, 32
"""Rows of a bound: the spans along three axes, their cells in the table, where the spans were looked up,
and 1 where no box on the piece is below the limit."""
NORMALS, EDGES, ACROSS, SECOND, BROKEN = 33, 45, 51, 57, 58
"""Rows of a pair of edges: normals of the facets of each, directions, spans; 1 where the second of two curves
is wanted; 1 where there is a second curve and the first was wanted."""
AXES, ENDS = 33, 42
"""Rows of a look at the vertices: the three axes, and how far and which vertices reach along one."""
OTHER, CUT = 47, 56
"""Rows of a piece with spans from both of its ends: those of its beginning, and where the bounds meet."""
ROWS = 59


@inlined
def three(lanes: FloatArray, first: int, k: int) -> Vector:
    """A vector of lane k."""
    return (
        lanes[first * LANES + k],
        lanes[(first + 1) * LANES + k],
        lanes[(first + 2) * LANES + k],
    )


@inlined
def put(lanes: FloatArray, first: int, k: int, vector: Vector) -> None:
    """Write a vector of lane k."""
    lanes[first * LANES + k] = vector[0]
    lanes[(first + 1) * LANES + k] = vector[1]
    lanes[(first + 2) * LANES + k] = vector[2]


@inlined
def curve_in(lanes: FloatArray, k: int) -> Curve:
    """The curve of lane k."""
    p, q, r = three(lanes, PQR, k)
    return Curve(
        three(lanes, A, k),
        three(lanes, A_TURN, k),
        three(lanes, B, k),
        three(lanes, B_TURN, k),
        p,
        q,
        r,
        lanes[LOW * LANES + k],
        lanes[HIGH * LANES + k],
    )


@inlined
def chosen(first: bool, one: Vector, two: Vector) -> Vector:
    """One of two vectors."""
    return (one[0] if first else two[0], one[1] if first else two[1], one[2] if first else two[2])


@leaf
def curves_between(lanes: FloatArray, count: int) -> None:
    """Curves of pairs of edges, from end to end; empty (low = high) where there is none.

    See :func:`regolith_studio.geometry.box_curve.curve_between`. With a = one + s (two - one) and b likewise
    with t, a . b is bilinear in (s, t): a hyperbola, that cuts the square of (s, t) once or twice.
    """
    for k in range(count):
        one, two = three(lanes, NORMALS, k), three(lanes, NORMALS + 3, k)
        other, last = three(lanes, NORMALS + 6, k), three(lanes, NORMALS + 9, k)
        s00, s01, s10, s11 = dot(one, other), dot(one, last), dot(two, other), dot(two, last)
        p00, p01, p10, p11 = s00 >= 0.0, s01 >= 0.0, s10 >= 0.0, s11 >= 0.0
        both, second = (p00 == p11) & (p00 != p01) & (p00 != p10), lanes[SECOND * LANES + k] == 1.0
        around = ((s00 * s11 - s01 * s10) / (s00 + s11 - s01 - s10) >= 0.0) == p00
        lanes[BROKEN * LANES + k] = 1.0 if both & (not second) else 0.0
        on_low, on_high = (p00 != p01) & (not (both & second)), p10 != p11
        at_side, over = s00 if on_low | (not on_high) else s10, s10 if not (on_low | on_high) else s11
        at_side = at_side / (at_side - (s01 if on_low else over))
        from_s, from_t = (
            0.0 if on_low else (1.0 if on_high else at_side),
            at_side if on_low | on_high else 0.0,
        )
        on_high, on_low = (p01 != p11) & (not (both & (around == second))), p00 != p10
        at_side = s01 if on_high else (s00 if on_low else s10)
        at_side = at_side / (at_side - (s11 if on_high | (not on_low) else s10))
        to_s, to_t = (
            at_side if on_high | on_low else 1.0,
            1.0 if on_high else (0.0 if on_low else at_side),
        )
        a_from, a_to = (
            unit(mixed(one, 1.0 - from_s, two, from_s)),
            unit(mixed(one, 1.0 - to_s, two, to_s)),
        )
        b_from, b_to = (
            unit(mixed(other, 1.0 - from_t, last, from_t)),
            unit(mixed(other, 1.0 - to_t, last, to_t)),
        )
        swap = dot(a_from, a_to) > dot(b_from, b_to)
        put(lanes, SPANS, k, chosen(swap, a_from, b_from))
        put(lanes, SPANS + 3, k, chosen(swap, a_to, b_to))
        put(lanes, A, k, chosen(swap, b_from, a_from))
        put(lanes, A_TURN, k, chosen(swap, b_to, a_to))
        first, second = three(lanes, EDGES, k), three(lanes, EDGES + 3, k)
        put(lanes, EDGES, k, chosen(swap, second, first))
        put(lanes, EDGES + 3, k, chosen(swap, first, second))
        first, second = three(lanes, ACROSS, k), three(lanes, ACROSS + 3, k)
        put(lanes, ACROSS, k, chosen(swap, second, first))
        put(lanes, ACROSS + 3, k, chosen(swap, first, second))
        foot, other_foot = lanes[FEET * LANES + k], lanes[(FEET + 1) * LANES + k]
        lanes[FEET * LANES + k] = other_foot if swap else foot
        lanes[(FEET + 1) * LANES + k] = foot if swap else other_foot
    for k in range(count):
        edge_a, edge_b = three(lanes, EDGES, k), three(lanes, EDGES + 3, k)
        a_from, a_to = three(lanes, A, k), three(lanes, A_TURN, k)
        b_from, b_to = three(lanes, SPANS, k), three(lanes, SPANS + 3, k)
        a = unit(mixed(a_from, 1.0, a_to, 1.0))
        b = cross(edge_b, a)
        lever = np.sqrt(dot(b, b))
        shrink = (-1.0 if dot(b, b_from) + dot(b, b_to) < 0.0 else 1.0) / lever
        b = mixed(b, shrink, b, 0.0)
        a_turn, b_turn = cross(edge_a, a), cross(edge_b, b)
        one_end, two_end = dot(a_from, a_turn) / dot(a_from, a), dot(a_to, a_turn) / dot(a_to, a)
        p, q, r = dot(a_turn, b), dot(a, b_turn), dot(a_turn, b_turn)
        sign = -1.0 if q < 0.0 else 1.0
        put(lanes, A, k, a)
        put(lanes, A_TURN, k, a_turn)
        put(lanes, B, k, b)
        put(lanes, B_TURN, k, b_turn)
        put(lanes, PQR, k, (sign * p, sign * q, sign * r))
        fine = (lever >= NO_LEVER) & (q != 0.0)
        lanes[LOW * LANES + k] = min(one_end, two_end) if fine else 0.0
        lanes[HIGH * LANES + k] = max(one_end, two_end) if fine else 0.0


@leaf
def cells_of(lanes: FloatArray, count: int, cells: int) -> None:
    """Cells of the three axes at X; see :func:`regolith_studio.geometry.box_widths.span_near`."""
    most = cells - 1.0
    half = 0.5 * cells
    for k in range(count):
        axes = directions_on(curve_in(lanes, k), lanes[X * LANES + k])
        for axis in range(3):
            x, y, z = axes[0] if axis == 0 else (axes[1] if axis == 1 else axes[2])
            first = (abs(x) >= abs(y)) & (abs(x) >= abs(z))
            second = abs(y) >= abs(z)
            face = 0.0 if first else (1.0 if second else 2.0)
            main = x if first else (y if second else z)
            u = (y if first else (z if second else x)) / main
            v = (z if first else (x if second else y)) / main
            i, j = min(most, np.floor((u + 1.0) * half)), min(most, np.floor((v + 1.0) * half))
            lanes[(CELLS + axis) * LANES + k] = (face * cells + i) * cells + j


@leaf
def look_up(lanes: FloatArray, count: int, table: SpanTable, first: int) -> None:
    """Spans of the cells, from axis `first` on."""
    spans = table.spans
    for axis in range(first, 3):
        for k in range(count):
            at = int(lanes[(CELLS + axis) * LANES + k])
            for c in range(3):
                lanes[(SPANS + 3 * axis + c) * LANES + k] = spans[at, c]


@leaf
def rule_out(lanes: FloatArray, count: int, limit: float) -> None:
    """Whether no box is below the limit, by the bound of the spans."""
    for k in range(count):
        curve = curve_in(lanes, k)
        factors = factors_of(
            curve,
            three(lanes, SPANS, k),
            three(lanes, SPANS + 3, k),
            three(lanes, SPANS + 6, k),
            lanes[X * LANES + k],
        )
        low, high = curve.low, curve.high
        proven = all_positive(factors, low, high) & nowhere_below(
            numerator(factors), denominator(curve), limit, low, high
        )
        lanes[RULED_OUT * LANES + k] = 1.0 if proven else 0.0


@leaf
def look_along(lanes: FloatArray, count: int, points: FloatArray) -> None:
    """Spans between the vertices that are farthest along the three axes at X."""
    for k in range(count):
        a, b, _ = directions_on(curve_in(lanes, k), lanes[X * LANES + k])
        a, b = unit(a), unit(b)
        put(lanes, AXES, k, a)
        put(lanes, AXES + 3, k, b)
        put(lanes, AXES + 6, k, cross(a, b))
    for axis in range(3):
        start = (AXES + 3 * axis) * LANES
        for at in range(0, count, WIDTH):
            x, y = load(lanes, start + at), load(lanes, start + LANES + at)
            z, low, high = load(lanes, start + 2 * LANES + at), splat(np.inf), splat(-np.inf)
            bottoms = tops = splat(0.0)
            for i in range(points.shape[1]):
                here = splat(points[0, i]) * x + splat(points[1, i]) * y + splat(points[2, i]) * z
                now = splat(float(i))
                bottoms, tops = pick(here, low, now, bottoms), pick(high, here, now, tops)
                low, high = least(here, low), most(here, high)
            store(lanes, (ENDS + 2) * LANES + at, bottoms)
            store(lanes, (ENDS + 3) * LANES + at, tops)
        for k in range(count):
            bottom, top = int(lanes[(ENDS + 2) * LANES + k]), int(lanes[(ENDS + 3) * LANES + k])
            for c in range(3):
                lanes[(SPANS + 3 * axis + c) * LANES + k] = points[c, top] - points[c, bottom]


@leaf
def set_aside(lanes: FloatArray, count: int) -> None:
    """Copy the spans."""
    for row in range(9):
        for k in range(count):
            lanes[(OTHER + row) * LANES + k] = lanes[(SPANS + row) * LANES + k]


@leaf
def take_back(lanes: FloatArray, count: int) -> None:
    """Copy the spans back."""
    for row in range(9):
        for k in range(count):
            lanes[(SPANS + row) * LANES + k] = lanes[(OTHER + row) * LANES + k]


@leaf
def where_bounds_meet(lanes: FloatArray, count: int) -> None:
    """About where the bound of the beginning's spans meets that of the end's."""
    for k in range(count):
        curve = curve_in(lanes, k)
        low, high = curve.low, curve.high
        one = numerator(
            factors_of(
                curve,
                three(lanes, OTHER, k),
                three(lanes, OTHER + 3, k),
                three(lanes, OTHER + 6, k),
                low,
            )
        )
        two = numerator(
            factors_of(
                curve,
                three(lanes, SPANS, k),
                three(lanes, SPANS + 3, k),
                three(lanes, SPANS + 6, k),
                high,
            )
        )
        begin, end = low, high
        f_low, f_high = value(one, low) - value(two, low), value(one, high) - value(two, high)
        x = 0.5 * (low + high)
        for step in range(6):
            secant = low - f_low * (high - low) / (f_high - f_low)
            x = secant if (step % 3 < 2) & (f_low > f_high) else 0.5 * (low + high)
            f = value(one, x) - value(two, x)
            low, high = x if f > 0.0 else low, high if f > 0.0 else x
            f_low, f_high = f if f > 0.0 else f_low, f_high if f > 0.0 else f
        small = 0.02 * (end - begin)
        inside = (x > begin + small) & (x < end - small)
        lanes[CUT * LANES + k] = x if inside else 0.5 * (begin + end)
