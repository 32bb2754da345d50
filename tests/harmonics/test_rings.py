"""Sums over rings of latitude: the values of SHTOOLS, and the same bits wherever samples lie in memory."""

import numpy as np
import pytest

from regolith_studio.harmonics import rings, shtools
from regolith_studio.harmonics.coefficients import ShCoefficients, from_pyshtools, to_pyshtools
from regolith_studio.harmonics.rings import analysed, synthesised
from tests.filling import filled


@pytest.fixture
def grid(request):
    """Nodes of Gauss and Legendre for a degree, and samples on them."""
    degree = request.param
    zeros, weights = shtools.call("expand.SHGLQ", degree)
    samples = np.random.default_rng(degree).normal(size=(degree + 1, 2 * degree + 1))
    return degree, zeros, weights, samples


@pytest.mark.parametrize("grid", [1, 12, 61], indirect=True)
def test_that_coefficients_and_samples_are_those_of_shtools(grid):
    degree, zeros, weights, samples = grid
    options = {"norm": 4, "csphase": 1}
    theirs = from_pyshtools(shtools.call("expand.SHExpandGLQ", samples, weights, zeros, **options)).values
    ours = analysed(samples, zeros, weights, degree)
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-13)
    cilm = to_pyshtools(ShCoefficients(theirs))
    there = shtools.call("expand.MakeGridGLQ", cilm, zeros, lmax=degree, **options)
    np.testing.assert_allclose(synthesised(theirs, zeros, 2 * degree + 1), there, rtol=0, atol=1e-12)


def test_that_the_sampling_theorem_of_driscoll_and_healy_is_that_of_shtools():
    n, l_max = 26, 12
    samples = np.random.default_rng(3).normal(size=(n, 2 * n))
    theirs = shtools.call("expand.SHExpandDH", samples, norm=4, sampling=2, csphase=1, lmax_calc=l_max)
    weights = np.asarray(shtools.call("utils.DHaj", n))
    ours = analysed(samples, np.cos(np.pi * np.arange(n) / n), 2 * weights / weights.sum(), l_max)
    np.testing.assert_allclose(ours, from_pyshtools(theirs).values, rtol=0, atol=1e-13)


@pytest.mark.parametrize("grid", [12, 61], indirect=True)
def test_that_bits_do_not_depend_on_where_samples_lie(grid):
    degree, zeros, weights, samples = grid
    first = analysed(samples, zeros, weights, degree)
    back = synthesised(first, zeros, 2 * degree + 1)
    for shift in range(8):
        moved = np.empty(samples.size + 8)[shift : shift + samples.size].reshape(samples.shape)
        moved[:] = samples
        assert np.array_equal(analysed(moved, zeros, weights, degree), first)
        again = np.empty(first.size + 8)[shift : shift + first.size]
        again[:] = first
        assert np.array_equal(synthesised(again, zeros, 2 * degree + 1), back)


def test_that_compiled_sums_are_those_of_the_reference():
    rng, cosines = np.random.default_rng(1), np.array([-1.0, -0.3, 0.2, 0.9])
    even, odd, values = rng.normal(size=(4, 6)), rng.normal(size=(4, 6)), rng.normal(size=36)
    ours, plain = (
        filled(f, (even, odd, cosines), np.zeros(36))[0]
        for f in (rings._sum_over_rings, rings._sum_over_rings.py_func)
    )
    np.testing.assert_allclose(ours, plain, atol=1e-14)
    ours, plain = (
        filled(f, (values, cosines), *np.zeros((2, 4, 6)))[:2]
        for f in (rings._sum_over_degrees, rings._sum_over_degrees.py_func)
    )
    np.testing.assert_allclose(ours, plain, atol=1e-14)
