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
    BROKEN,
    CUT,
    CUTS,
    DIRECTION,
    FEET,
    FOOT,
    HIGH,
    LANES,
    LOW,
    NORMALS,
    NUMBER,
    OF_A_PIECE,
    OF_AN_EDGE,
    ONE_EDGE,
    OTHER_EDGE,
    ROWS,
    RULED_OUT,
    SECOND,
    SHRINK,
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
    whole_eights,
)
from regolith_studio.geometry.box_record import Found
from regolith_studio.geometry.box_widths import SpanTable
from regolith_studio.geometry.eights import (
    WIDTH,
    count_bits,
    first_bit,
    least,
    load,
    most,
    positive,
    splat,
    store,
    store_some,
)
from regolith_studio.geometry.kernels import inline_kernel, kernel, kernel_noalloc
from regolith_studio.geometry.vectors import length, row

MOST_WAITING = 512
"""Pieces that wait; when it is so many, they are worked off."""
HALVINGS, DEEPEST = 2, 5
"""How often a curve is halved before vertices are looked at, and cut before a piece is searched by itself."""
MOST = MOST_WAITING + (DEEPEST + 2) * LANES + WIDTH
"""Places on a stack; the last eight may be written over."""
PAIRS = 2
"""Place in the numbers of what is filled."""


class Sieve(NamedTuple):
    """Scratch.

    Parameters
    ----------
    lanes
        Of :mod:`regolith_studio.geometry.box_lanes`.
    waiting
        Two stacks of pieces, to be halved and to be cut where bounds meet, a piece a column: the rows of a
        piece, shape (2, OF_A_PIECE, MOST).
    filled
        How many pieces wait on either stack, and how many pairs of edges are in the lanes, shape (3,).
    ends
        Of the pieces in the lanes: where they begin and end, shape (2, LANES).
    broken
        Edges of pairs of which the second curve is still to be asked, shape (2, LANES).
    """

    lanes: FloatArray
    waiting: FloatArray
    filled: IntArray
    ends: FloatArray
    broken: IntArray


@kernel
def empty_sieve() -> Sieve:
    """Nothing in the lanes, nothing waits."""
    return Sieve(
        np.zeros(ROWS * LANES),
        np.empty((2, OF_A_PIECE, MOST)),
        np.zeros(3, np.int64),
        np.empty((2, LANES)),
        np.empty((2, LANES), np.int64),
    )


@kernel
def records_of(facets: Facets, arcs: FloatArray) -> FloatArray:
    """What lanes hold of each edge, shape (OF_AN_EDGE, e + 8): eight may be loaded wherever an edge is."""
    records = np.zeros((OF_AN_EDGE, len(facets.edges) + WIDTH))
    for e in range(len(facets.edges)):
        one, two = facets.edges[e, 2], facets.edges[e, 3]
        for c in range(3):
            records[NORMALS + c, e] = facets.normals[one, c]
            records[NORMALS + 3 + c, e] = facets.normals[two, c]
            records[DIRECTION + c, e] = arcs[e, c]
        records[SHRINK, e], records[SHRINK + 1, e] = (
            1.0 / length(row(facets.normals, one)),
            1.0 / length(row(facets.normals, two)),
        )
        records[FOOT, e], records[NUMBER, e] = facets.edges[e, 0], e
    return records


@inline_kernel
def orthogonal(records: FloatArray, i: int, k: int) -> int:
    """Which of the eight edges from k on have normals that are orthogonal to some of edge i, as bits."""
    n = records.shape[1]
    nought = lowest = highest = splat(0.0)
    for side in range(NORMALS, NORMALS + 6, 3):
        x, y, z = splat(records[side, i]), splat(records[side + 1, i]), splat(records[side + 2, i])
        for other in range(NORMALS, NORMALS + 6, 3):
            at = other * n + k
            here = x * load(records, at) + y * load(records, at + n) + z * load(records, at + 2 * n)
            first = (side == NORMALS) & (other == NORMALS)
            lowest, highest = here if first else least(here, lowest), here if first else most(here, highest)
    return positive(nought - lowest) & ~positive(nought - highest)


