"""Which pairs of edges a box below the limit could be flush with: bounds for many curves side by side.

Curves are ruled out whole, then in halves, quarters and so on, each with the spans that the table has for its
middle, later with the vertices that are farthest there. What remains is searched one by one
(:mod:`regolith_studio.geometry.box_branch`).
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.box_branch import least_on_curve
from regolith_studio.geometry.box_facets import Facets
from regolith_studio.geometry.box_lanes import (
    ACROSS,
    BROKEN,
    CUT,
    EDGES,
    FEET,
    HIGH,
    LANES,
    LOW,
    NORMALS,
    OF_A_CURVE,
    ROWS,
    RULED_OUT,
    SPANS,
    X,
    cells_of,
    curve_in,
    curves_between,
    look_along,
    look_up,
    rule_out,
    set_aside,
    take_back,
    where_bounds_meet,
)
from regolith_studio.geometry.box_record import Found
from regolith_studio.geometry.box_widths import SpanTable
from regolith_studio.geometry.compiled import kernel, leaf

MOST_WAITING = 512
"""Pieces that wait; when it is so many, they are worked off."""
LOOK_DEPTH, DEEPEST = 1, 3
"""Halvings of a curve after which vertices are looked at, and after which a piece is searched by itself."""


class Sieve(NamedTuple):
    """Scratch.

    Parameters
    ----------
    lanes
        Of :mod:`regolith_studio.geometry.box_lanes`.
    pairs
        Edges of the curve in each lane, shape (LANES, 2).
    waiting
        Pieces: the rows of a curve, and how often it was cut; a stack.
    filled
        How many pairs are in the lanes and how many pieces wait, shape (2,).
    ends, depth
        Of the pieces in the lanes: where they begin and end, shape (2, LANES), and how often they were cut.
    """

    lanes: FloatArray
    pairs: IntArray
    waiting: FloatArray
    filled: IntArray
    ends: FloatArray
    depth: IntArray


@kernel
def empty_sieve() -> Sieve:
    """Nothing in the lanes, nothing waits."""
    most = MOST_WAITING + (DEEPEST + 2) * LANES
    return Sieve(
        np.zeros(ROWS * LANES),
        np.empty((LANES, 2), np.int64),
        np.empty((most, OF_A_CURVE + 1)),
        np.zeros(2, np.int64),
        np.empty((2, LANES)),
        np.empty(LANES, np.int64),
    )


@leaf
def add_pair(facets: Facets, arcs: FloatArray, i: int, k: int, sieve: Sieve) -> None:
    """Put a pair of edges into the next lane."""
    lanes, edges, normals = sieve.lanes, facets.edges, facets.normals
    at = sieve.filled[0]
    sieve.pairs[at, 0], sieve.pairs[at, 1] = i, k
    for side in range(2):
        e = i if side == 0 else k
        one, two = edges[e, 2], edges[e, 3]
        lanes[(FEET + side) * LANES + at] = edges[e, 0]
        for c in range(3):
            lanes[(NORMALS + 6 * side + c) * LANES + at] = normals[one, c]
            lanes[(NORMALS + 6 * side + 3 + c) * LANES + at] = normals[two, c]
            lanes[(EDGES + 3 * side + c) * LANES + at] = arcs[e, c]
            lanes[(ACROSS + 3 * side + c) * LANES + at] = arcs[e, 3 + c]
    sieve.filled[0] += 1


@leaf
def whole_curves(table: SpanTable, limit: float, sieve: Sieve) -> None:
    """Let the curves in the lanes wait that are not ruled out whole; those of broken ones stay in front."""
    lanes, waiting, count = sieve.lanes, sieve.waiting, sieve.filled
    curves_between(lanes, count[0])
    for k in range(count[0]):
        lanes[X * LANES + k] = 0.0
    cells_of(lanes, count[0], table.cells)
    look_up(lanes, count[0], table, 2)
    for row in range(6):
        for k in range(count[0]):
            lanes[(SPANS + row) * LANES + k] = lanes[(ACROSS + row) * LANES + k]
    rule_out(lanes, count[0], limit)
    broken = 0
    for k in range(count[0]):
        if lanes[BROKEN * LANES + k] > 0.0:
            sieve.pairs[broken, 0], sieve.pairs[broken, 1] = sieve.pairs[k, 0], sieve.pairs[k, 1]
            broken += 1
        elif lanes[RULED_OUT * LANES + k] == 0.0 and lanes[LOW * LANES + k] < lanes[HIGH * LANES + k]:
            for row in range(OF_A_CURVE):
                waiting[count[1], row] = lanes[row * LANES + k]
            waiting[count[1], OF_A_CURVE] = 0.0
            count[1] += 1
    count[0] = broken


@leaf
def work_off(points: FloatArray, table: SpanTable, margin: float, found: Found, sieve: Sieve) -> None:
    """Cut waiting pieces until none is left."""
    while sieve.filled[1] > 0:
        taken = take_top(sieve)
        if sieve.depth[0] <= LOOK_DEPTH:
            halved(points, table, margin, found, taken, sieve)
        else:
            cut_where_bounds_meet(points, table, margin, found, taken, sieve)


@leaf
def take_top(sieve: Sieve) -> int:
    """Put the top of the stack into the lanes."""
    lanes, waiting, count = sieve.lanes, sieve.waiting, sieve.filled
    taken = min(LANES, int(count[1]))
    count[1] -= taken
    for row in range(OF_A_CURVE):
        for k in range(taken):
            lanes[row * LANES + k] = waiting[count[1] + k, row]
    for k in range(taken):
        sieve.depth[k] = int(waiting[count[1] + k, OF_A_CURVE]) + 1
        sieve.ends[0, k], sieve.ends[1, k] = lanes[LOW * LANES + k], lanes[HIGH * LANES + k]
    return taken


@leaf
def halved(
    points: FloatArray, table: SpanTable, margin: float, found: Found, taken: int, sieve: Sieve
) -> None:
    """Ask both halves of the pieces in the lanes."""
    lanes = sieve.lanes
    for half in range(2):
        for k in range(taken):
            low, high = sieve.ends[0, k], sieve.ends[1, k]
            middle = 0.5 * (low + high)
            low, high = (low, middle) if half == 0 else (middle, high)
            lanes[LOW * LANES + k], lanes[HIGH * LANES + k] = low, high
            lanes[X * LANES + k] = 0.5 * (low + high)
        cells_of(lanes, taken, table.cells)
        look_up(lanes, taken, table, 0)
        rule_out(lanes, taken, found.record[0] * (1.0 + margin))
        let_wait(points, table, margin, found, taken, sieve)


@leaf
def cut_where_bounds_meet(
    points: FloatArray, table: SpanTable, margin: float, found: Found, taken: int, sieve: Sieve
) -> None:
    """Ask the pieces in the lanes up to a cut and from there, with the vertices farthest at either end."""
    lanes = sieve.lanes
    for k in range(taken):
        lanes[X * LANES + k] = lanes[LOW * LANES + k]
    look_along(lanes, taken, points)
    set_aside(lanes, taken)
    for k in range(taken):
        lanes[X * LANES + k] = lanes[HIGH * LANES + k]
    look_along(lanes, taken, points)
    where_bounds_meet(lanes, taken)
    for k in range(taken):
        lanes[LOW * LANES + k] = lanes[CUT * LANES + k]
    rule_out(lanes, taken, found.record[0] * (1.0 + margin))
    let_wait(points, table, margin, found, taken, sieve)
    take_back(lanes, taken)
    for k in range(taken):
        lanes[LOW * LANES + k], lanes[HIGH * LANES + k] = sieve.ends[0, k], lanes[CUT * LANES + k]
        lanes[X * LANES + k] = sieve.ends[0, k]
    rule_out(lanes, taken, found.record[0] * (1.0 + margin))
    let_wait(points, table, margin, found, taken, sieve)


@leaf
def let_wait(
    points: FloatArray, table: SpanTable, margin: float, found: Found, taken: int, sieve: Sieve
) -> None:
    """Put the pieces that are not ruled out on the stack; those cut too often are searched at once."""
    lanes, waiting, count = sieve.lanes, sieve.waiting, sieve.filled
    for k in range(taken):
        if lanes[RULED_OUT * LANES + k] == 1.0:
            continue
        if sieve.depth[k] >= DEEPEST:
            curve = curve_in(lanes, k)
            one, two = int(lanes[FEET * LANES + k]), int(lanes[(FEET + 1) * LANES + k])
            least_on_curve(points, table, curve, one, two, margin, found)
            continue
        for row in range(OF_A_CURVE):
            waiting[count[1], row] = lanes[row * LANES + k]
        waiting[count[1], OF_A_CURVE] = sieve.depth[k]
        count[1] += 1
