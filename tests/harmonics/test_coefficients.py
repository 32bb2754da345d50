"""Coefficients as values, their conventions and their rotation."""

import pickle

import numpy as np
import pyshtools
import pytest
from scipy.spatial.transform import Rotation

from regolith_studio.errors import InputError
from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.harmonics.coefficients import (
    ShCoefficients,
    degrees,
    from_pyshtools,
    orders,
    power_spectrum,
    roughness_split,
    sample_spectrum,
    to_pyshtools,
)
from regolith_studio.harmonics.sphere_grid import harmonics
from regolith_studio.harmonics.transform import evaluate_on_grid, ray_grid, rotated


def test_that_the_mean_radius_of_a_sphere_is_its_radius():
    assert ShCoefficients([3.0 * np.sqrt(4 * np.pi)]).mean_radius == pytest.approx(3.0, rel=1e-15)


def test_that_truncation_keeps_the_low_degrees_and_padding_adds_zeros(rough):
    particle = rough(6)
    cut = particle.truncated(2)
    assert cut.l_max == 2
    np.testing.assert_array_equal(cut.values, particle.values[:9])
    np.testing.assert_array_equal(cut.padded(4).values[9:], 0.0)
    assert particle.content[(3, -2)] == particle.values[9 + 3 - 2]


@pytest.mark.parametrize("l_max", [-1, 7, 2.5, None])
def test_that_a_degree_out_of_range_is_refused_in_one_sentence(rough, l_max):
    with pytest.raises(InputError, match="whole number from 0 to 6"):
        rough(6).truncated(l_max)


def test_that_nan_is_refused_with_its_degree_and_order():
    values = np.zeros(16)
    values[9 + 3 + 1] = np.nan
    with pytest.raises(InputError, match=r"1 of 16 coefficients .* l = 3, m = 1"):
        ShCoefficients(values)


def test_that_a_length_that_is_no_square_is_a_programmers_error():
    with pytest.raises(ValueError, match="l_max"):
        ShCoefficients(np.zeros(5))


def test_that_coefficients_survive_pickling_and_stay_locked(rough):
    copy = pickle.loads(pickle.dumps(rough(4)))
    np.testing.assert_array_equal(copy.values, rough(4).values)
    assert not copy.values.flags.writeable


def test_that_pyshtools_evaluates_the_same_function(rough):
    particle = rough(8)
    theirs = pyshtools.SHCoeffs.from_array(to_pyshtools(particle), normalization="ortho", csphase=1)
    directions = fibonacci_directions(50)
    latitude = np.degrees(np.arcsin(directions[:, 2]))
    longitude = np.degrees(np.arctan2(directions[:, 1], directions[:, 0]))
    np.testing.assert_allclose(
        theirs.expand(lat=latitude, lon=longitude), particle.values @ harmonics(directions, 8), atol=1e-12
    )
    np.testing.assert_array_equal(from_pyshtools(to_pyshtools(particle)).values, particle.values)


def test_that_negative_orders_are_sines():
    y_axis = np.array([[0.0, 1.0, 0.0]])
    basis = harmonics(y_axis, 1)[:, 0]
    assert orders(4).tolist() == [0, -1, 0, 1]
    assert basis[1] == pytest.approx(np.sqrt(3 / (4 * np.pi)))
    assert basis[3] == pytest.approx(0.0, abs=1e-15)


def test_that_a_rotated_body_has_the_radius_of_the_body_in_the_rotated_direction(rough):
    particle, directions = rough(10), fibonacci_directions(60)
    matrix = Rotation.from_euler("xyz", [0.4, -1.3, 2.2]).as_matrix()
    turned = rotated(particle, matrix)
    np.testing.assert_allclose(
        turned.values @ harmonics(directions @ matrix.T, 10),
        particle.values @ harmonics(directions, 10),
        atol=1e-12,
    )


def test_that_rotation_leaves_the_power_spectrum_alone(rough):
    particle = rough(30)
    for seed in range(3):
        turned = rotated(particle, Rotation.random(random_state=seed).as_matrix())
        np.testing.assert_allclose(power_spectrum(turned).values, power_spectrum(particle).values, rtol=1e-10)


def test_that_half_turns_and_the_identity_are_rotations_too(rough):
    particle = rough(5)
    np.testing.assert_allclose(rotated(particle, np.eye(3)).values, particle.values, atol=1e-13)
    half = rotated(rotated(particle, np.diag([1.0, -1.0, -1.0])), np.diag([1.0, -1.0, -1.0]))
    np.testing.assert_allclose(half.values, particle.values, atol=1e-13)


def test_that_a_mirror_is_no_rotation(rough):
    with pytest.raises(ValueError, match="mirrors"):
        rotated(rough(2), np.diag([1.0, 1.0, -1.0]))
    with pytest.raises(ValueError, match="orthogonal"):
        rotated(rough(2), 2 * np.eye(3))


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
