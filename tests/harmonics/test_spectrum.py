"""Power spectra: Parseval, pyshtools, and the truth of a Gaussian sample."""

import pickle

import numpy as np
import pyshtools
import pytest

from regolith_studio.errors import InputError
from regolith_studio.harmonics.coefficients import ShCoefficients, degrees, to_pyshtools
from regolith_studio.harmonics.spectrum import PowerSpectrum, power_spectrum, roughness_split, sample_spectrum
from regolith_studio.harmonics.transform import evaluate_on_grid, ray_grid


@pytest.fixture(scope="module")
def gaussian_sample():
    """400 particles with c_00 ~ N(10, 1) and c_lm ~ N(0, (l + 1)^-2)."""
    rng = np.random.default_rng(5)
    scale = 1.0 / (degrees(81) + 1.0)
    rows = rng.normal(size=(400, 81)) * scale
    rows[:, 0] += 10.0
    return [ShCoefficients(row) for row in rows]


def test_that_the_spectrum_is_pyshtools_energy_per_order(rough):
    particle = rough(12)
    theirs = pyshtools.SHCoeffs.from_array(to_pyshtools(particle), normalization="ortho", csphase=1)
    np.testing.assert_allclose(
        power_spectrum(particle).values, theirs.spectrum(convention="energy", unit="per_lm"), rtol=1e-12
    )


def test_that_the_deviation_of_all_degrees_is_that_of_the_radius(rough):
    particle, grid = rough(12), ray_grid(24)
    radius = evaluate_on_grid(grid, particle)
    variance = grid.mean(radius**2) - grid.mean(radius) ** 2
    spectrum = power_spectrum(particle)
    assert spectrum.deviation(1, 12) == pytest.approx(np.sqrt(variance) / spectrum.mean_radius, rel=1e-9)


def test_that_the_split_adds_up_and_ignores_size(rough):
    parts = roughness_split(power_spectrum(rough(30)))
    total = power_spectrum(rough(30)).deviation(1, 30)
    assert np.hypot.reduce(list(parts.values())) == pytest.approx(total, rel=1e-12)
    assert roughness_split(power_spectrum(rough(30).scaled(7.0))) == pytest.approx(parts)
    assert list(parts) == ["form", "roundness", "roughness"]


def test_that_a_split_of_few_degrees_has_no_roughness(rough):
    assert roughness_split(power_spectrum(rough(3)))["roughness"] == 0.0


def test_that_the_spectrum_of_a_sample_finds_the_truth_within_its_bands(gaussian_sample):
    spectrum = sample_spectrum(gaussian_sample)
    truth = 1.0 / (np.arange(9) + 1.0) ** 2
    np.testing.assert_allclose(spectrum.values, truth, rtol=0.2)
    assert ((spectrum.low < truth) & (truth < spectrum.high)).sum() >= 8
    assert spectrum.mean_radius * np.sqrt(4 * np.pi) == pytest.approx(10.0, abs=0.15)
    assert (spectrum.low < spectrum.values).all()


def test_that_relative_amplitudes_are_free_of_size(rough):
    one, seven = (power_spectrum(rough(5).scaled(size)).relative_amplitudes for size in (1.0, 7.0))
    np.testing.assert_allclose(one, seven, rtol=1e-12)


def test_that_one_particle_is_no_sample(rough):
    with pytest.raises(InputError, match=r"at least two particles, got 1"):
        sample_spectrum([rough(3)])


def test_that_a_sample_is_cut_to_its_lowest_degree(rough):
    assert sample_spectrum([rough(3), rough(5), rough(4)]).l_max == 3


def test_that_a_spectrum_survives_pickling(gaussian_sample):
    spectrum = sample_spectrum(gaussian_sample[:5])
    copy = pickle.loads(pickle.dumps(spectrum))
    np.testing.assert_array_equal(copy.high, spectrum.high)
    assert isinstance(copy, PowerSpectrum)
