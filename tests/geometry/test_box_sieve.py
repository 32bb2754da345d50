"""Many curves of boxes side by side, against one at a time and against plain arithmetic."""

from itertools import pairwise

import numpy as np
import pytest

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.box_curve import frame_on
from regolith_studio.geometry.box_facets import Facets, arcs_of, facets_of, nothing_on_facet
from regolith_studio.geometry.box_lanes import (
    AREA,
    BROKEN,
    CELLS,
    CUT,
    CUTS,
    FEET,
    HIGH,
    LANES,
    LEVER,
    LOW,
    NUMBER,
    OF_A_PIECE,
    OF_AN_EDGE,
    ONE_EDGE,
    OTHER,
    OTHER_EDGE,
    ROWS,
    RULED_OUT,
    SIDES,
    SPANS,
    X,
    bounds_on_facet,
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
from regolith_studio.geometry.box_record import nothing_below
from regolith_studio.geometry.box_search import minimum_box
from regolith_studio.geometry.box_sieve import (
    HALVINGS,
    PAIRS,
    Sieve,
    add_pair,
    add_pairs,
    empty_sieve,
    let_wait,
    orthogonal,
    records_of,
    take_top,
    whole_curves,
    work_off,
)
from regolith_studio.geometry.box_widths import span_near, span_table
from regolith_studio.geometry.eights import WIDTH
from regolith_studio.geometry.hull_graph import hull_graph
from regolith_studio.geometry.kernels import kernel
from tests.geometry.solids import random_polyhedron


@kernel
def asked(records: FloatArray, i: int, k: int) -> int:
    """What is copied into kernels, compiled by itself."""
    return orthogonal(records, i, k)


@kernel
def put_down(records: FloatArray, i: int, k: int, bits: int, sieve: Sieve) -> None:
    """What is copied into kernels, compiled by itself."""
    add_pairs(records, i, k, bits, sieve)


def facets(seed: int) -> Facets:
    hull = random_polyhedron(seed, 20).hull
    return facets_of(hull_graph(np.array(hull.vertices), hull.faces))


def orthogonal_pairs(solid: Facets) -> list[tuple[int, int]]:
    """Pairs of edges of whose facets some normals are at less and some at more than a right angle."""
    found = []
    for i in range(len(solid.edges)):
        for k in range(i, len(solid.edges)):
            products = solid.normals[solid.edges[i, 2:]] @ solid.normals[solid.edges[k, 2:]].T >= 0.0
            if products.any() and not products.all():
                found.append((i, k))
    return found


def full_lanes(solid: Facets, seed: int = 0) -> tuple[Sieve, FloatArray]:
    """Curves of pairs of edges with orthogonal normals in all lanes, also second ones; and the rows."""
    sieve, arcs = empty_sieve(), arcs_of(solid)
    rng = np.random.default_rng(seed)
    records = records_of(solid, arcs)
    while sieve.filled[PAIRS] < LANES:
        i, k = rng.integers(len(arcs), size=2)
        products = solid.normals[solid.edges[i, 2:]] @ solid.normals[solid.edges[k, 2:]].T >= 0.0
        if i != k and products.any() and not products.all() and (products[0] != products[1]).any():
            broken = products[0, 0] == products[1, 1] and products[0, 1] == products[1, 0]
            add_pair(records, i, k, bool(broken and rng.random() < 0.5), sieve)
    curves_between(sieve.lanes, LANES)
    return sieve, sieve.lanes.reshape(-1, LANES)


def volumes_along(solid: Facets, sieve: Sieve, k: int, low: float, high: float) -> FloatArray:
    """Volumes of boxes on a grid along the curve of lane k."""
    curve = curve_in.py_func(sieve.lanes, k)  # type: ignore[attr-defined]
    frames = np.array([frame_on(curve, x) for x in np.linspace(low, high, 101)])
    return np.asarray(np.prod(np.ptp(frames @ solid.points, axis=2), axis=1))


@pytest.mark.parametrize("seed", range(3))
def test_that_curves_in_lanes_run_between_facets_and_are_flush_with_their_edges(seed: int) -> None:
    solid = facets(seed)
    sieve, rows = full_lanes(solid, seed)
    for k in range(LANES):
        curve = curve_in.py_func(sieve.lanes, k)  # type: ignore[attr-defined]
        feet = rows[FEET : FEET + 2, k].astype(int)
        assert curve.low < curve.high
        for x in np.linspace(curve.low, curve.high, 5):
            frame = np.array(frame_on(curve, x))
            assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-11)
            reach = frame[:2] @ solid.points
            assert reach[[0, 1], feet] == pytest.approx(reach.max(axis=1), abs=1e-11)
        for x in (curve.low, curve.high):
            a, b, _ = frame_on(curve, x)
            edges = rows[[*range(ONE_EDGE, ONE_EDGE + 6), *range(OTHER_EDGE, OTHER_EDGE + 6)], k]
            on_facets = edges.reshape(4, 3) @ np.array([a, b]).T
            assert np.sort(on_facets.ravel())[-1] == pytest.approx(1.0, abs=1e-12)


