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
    scaled,
    unit,
    value,
)
from regolith_studio.geometry.box_widths import SpanTable
from regolith_studio.geometry.eights import WIDTH, least, load, most, pick, splat, store
from regolith_studio.geometry.kernels import inline_kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector, cross, dot, mixed, row

LANES = 64
"""Curves side by side."""
A, A_TURN, B, B_TURN, PQR, LOW, HIGH, FEET, CUTS = 0, 3, 6, 9, 12, 15, 16, 17, 19
"""Rows of a curve, as in :class:`regolith_studio.geometry.box_curve.Curve`; then a vertex of each edge, and
how often the curve was cut."""
OF_A_PIECE = 20
"""Rows that go with a piece of a curve."""
SPANS, CELLS, X, RULED_OUT = 20, 29, 32, 33
"""Rows of a bound: the spans along three axes, their cells in the table, where the spans were looked up,
and 1 where no box on the piece is below the limit."""
ONE_EDGE, OTHER_EDGE, SECOND, BROKEN = 34, 47, 60, 61
"""Rows of a pair of edges: what is recorded of each; 1 where the second of two curves is wanted; 1 where
there is a second curve and the first was wanted."""
NORMALS, SHRINK, DIRECTION, FOOT, NUMBER, OF_AN_EDGE = 0, 6, 8, 11, 12, 13
"""What is recorded of an edge: normals of its facets and what brings each to length 1 (but for rounding it is
1), its direction, a vertex, its number."""
AXES, ENDS = 34, 43
"""Rows of a look at the vertices: the three axes, and which vertices reach farthest along one."""
OTHER, CUT = 47, 56
"""Rows of a piece with spans from both of its ends: those of its beginning, and where the bounds meet."""
WHICH, SIDES, LEVER, AREA, ACROSS = 0, 1, 4, 5, 6
"""Rows of a rectangle on a facet: number and direction of the edge along it, square of the length that the
direction has across the axis, a bound on the area, and both directions."""
ROWS = 62


@inline_kernel
def three(lanes: FloatArray, first: int, k: int) -> Vector:
    """A vector of lane k."""
    return (
        lanes[first * LANES + k],
        lanes[(first + 1) * LANES + k],
        lanes[(first + 2) * LANES + k],
    )


@inline_kernel
def put(lanes: FloatArray, first: int, k: int, vector: Vector) -> None:
    """Write a vector of lane k."""
    lanes[first * LANES + k] = vector[0]
    lanes[(first + 1) * LANES + k] = vector[1]
    lanes[(first + 2) * LANES + k] = vector[2]


@inline_kernel
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


@inline_kernel
def chosen(first: bool, one: Vector, two: Vector) -> Vector:
    """One of two vectors."""
    return (one[0] if first else two[0], one[1] if first else two[1], one[2] if first else two[2])


