from collections.abc import Callable

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.shape_models.sample import Sample


def sphere(radius: float, l_max: int = 2) -> np.ndarray:
    return np.array([radius * np.sqrt(4 * np.pi)] + [0.0] * ((l_max + 1) ** 2 - 1))


def test_that_spheres_have_their_radius_as_equivalent_radius() -> None:
    sample = Sample(np.stack([sphere(2.0), sphere(3.0)]))
    np.testing.assert_allclose(sample.equivalent_radii, [2.0, 3.0], rtol=1e-13)
    np.testing.assert_allclose(sample.min_radii, [2.0, 3.0], rtol=1e-13)


def test_that_the_volume_of_a_shifted_sphere_is_found_from_its_series() -> None:
    """r = d cos t + sqrt(1 - d^2 sin^2 t) is a unit sphere seen from a point at distance d."""
    d = 0.3
    cosines, weights = np.polynomial.legendre.leggauss(60)
    radius = d * cosines + np.sqrt(1 - d**2 * (1 - cosines**2))
    values = np.zeros(21**2)
    for degree in range(21):
        legendre = np.polynomial.legendre.Legendre.basis(degree)(cosines) * np.sqrt(
            (2 * degree + 1) / (4 * np.pi)
        )
        values[degree**2 + degree] = 2 * np.pi * weights @ (radius * legendre)
    sample = Sample(np.stack([values, 2 * values]))
    np.testing.assert_allclose(sample.equivalent_radii, [1.0, 2.0], rtol=1e-8)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (np.stack([sphere(1.0)]), "at least 2 different particles, got 1"),
        (np.stack([sphere(1.0)] * 5), "All 5 particles are the same"),
        (np.stack([sphere(1.0), sphere(np.nan)]), "not finite numbers, the first is 'particle-2'"),
        (np.stack([sphere(1.0), sphere(-1.0)]), "mean radius that is not positive"),
        (np.empty((0, 9)), "got 0"),
    ],
)
def test_that_a_sample_no_model_can_use_is_refused_in_one_sentence(rows: np.ndarray, words: str) -> None:
    with pytest.raises(InputError, match=words) as refusal:
        Sample(rows)
    assert str(refusal.value).count(".") <= 1 or str(refusal.value).endswith(".")


def test_that_two_groups_of_different_degree_are_refused_with_the_degree_to_cut_to() -> None:
    particles = [
        ShCoefficients(sphere(1.0, 2)),
        ShCoefficients(sphere(2.0, 4)),
        ShCoefficients(sphere(3.0, 4)),
    ]
    with pytest.raises(
        InputError, match=r"1 with l_max = 2, 2 with l_max = 4\); cut all of them to l_max = 2"
    ):
        Sample.of(particles)
    assert Sample.of([each.truncated(2) for each in particles]).l_max == 2


def test_that_no_particles_are_refused() -> None:
    with pytest.raises(InputError, match="got 0"):
        Sample.of([])


def test_that_halves_are_disjoint_complete_and_repeatable(rough_sample: Callable[..., Sample]) -> None:
    sample = rough_sample(31)
    first, second = sample.halves(4)
    assert sorted([*first, *second]) == list(range(31))
    np.testing.assert_array_equal(first, sample.halves(4)[0])
    assert not np.array_equal(first, sample.halves(5)[0])


def test_that_particles_with_a_negative_radius_are_left_out_for_logarithms() -> None:
    bad = sphere(1.0)
    bad[6] = 5.0
    sample = Sample(np.stack([sphere(1.0), bad, sphere(2.0)]))
    assert sample.star_shaped().names == ("particle-1", "particle-3")
    with pytest.raises(InputError, match="Only 1 of 2 particles"):
        Sample(np.stack([sphere(1.0), bad])).star_shaped()


def test_that_a_degree_beyond_the_sample_is_refused(rough_sample: Callable[..., Sample]) -> None:
    with pytest.raises(InputError, match="expanded to l_max = 6, so it has no l_max = 9"):
        rough_sample(4).truncated(9)