def test_that_a_hyperbola_with_two_branches_in_the_square_is_called_broken() -> None:
    rng = np.random.default_rng(2)
    sieve = empty_sieve()
    normals = rng.normal(size=(4, 3, LANES))
    rows = sieve.lanes.reshape(-1, LANES)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    rows[ONE_EDGE : ONE_EDGE + 6] = normals[:2].reshape(6, -1)
    rows[OTHER_EDGE : OTHER_EDGE + 6] = normals[2:].reshape(6, -1)
    curves_between(sieve.lanes, LANES)
    signs = np.einsum("ick,jck->kij", normals[:2], normals[2:]) >= 0.0
    diagonal = (signs[:, 0, 0] == signs[:, 1, 1]) & (signs[:, 0, 1] == signs[:, 1, 0])
    broken = diagonal & (signs[:, 0, 0] != signs[:, 0, 1])
    assert 0 < broken.sum() < LANES
    assert (rows[BROKEN] == broken).all()


@pytest.mark.parametrize("seed", range(3))
def test_that_spans_in_lanes_are_those_of_the_table_and_of_the_farthest_vertices(seed: int) -> None:
    solid = facets(seed)
    table, (sieve, rows) = span_table(solid.points), full_lanes(solid, seed)
    rows[X] = np.random.default_rng(seed).uniform(rows[LOW], rows[HIGH])
    cells_of(sieve.lanes, LANES, table.cells)
    look_up(sieve.lanes, LANES, table)
    looked_up = rows[SPANS : SPANS + 9].copy()
    look_along(sieve.lanes, LANES, solid.points)
    for k in range(LANES):
        axes = frame_on(curve_in.py_func(sieve.lanes, k), rows[X, k])  # type: ignore[attr-defined]
        for axis, near, far in zip(
            axes, looked_up[:, k].reshape(3, 3), rows[SPANS : SPANS + 9, k].reshape(3, 3), strict=True
        ):
            reach = np.array(axis) @ solid.points
            assert np.array(axis) @ far == pytest.approx(np.ptp(reach), rel=1e-12)
            assert near.tolist() == list(span_near(table, axis))