@kernel_noalloc
def curves_between(lanes: FloatArray, count: int) -> None:
    """Curves of pairs of edges, from end to end; empty (low = high) where there is none.

    See :func:`regolith_studio.geometry.box_curve.curve_between`. With a = one + s (two - one) and b likewise
    with t, a . b is bilinear in (s, t): a hyperbola, that cuts the square of (s, t) once or twice.
    """
    for k in range(count):
        one, two = three(lanes, ONE_EDGE + NORMALS, k), three(lanes, ONE_EDGE + NORMALS + 3, k)
        other, last = three(lanes, OTHER_EDGE + NORMALS, k), three(lanes, OTHER_EDGE + NORMALS + 3, k)
        s00, s01, s10, s11 = dot(one, other), dot(one, last), dot(two, other), dot(two, last)
        p00, p01, p10, p11 = s00 >= 0.0, s01 >= 0.0, s10 >= 0.0, s11 >= 0.0
        both, second = (p00 == p11) & (p00 != p01) & (p00 != p10), lanes[SECOND * LANES + k] == 1.0
        around = ((s00 * s11 - s01 * s10) * (s00 + s11 - s01 - s10) >= 0.0) == p00
        lanes[BROKEN * LANES + k] = 1.0 if both & (not second) else 0.0
        on_low, on_high = (p00 != p01) & (not (both & second)), p10 != p11
        at_side, over = s00 if on_low | (not on_high) else s10, s10 if not (on_low | on_high) else s11
        at_side = at_side / (at_side - (s01 if on_low else over))
        on_side = on_low | on_high
        shrink = lanes[(ONE_EDGE + SHRINK) * LANES + k], lanes[(ONE_EDGE + SHRINK + 1) * LANES + k]
        other_shrink = lanes[(OTHER_EDGE + SHRINK) * LANES + k], lanes[(OTHER_EDGE + SHRINK + 1) * LANES + k]
        moved = mixed(chosen(on_side, other, one), 1.0 - at_side, chosen(on_side, last, two), at_side)
        moved = unit(moved)
        known = shrink[0] if on_low else (shrink[1] if on_high else other_shrink[0])
        fixed = scaled(chosen(on_low, one, chosen(on_high, two, other)), known)
        a_from, b_from = chosen(on_side, fixed, moved), chosen(on_side, moved, fixed)
        on_high, on_low = (p01 != p11) & (not (both & (around == second))), p00 != p10
        at_side = s01 if on_high else (s00 if on_low else s10)
        at_side = at_side / (at_side - (s11 if on_high | (not on_low) else s10))
        on_side = on_low | on_high
        moved = mixed(chosen(on_side, one, other), 1.0 - at_side, chosen(on_side, two, last), at_side)
        moved = unit(moved)
        known = other_shrink[1] if on_high else (other_shrink[0] if on_low else shrink[1])
        fixed = scaled(chosen(on_high, last, chosen(on_low, other, two)), known)
        a_to, b_to = chosen(on_side, moved, fixed), chosen(on_side, fixed, moved)
        swap = dot(a_from, a_to) > dot(b_from, b_to)
        put(lanes, SPANS, k, chosen(swap, a_from, b_from))
        put(lanes, SPANS + 3, k, chosen(swap, a_to, b_to))
        put(lanes, A, k, chosen(swap, b_from, a_from))
        put(lanes, A_TURN, k, chosen(swap, b_to, a_to))
        edge, other_edge = (
            three(lanes, ONE_EDGE + DIRECTION, k),
            three(lanes, OTHER_EDGE + DIRECTION, k),
        )
        put(lanes, ONE_EDGE + DIRECTION, k, chosen(swap, other_edge, edge))
        put(lanes, OTHER_EDGE + DIRECTION, k, chosen(swap, edge, other_edge))
        foot, other_foot = lanes[(ONE_EDGE + FOOT) * LANES + k], lanes[(OTHER_EDGE + FOOT) * LANES + k]
        lanes[FEET * LANES + k] = other_foot if swap else foot
        lanes[(FEET + 1) * LANES + k] = foot if swap else other_foot
    for k in range(count):
        edge_a, edge_b = three(lanes, ONE_EDGE + DIRECTION, k), three(lanes, OTHER_EDGE + DIRECTION, k)
        a_from, a_to = three(lanes, A, k), three(lanes, A_TURN, k)
        b_from, b_to = three(lanes, SPANS, k), three(lanes, SPANS + 3, k)
        a = unit(mixed(a_from, 1.0, a_to, 1.0))
        b = cross(edge_b, a)
        lever = np.sqrt(dot(b, b))
        shrink = (-1.0 if dot(b, b_from) + dot(b, b_to) < 0.0 else 1.0) / lever
        b = scaled(b, shrink)
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


@inline_kernel
def whole_eights(count: int) -> int:
    """So many lanes that no loop has a rest; what is worked out in lanes that hold nothing, nobody reads."""
    return (count + WIDTH - 1) // WIDTH * WIDTH


@inline_kernel
def main_of(vector: Vector) -> float:
    """The component of largest size."""
    x, y, z = vector
    first, second = (abs(x) >= abs(y)) & (abs(x) >= abs(z)), abs(y) >= abs(z)
    return x if first else (y if second else z)


@inline_kernel
def cell_of(vector: Vector, shrink: float, cells: int) -> float:
    """Its cell in a table of directions, with 1 over its component of largest size."""
    x, y, z = vector
    first, second = (abs(x) >= abs(y)) & (abs(x) >= abs(z)), abs(y) >= abs(z)
    face = 0.0 if first else (1.0 if second else 2.0)
    u = (y if first else (z if second else x)) * shrink
    v = (z if first else (x if second else y)) * shrink
    i = max(0.0, min(cells - 1.0, np.floor((u + 1.0) * (0.5 * cells))))
    j = max(0.0, min(cells - 1.0, np.floor((v + 1.0) * (0.5 * cells))))
    return float((face * cells + i) * cells + j)


