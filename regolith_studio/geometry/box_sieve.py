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
    SECOND,
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
HALVINGS, DEEPEST = 2, 5
"""How often a curve is halved before vertices are looked at, and cut before a piece is searched by itself."""
PAIRS = 2
"""Place in the numbers of what is filled."""
OF_AN_EDGE = 13
ROWS_OF_AN_EDGE = (
    *((NORMALS + k, NORMALS + 6 + k) for k in range(6)),
    *((EDGES + k, EDGES + 3 + k) for k in range(3)),
    *((ACROSS + k, ACROSS + 3 + k) for k in range(3)),
    (FEET, FEET + 1),
)
"""Where the lanes hold what is recorded of the first and of the second edge."""


class Sieve(NamedTuple):
    """Scratch.

    Parameters
    ----------
    lanes
        Of :mod:`regolith_studio.geometry.box_lanes`.
    pairs
        Edges of the curve in each lane, and whether it is their second, shape (3, LANES).
    waiting
        Two stacks of pieces, to be halved and to be cut where bounds meet: the rows of a curve, and how
        often it was cut.
    filled
        How many pieces wait on either stack, and how many pairs are in the lanes, shape (3,).
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
        np.empty((3, LANES), np.int64),
        np.empty((2, most, OF_A_CURVE + 1)),
        np.zeros(3, np.int64),
        np.empty((2, LANES)),
        np.empty(LANES, np.int64),
    )


@kernel
def records_of(facets: Facets, arcs: FloatArray) -> FloatArray:
    """What lanes hold of each edge: normals of its facets, direction, span and a vertex, shape (13, e)."""
    records = np.empty((OF_AN_EDGE, len(facets.edges)))
    for e in range(len(facets.edges)):
        one, two = facets.edges[e, 2], facets.edges[e, 3]
        for c in range(3):
            records[c, e], records[3 + c, e] = facets.normals[one, c], facets.normals[two, c]
            records[6 + c, e], records[9 + c, e] = arcs[e, c], arcs[e, 3 + c]
        records[12, e] = facets.edges[e, 0]
    return records


@leaf
def add_pair(i: int, k: int, second: bool, sieve: Sieve) -> None:
    """Put a pair of edges down for the next lane, for its first or second curve."""
    at = sieve.filled[PAIRS]
    sieve.pairs[0, at], sieve.pairs[1, at], sieve.pairs[2, at] = i, k, second
    sieve.filled[PAIRS] += 1


@leaf
def take_pairs(records: FloatArray, sieve: Sieve) -> None:
    """Fill the lanes with the pairs that are put down."""
    lanes, pairs, count = sieve.lanes, sieve.pairs, sieve.filled[PAIRS]
    for side in range(2):
        for row in range(OF_AN_EDGE):
            to = ROWS_OF_AN_EDGE[row][side] * LANES
            for k in range(count):
                lanes[to + k] = records[row, pairs[side, k]]
    for k in range(count):
        lanes[SECOND * LANES + k] = float(pairs[2, k])


@leaf
def whole_curves(records: FloatArray, table: SpanTable, limit: float, sieve: Sieve) -> None:
    """Let the curves of the pairs wait that are not ruled out whole; pairs with a second curve stay."""
    lanes, waiting, count = sieve.lanes, sieve.waiting, sieve.filled[PAIRS]
    take_pairs(records, sieve)
    curves_between(lanes, count)
    for k in range(count):
        lanes[X * LANES + k] = 0.0
    cells_of(lanes, count, table.cells)
    look_up(lanes, count, table, 2)
    for row in range(6):
        for k in range(count):
            lanes[(SPANS + row) * LANES + k] = lanes[(ACROSS + row) * LANES + k]
    rule_out(lanes, count, limit)
    broken = 0
    for k in range(count):
        if lanes[BROKEN * LANES + k] > 0.0:
            sieve.pairs[0, broken], sieve.pairs[1, broken] = sieve.pairs[0, k], sieve.pairs[1, k]
            broken += 1
        if lanes[RULED_OUT * LANES + k] == 0.0 and lanes[LOW * LANES + k] < lanes[HIGH * LANES + k]:
            for row in range(OF_A_CURVE):
                waiting[0, sieve.filled[0], row] = lanes[row * LANES + k]
            waiting[0, sieve.filled[0], OF_A_CURVE] = 0.0
            sieve.filled[0] += 1
    sieve.filled[PAIRS] = broken


@leaf
def work_off(points: FloatArray, table: SpanTable, margin: float, found: Found, sieve: Sieve) -> None:
    """Cut waiting pieces until none is left."""
    while sieve.filled[0] + sieve.filled[1] > 0:
        if sieve.filled[0] == 0 or sieve.filled[1] >= LANES:
            cut_where_bounds_meet(points, table, margin, found, take_top(1, sieve), sieve)
        else:
            halved(points, table, margin, found, take_top(0, sieve), sieve)


@leaf
def take_top(stack: int, sieve: Sieve) -> int:
    """Put the top of a stack into the lanes."""
    lanes, waiting = sieve.lanes, sieve.waiting
    taken = min(LANES, int(sieve.filled[stack]))
    sieve.filled[stack] -= taken
    first = sieve.filled[stack]
    for row in range(OF_A_CURVE):
        for k in range(taken):
            lanes[row * LANES + k] = waiting[stack, first + k, row]
    for k in range(taken):
        sieve.depth[k] = int(waiting[stack, first + k, OF_A_CURVE]) + 1
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
    lanes, waiting = sieve.lanes, sieve.waiting
    for k in range(taken):
        if lanes[RULED_OUT * LANES + k] == 1.0:
            continue
        if sieve.depth[k] >= DEEPEST:
            curve = curve_in(lanes, k)
            one, two = int(lanes[FEET * LANES + k]), int(lanes[(FEET + 1) * LANES + k])
            least_on_curve(points, table, curve, one, two, margin, found)
            continue
        stack = 0 if sieve.depth[k] < HALVINGS else 1
        at = sieve.filled[stack]
        for row in range(OF_A_CURVE):
            waiting[stack, at, row] = lanes[row * LANES + k]
        waiting[stack, at, OF_A_CURVE] = sieve.depth[k]
        sieve.filled[stack] += 1
