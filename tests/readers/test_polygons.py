"""Polygons cut into triangles: their areas add up, none is turned round, and convex ones are fans."""

import numpy as np
import pytest

from regolith_studio.readers.polygons import triangulated


def star(n, seed):
    """A polygon about the origin with corners at any radius, and its area by the shoelace formula."""
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * (np.arange(n) + 0.4 * rng.random(n)) / n
    x, y = rng.uniform(0.2, 1.0, n) * (np.cos(angle), np.sin(angle))
    return np.column_stack([x, y, 0 * x]), 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def tilted(points, seed):
    """The points in some plane of space, and the plane's normal."""
    axes = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    axes *= np.sign(np.linalg.det(axes))
    return points @ axes.T + (3, -2, 7), axes[:, 2]


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("n", [4, 5, 9, 30])
def test_that_the_triangles_of_a_concave_polygon_add_up_to_its_area(n, seed):
    flat, area = star(n, seed)
    points, normal = tilted(flat, seed)
    triangles = points[triangulated(points, np.arange(n), np.array([n]))]
    signed = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) @ normal / 2
    assert len(triangles) == n - 2
    assert signed.sum() == pytest.approx(area)
    assert np.abs(signed).sum() == pytest.approx(area)


def test_that_polygons_of_several_sizes_are_cut_each_by_itself():
    points = np.column_stack([np.cos(np.arange(6)), np.sin(np.arange(6)), np.zeros(6)])
    corners = np.array([0, 1, 2, 0, 1, 2, 3, 4, 5, 0, 1, 0, 1, 2, 3])
    triangles = triangulated(points, corners, np.array([3, 6, 2, 4]))
    assert len(triangles) == 1 + 4 + 0 + 2
    assert triangles[0].tolist() == [0, 1, 2]


def test_that_a_convex_polygon_becomes_a_fan():
    angle = 2 * np.pi * np.arange(7) / 7
    points = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    triangles = triangulated(points, np.arange(7), np.array([7]))
    assert (triangles[:, 0] == 0).all()


@pytest.mark.parametrize("points", [np.zeros((5, 3)), np.arange(15.0).reshape(5, 3), np.full((5, 3), 1e300)])
def test_that_polygons_without_area_are_cut_all_the_same(points):
    assert triangulated(points, np.arange(5), np.array([5])).shape == (3, 3)


def test_that_no_polygons_give_no_triangles():
    assert triangulated(np.zeros((0, 3)), np.zeros(0, dtype=int), np.zeros(0, dtype=int)).shape == (0, 3)
