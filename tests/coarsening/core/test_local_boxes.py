"""Locally minimal boxes and how they follow the planes."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.core.box import Solid, box_at, empty_touch, scratch_for
from regolith_studio.coarsening.core.box_contacts import (
    NONE,
    fill_points,
    pose_of,
    rotate,
    tie_to_release,
    touched,
    walk_to_minimum,
)
from regolith_studio.coarsening.core.box_gradient import fill_extent_gradients, gradient_workspace
from regolith_studio.coarsening.core.box_search import (
    DENSE_ANGLE,
    FINE_ANGLE,
    LocalBoxes,
    local_boxes,
)
from regolith_studio.coarsening.core.plane_coordinates import moved_planes, tangents_of
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron
from regolith_studio.coarsening.core.tracked_boxes import select_boxes, track_boxes
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.oriented_box import minimum_volume_box


def random_planes(n: int, seed: int) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(n, 3)) * (1.0, 1.4, 0.8)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True), rng.uniform(0.8, 1.2, n)


def solid_of(normals: FloatArray, offsets: FloatArray) -> tuple[Solid, FloatArray]:
    shape = measure_polyhedron(normals, offsets)
    return Solid(shape.vertices, normals, shape.areas, shape.edges), shape.triples


def found_on(solid: Solid, margin: float, angle: float = FINE_ANGLE) -> LocalBoxes:
    return local_boxes(solid, margin, angle)


def likeness(some: FloatArray, others: FloatArray) -> FloatArray:
    """Cosines of the largest angles between the axes of two lists of boxes, in any order and direction."""
    cosines = np.abs(some[:, None] @ others.transpose(0, 2, 1))
    return np.asarray(cosines.max(axis=3).min(axis=2))


@pytest.mark.parametrize("n", [10, 20, 50])
def test_that_the_least_box_is_the_exact_one(n: int) -> None:
    for seed in range(3):
        normals, offsets = random_planes(n, seed)
        boxes = found_on(solid_of(normals, offsets)[0], 0.02, DENSE_ANGLE)
        exact = minimum_volume_box(ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, offsets)))
        assert boxes.volumes[0] == pytest.approx(exact.volume, rel=1e-6)
        assert np.sort(boxes.extents[0])[::-1] == pytest.approx(exact.extents, rel=1e-6)


def test_that_every_box_holds_all_vertices() -> None:
    normals, offsets = random_planes(20, 7)
    solid, _ = solid_of(normals, offsets)
    boxes = found_on(solid, 0.05)
    for frame, extents in zip(boxes.frames, boxes.extents, strict=True):
        along = solid.vertices @ frame.T
        assert np.ptp(along, axis=0) == pytest.approx(extents, rel=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_that_no_small_turn_makes_a_reported_box_smaller(seed: int) -> None:
    solid, _ = solid_of(*random_planes((12, 20)[seed % 2], seed))
    rng = np.random.default_rng(seed)
    for frame, volume in zip(*found_on(solid, 0.05)[1::-1], strict=True):
        for turn in rng.normal(size=(200, 3)):
            other = frame.copy()
            rotate(other, tuple((1e-5 * turn / np.linalg.norm(turn)).tolist()))
            assert np.prod(np.ptp(solid.vertices @ other.T, axis=0)) > volume * (1.0 - 1e-11)


def test_that_a_brick_has_one_least_box() -> None:
    # Any other box is flush with two of the brick's edges at most, and falls to either side.
    normals = np.vstack([np.eye(3), -np.eye(3)])
    solid, _ = solid_of(normals, np.array([1.0, 0.9, 0.7, 1.1, 0.8, 0.6]))
    boxes = found_on(solid, 0.5)
    assert boxes.volumes == pytest.approx([2.1 * 1.7 * 1.3], rel=1e-12)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.slow
def test_that_tracked_boxes_are_those_that_a_search_finds(seed: int) -> None:
    normals, offsets = random_planes((12, 20, 50)[seed % 3], seed)
    solid, triples = solid_of(normals, offsets)
    boxes = found_on(solid, 0.02, DENSE_ANGLE)
    rng = np.random.default_rng(seed)
    turns = normals + 1e-3 * rng.normal(size=normals.shape)
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    then, corners = solid_of(turns, offsets * (1.0 + 1e-3 * rng.normal(size=len(offsets))))
    tracked = select_boxes(boxes, np.arange(len(boxes.volumes)), triples)
    kept, lost = track_boxes(then.vertices, corners, len(offsets), tracked)
    assert (0 if lost is None else lost.sum()) + len(kept.volumes) == len(boxes.volumes)
    assert len(kept.volumes) > 0
    found = found_on(then, 0.05, DENSE_ANGLE)
    for frame, volume in zip(kept.frames, kept.volumes, strict=True):
        alike = likeness(frame[None], found.frames)[0] > 1.0 - 1e-9
        assert found.volumes[np.argmax(alike)] == pytest.approx(volume, rel=1e-9)
        assert np.prod(np.ptp(then.vertices @ frame.T, axis=0)) == pytest.approx(volume, rel=1e-9)


@pytest.mark.parametrize("seed", [2, 11, 33])
def test_that_tracked_boxes_that_end_at_one_minimum_become_one(seed: int) -> None:
    normals, offsets = random_planes(20, seed)
    solid, triples = solid_of(normals, offsets)
    boxes = found_on(solid, 0.05)
    rng = np.random.default_rng(seed)
    turns = normals + 2e-2 * rng.normal(size=normals.shape)
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    then, corners = solid_of(turns, offsets * (1.0 + 2e-2 * rng.normal(size=len(offsets))))
    tracked = select_boxes(boxes, np.arange(len(boxes.volumes)), triples)
    kept, _ = track_boxes(then.vertices, corners, len(offsets), tracked)
    alike = likeness(kept.frames, kept.frames) > 1.0 - 1e-9
    assert 0 < len(kept.volumes) < len(boxes.volumes)
    assert alike.sum() == len(kept.volumes)


def test_that_compiled_contacts_are_their_python_reference() -> None:
    solid, _ = solid_of(*random_planes(20, 2))
    boxes = found_on(solid, 0.02)
    points = np.empty((9, 3))
    fill_points.py_func(solid.vertices, boxes.contacts[0], points)
    one = pose_of(points, boxes.contacts[0], boxes.frames[0])
    two = pose_of.py_func(points, boxes.contacts[0], boxes.frames[0])
    for ours, reference in zip(one, two, strict=True):
        assert np.asarray(ours) == pytest.approx(np.asarray(reference), rel=1e-12, abs=1e-12)
    assert tie_to_release(one, boxes.contacts[0])[0] == NONE
    assert tie_to_release.py_func(two, boxes.contacts[0])[0] == NONE


@pytest.mark.parametrize("seed", range(10))
def test_that_the_box_on_an_axis_stands_on_the_least_rectangle_of_the_shadow(seed: int) -> None:
    solid, _ = solid_of(*random_planes(30, seed))
    axis = np.random.default_rng(seed).normal(size=3)
    axis /= np.linalg.norm(axis)
    frame = np.linalg.qr(np.column_stack([axis, np.eye(3)]))[0][:, 1:3]
    shadow = solid.vertices @ frame
    corners = shadow[ConvexHull(shadow).vertices]
    areas = []
    for side in np.roll(corners, -1, axis=0) - corners:
        way = side / np.linalg.norm(side)
        areas.append(np.ptp(corners @ way) * np.ptp(corners @ [-way[1], way[0]]))
    touch = empty_touch()
    volume = box_at(tuple(axis.tolist()), solid, np.inf, scratch_for(solid), touch)
    assert volume == pytest.approx(min(areas) * np.ptp(solid.vertices @ axis), rel=1e-12)
    assert np.ptp(solid.vertices @ touch.frame.T, axis=0) == pytest.approx(touch.extents, rel=1e-12)


def test_that_the_compiled_box_is_its_python_reference() -> None:
    solid, _ = solid_of(*random_planes(12, 3))
    axis = (0.36, 0.48, 0.8)
    one, two = empty_touch(), empty_touch()
    volume = box_at(axis, solid, np.inf, scratch_for(solid), one)
    assert box_at.py_func(axis, solid, np.inf, scratch_for(solid), two) == pytest.approx(volume, rel=1e-14)
    assert np.allclose(one.frame, two.frame)


@pytest.mark.parametrize("seed", range(8))
def test_that_the_edges_follow_the_planes_as_finite_differences_say(seed: int) -> None:
    normals, offsets = random_planes((12, 20)[seed % 2], seed)
    n = len(offsets)
    solid, _ = solid_of(normals, offsets)
    boxes = found_on(solid, 0.02)
    shape = measure_polyhedron(normals, offsets)
    tangents, scales, pivots = tangents_of(normals), np.full(n, 0.3), shape.centroids
    work = gradient_workspace(n)
    logs, gradients = work.logs, work.gradients
    fill_extent_gradients(shape, boxes.frames[0], boxes.contacts[0], tangents, scales, work)
    assert np.exp(logs) == pytest.approx(boxes.extents[0], rel=1e-12)
    step = 1e-6 * np.random.default_rng(seed).normal(size=3 * n)

    def edges_after(change: FloatArray) -> FloatArray:
        then, _ = solid_of(*moved_planes(normals, pivots, offsets, tangents, scales, change)[:2])
        found = found_on(then, 0.02)
        alike = int(likeness(boxes.frames[:1], found.frames).argmax())
        return np.log(np.sort(found.extents[alike]))

    change = (edges_after(step) - edges_after(-step)) / 2
    assert gradients[np.argsort(logs)] @ step == pytest.approx(change, rel=1e-4, abs=1e-10)


@pytest.mark.parametrize("seed", range(6))
def test_that_a_box_that_was_turned_away_walks_back_to_a_minimum(seed: int) -> None:
    solid, _ = solid_of(*random_planes((12, 20, 50)[seed % 3], seed))
    vertices, known = solid.vertices, found_on(solid, 0.2, DENSE_ANGLE)
    rng, arrived = np.random.default_rng(seed), 0
    for turn in 0.02 * rng.normal(size=(30, 3)):
        frame, contact, points = known.frames[0].copy(), np.zeros(13, dtype=np.int64), np.empty((9, 3))
        rotate(frame, tuple(turn.tolist()))
        if walk_to_minimum(vertices, contact, frame, points, np.empty((3, 3)), 0.3):
            volume = np.prod(np.ptp(vertices @ frame.T, axis=0))
            arrived += np.abs(known.volumes / volume - 1.0).min() < 1e-9
    assert arrived >= 20


@pytest.mark.parametrize("seed", range(6))
def test_that_a_box_on_a_facet_tips_over_an_edge_where_that_makes_it_smaller(seed: int) -> None:
    solid, _ = solid_of(*random_planes((12, 20)[seed % 2], seed))
    rng, tipped = np.random.default_rng(seed), 0
    for facet in np.flatnonzero(solid.areas > 1e-3):
        touch, axis = empty_touch(), tuple(solid.normals[facet].tolist())
        on_facet = box_at(axis, solid, np.inf, scratch_for(solid), touch)
        frame, contact = touch.frame.copy(), np.zeros(13, dtype=np.int64)
        touched(solid.vertices, frame, contact, np.empty((3, 3)))
        if not walk_to_minimum(solid.vertices, contact, frame, np.empty((9, 3)), np.empty((3, 3)), 0.3):
            continue
        volume = np.prod(np.ptp(solid.vertices @ frame.T, axis=0))
        assert volume < on_facet * (1.0 + 1e-12)
        tipped += volume < on_facet * (1.0 - 1e-6)
        for turn in rng.normal(size=(200, 3)):
            other = frame.copy()
            rotate(other, tuple((1e-5 * turn / np.linalg.norm(turn)).tolist()))
            assert np.prod(np.ptp(solid.vertices @ other.T, axis=0)) > volume * (1.0 - 1e-11)
    assert tipped > 0
