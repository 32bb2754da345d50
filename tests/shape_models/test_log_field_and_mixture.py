from collections.abc import Callable

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.shape_models.models.gaussian_field import MODEL as GAUSSIAN_FIELD
from regolith_studio.shape_models.models.gaussian_mixture import MODEL as GAUSSIAN_MIXTURE
from regolith_studio.shape_models.models.gaussian_mixture import MixtureSettings
from regolith_studio.shape_models.models.log_field import MODEL as LOG_FIELD
from regolith_studio.shape_models.models.log_field import LogField, LogFieldSettings
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample, directed, log_shapes, sized
from regolith_studio.shape_models.size_law import LogNormalSizes


def log_sample(n: int, amplitude: float, size: float, seed: int) -> Sample:
    """Particles whose ln r is a Gaussian field of degrees 1 to 3, cut at degree 8."""
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(n, 16)) * np.where(degrees(16) >= 1, amplitude, 0.0)
    logs = sized(np.pad(rows, ((0, 0), (0, 81 - 16))), size * np.exp(0.1 * rng.normal(size=n)))
    draws = Realizations(logs, "log_radius", "test", 0)
    return Sample(np.stack([draws.particle(i).values for i in range(n)]))


def test_that_sized_shapes_have_the_radius_asked_for(rough_sample: Callable[..., Sample]) -> None:
    rows = log_shapes(rough_sample(20, 6)).coefficients
    radii = np.linspace(1, 5, 20)
    draws = Realizations(sized(rows, radii), "log_radius", "test", 0)
    np.testing.assert_allclose(draws.equivalent_radii(), radii, rtol=1e-12)


def test_that_the_logarithm_of_a_weak_field_gives_the_radius_back() -> None:
    sample = log_sample(6, 0.05, 2.0, 0)
    shapes = log_shapes(sample)
    draws = Realizations(sized(shapes.coefficients, shapes.equivalent_radii), "log_radius", "test", 0)
    again = np.stack([draws.particle(i).values for i in range(6)])
    np.testing.assert_allclose(again, sample.coefficients, atol=2e-4)


def test_that_directed_coefficients_have_the_power_of_each_degree() -> None:
    powers = np.abs(np.random.default_rng(0).normal(size=(7, 4)))
    rows = directed(powers, np.random.default_rng(1))
    np.testing.assert_allclose(np.add.reduceat(rows**2, [0, 1, 4, 9], axis=1), powers, rtol=1e-12)


def test_that_the_pooled_spectrum_of_a_large_sample_is_the_one_that_drew_it() -> None:
    field = LOG_FIELD.fit(log_sample(400, 0.1, 5.0, 1), LogFieldSettings(8, "pooled", size_dependent=False))
    assert np.sqrt(field.spectrum[2]) == pytest.approx(0.1, rel=0.06)
    assert np.sqrt(field.spectrum[3]) == pytest.approx(0.1, rel=0.06)
    assert field.spectrum[4:].max() < 1e-5


def test_that_a_spectrum_that_follows_size_is_found_and_drawn() -> None:
    """Half the particles are four times as large and twice as strong in amplitude: A_l ~ r_eq^1."""
    small, large = log_sample(150, 0.06, 1.0, 0), log_sample(150, 0.12, 4.0, 1)
    sample = Sample(np.concatenate([small.coefficients, large.coefficients]))
    field = LOG_FIELD.fit(sample, LogFieldSettings(8, "pooled"))
    assert field.exponents is not None
    assert field.exponents[2] == pytest.approx(1.0, abs=0.15)
    strong = field.draw(400, 0, (3.9, 4.1)).coefficients[:, 4:9].std()
    weak = field.draw(400, 0, (0.98, 1.02)).coefficients[:, 4:9].std()
    assert strong / weak == pytest.approx(2.0, rel=0.15)


def test_that_an_edited_spectrum_replaces_the_measured_ones(rough_sample: Callable[..., Sample]) -> None:
    field = LOG_FIELD.fit(rough_sample(30, 4), LogFieldSettings(l_max=4))
    assert field.resampled
    spheres = field.with_amplitudes(np.zeros(4)).draw(20, 0)
    assert np.abs(spheres.coefficients[:, 1:]).max() == 0.0


@pytest.mark.parametrize("changes", [{"spectrum": "guessed"}, {"size_law": "cauchy"}])
def test_that_an_unknown_setting_is_refused_with_the_choices(
    changes: dict[str, str], rough_sample: Callable[..., Sample]
) -> None:
    with pytest.raises(InputError, match="must be one of"):
        LOG_FIELD.fit(rough_sample(5, 4), LogFieldSettings(l_max=4, **changes))


def test_that_sizes_far_outside_the_sample_are_drawn() -> None:
    field = LogField(np.array([0, 0, 0.01]), LogNormalSizes.log_normal(np.array([1.0, 1.2, 0.9])))
    radii = field.draw(100, 0, (100.0, 200.0)).equivalent_radii()
    assert radii.min() * (1 + 1e-9) >= 100.0
    assert radii.max() <= 200.0 * (1 + 1e-9)


def test_that_the_papers_mixture_finds_two_constituents_and_draws_them_apart() -> None:
    """Spheres about 10 with A_2 = 0.01 and about 20 with A_2 = 0.09, two to one."""
    rng = np.random.default_rng(0)
    scales = np.repeat([10.0, 20.0], [200, 100])
    rows = rng.normal(size=(300, 9)) * np.repeat([0.1, 0.3], [200, 100])[:, None]
    rows[:, 0] = np.sqrt(4 * np.pi) * scales * (1 + 0.02 * rng.normal(size=300))
    mixture = GAUSSIAN_MIXTURE.fit(Sample(rows), MixtureSettings(l_max=2, max_components=4))
    assert mixture.n_components == 2
    assert len(mixture.bic) == 4
    assert mixture.labels is not None
    assert (mixture.labels == np.repeat([0, 1], [200, 100])).all()
    np.testing.assert_allclose(mixture.weights, [2 / 3, 1 / 3], atol=0.01)
    np.testing.assert_allclose(mixture.means, np.sqrt(4 * np.pi) * np.array([10, 20]), rtol=0.01)
    np.testing.assert_allclose(mixture.spectra[:, 2], [0.01, 0.09], rtol=0.15)
    draws = mixture.renamed(["fine", "coarse"]).draw(900, 0)
    assert draws.rejected == 0
    parts, radii = np.asarray(draws.components), draws.equivalent_radii()
    assert parts.mean() == pytest.approx(1 / 3, abs=0.05)
    assert radii[parts == 0].max() < 12 < 18 < radii[parts == 1].min()


def test_that_the_papers_mixture_of_one_part_is_the_papers_field(rough_sample: Callable[..., Sample]) -> None:
    sample = rough_sample(40, 4)
    mixture = GAUSSIAN_MIXTURE.fit(sample, MixtureSettings(l_max=4, n_components=1))
    field = GAUSSIAN_FIELD.fit(sample, GAUSSIAN_FIELD.Settings(4))
    assert mixture.means[0] == pytest.approx(field.mean)
    np.testing.assert_allclose(mixture.spectra[0, 1:], field.spectrum[1:])
    assert mixture.spectra[0, 0] == pytest.approx(field.spectrum[0] * 39 / 40)  # maximum likelihood


def test_that_more_parts_than_the_particles_can_carry_are_refused() -> None:
    with pytest.raises(InputError, match="20 particles are enough for 1 to 5 parts, got 6"):
        GAUSSIAN_MIXTURE.fit(log_sample(20, 0.1, 1.0, 0), MixtureSettings(l_max=3, n_components=6))
