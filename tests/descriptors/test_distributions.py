"""Weighted distributions against numpy, scipy and hand."""

import numpy as np
import pytest
from scipy.stats import ks_2samp

from regolith_studio.descriptors.describe import describe
from regolith_studio.descriptors.distributions import (
    Distribution,
    distribution,
    kolmogorov_smirnov_distance,
    wasserstein_1,
    zingg_class,
)
from tests.geometry.solids import cuboid

SAMPLE = [
    {"volume": 8.0, "sphericity": 0.5},
    {"volume": 1.0, "sphericity": 0.9},
    {"volume": 1.0, "sphericity": 0.7},
]


def test_that_number_and_volume_weighting_differ_as_they_must() -> None:
    assert distribution(SAMPLE, "sphericity").mean == pytest.approx(0.7)
    assert distribution(SAMPLE, "sphericity", "volume").mean == pytest.approx(0.56)


def test_that_the_ecdf_steps_by_the_weights() -> None:
    by_volume = distribution(SAMPLE, "sphericity", "volume")
    assert by_volume.ecdf([0.4, 0.5, 0.6, 0.7, 0.95]) == pytest.approx([0.0, 0.8, 0.8, 0.9, 1.0])


def test_that_quantiles_invert_the_ecdf() -> None:
    rng = np.random.default_rng(0)
    drawn = Distribution(rng.normal(size=101), rng.uniform(0.1, 1.0, 101))
    shares = np.linspace(0.0, 1.0, 21)
    values = drawn.quantile(shares)
    assert (drawn.ecdf(values) >= shares - 1e-12).all()
    assert (drawn.ecdf(values - 1e-9) <= shares + 1e-12).all()


def test_that_unweighted_quantiles_are_those_of_numpy() -> None:
    drawn = np.random.default_rng(1).normal(size=50)
    wanted = np.quantile(drawn, [0.1, 0.5, 0.93], method="inverted_cdf")
    assert Distribution(drawn, np.ones(50)).quantile([0.1, 0.5, 0.93]) == pytest.approx(wanted)


def test_that_a_histogram_holds_the_whole_sample() -> None:
    shares, edges = distribution(SAMPLE, "sphericity", "volume").histogram([0.4, 0.6, 0.8, 1.0])
    assert shares == pytest.approx([0.8, 0.1, 0.1])
    assert edges == pytest.approx([0.4, 0.6, 0.8, 1.0])


def test_that_the_standard_deviation_is_that_of_numpy() -> None:
    drawn = np.random.default_rng(2).normal(size=40)
    assert Distribution(drawn, np.full(40, 3.0)).standard_deviation == pytest.approx(drawn.std())


def test_that_the_wasserstein_distance_is_the_area_between_the_ecdfs() -> None:
    rng = np.random.default_rng(4)
    one, other = (Distribution(rng.uniform(size=20), rng.uniform(size=20)) for _ in range(2))
    grid = (np.arange(200_000) + 0.5) / 200_000
    area = np.abs(one.ecdf(grid) - other.ecdf(grid)).mean()
    assert wasserstein_1(one, other) == pytest.approx(area, rel=1e-4)


def test_that_impossible_samples_are_refused() -> None:
    with pytest.raises(ValueError, match="needs values"):
        Distribution(np.array([]), np.array([]))
    with pytest.raises(ValueError, match="needs values"):
        Distribution(np.ones(2), np.array([1.0, -1.0]))
    with pytest.raises(ValueError, match="weighting"):
        distribution(SAMPLE, "sphericity", "beauty")
    with pytest.raises(ValueError, match="between 0 and 1"):
        distribution(SAMPLE, "sphericity").quantile([1.2])


def test_that_the_kolmogorov_smirnov_distance_of_equal_weights_is_that_of_scipy() -> None:
    rng = np.random.default_rng(3)
    one, other = rng.normal(size=40), rng.normal(0.5, 2.0, size=25)
    weighted = [Distribution(values, np.ones(len(values))) for values in (one, other)]
    assert kolmogorov_smirnov_distance(*weighted) == pytest.approx(ks_2samp(one, other).statistic)


@pytest.mark.parametrize(
    ("edges", "form"),
    [
        ((1.0, 1.0, 1.0), "equant"),
        ((3.0, 3.0, 1.0), "disc"),
        ((3.0, 1.0, 1.0), "rod"),
        ((9.0, 3.0, 1.0), "blade"),
    ],
)
def test_that_a_cuboid_falls_in_its_class(edges: tuple[float, float, float], form: str) -> None:
    assert zingg_class(describe(cuboid(*edges))) == form
