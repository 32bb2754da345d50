"""Harmonics against scipy, and against their own integrals."""

import numpy as np
import pytest
from scipy.special import sph_harm_y

from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.harmonics.coefficients import ShCoefficients, from_pyshtools, to_pyshtools
from regolith_studio.harmonics.sphere_grid import (
    analyse_rings,
    harmonics,
    synthesise_rings,
)
from regolith_studio.harmonics.transform import call_shtools


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


def test_that_harmonics_are_defined_at_the_poles():
    basis = harmonics(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]), 5)
    for degree in range(6):
        wanted = np.sqrt((2 * degree + 1) / (4 * np.pi))
        np.testing.assert_allclose(basis[degree**2 + degree], [wanted, (-1) ** degree * wanted], rtol=1e-14)


@pytest.fixture
def grid(request):
    """Nodes of Gauss and Legendre for a degree, and samples on them."""
    degree = request.param
    zeros, weights = call_shtools("expand.SHGLQ", degree)
    samples = np.random.default_rng(degree).normal(size=(degree + 1, 2 * degree + 1))
    return degree, zeros, weights, samples


@pytest.mark.parametrize("grid", [1, 12, 61], indirect=True)
def test_that_coefficients_and_samples_are_those_of_shtools(grid):
    degree, zeros, weights, samples = grid
    options = {"norm": 4, "csphase": 1}
    theirs = from_pyshtools(call_shtools("expand.SHExpandGLQ", samples, weights, zeros, **options)).values
    ours = analyse_rings(samples, zeros, weights, degree)
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-13)
    cilm = to_pyshtools(ShCoefficients(theirs))
    there = call_shtools("expand.MakeGridGLQ", cilm, zeros, lmax=degree, **options)
    np.testing.assert_allclose(synthesise_rings(theirs, zeros, 2 * degree + 1), there, rtol=0, atol=1e-12)


def test_that_the_sampling_theorem_of_driscoll_and_healy_is_that_of_shtools():
    n, l_max = 26, 12
    samples = np.random.default_rng(3).normal(size=(n, 2 * n))
    theirs = call_shtools("expand.SHExpandDH", samples, norm=4, sampling=2, csphase=1, lmax_calc=l_max)
    weights = np.asarray(call_shtools("utils.DHaj", n))
    ours = analyse_rings(samples, np.cos(np.pi * np.arange(n) / n), 2 * weights / weights.sum(), l_max)
    np.testing.assert_allclose(ours, from_pyshtools(theirs).values, rtol=0, atol=1e-13)


@pytest.mark.parametrize("grid", [12, 61], indirect=True)
def test_that_bits_do_not_depend_on_where_samples_lie(grid):
    degree, zeros, weights, samples = grid
    first = analyse_rings(samples, zeros, weights, degree)
    back = synthesise_rings(first, zeros, 2 * degree + 1)
    for shift in range(8):
        moved = np.empty(samples.size + 8)[shift : shift + samples.size].reshape(samples.shape)
        moved[:] = samples
        assert np.array_equal(analyse_rings(moved, zeros, weights, degree), first)
        again = np.empty(first.size + 8)[shift : shift + first.size]
        again[:] = first
        assert np.array_equal(synthesise_rings(again, zeros, 2 * degree + 1), back)