@inline_kernel
def add_pairs(records: FloatArray, i: int, k: int, bits: int, sieve: Sieve) -> None:
    """Put edge i into the next lanes, with each of the eight edges from k on whose bit is set."""
    lanes, at, n = sieve.lanes, sieve.filled[PAIRS], records.shape[1]
    for line in range(OF_AN_EDGE):
        store(lanes, (ONE_EDGE + line) * LANES + at, splat(records[line, i]))
        store_some(lanes, (OTHER_EDGE + line) * LANES + at, load(records, line * n + k), bits)
    store(lanes, SECOND * LANES + at, splat(0.0))
    sieve.filled[PAIRS] += count_bits(bits)


@kernel_noalloc
def add_pair(records: FloatArray, i: int, k: int, second: bool, sieve: Sieve) -> None:
    """Put a pair of edges into the next lane, for its first or second curve."""
    lanes, at = sieve.lanes, sieve.filled[PAIRS]
    for line in range(OF_AN_EDGE):
        lanes[(ONE_EDGE + line) * LANES + at] = records[line, i]
        lanes[(OTHER_EDGE + line) * LANES + at] = records[line, k]
    lanes[SECOND * LANES + at] = 1.0 if second else 0.0
    sieve.filled[PAIRS] += 1


@kernel_noalloc
def whole_curves(table: SpanTable, limit: float, sieve: Sieve) -> int:
    """Let the curves of the pairs wait that are not ruled out whole; how many pairs have a second curve."""
    lanes, count = sieve.lanes, sieve.filled[PAIRS]
    full = whole_eights(count)
    curves_between(lanes, full)
    for k in range(full):
        lanes[X * LANES + k] = lanes[CUTS * LANES + k] = 0.0
    cells_of(lanes, full, table.cells)
    look_up(lanes, count, table)
    rule_out(lanes, full, limit)
    for at in range(0, count, WIDTH):
        low, high = load(lanes, LOW * LANES + at), load(lanes, HIGH * LANES + at)
        push(0, at, not_ruled_out(lanes, at, count) & positive(high - low), sieve)
    broken = 0
    for k in range(count):
        if lanes[BROKEN * LANES + k] > 0.0:
            sieve.broken[0, broken] = int(lanes[(ONE_EDGE + NUMBER) * LANES + k])
            sieve.broken[1, broken] = int(lanes[(OTHER_EDGE + NUMBER) * LANES + k])
            broken += 1
    sieve.filled[PAIRS] = 0
    return broken


@kernel_noalloc
def work_off(points: FloatArray, table: SpanTable, margin: float, found: Found, sieve: Sieve) -> None:
    """Cut waiting pieces until none is left."""
    while sieve.filled[0] + sieve.filled[1] > 0:
        if sieve.filled[0] == 0 or sieve.filled[1] >= LANES:
            cut_where_bounds_meet(points, table, margin, found, take_top(1, sieve), sieve)
        else:
            halved(points, table, margin, found, take_top(0, sieve), sieve)


@inline_kernel
def not_ruled_out(lanes: FloatArray, at: int, count: int) -> int:
    """Which of the eight lanes from `at` on hold a piece that is not ruled out, as bits."""
    bits = positive(splat(0.5) - load(lanes, RULED_OUT * LANES + at))
    return bits & ((1 << min(WIDTH, count - at)) - 1)


@inline_kernel
def push(stack: int, at: int, bits: int, sieve: Sieve) -> None:
    """Put those of the pieces in the eight lanes from `at` on whose bit is set on a stack."""
    if bits != 0:
        to = stack * OF_A_PIECE * MOST + sieve.filled[stack]
        for line in range(OF_A_PIECE):
            store_some(sieve.waiting, to + line * MOST, load(sieve.lanes, line * LANES + at), bits)
        sieve.filled[stack] += count_bits(bits)


