"""Feret diameters against closed forms and many directions."""

import numpy as np
import pytest
from scipy.optimize import minimize

from regolith_studio.geometry.feret import feret_max, feret_min
from regolith_studio.geometry.sphere_points import fibonacci_directions
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
