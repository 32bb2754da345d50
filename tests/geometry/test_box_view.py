"""Outlines, calipers and bounds of a view against scipy and a search over all sides."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.box_search import minimum_box
from regolith_studio.geometry.box_view import (
    View,
    bound_after_turn,
    bound_within_cap,
    empty_view,
    least_rectangle,
    look,
    turn_calipers,
)
from regolith_studio.geometry.hull_graph import hull_graph
from regolith_studio.geometry.outline import outline
from tests.geometry.solids import cuboid, random_polyhedron, rotation


def polygon(seed: int) -> FloatArray:
    """Corners of a random convex polygon, counter-clockwise, shape (n, 2)."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(30, 2)) * [1.0, rng.uniform(0.1, 1.0)]
    return points[ConvexHull(points).vertices]


def least_area(corners: FloatArray) -> float:
    """Least area of a rectangle flush with a side."""
    areas = []
    for x, y in np.roll(corners, -1, axis=0) - corners:
        way = np.array([x, y]) / np.hypot(x, y)
        areas.append(np.ptp(corners @ way) * np.ptp(corners @ [-way[1], way[0]]))
    return min(areas)


def view_of(corners: FloatArray) -> View:
    """A view whose outline has these corners."""
    view = empty_view(len(corners))
    view.x[:], view.y[:] = corners.T
    view.z[:] = 0.0
    turn_calipers(view, len(corners))
    return view


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("compiled", [True, False])
def test_that_calipers_find_the_smallest_rectangle(seed: int, compiled: bool) -> None:
    corners = polygon(seed)
    view = view_of(corners)
    find = least_rectangle if compiled else least_rectangle.py_func  # type: ignore[attr-defined]
    wide, high, side = find(view, len(corners))
    way = np.array([view.dx[side], view.dy[side]])
    assert wide * high == pytest.approx(least_area(corners), rel=1e-9)
    assert wide == pytest.approx(np.ptp(corners @ way), rel=1e-9)


def test_that_a_side_too_short_to_have_a_direction_does_not_shrink_the_rectangle() -> None:
    tiny = 1e-9
    corners = np.array(
        [[0.0, 0.0], [5.0, -tiny], [5.0 + tiny, 1.0], [5.0, 1.0 + tiny], [0.0, 1.0], [-tiny, tiny]]
    )
    wide, high, _ = least_rectangle(view_of(corners), len(corners))
    assert wide * high == pytest.approx(5.0, rel=1e-7)
    assert wide * high >= 5.0


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("digits", [0, 1, 15])
def test_that_the_outline_is_the_hull_of_scipy(seed: int, digits: int) -> None:
    points = np.random.default_rng(seed).normal(size=(60, 2)).round(digits)
    points = np.vstack([points, points[:20] + 1e-17])
    chain = outline(points[:, 0].copy(), points[:, 1].copy())
    x, y = points[chain].T
    area = np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2
    assert area == pytest.approx(ConvexHull(points).volume, rel=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_that_no_box_nearby_is_smaller_than_the_bounds_of_a_view(seed: int) -> None:
    hull = random_polyhedron(seed, n_faces=12)
    graph = hull_graph(np.array(hull.vertices), hull.faces)
    first, second, axis = rotation(seed)
    view = empty_view(len(graph.points))
    n = look(graph, tuple(axis), tuple(first), tuple(second), view)
    angle, rng = 0.2, np.random.default_rng(seed)
    bound = min(bound_after_turn(view, n, np.cos(angle), way * np.sin(angle)) for way in (-1.0, 1.0))
    for turn in np.linspace(-angle, angle, 40):
        turned = Rotation.from_rotvec(-turn * first).apply([first, second, axis])
        assert least_box_along(hull.vertices, turned) >= bound * (1 - 1e-12)
    near = []
    for _ in range(100):
        lean = np.cross(axis, rng.normal(size=3))
        lean *= rng.uniform(0.0, angle) / np.linalg.norm(lean)
        near.append(least_box_along(hull.vertices, Rotation.from_rotvec(lean).apply([first, second, axis])))
    volume = bound
    while bound_within_cap(view, n, angle, volume, 0) >= 0:
        volume *= 0.98
    assert min(near) >= volume > 0.5 * min(near)


def least_box_along(points: FloatArray, frame: FloatArray) -> float:
    """Least volume of a box with a side normal to the last row of `frame`."""
    flat = points @ frame[:2].T
    return least_area(flat[ConvexHull(flat).vertices]) * float(np.ptp(points @ frame[2]))


def test_that_the_compiled_box_search_and_its_python_agree() -> None:
    hull = cuboid(0.9, 0.6, 0.3)
    python = minimum_box.py_func(np.array(hull.vertices), hull.faces)  # type: ignore[attr-defined]
    compiled = minimum_box(np.array(hull.vertices), hull.faces)
    assert np.abs(compiled) == pytest.approx(np.abs(python), abs=1e-9)
