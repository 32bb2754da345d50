"""Feret diameters against closed forms and many directions."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.distance import pdist

from regolith_studio.geometry.feret import feret_max, feret_min, longest_chord
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere
from tests.geometry.solids import cuboid, random_polyhedron, rotation, rough_stone, tetrahedron


def test_that_a_cuboid_is_as_thick_as_its_shortest_edge_and_as_long_as_its_diagonal() -> None:
    solid = cuboid(3.0, 2.0, 1.0).moved(rotation=rotation(0))
    assert feret_min(solid) == pytest.approx(1.0)
    assert feret_max(solid) == pytest.approx(np.sqrt(14.0))


def test_that_the_least_width_of_a_tetrahedron_is_between_two_edges() -> None:
    assert feret_min(tetrahedron(1.0)) == pytest.approx(1.0 / np.sqrt(2.0))
    assert feret_max(tetrahedron(1.0)) == pytest.approx(1.0)


@pytest.mark.parametrize("seed", range(8))
def test_that_no_direction_is_narrower_and_some_is_as_narrow(seed: int) -> None:
    solid = random_polyhedron(seed, n_facets=12 + seed, stretch=0.4)

    def width(direction: np.ndarray) -> float:
        return float(np.ptp(solid.vertices @ direction) / np.linalg.norm(direction))

    directions = fibonacci_directions(2000)
    widths = np.ptp(directions @ solid.vertices.T, axis=1)
    best = [minimize(width, directions[k], method="Nelder-Mead") for k in np.argsort(widths)[:10]]
    assert feret_min(solid) <= widths.min() * (1 + 1e-12)
    assert feret_min(solid) == pytest.approx(min(result.fun for result in best), rel=1e-3)


def test_that_feret_diameters_of_a_stone_do_not_depend_on_its_unit() -> None:
    hull = rough_stone(1, level=2).hull
    tiny = hull.moved(rotation=rotation(1), scale=1e-9)
    assert feret_min(tiny) == pytest.approx(1e-9 * feret_min(hull), rel=1e-9)
    assert feret_max(tiny) == pytest.approx(1e-9 * feret_max(hull), rel=1e-9)


@pytest.mark.parametrize("semi_axes", [(1.0, 1.0, 1.0), (5.0, 1.0, 1.0), (3.0, 3.0, 0.2), (1.0, 0.9, 0.8)])
def test_that_the_longest_chord_of_an_ellipsoid_is_its_longest_axis(semi_axes):
    """All vertices are on the hull, and those of a ball have an opposite each: no pair is ruled out early."""
    sphere = icosphere(5)
    assert longest_chord(sphere.vertices * semi_axes) == pytest.approx(2.0 * max(semi_axes), rel=2e-3)
    assert longest_chord(sphere.vertices) == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize("n", [1, 2, 3, 30, 500, 3000])
@pytest.mark.parametrize("kind", ["normal", "cube", "plane", "line", "same"])
def test_that_the_longest_chord_is_that_of_all_pairs(kind, n):
    rng = np.random.default_rng(n)
    points = {
        "normal": rng.normal(size=(n, 3)),
        "cube": rng.integers(0, 4, size=(n, 3)) - 1.5,
        "plane": rng.normal(size=(n, 3)) * [1, 1, 0],
        "line": rng.normal(size=(n, 1)) * [1.0, 2.0, 3.0],
        "same": np.ones((n, 3)),
    }[kind]
    expected = pdist(points).max(initial=0.0)
    assert longest_chord(points) == pytest.approx(expected, rel=1e-14, abs=0)
