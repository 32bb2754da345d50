"""Boxes with a side normal to an axis of a Gauss arc: the best so far, and descent along a piece of it."""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.box_view import TIE, View, flush_after_turn, least_rectangle, look
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.hull_graph import HullGraph
from regolith_studio.geometry.vectors import Vector, frame, mixed

INSET = 1e-8
"""Turn from the ends of a piece, where edges of one face may be flush together, in radians."""
SHARPEST = 1e-9
"""Angle to which minima are found, in radians."""
SAME_BOX = 1e-4
"""Of boxes whose volumes differ by a share below TIE, the one with the lesser sum of edges is kept; where
that differs by less than SAME_BOX, it is one box, better placed."""
STEP = 1e-5
BEND = 16.0
"""Bound on the curvature of the volume with the angle, as a share of the volume."""


class Search(NamedTuple):
    """Scratch space and the best box so far.

    Parameters
    ----------
    sight
        Of the last axis.
    record
        The least volume so far and the sum of the edges of its box, shape (2,).
    axes
        Of the best box, one a row, shape (3, 3).
    todo
        Ends of the pieces of an arc still to be searched, shape (DEPTH, 2).
    """

    sight: View
    record: FloatArray
    axes: FloatArray
    todo: FloatArray


class Arc(NamedTuple):
    """Axes cos(t) start + sin(t) across for t from 0 to angle; (edge, across, start) is right-handed."""

    start: Vector
    across: Vector
    edge: Vector
    angle: float


@kernel
def keep_box(axis: Vector, first: Vector, second: Vector, n: int, search: Search) -> float:
    """Volume of the least box in the view; it is kept if it is the best so far.

    Of two that tie, the one with the shorter edges.
    """
    view = search.sight
    wide, high, at = least_rectangle(view, n)
    if at < 0:
        return np.inf
    volume, total = view.tall[2] * wide * high, view.tall[2] + wide + high
    least, shorter = search.record[0], total / search.record[1] - 1.0
    alike = abs(shorter) < SAME_BOX
    if (
        volume < least * (1.0 - TIE)
        or (alike and volume < least)
        or (shorter < -SAME_BOX and volume < least * (1.0 + TIE))
    ):
        search.record[0], search.record[1] = volume, total
        dx, dy = view.dx[at], view.dy[at]
        for k in range(3):
            search.axes[0, k] = axis[k]
            search.axes[1, k] = dx * first[k] + dy * second[k]
            search.axes[2, k] = dx * second[k] - dy * first[k]
    return float(volume)


@kernel
def box_on(graph: HullGraph, axis: Vector, search: Search) -> int:
    """See the solid along `axis` and keep the least box on it if it is the best so far; as `look` returns."""
    first, second = frame(axis)
    n = look(graph, axis, first, second, search.sight)
    keep_box(axis, first, second, abs(n), search)
    return n


@kernel
def box_on_arc(graph: HullGraph, arc: Arc, angle: float, search: Search) -> tuple[int, float]:
    """See the solid along an axis of the arc: as `look` returns, and the least volume."""
    axis = mixed(arc.start, np.cos(angle), arc.across, np.sin(angle))
    second = mixed(arc.across, np.cos(angle), arc.start, -np.sin(angle))
    n = look(graph, axis, arc.edge, second, search.sight)
    return n, keep_box(axis, arc.edge, second, abs(n), search)


@kernel
def descend(graph: HullGraph, arc: Arc, low: float, high: float, side: int, search: Search) -> None:
    """Least volume of boxes flush with one edge on a piece of an arc where that has one minimum.

    From values and slopes: in turns where the tangents meet (right for a kink) and where the slope,
    interpolated, vanishes (right for a smooth minimum), else the middle.
    """
    box_on_arc(graph, arc, low, search)
    box_on_arc(graph, arc, high, search)
    low, high = low + INSET, high - INSET
    at_low, slope_low = _volume_and_slope(graph, arc, low, side, search)
    at_high, slope_high = _volume_and_slope(graph, arc, high, side, search)
    for step in range(60):
        gap = high - low
        if slope_low >= 0.0 or slope_high <= 0.0 or gap < SHARPEST:
            break
        meeting = (at_high - at_low - slope_high * gap) / (slope_low - slope_high)
        if at_low + slope_low * meeting - BEND * at_low * gap * gap > search.record[0]:
            break
        turn = meeting
        if step % 3 == 1:
            turn = gap * slope_low / (slope_low - slope_high)
        elif step % 3 == 2:
            turn = gap / 2.0
        angle = low + min(max(turn, 0.02 * SHARPEST), gap - 0.02 * SHARPEST)
        volume, slope = _volume_and_slope(graph, arc, angle, side, search)
        if slope < 0.0:
            low, at_low, slope_low = angle, volume, slope
        else:
            high, at_high, slope_high = angle, volume, slope


@kernel
def _volume_and_slope(
    graph: HullGraph, arc: Arc, angle: float, side: int, search: Search
) -> tuple[float, float]:
    """Volume of the box flush with an edge of the outline, and its derivative with the angle."""
    n = abs(box_on_arc(graph, arc, angle, search)[0])
    if side >= n:
        return np.inf, np.nan
    less, _ = flush_after_turn(search.sight, n, side, np.cos(STEP), -np.sin(STEP))
    here, _ = flush_after_turn(search.sight, n, side, 1.0, 0.0)
    more, _ = flush_after_turn(search.sight, n, side, np.cos(STEP), np.sin(STEP))
    return here, (more - less) / (2.0 * STEP)
