"""Harmonics against scipy, and against their own integrals."""

import numpy as np
import pytest
from scipy.special import sph_harm_y

from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.harmonics.legendre import fill_basis, harmonics, legendre, legendre_slopes
from regolith_studio.harmonics.transform import ray_grid


def test_that_harmonics_are_scipys_made_real_without_the_condon_shortley_phase():
    directions = fibonacci_directions(200)
    theta = np.arccos(directions[:, 2])
    phi = np.arctan2(directions[:, 1], directions[:, 0])
    basis = harmonics(directions, 30)
    for degree in (0, 1, 2, 7, 30):
        for order in range(-degree, degree + 1):
            complex_one = (-1) ** order * sph_harm_y(degree, abs(order), theta, phi)
            if order:
                complex_one = np.sqrt(2) * complex_one
            wanted = complex_one.imag * (-1) ** order if order < 0 else complex_one.real
            wanted = (-1) ** order * wanted if order < 0 else wanted
            np.testing.assert_allclose(basis[degree**2 + degree + order], wanted, atol=2e-13)


def test_that_harmonics_are_orthonormal():
    grid = ray_grid(24)
    basis = harmonics(grid.directions, 12)
    np.testing.assert_allclose(basis * grid.solid_angles @ basis.T, np.eye(169), atol=1e-13)


def test_that_harmonics_are_defined_at_the_poles():
    basis = harmonics(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]), 5)
    for degree in range(6):
        wanted = np.sqrt((2 * degree + 1) / (4 * np.pi))
        np.testing.assert_allclose(basis[degree**2 + degree], [wanted, (-1) ** degree * wanted], rtol=1e-14)


@pytest.mark.parametrize("theta", [0.1, 1.2, 2.9])
def test_that_slopes_are_derivatives_with_respect_to_the_polar_angle(theta):
    step = 1e-6
    ahead, behind = (legendre(np.cos(t), np.sin(t), 12) for t in (theta + step, theta - step))
    here = legendre(np.cos(theta), np.sin(theta), 12)
    slopes = legendre_slopes(here, np.cos(theta), np.sin(theta))
    np.testing.assert_allclose(slopes, (ahead - behind) / (2 * step), atol=1e-7)


def test_that_compiled_and_plain_kernels_agree():
    directions = fibonacci_directions(7)
    compiled, plain = np.empty((25, 7)), np.empty((25, 7))
    fill_basis(directions, 4, compiled)
    fill_basis.py_func(directions, 4, plain)
    np.testing.assert_allclose(compiled, plain, rtol=1e-14)
    p = legendre.py_func(0.3, np.sqrt(1 - 0.09), 4)
    np.testing.assert_allclose(legendre_slopes.py_func(p, 0.3, 0.9), legendre_slopes(p, 0.3, 0.9), rtol=1e-14)
