import numpy as np
import pytest
from scipy.stats import lognorm

from regolith_studio.errors import InputError
from regolith_studio.shape_models.size_law import SIZE_LAWS, LogNormalSizes, size_law_from

RNG = np.random.default_rng


def gap(values: np.ndarray, cdf: np.ndarray) -> float:
    order = np.argsort(values)
    return float(np.abs(cdf[order] - (np.arange(len(values)) + 0.5) / len(values)).max())


def test_that_a_log_normal_law_draws_what_scipy_says() -> None:
    law = LogNormalSizes.log_normal(np.array([1.0, 2.0, 4.0, 8.0]))
    values, _ = law.draw(20000, RNG(0))
    spread = np.log([1.0, 2.0, 4.0, 8.0]).std(ddof=1)
    assert gap(values, lognorm(spread, scale=8**0.5).cdf(values)) < 0.012


def test_that_a_law_cut_to_a_range_is_the_law_given_the_range() -> None:
    law = LogNormalSizes(np.array([0.7, 0.3]), np.array([0.0, 1.0]), np.array([0.5, 0.2]))
    whole, parts = law.draw(200000, RNG(0))
    inside = (whole > 1.2) & (whole < 3.0)
    cut, cut_parts = law.draw(20000, RNG(1), (1.2, 3.0))
    assert cut.min() >= 1.2
    assert cut.max() <= 3.0
    assert cut.mean() == pytest.approx(whole[inside].mean(), rel=0.01)
    assert cut_parts.mean() == pytest.approx(parts[inside].mean(), abs=0.02)


@pytest.mark.parametrize("bounds", [(1e-9, 1e-8), (1e8, 1e9), (0.999, 1.001)])
@pytest.mark.parametrize("key", sorted(SIZE_LAWS))
def test_that_a_range_far_from_the_sample_is_filled_all_the_same(
    key: str, bounds: tuple[float, float]
) -> None:
    law = SIZE_LAWS[key](RNG(0).lognormal(0, 0.3, 50))
    values, _ = law.draw(1000, RNG(0), bounds)
    assert bounds[0] <= values.min() < values.max() <= bounds[1]


def test_that_the_limits_of_a_law_hold_where_no_other_range_is_asked_for() -> None:
    law = size_law_from(LogNormalSizes(np.ones(1), np.zeros(1), np.ones(1), (0.5, 2.0)).stored())
    uncut = LogNormalSizes(np.ones(1), np.zeros(1), np.ones(1))
    for bounds in (None, (0.5, 2.0)):
        np.testing.assert_array_equal(law.draw(99, RNG(0), bounds)[0], uncut.draw(99, RNG(0), (0.5, 2.0))[0])
    assert law.draw(99, RNG(0), (3.0, 4.0))[0].min() >= 3.0


@pytest.mark.parametrize("key", sorted(SIZE_LAWS))
def test_that_a_law_read_back_draws_the_same(key: str) -> None:
    law = SIZE_LAWS[key](RNG(0).lognormal(0, 0.3, 50))
    again = size_law_from(law.stored())
    np.testing.assert_array_equal(law.draw(9, RNG(1))[0], again.draw(9, RNG(1))[0])


@pytest.mark.parametrize(
    "values",
    [{}, {"type": "cauchy"}, {"type": "log_normal_mixture", "weights": [1.0]}],
)
def test_that_a_broken_law_is_refused(values: dict[str, object]) -> None:
    with pytest.raises(InputError, match="size distribution"):
        size_law_from(values)


def test_that_a_mixture_of_log_normal_laws_finds_the_two_that_drew() -> None:
    radii = np.concatenate([RNG(0).lognormal(0.0, 0.1, 600), RNG(1).lognormal(1.5, 0.25, 300)])
    law = LogNormalSizes.mixture(radii)
    order = np.argsort(law.means)
    np.testing.assert_allclose(law.weights[order], [2 / 3, 1 / 3], atol=0.01)
    np.testing.assert_allclose(law.means[order], [0.0, 1.5], atol=0.04)
    np.testing.assert_allclose(law.deviations[order], [0.1, 0.25], rtol=0.08)


def test_that_one_log_normal_law_is_found_to_be_one() -> None:
    law = LogNormalSizes.mixture(RNG(0).lognormal(1.0, 0.4, 500))
    assert len(law.weights) == 1
    assert law.deviations[0] == pytest.approx(0.4, rel=0.08)
