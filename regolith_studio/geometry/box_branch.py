"""Branch and bound for the least box along one curve of boxes that are flush with two edges."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.box_curve import (
    Curve,
    Quartic,
    all_positive,
    crossing,
    denominator,
    directions_on,
    factors_of,
    frame_on,
    least_ratio,
    nowhere_below,
    numerator,
    value,
)
from regolith_studio.geometry.box_record import Found, keep
from regolith_studio.geometry.box_widths import SpanTable, between, ends_along_axes, span_near
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import dot

EQUAL = 1e-11
"""Boxes whose volumes differ by a smaller share are not told apart."""
FINEST = 1e-9
"""Pieces of a curve, in radians, are not cut below this."""
FINE = 0.02
"""Longer pieces with a bound FAR above the limit in the middle are halved without a look at the vertices."""
FAR = 1.003
MANY_PIECES = 3000
"""After so many pieces of one curve, needed only where the volume hardly changes along it, FINEST grows."""
Touched = tuple[int, int, int, int]


@kernel_noalloc
def least_on_curve(
    points: FloatArray, table: SpanTable, curve: Curve, foot_a: int, foot_b: int, margin: float, found: Found
) -> tuple[float, float]:
    """Least volume on a curve and where it is; infinite if none is below (1 + margin) times the least.

    A piece is ruled out by a bound, or cut where the bound is least, or where the bound of the vertices
    touched in its middle meets that of the vertices touched there.

    Parameters
    ----------
    points
        Vertices of the solid, shape (3, n).
    table
        As from :func:`regolith_studio.geometry.box_widths.span_table`.
    foot_a, foot_b
        A vertex of each edge.
    """
    bottom = denominator(curve)
    least, at = np.inf, 0.0
    todo = found.todo
    todo[0, 0], todo[0, 1] = curve.low, curve.high
    n, pieces, finest = 1, 0, FINEST
    while n > 0:
        n -= 1
        low, high = todo[n, 0], todo[n, 1]
        x = 0.5 * (low + high)
        cut = x
        pieces += 1
        if pieces % MANY_PIECES == 0:
            finest *= 100.0
        limit = _limit(found, margin, least)
        a, b, c = directions_on(curve, x)
        factors = factors_of(curve, span_near(table, a), span_near(table, b), span_near(table, c), x)
        top = numerator(factors)
        if all_positive(factors, low, high) and nowhere_below(top, bottom, limit, low, high):
            continue
        if high - low < FINE or value(top, x) < FAR * limit * value(bottom, x):
            volume, touched = _look(points, curve, x, found)
            if volume < least:
                least, at = volume, x
            positive, top = _held(points, foot_a, foot_b, curve, touched, x, low, high)
            if positive:
                if nowhere_below(top, bottom, _limit(found, margin, least), low, high):
                    continue
                cut = least_ratio(top, bottom, low, high)
                volume, others = _look(points, curve, cut, found)
                if volume < least:
                    least, at = volume, cut
                if others != touched:
                    _, more = _held(points, foot_a, foot_b, curve, others, cut, low, high)
                    cut = crossing(top, more, min(x, cut), max(x, cut))
                    volume, _ = _look(points, curve, cut, found)
                    if volume < least:
                        least, at = volume, cut
                if nowhere_below(top, bottom, _limit(found, margin, least), low, high):
                    continue
        if high - low < finest or n + 2 > len(todo):
            continue
        if not min(cut - low, high - cut) > FINE * (high - low):
            cut = x
        todo[n, 0], todo[n, 1], todo[n + 1, 0], todo[n + 1, 1] = low, cut, cut, high
        n += 2
    return least if least <= found.record[0] * (1.0 + margin) else np.inf, at


@kernel_noalloc
def _limit(found: Found, margin: float, least: float) -> float:
    """Boxes on this curve that are not smaller are of no interest."""
    return float(min(found.record[0] * (1.0 + margin), least * (1.0 - EQUAL)))


@kernel_noalloc
def _look(points: FloatArray, curve: Curve, x: float, found: Found) -> tuple[float, Touched]:
    """Volume of the box at x, and the vertices across from the edges and at both ends of the third axis."""
    a, b, c = frame_on(curve, x)
    (top_a, across_a), (top_b, across_b), (top, bottom) = ends_along_axes(points, a, b, c)
    long, wide = dot(between(points, top_a, across_a), a), dot(between(points, top_b, across_b), b)
    volume = keep(long, wide, dot(between(points, top, bottom), c), a, b, c, found)
    return volume, (across_a, across_b, max(top, bottom), min(top, bottom))


@kernel_noalloc
def _held(
    points: FloatArray,
    foot_a: int,
    foot_b: int,
    curve: Curve,
    touched: Touched,
    x: float,
    low: float,
    high: float,
) -> tuple[bool, Quartic]:
    """Whether the bound of these vertices holds on a piece, and its numerator."""
    across_a, across_b, top, bottom = touched
    span_a, span_b = between(points, foot_a, across_a), between(points, foot_b, across_b)
    factors = factors_of(curve, span_a, span_b, between(points, top, bottom), x)
    return all_positive(factors, low, high), numerator(factors)
