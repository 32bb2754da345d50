from collections.abc import Callable

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.harmonics.sphere_grid import harmonics
from regolith_studio.shape_models.models.gaussian_field import MODEL, GaussianField, GaussianFieldSettings
from regolith_studio.shape_models.realizations import positive_rows
from regolith_studio.shape_models.sample import Sample


def test_that_the_estimates_of_a_large_draw_are_the_numbers_it_was_drawn_with() -> None:
    """So weak a field that no radius is ever negative: mean and variances within four standard errors."""
    field = GaussianField(35.0, np.array([4.0, 0.0, 0.8, 0.4, 0.1]))
    draws = field.draw(20000, 0)
    again = MODEL.fit(Sample(draws.coefficients), GaussianFieldSettings(l_max=4))
    assert draws.rejected == 0
    assert again.mean == pytest.approx(35.0, abs=4 * 2.0 / np.sqrt(20000))
    orders = 2 * np.arange(5) + 1
    error = 4 * np.sqrt(2 / (20000 * orders))
    np.testing.assert_allclose(
        again.spectrum[[0, 2, 3, 4]] / field.spectrum[[0, 2, 3, 4]], 1, atol=error.max()
    )


def test_that_the_share_of_rejected_draws_of_spheres_is_that_of_the_normal_law() -> None:
    """With l_max = 0 a draw is a sphere of radius N(mu, A_0): rejected with probability Phi(-mu / s)."""
    draws = GaussianField(1.0, np.array([1.0])).draw(20000, 0)
    assert 1 - draws.acceptance == pytest.approx(0.158655, abs=0.01)


def test_that_every_kept_radius_is_positive_between_the_nodes_too() -> None:
    field = GaussianField(3.5, np.array([0.1, 0.0, 0.2, 0.1, 0.05, 0.05, 0.05]))
    draws = field.draw(300, 0)
    assert draws.rejected > 0
    directions = np.random.default_rng(0).normal(size=(20000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    assert (draws.coefficients @ harmonics(directions, 6)).min() > 0
    assert positive_rows(draws.coefficients).all()
    assert not positive_rows(-draws.coefficients[:3]).any()


def test_that_a_spectrum_edited_by_hand_is_drawn_from(rough_sample: Callable[..., Sample]) -> None:
    field = MODEL.fit(rough_sample(40, 3), GaussianFieldSettings(l_max=3))
    spheres = field.with_amplitudes(np.zeros(3)).draw(10, 0)
    assert np.abs(spheres.coefficients[:, 1:]).max() == 0.0


@pytest.mark.parametrize(
    ("mean", "spectrum", "words"),
    [
        (1.0, [1.0, -1.0], "none of them negative"),
        (0.0, [1.0], "must be positive"),
        (1.0, [np.nan], "variance"),
    ],
)
def test_that_numbers_of_no_field_are_refused(mean: float, spectrum: list[float], words: str) -> None:
    with pytest.raises(InputError, match=words):
        GaussianField(mean, np.array(spectrum))


def test_that_a_range_that_the_field_never_reaches_is_refused() -> None:
    with pytest.raises(InputError, match="only 0 have a positive radius and the size asked for"):
        GaussianField(3.5, np.array([0.01, 0.0, 0.01])).draw(5, 0, (100.0, 200.0))


def test_that_rejection_makes_the_kept_draws_larger_and_rounder() -> None:
    """Of radii N(1, 1) those above zero have the mean 1 + phi(1) / Phi(1)."""
    bias = GaussianField(1.0, np.array([1.0])).rejection_bias()
    assert bias.rejected == pytest.approx(0.1587, abs=0.02)
    assert bias.mean_radius == pytest.approx(0.2876, abs=0.04)
    rough = GaussianField(3.5, np.array([0.1, 0.0, 0.3, 0.1, 0.05])).rejection_bias()
    assert rough.mean_radius > 0 > rough.second_degree