@kernel_noalloc
def take_top(stack: int, sieve: Sieve) -> int:
    """Put the top of a stack into the lanes, each cut once more than before."""
    lanes, waiting = sieve.lanes, sieve.waiting
    taken = min(LANES, int(sieve.filled[stack]))
    sieve.filled[stack] -= taken
    first = stack * OF_A_PIECE * MOST + sieve.filled[stack]
    for at in range(0, taken, WIDTH):
        for line in range(OF_A_PIECE):
            store(lanes, line * LANES + at, load(waiting, first + line * MOST + at))
        store(lanes, CUTS * LANES + at, load(lanes, CUTS * LANES + at) + splat(1.0))
        store(sieve.ends, at, load(lanes, LOW * LANES + at))
        store(sieve.ends, LANES + at, load(lanes, HIGH * LANES + at))
    return taken


@kernel_noalloc
def halved(
    points: FloatArray, table: SpanTable, margin: float, found: Found, taken: int, sieve: Sieve
) -> None:
    """Ask both halves of the pieces in the lanes."""
    lanes, full = sieve.lanes, whole_eights(taken)
    for half in range(2):
        for k in range(full):
            low, high = sieve.ends[0, k], sieve.ends[1, k]
            middle = 0.5 * (low + high)
            low, high = (low, middle) if half == 0 else (middle, high)
            lanes[LOW * LANES + k], lanes[HIGH * LANES + k] = low, high
            lanes[X * LANES + k] = 0.5 * (low + high)
        cells_of(lanes, full, table.cells)
        look_up(lanes, taken, table)
        rule_out(lanes, full, found.record[0] * (1.0 + margin))
        let_wait(points, table, margin, found, taken, sieve)


@kernel_noalloc
def cut_where_bounds_meet(
    points: FloatArray, table: SpanTable, margin: float, found: Found, taken: int, sieve: Sieve
) -> None:
    """Ask the pieces in the lanes up to a cut and from there, with the vertices farthest at either end."""
    lanes, full = sieve.lanes, whole_eights(taken)
    for k in range(full):
        lanes[X * LANES + k] = lanes[LOW * LANES + k]
    look_along(lanes, taken, points)
    set_aside(lanes, full)
    for k in range(full):
        lanes[X * LANES + k] = lanes[HIGH * LANES + k]
    look_along(lanes, taken, points)
    where_bounds_meet(lanes, full)
    for k in range(full):
        lanes[LOW * LANES + k] = lanes[CUT * LANES + k]
    rule_out(lanes, full, found.record[0] * (1.0 + margin))
    let_wait(points, table, margin, found, taken, sieve)
    take_back(lanes, full)
    for k in range(full):
        lanes[LOW * LANES + k], lanes[HIGH * LANES + k] = sieve.ends[0, k], lanes[CUT * LANES + k]
        lanes[X * LANES + k] = sieve.ends[0, k]
    rule_out(lanes, full, found.record[0] * (1.0 + margin))
    let_wait(points, table, margin, found, taken, sieve)


@kernel_noalloc
def let_wait(
    points: FloatArray, table: SpanTable, margin: float, found: Found, taken: int, sieve: Sieve
) -> None:
    """Put the pieces that are not ruled out on the stacks; those cut too often are searched at once."""
    lanes = sieve.lanes
    for at in range(0, taken, WIDTH):
        bits, cuts = not_ruled_out(lanes, at, taken), load(lanes, CUTS * LANES + at)
        few, many = positive(splat(HALVINGS - 0.5) - cuts), positive(cuts - splat(DEEPEST - 0.5))
        push(0, at, bits & few, sieve)
        push(1, at, bits & ~few & ~many, sieve)
        bits &= many
        while bits > 0:
            k = at + first_bit(bits)
            bits &= bits - 1
            curve = curve_in(lanes, k)
            one, two = int(lanes[FEET * LANES + k]), int(lanes[(FEET + 1) * LANES + k])
            least_on_curve(points, table, curve, one, two, margin, found)
