import numpy as np
import pytest
from scipy.stats import ks_2samp, wasserstein_distance

from regolith_studio.errors import InputError
from regolith_studio.shape_models.goodness_of_fit import (
    classifier_accuracy,
    energy_distance,
    kolmogorov_smirnov,
    relative_wasserstein,
    resampled_distances,
)

RNG = np.random.default_rng


def test_that_the_unweighted_gap_is_that_of_scipy() -> None:
    one, two = RNG(0).normal(size=80), RNG(1).normal(0.3, 1, size=131)
    found = kolmogorov_smirnov(one, two, np.ones(80), np.ones(131))
    assert found == pytest.approx(ks_2samp(one, two).statistic, abs=1e-12)


def test_that_many_weightings_at_once_are_each_of_them_alone() -> None:
    one, two = RNG(0).normal(2, 1, size=60), np.round(RNG(1).normal(2, 1, size=45), 1)
    weights, others = RNG(2).integers(0, 4, (5, 60)) * 1.0, RNG(3).integers(0, 4, (5, 45)) * 1.0
    near, gaps = resampled_distances(one, two, weights, others, np.ones(60))
    for row in range(5):
        assert near[row] * one.mean() == pytest.approx(
            wasserstein_distance(one, two, weights[row], others[row])
        )
        assert gaps[row] == pytest.approx(kolmogorov_smirnov(one, two, weights[row], others[row]))


def test_that_whole_weights_are_repetitions() -> None:
    one, two = RNG(0).normal(size=20), RNG(1).normal(size=30)
    counts = RNG(2).integers(1, 5, 20)
    many = np.repeat(one, counts)
    expected = ks_2samp(many, two).statistic
    assert kolmogorov_smirnov(one, two, counts * 1.0, np.ones(30)) == pytest.approx(expected, abs=1e-12)
    weighted = relative_wasserstein(one, two, counts * 1.0, np.ones(30))
    assert weighted == pytest.approx(relative_wasserstein(many, two, np.ones(len(many)), np.ones(30)))


def test_that_the_energy_distance_of_shifted_normals_is_the_known_one() -> None:
    """Of N(0, 1) and N(d, 1): 2 E|Z sqrt2 + d| - 4 / sqrt pi, from the folded normal law."""
    shift = 1.0
    one, two = RNG(0).normal(size=(2000, 1)), RNG(1).normal(shift, 1, size=(2000, 1))
    folded = 2 / np.sqrt(np.pi) * np.exp(-(shift**2) / 4) + shift * 0.5204998778
    assert energy_distance(one, two) == pytest.approx(2 * folded - 4 / np.sqrt(np.pi), rel=0.1)


def test_that_a_classifier_is_at_chance_for_equal_laws_and_sure_for_distant_ones() -> None:
    one, two = RNG(0).normal(size=(800, 3)), RNG(1).normal(size=(700, 3))
    assert classifier_accuracy(one, two, RNG(2)) == pytest.approx(0.5, abs=0.05)
    assert classifier_accuracy(one, two + 5, RNG(2)) > 0.99


def test_that_a_classifier_sees_a_correlation_that_the_columns_hide() -> None:
    one = RNG(0).normal(size=(800, 2))
    two = RNG(1).multivariate_normal([0, 0], [[1, 0.9], [0.9, 1]], 800)
    assert classifier_accuracy(one, two, RNG(2)) > 0.7


def test_that_a_classifier_needs_ten_particles_of_either_kind() -> None:
    with pytest.raises(InputError, match="at least 10 particles of either kind, got 4"):
        classifier_accuracy(np.zeros((4, 2)), np.zeros((50, 2)), RNG(0))