@pytest.mark.parametrize("seed", range(3))
def test_that_no_box_on_a_piece_that_is_ruled_out_is_below_the_limit(seed: int) -> None:
    solid = facets(seed)
    sieve, rows = full_lanes(solid, seed)
    least = [volumes_along(solid, sieve, k, rows[LOW, k], rows[HIGH, k]).min() for k in range(LANES)]
    limit = float(np.median(least)) * 0.97
    rows[X] = rows[LOW]
    look_along(sieve.lanes, LANES, solid.points)
    set_aside(sieve.lanes, LANES)
    begin, begins = rows[SPANS : SPANS + 9].copy(), rows[LOW].copy()
    rows[X] = rows[HIGH]
    look_along(sieve.lanes, LANES, solid.points)
    where_bounds_meet(sieve.lanes, LANES)
    assert ((rows[CUT] > rows[LOW]) & (rows[CUT] < rows[HIGH])).all()
    rows[LOW] = rows[CUT]
    rule_out(sieve.lanes, LANES, limit)
    after = rows[RULED_OUT].copy() == 1.0
    take_back(sieve.lanes, LANES)
    assert (rows[SPANS : SPANS + 9] == begin).all()
    assert (rows[OTHER : OTHER + 9] == begin).all()
    ends = rows[HIGH].copy()
    rows[LOW], rows[HIGH], rows[X] = begins, rows[CUT], begins
    rule_out(sieve.lanes, LANES, limit)
    before = rows[RULED_OUT] == 1.0
    cuts = rows[CUT].copy()
    assert 0 < (before & after).sum() < LANES
    for k in range(LANES):
        for ruled_out, (low, high) in zip(
            (before[k], after[k]), pairwise((begins[k], cuts[k], ends[k])), strict=True
        ):
            rows[LOW, k], rows[HIGH, k] = begins[k], ends[k]
            volumes = volumes_along(solid, sieve, k, low, high)
            assert not ruled_out or volumes.min() >= limit * (1.0 - 1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_that_what_waits_holds_the_least_box_and_working_it_off_finds_it(seed: int) -> None:
    """First curves only; the least box of the solids here is on none of the second ones."""
    solid = facets(seed)
    hull = random_polyhedron(seed, 20).hull
    axes = minimum_box(np.array(hull.vertices), hull.faces)
    least = float(np.prod(np.ptp(axes @ hull.vertices.T, axis=1)))
    arcs, table, sieve = arcs_of(solid), span_table(solid.points), empty_sieve()
    found, records = nothing_below(1.02 * least), records_of(solid, arcs)
    for i, k in orthogonal_pairs(solid):
        add_pair(records, i, k, False, sieve)
        if sieve.filled[PAIRS] == LANES:
            whole_curves(table, float(found.record[0]), sieve)
            work_off(solid.points, table, 0.0, found, sieve)
    whole_curves(table, float(found.record[0]), sieve)
    work_off(solid.points, table, 0.0, found, sieve)
    assert sieve.filled[:2].tolist() == [0, 0]
    assert found.record[0] == pytest.approx(least, rel=1e-8)
    assert np.prod(np.ptp(found.axes @ solid.points, axis=1)) == pytest.approx(least, rel=1e-8)


@pytest.mark.parametrize("seed", range(3))
def test_that_the_pairs_put_into_lanes_are_those_with_orthogonal_normals(seed: int) -> None:
    solid = facets(seed)
    records, sieve = records_of(solid, arcs_of(solid)), empty_sieve()
    rows, n, found = sieve.lanes.reshape(-1, LANES), len(solid.edges), []
    for i in range(n):
        for k in range(i, n, WIDTH):
            bits = asked(records, i, k) & ((1 << min(WIDTH, n - k)) - 1)
            put_down(records, i, k, bits, sieve)
            count = int(sieve.filled[PAIRS])
            numbers = rows[[ONE_EDGE + NUMBER, OTHER_EDGE + NUMBER], :count]
            found += [(int(one), int(other)) for one, other in numbers.T]
            assert (rows[ONE_EDGE : ONE_EDGE + OF_AN_EDGE, :count] == records[:, [i] * count]).all()
            others = numbers[1].astype(int)
            assert (rows[OTHER_EDGE : OTHER_EDGE + OF_AN_EDGE, :count] == records[:, others]).all()
            sieve.filled[PAIRS] = 0
    assert found == orthogonal_pairs(solid)


def test_that_pieces_wait_in_their_order_and_come_back_as_they_were() -> None:
    sieve, rng = empty_sieve(), np.random.default_rng(5)
    rows = sieve.lanes.reshape(-1, LANES)
    rows[:OF_A_PIECE] = given = rng.normal(size=(OF_A_PIECE, LANES))
    rows[RULED_OUT] = ruled_out = rng.random(LANES) < 0.7
    rows[CUTS] = given[CUTS] = rng.integers(0, 4, LANES)
    solid = facets(0)
    let_wait(solid.points, span_table(solid.points), 0.0, nothing_below(np.inf), LANES - 3, sieve)
    ruled_out[-3:] = True
    for stack in (1, 0):
        wanted = given[:, ~ruled_out & ((given[CUTS] >= HALVINGS) == (stack == 1))]
        assert sieve.filled[stack] == wanted.shape[1] > 0
        assert take_top(stack, sieve) == wanted.shape[1]
        wanted[CUTS] += 1
        assert (rows[:OF_A_PIECE, : wanted.shape[1]] == wanted).all()
        assert (sieve.ends[:, : wanted.shape[1]] == wanted[[LOW, HIGH]]).all()


def test_that_lanes_with_nothing_in_them_read_no_cell_beyond_the_table() -> None:
    lanes = np.full(ROWS * LANES, np.nan)
    cells_of(lanes, LANES, 20)
    cells = lanes.reshape(-1, LANES)[CELLS : CELLS + 3]
    assert (cells >= 0.0).all()
    assert (cells < 1200.0).all()


@pytest.mark.parametrize("seed", range(3))
def test_that_no_rectangle_on_a_facet_is_smaller_than_its_bound(seed: int) -> None:
    solid = facets(seed)
    table, lanes, axis = span_table(solid.points), np.zeros(ROWS * LANES), solid.normals[seed]
    rows, directions = lanes.reshape(-1, LANES), arcs_of(solid)[:, :3]
    count = len(directions)
    rows[SIDES : SIDES + 3, :count] = directions.T
    rows[SIDES : SIDES + 3, 7] = axis
    bounds_on_facet(lanes, count, tuple(axis), table)
    assert rows[AREA, 7] == np.inf
    for k in set(range(count)) - {7}:
        b = np.cross(directions[k], axis)
        lever = float(np.linalg.norm(b))
        b = b / lever
        area = np.prod(np.ptp(np.array([b, np.cross(axis, b)]) @ solid.points, axis=1))
        assert rows[LEVER, k] == pytest.approx(lever**2, rel=1e-12)
        assert 0.8 * area < rows[AREA, k] / rows[LEVER, k] <= area * (1.0 + 1e-12)


def test_that_a_facet_on_which_nothing_is_said_to_stand_bears_no_smaller_box() -> None:
    solid = facets(1)
    table, turns = span_table(solid.points), np.linspace(0.0, np.pi / 2, 401)
    said = 0
    for axis in solid.normals:
        first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        first /= np.linalg.norm(first)
        second, height = np.cross(axis, first), float(np.ptp(axis @ solid.points))
        b = np.outer(np.cos(turns), first) + np.outer(np.sin(turns), second)
        c = np.cross(axis, b)
        least = height * (np.ptp(b @ solid.points, axis=1) * np.ptp(c @ solid.points, axis=1)).min()
        for share in (0.8, 0.9, 0.95):
            said += nothing_on_facet(table, tuple(axis), height, share * least)
        assert not nothing_on_facet(table, tuple(axis), height, 1.0001 * least)
    assert said > 10
