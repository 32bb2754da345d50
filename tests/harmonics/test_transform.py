"""Grids: exact for band-limited functions, and what too few rays do."""

import pickle

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.harmonics.sphere_grid import harmonics
from regolith_studio.harmonics.transform import (
    analyse,
    band_limited,
    evaluate_on_grid,
    ray_grid,
)


@pytest.mark.parametrize("l_max", [0, 1, 5, 30])
def test_that_a_band_limited_function_is_expanded_exactly(rough, l_max):
    particle, grid = rough(l_max), ray_grid(max(l_max, 1))
    samples = particle.values @ harmonics(grid.directions, l_max)
    np.testing.assert_allclose(analyse(grid, samples, l_max).values, particle.values, atol=1e-12)
    np.testing.assert_allclose(evaluate_on_grid(grid, particle), samples, atol=1e-12)
    np.testing.assert_allclose(band_limited(grid, samples, l_max), samples, atol=1e-12)


def test_that_the_solid_angles_of_a_grid_fill_the_sphere():
    grid = ray_grid(15)
    assert grid.solid_angles.sum() == pytest.approx(4 * np.pi, rel=1e-14)
    assert grid.mean(grid.directions[:, 0] ** 2) == pytest.approx(1 / 3, rel=1e-12)
    np.testing.assert_allclose(np.linalg.norm(grid.directions, axis=1), 1.0, rtol=1e-14)


def test_that_no_ray_of_a_grid_lies_in_a_coordinate_plane():
    assert np.abs(ray_grid(60).directions).min() > 1e-7


def test_that_sampling_at_the_degree_of_the_fit_folds_finer_shape_into_it(rough):
    """SHAPE: the error at l = 10 falls from percent to nothing as the grid's degree grows to the band's."""
    particle = rough(40, strength=0.4)
    errors = []
    for degree in (10, 20, 30, 40):
        grid = ray_grid(degree)
        found = analyse(grid, particle.values @ harmonics(grid.directions, 40), 10)
        shape = particle.truncated(10).values[1:]
        errors.append(np.linalg.norm(found.values[1:] - shape) / np.linalg.norm(shape))
    assert errors[0] > 0.02
    assert errors[0] > 4 * errors[1] > 4 * errors[2]
    assert errors[3] < 1e-12


def test_that_bad_degrees_are_refused():
    for call in (lambda: ray_grid(0), lambda: ray_grid(9999)):
        with pytest.raises(InputError, match=r"must be"):
            call()
    with pytest.raises(InputError, match="0 to 10, got 11"):
        analyse(ray_grid(10), np.ones(11 * 21), 11)


def test_that_a_grid_is_pickled_by_its_degree():
    assert pickle.loads(pickle.dumps(ray_grid(9))) is ray_grid(9)
