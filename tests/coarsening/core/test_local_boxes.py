"""Locally minimal boxes: the least one, and how it follows the planes."""

import numpy as np
import pytest

from regolith_studio.coarsening.core.box_contacts import (
    NONE,
    fill_points,
    pose_of,
    rotate,
    tie_to_release,
    walk_to_minimum,
)
from regolith_studio.coarsening.core.polyhedron_measures import tangents_of
from regolith_studio.coarsening.optimiser.body import (
    N_BOXES,
    N_VERTICES,
    Body,
    Prices,
    body_scratch,
    copy_boxes,
    empty_body,
    fill_body,
)
from regolith_studio.coarsening.optimiser.followed_boxes import box_memory, check_boxes
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.oriented_box import minimum_volume_box

WANTED = np.array([1.0, 0.9, 0.8, 1.4, 1.75, 1.0])


def random_planes(n: int, seed: int) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(n, 3)) * (1.0, 1.4, 0.8)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True), rng.uniform(0.8, 1.2, n)


def boxed(normals: FloatArray, offsets: FloatArray, before: Body | None = None) -> Body:
    """The half-spaces with their least box, or those of a body before they moved."""
    n, free = len(offsets), np.zeros(6)
    body, scratch = empty_body(n), body_scratch(n)
    body.normals[:], body.offsets[:], body.tangents[:] = normals, offsets, tangents_of(normals)
    if before is not None:
        copy_boxes(before, body)
    assert fill_body(body, WANTED, True, scratch)
    if before is None:
        assert check_boxes(body, Prices(WANTED, free, free, 1.0), np.eye(3), box_memory(n, 2 * n), scratch)
    return body


def corners_of(body: Body) -> FloatArray:
    return body.vertices[: body.counts[N_VERTICES]]


def assert_that_no_small_turn_helps(corners: FloatArray, frame: FloatArray, seed: int) -> None:
    volume = np.prod(np.ptp(corners @ frame.T, axis=0))
    for turn in np.random.default_rng(seed).normal(size=(200, 3)):
        other = frame.copy()
        rotate(other, tuple((1e-5 * turn / np.linalg.norm(turn)).tolist()))
        assert np.prod(np.ptp(corners @ other.T, axis=0)) > volume * (1.0 - 1e-11)


@pytest.mark.parametrize("n", [10, 20, 50])
@pytest.mark.parametrize("seed", range(3))
def test_that_the_least_box_is_the_exact_one(n: int, seed: int) -> None:
    planes = random_planes(n, seed)
    body = boxed(*planes)
    exact = minimum_volume_box(ConvexPolyhedron.from_half_spaces(HalfSpaces(*planes)))
    assert np.sort(body.extents[0])[::-1] == pytest.approx(exact.extents, rel=1e-6)
    assert np.ptp(corners_of(body) @ body.frames[0].T, axis=0) == pytest.approx(body.extents[0], rel=1e-9)
    assert_that_no_small_turn_helps(corners_of(body), body.frames[0], seed)


def test_that_a_brick_has_one_least_box() -> None:
    # Any other box is flush with two of the brick's edges at most, and falls to either side.
    body = boxed(np.vstack([np.eye(3), -np.eye(3)]), np.array([1.0, 0.9, 0.7, 1.1, 0.8, 0.6]))
    assert body.counts[N_BOXES] == 1
    assert body.extents[0].prod() == pytest.approx(2.1 * 1.7 * 1.3, rel=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_that_a_box_that_is_followed_a_little_is_a_local_minimum(seed: int) -> None:
    normals, offsets = random_planes((12, 20, 50)[seed % 3], seed)
    rng = np.random.default_rng(seed)
    turned = normals + 1e-3 * rng.normal(size=normals.shape)
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    shifted = offsets * (1.0 + 1e-3 * rng.normal(size=len(offsets)))
    then = boxed(turned, shifted, boxed(normals, offsets))
    assert np.ptp(corners_of(then) @ then.frames[0].T, axis=0) == pytest.approx(then.extents[0], rel=1e-9)
    assert_that_no_small_turn_helps(corners_of(then), then.frames[0], seed)


def test_that_compiled_contacts_are_their_python_reference() -> None:
    body = boxed(*random_planes(20, 2))
    contact, points = body.contacts[0], np.empty((9, 3))
    fill_points.py_func(corners_of(body), contact, points)
    one = pose_of(points, contact, body.frames[0])
    two = pose_of.py_func(points, contact, body.frames[0])
    for ours, reference in zip(one, two, strict=True):
        assert np.asarray(ours) == pytest.approx(np.asarray(reference), rel=1e-12, abs=1e-12)
    assert tie_to_release(one, contact)[0] == NONE
    assert tie_to_release.py_func(two, contact)[0] == NONE


@pytest.mark.parametrize("seed", range(6))
def test_that_a_box_that_was_turned_away_walks_back_to_a_minimum(seed: int) -> None:
    body = boxed(*random_planes((12, 20, 50)[seed % 3], seed))
    vertices, arrived = corners_of(body), 0
    for turn in 0.02 * np.random.default_rng(seed).normal(size=(30, 3)):
        frame, contact, points = body.frames[0].copy(), np.zeros(13, dtype=np.int64), np.empty((9, 3))
        rotate(frame, tuple(turn.tolist()))
        if walk_to_minimum(vertices, contact, frame, points, np.empty((3, 3)), 0.3):
            assert_that_no_small_turn_helps(vertices, frame, seed)
            arrived += 1
    assert arrived >= 20