@kernel_noalloc
def cells_of(lanes: FloatArray, count: int, cells: int) -> None:
    """Cells of the three axes at X; see :func:`regolith_studio.geometry.box_widths.span_near`."""
    for k in range(count):
        curve, at = curve_in(lanes, k), lanes[X * LANES + k]
        a = mixed(curve.a, 1.0, curve.a_turn, at)
        b = mixed(curve.b, curve.q + curve.r * at, curve.b_turn, -curve.p * at)
        axes = a, b, cross(a, b)
        mains = main_of(axes[0]), main_of(axes[1]), main_of(axes[2])
        shrink = 1.0 / (mains[0] * mains[1] * mains[2])
        for axis in range(3):
            one, two = mains[1] if axis == 0 else mains[0], mains[1] if axis == 2 else mains[2]
            way = axes[0] if axis == 0 else (axes[1] if axis == 1 else axes[2])
            lanes[(CELLS + axis) * LANES + k] = cell_of(way, shrink * one * two, cells)


@kernel_noalloc
def look_up(lanes: FloatArray, count: int, table: SpanTable) -> None:
    """Spans of the cells."""
    spans = table.spans
    for axis in range(3):
        for k in range(count):
            at = np.uintp(int(lanes[(CELLS + axis) * LANES + k]))
            for c in range(3):
                lanes[(SPANS + 3 * axis + c) * LANES + k] = spans[at, c]


@kernel_noalloc
def bounds_on_facet(lanes: FloatArray, count: int, axis: Vector, table: SpanTable) -> None:
    """Bounds on the areas of rectangles normal to an axis, each with a side along an edge.

    The bound is LEVER times too large; infinite where the edge is along the axis.
    """
    for k in range(whole_eights(count)):
        b = cross(three(lanes, SIDES, k), axis)
        c = cross(axis, b)
        main, other = main_of(b), main_of(c)
        shrink = 1.0 / (main * other)
        put(lanes, ACROSS, k, b)
        put(lanes, ACROSS + 3, k, c)
        lanes[LEVER * LANES + k] = dot(b, b)
        lanes[CELLS * LANES + k] = cell_of(b, shrink * other, table.cells)
        lanes[(CELLS + 1) * LANES + k] = cell_of(c, shrink * main, table.cells)
    for k in range(count):
        lanes[AREA * LANES + k] = np.inf
        if lanes[LEVER * LANES + k] > NO_LEVER * NO_LEVER:
            one = row(table.spans, int(lanes[CELLS * LANES + k]))
            two = row(table.spans, int(lanes[(CELLS + 1) * LANES + k]))
            wide, high = dot(one, three(lanes, ACROSS, k)), dot(two, three(lanes, ACROSS + 3, k))
            lanes[AREA * LANES + k] = abs(wide * high)


@kernel_noalloc
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


@kernel_noalloc
def look_along(lanes: FloatArray, count: int, points: FloatArray) -> None:
    """Spans between the vertices that are farthest along the three axes at X; along two, an edge's is."""
    for k in range(whole_eights(count)):
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
            if axis < 2:
                tops = load(lanes, (FEET + axis) * LANES + at)
                for i in range(points.shape[1]):
                    here = splat(points[0, i]) * x + splat(points[1, i]) * y + splat(points[2, i]) * z
                    bottoms, low = pick(here, low, splat(float(i)), bottoms), least(here, low)
            else:
                for i in range(points.shape[1]):
                    here = splat(points[0, i]) * x + splat(points[1, i]) * y + splat(points[2, i]) * z
                    now = splat(float(i))
                    bottoms, tops = pick(here, low, now, bottoms), pick(high, here, now, tops)
                    low, high = least(here, low), most(here, high)
            store(lanes, ENDS * LANES + at, bottoms)
            store(lanes, (ENDS + 1) * LANES + at, tops)
        for k in range(count):
            bottom, top = np.uintp(int(lanes[ENDS * LANES + k])), np.uintp(int(lanes[(ENDS + 1) * LANES + k]))
            for c in range(3):
                lanes[(SPANS + 3 * axis + c) * LANES + k] = points[c, top] - points[c, bottom]


@kernel_noalloc
def set_aside(lanes: FloatArray, count: int) -> None:
    """Copy the spans."""
    for line in range(9):
        for k in range(count):
            lanes[(OTHER + line) * LANES + k] = lanes[(SPANS + line) * LANES + k]


@kernel_noalloc
def take_back(lanes: FloatArray, count: int) -> None:
    """Copy the spans back."""
    for line in range(9):
        for k in range(count):
            lanes[(SPANS + line) * LANES + k] = lanes[(OTHER + line) * LANES + k]


@kernel_noalloc
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
