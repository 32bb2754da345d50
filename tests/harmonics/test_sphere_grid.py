"""Quadrature grids with harmonics, and how many of them stay in memory."""

import gc
import weakref

import numpy as np
import pytest

from regolith_studio.harmonics.legendre import harmonics
from regolith_studio.harmonics.sphere_grid import GRIDS_KEPT, sphere_grid
from regolith_studio.shape_models.convex_hull import hull_grid


def test_that_harmonics_are_orthonormal_under_the_quadrature() -> None:
    grid = sphere_grid(7, 7)
    assert grid.weights.sum() == pytest.approx(4 * np.pi)
    assert grid.expanded(grid.values(np.eye(64))) == pytest.approx(np.eye(64), abs=1e-12)


def test_that_values_are_sums_of_the_harmonics_at_the_nodes() -> None:
    grid = sphere_grid(9, 5)
    rows = np.random.default_rng(0).standard_normal((4, 36))
    assert grid.values(rows) == pytest.approx(rows @ harmonics(grid.directions, 5), abs=1e-12)


def test_that_going_through_all_degrees_leaves_few_grids_in_memory() -> None:
    made = [weakref.ref(sphere_grid(2 * l_max, l_max)) for l_max in range(2, 18)]
    made += [weakref.ref(hull_grid(l_max, l_max)) for l_max in range(2, 10)]
    gc.collect()
    assert sum(each() is not None for each in made) <= GRIDS_KEPT + 2
    assert made[-1]() is hull_grid(9, 9)
