"""Poses are values: what is copied shows the same."""

import numpy as np
import pytest
import pyvista as pv

from regolith_studio.scene.cameras import (
    DIRECTIONS,
    CameraPose,
    apply_pose,
    framing_pose,
    orbited,
    panned,
    pose_of,
    refitted,
    rolled,
    turned,
    zoomed,
)

POSE = CameraPose((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 2.0)


@pytest.fixture
def plotter():
    made = pv.Plotter(off_screen=True)
    yield made
    made.close()


def eye_distance(pose):
    return np.linalg.norm(np.subtract(pose.position, pose.focal_point))


def test_that_a_pose_is_read_back_as_it_was_applied(plotter):
    plotter.add_mesh(pv.Sphere())
    apply_pose(plotter, POSE)
    assert pose_of(plotter) == POSE


def test_that_the_clipping_range_holds_what_is_shown_after_a_pose(plotter):
    plotter.add_mesh(pv.Sphere(radius=0.5))
    apply_pose(plotter, POSE)
    near, far = plotter.camera.clipping_range
    assert near < 3.5
    assert far > 4.5


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("aspect", [0.4, 1.0, 2.5])
def test_that_every_point_is_in_the_picture_from_every_direction(direction, aspect):
    points = np.random.default_rng(1).normal(size=(200, 3)) * [1.0, 5.0, 0.2] + [10.0, 20.0, 30.0]
    pose = framing_pose(points, direction, aspect)
    forward = np.subtract(pose.focal_point, pose.position) / eye_distance(pose)
    side = np.cross(forward, pose.view_up)
    side /= np.linalg.norm(side)
    up = np.cross(side, forward)
    seen = points - pose.focal_point
    assert np.abs(seen @ up).max() <= pose.parallel_scale
    assert np.abs(seen @ side).max() <= pose.parallel_scale * aspect
    shorter = pose.parallel_scale * min(1.0, aspect)
    assert max(np.abs(seen @ up).max(), np.abs(seen @ side).max()) == pytest.approx(0.85 * shorter)
    free = framing_pose(points, direction, aspect, turning=True)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    assert np.linalg.norm(points - middle, axis=1).max() <= free.parallel_scale * min(1.0, aspect)


def test_that_a_standard_direction_keeps_point_and_scale():
    pose = turned(POSE, "top")
    assert pose.position == pytest.approx((0.0, 0.0, 4.0))
    assert (pose.focal_point, pose.parallel_scale) == (POSE.focal_point, POSE.parallel_scale)


def test_that_orbiting_keeps_the_distance_and_back_again_is_where_it_was():
    there = orbited(POSE, 0.3, 0.0)
    assert eye_distance(there) == pytest.approx(4.0)
    assert orbited(there, -0.3, 0.0).position == pytest.approx(POSE.position)


def test_that_dragging_to_the_right_brings_the_left_side_forward():
    assert orbited(POSE, 0.1, 0.0).position[0] < 0.0


def test_that_dragging_up_shows_more_of_the_underside():
    assert orbited(POSE, 0.0, 0.1).position[2] < 0.0


def test_that_panning_by_the_whole_height_moves_by_twice_the_scale():
    assert panned(POSE, 0.0, 1.0).focal_point == pytest.approx((0.0, 0.0, -4.0))
    assert panned(POSE, 1.0, 0.0).focal_point == pytest.approx((-4.0, 0.0, 0.0))


def test_that_zooming_by_two_halves_the_scale():
    assert zoomed(POSE, 2.0).parallel_scale == 1.0


def test_that_rolling_by_a_right_angle_lays_up_on_its_side():
    assert np.abs(rolled(POSE, np.pi / 2).view_up) == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("before", [0.3, 1.0, 2.5])
@pytest.mark.parametrize("after", [0.4, 1.0, 3.0])
def test_that_a_pose_for_another_shape_of_the_picture_frames_the_same_points(before, after):
    points = np.random.default_rng(0).normal(size=(40, 3))
    made = refitted(framing_pose(points, "left", before), before, after)
    assert made.parallel_scale == pytest.approx(framing_pose(points, "left", after).parallel_scale)
    assert made.position == framing_pose(points, "left", after).position
