"""Kernels in the plane against scipy and a search over all sides."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.box_search import minimum_box
from regolith_studio.geometry.rectangle import outline, smallest_rectangle
from tests.geometry.solids import cuboid


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


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("compiled", [True, False])
def test_that_calipers_find_the_smallest_rectangle(seed: int, compiled: bool) -> None:
    corners = polygon(seed)
    calipers = smallest_rectangle if compiled else smallest_rectangle.py_func  # type: ignore[attr-defined]
    area, cosine, sine, longer = calipers(corners[:, 0].copy(), corners[:, 1].copy(), len(corners))
    way = np.array([cosine, sine])
    assert area == pytest.approx(least_area(corners), rel=1e-9)
    assert longer == pytest.approx(max(np.ptp(corners @ way), np.ptp(corners @ [-sine, cosine])), rel=1e-9)


def test_that_a_side_too_short_to_have_a_direction_does_not_shrink_the_rectangle() -> None:
    tiny = 1e-9
    corners = np.array(
        [[0.0, 0.0], [5.0, -tiny], [5.0 + tiny, 1.0], [5.0, 1.0 + tiny], [0.0, 1.0], [-tiny, tiny]]
    )
    area = smallest_rectangle(corners[:, 0].copy(), corners[:, 1].copy(), len(corners))[0]
    assert area == pytest.approx(5.0, rel=1e-7)
    assert area >= 5.0


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("digits", [0, 1, 15])
def test_that_gift_wrapping_finds_the_hull_of_scipy(seed: int, digits: int) -> None:
    points = np.random.default_rng(seed).normal(size=(60, 2)).round(digits)
    points = np.vstack([points, points[:20] + 1e-17])
    chain = outline(points[:, 0].copy(), points[:, 1].copy())
    x, y = points[chain].T
    area = np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2
    assert area == pytest.approx(ConvexHull(points).volume, rel=1e-12)


def test_that_the_compiled_box_search_and_its_python_agree() -> None:
    hull = cuboid(0.9, 0.6, 0.3)
    python = minimum_box.py_func(hull.vertices, hull.faces)  # type: ignore[attr-defined]
    assert np.abs(minimum_box(hull.vertices, hull.faces)) == pytest.approx(np.abs(python), abs=1e-9)
