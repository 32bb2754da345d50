"""Size distributions against scipy.stats, quadrature and sampling."""

import numpy as np
import pytest
from pydantic import ValidationError
from scipy import integrate, stats

from regolith_studio.dataset.size_distributions import (
    DiscreteSizeDistribution,
    LogNormalSizeDistribution,
    RosinRammlerSizeDistribution,
    ShapeClass,
    SieveSizeDistribution,
    SizeDistribution,
    equivalent_diameter,
    normalised_shares,
    parse_sizes,
)
from regolith_studio.errors import InputError

PAPER = DiscreteSizeDistribution.of([25, 37, 56, 84, 125], [85.5, 12.6, 1.7, 0.23, 0.03])
SIEVE = SieveSizeDistribution.of([20, 40, 80, 160], [1, 2, 1])
LOG_NORMAL = LogNormalSizeDistribution(median_um=60.0, log_deviation=0.4)
ROSIN_RAMMLER = RosinRammlerSizeDistribution(scale_um=70.0, shape=2.5, min_um=10.0, max_um=200.0)
ALL = [PAPER, SIEVE, LOG_NORMAL, ROSIN_RAMMLER]
KINDS = pytest.mark.parametrize("sizes", ALL, ids=lambda sizes: sizes.type)


@KINDS
def test_that_the_distribution_function_rises_from_zero_to_one(sizes: SizeDistribution) -> None:
    values = sizes.cdf(np.geomspace(0.1, 1e5, 500))
    assert (np.diff(values) >= 0).all()
    assert values[0] == pytest.approx(0.0, abs=1e-12)
    assert values[-1] == pytest.approx(1.0, abs=1e-12)


@KINDS
def test_that_the_quantile_inverts_the_distribution_function(sizes: SizeDistribution) -> None:
    p = np.linspace(0.001, 0.999, 301)
    diameters = sizes.quantile(p)
    assert (sizes.cdf(diameters) >= p - 1e-12).all()
    assert (sizes.cdf(diameters * (1 - 1e-9)) <= p + 1e-6).all()


@KINDS
@pytest.mark.parametrize("power", [-3, -1, 1, 3])
def test_that_moments_are_those_of_many_draws(sizes: SizeDistribution, power: int) -> None:
    draws = sizes.quantile((np.arange(200_000) + 0.5) / 200_000)
    assert sizes.moment(power) == pytest.approx(np.mean(draws**power), rel=2e-3)


@KINDS
def test_that_counting_by_volume_and_back_gives_the_same_distribution(sizes: SizeDistribution) -> None:
    back = sizes.weighted("volume").weighted("number")
    diameters = np.geomspace(10, 200, 50)
    tolerance = 1e-3 if sizes.type in ("rosin-rammler", "sieve") else 1e-12
    assert back.cdf(diameters) == pytest.approx(sizes.cdf(diameters), abs=tolerance)
    assert sizes.weighted("number") is sizes


@KINDS
def test_that_counting_by_volume_is_weighting_each_particle_by_its_cube(sizes: SizeDistribution) -> None:
    draws = sizes.quantile((np.arange(200_000) + 0.5) / 200_000)
    by_volume = sizes.weighted("volume")
    for diameter in (30.0, 60.0, 100.0):
        below = (draws[draws <= diameter] ** 3).sum() / (draws**3).sum()
        assert by_volume.cdf(diameter) == pytest.approx(below, abs=5e-3)


@KINDS
def test_that_the_mean_volume_of_a_particle_does_not_depend_on_how_it_is_counted(
    sizes: SizeDistribution,
) -> None:
    assert sizes.weighted("volume").mean_cube() == pytest.approx(sizes.mean_cube(), rel=2e-3)


def test_that_the_log_normal_is_that_of_scipy() -> None:
    truth = stats.lognorm(0.4, scale=60.0)
    diameters = np.array([10.0, 50.0, 60.0, 200.0])
    assert LOG_NORMAL.cdf(diameters) == pytest.approx(truth.cdf(diameters))
    assert LOG_NORMAL.moment(3) == pytest.approx(truth.moment(3))


def test_that_rosin_rammler_is_the_weibull_distribution_of_scipy_cut_off() -> None:
    truth = stats.weibull_min(2.5, scale=70.0)
    low, high = truth.cdf([10.0, 200.0])
    assert ROSIN_RAMMLER.cdf(50.0) == pytest.approx((truth.cdf(50.0) - low) / (high - low))
    cube, _ = integrate.quad(lambda d: d**3 * truth.pdf(d) / (high - low), 10.0, 200.0)
    assert ROSIN_RAMMLER.moment(3) == pytest.approx(cube)
    inverse, _ = integrate.quad(lambda d: d**-3 * truth.pdf(d) / (high - low), 10.0, 200.0)
    assert ROSIN_RAMMLER.moment(-3) == pytest.approx(inverse, rel=1e-4)


def test_that_the_paper_s_sizes_by_number_give_its_shares_by_mass() -> None:
    """15 g in 378,000 particles of 3.075 g/cm3, coarse-grained by 10: mean-mass diameter 29.1 um."""
    by_mass = np.array(PAPER.weighted("volume").shares)
    assert by_mass == pytest.approx([0.54, 0.26, 0.12, 0.055, 0.026], abs=0.01)
    assert PAPER.mean_cube() ** (1 / 3) == pytest.approx(29.1, abs=0.15)


def test_that_measured_sizes_become_their_empirical_distribution() -> None:
    sizes = DiscreteSizeDistribution.empirical([30.0, 10.0, 20.0, 20.0])
    assert sizes.diameters_um == (10.0, 20.0, 30.0)
    assert sizes.shares == (0.25, 0.5, 0.25)
    assert sizes.cdf([9.9, 10.0, 25.0, 30.0]) == pytest.approx([0.0, 0.25, 0.75, 1.0])


def test_that_measured_sizes_go_to_the_nearest_class_of_the_paper() -> None:
    measured = DiscreteSizeDistribution.empirical([1.0, 26.0, 30.0, 31.0, 84.0, 1000.0])
    sizes = parse_sizes("classes")(ShapeClass(1.0, measured))
    assert isinstance(sizes, DiscreteSizeDistribution)
    assert sizes.diameters_um == (25.0, 37.0, 56.0, 84.0, 125.0)
    assert sizes.shares == pytest.approx((3 / 6, 1 / 6, 0, 1 / 6, 1 / 6))


@KINDS
def test_that_sizes_come_back_from_json_as_they_were(sizes: SizeDistribution) -> None:
    assert type(sizes).model_validate_json(sizes.model_dump_json()) == sizes


@pytest.mark.parametrize(
    "wrong",
    [
        {"diameters_um": (2.0, 1.0), "shares": (0.5, 0.5)},
        {"diameters_um": (1.0, 2.0), "shares": (0.5, 0.4)},
        {"diameters_um": (1.0, 2.0), "shares": (1.0,)},
        {"diameters_um": (1.0, 2.0), "shares": (1.5, -0.5)},
        {"diameters_um": (-1.0, 2.0), "shares": (0.5, 0.5)},
        {"diameters_um": (), "shares": ()},
        {"diameters_um": (1.0, float("nan")), "shares": (0.5, 0.5)},
        {"diameters_um": (1.0, 2.0), "shares": (0.5, 0.5), "unit": "mm"},
    ],
)
def test_that_impossible_sizes_are_refused(wrong: dict) -> None:
    with pytest.raises(ValidationError):
        DiscreteSizeDistribution(**wrong)


def test_that_a_rosin_rammler_law_with_nothing_between_its_limits_is_refused() -> None:
    with pytest.raises(ValidationError, match="hardly any particles"):
        RosinRammlerSizeDistribution(scale_um=1.0, shape=10.0, min_um=50.0, max_um=60.0)


@pytest.mark.parametrize("amounts", [[0.0, 0.0], [1.0, -1.0], [np.inf, 1.0]])
def test_that_impossible_weights_are_refused(amounts: list[float]) -> None:
    with pytest.raises(InputError):
        normalised_shares(amounts)


def test_that_shares_add_up_to_one_within_1e_12() -> None:
    for seed in range(20):
        shares = normalised_shares(np.random.default_rng(seed).lognormal(0, 4, 5000))
        assert abs(sum(shares) - 1.0) < 1e-12


def test_that_the_equivalent_diameter_of_a_unit_volume_is_1_2407() -> None:
    assert equivalent_diameter(1.0) == pytest.approx(1.2407, abs=1e-4)


MEMBERS = np.random.default_rng(0).lognormal(np.log(50), 0.3, 400)
OWN = ShapeClass(1.0, DiscreteSizeDistribution.empirical(MEMBERS), 400)


def test_that_measured_sizes_stay() -> None:
    assert parse_sizes("measured")(OWN) == OWN.sizes


def test_that_members_move_to_the_nearest_class_in_ln_d() -> None:
    classes = np.array([25.0, 37.0, 56.0, 84.0, 125.0])
    sizes = parse_sizes("classes:25,37,56,84,125")(OWN)
    nearest = np.abs(np.log(MEMBERS)[:, None] - np.log(classes)).argmin(axis=1)
    assert sizes.diameters_um == tuple(classes)
    assert sizes.shares == pytest.approx(np.bincount(nearest, minlength=5) / 400)
    assert parse_sizes("classes")(OWN) == sizes


def test_that_a_fit_has_mean_and_deviation_of_ln_d() -> None:
    sizes = parse_sizes("fitted:log-normal")(OWN)
    assert np.log(sizes.median_um) == pytest.approx(np.log(MEMBERS).mean())
    assert sizes.log_deviation == pytest.approx(np.log(MEMBERS).std())
    single = ShapeClass(1.0, DiscreteSizeDistribution.empirical([40.0]))
    assert parse_sizes("fitted:log-normal")(single) == single.sizes


@pytest.mark.parametrize(
    ("text", "sizes"),
    [
        ("log-normal:50,0.4", LogNormalSizeDistribution(median_um=50.0, log_deviation=0.4)),
        (
            "log-normal:50,0.4@volume",
            LogNormalSizeDistribution(weighting="volume", median_um=50.0, log_deviation=0.4),
        ),
        (
            "rosin-rammler:60,2,10,200",
            RosinRammlerSizeDistribution(scale_um=60.0, shape=2.0, min_um=10.0, max_um=200.0),
        ),
        ("sieve:20,30,60=0.25,0.75", SieveSizeDistribution.of([20, 30, 60], [1, 3])),
        ("discrete:25=0.5,50=0.5", DiscreteSizeDistribution.of([25, 50], [1, 1])),
    ],
)
def test_that_laws_are_read_as_written(text: str, sizes) -> None:
    assert parse_sizes(text)(OWN) == sizes


def test_that_shares_need_not_add_up_and_may_be_left_out() -> None:
    assert parse_sizes("discrete:25=30,50=10")(OWN).shares == pytest.approx([0.75, 0.25])
    assert parse_sizes("discrete:25,50")(OWN).shares == pytest.approx([0.5, 0.5])


@pytest.mark.parametrize(
    "text",
    [
        "", "gamma:3", "log-normal:50", "log-normal:0,1", "log-normal:50,x", "rosin-rammler:60,2,200,10",
        "discrete:50=1,25=1", "discrete:25=-1", "sieve:20,30=1,2", "classes:50,25", "classes:0,5",
        "measured:7", "measured@volume", "fitted:gauss", "log-normal:50,0.4@mass",
    ],
)  # fmt: skip
def test_that_what_is_no_distribution_is_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(InputError) as refused:
        parse_sizes(text)(OWN)
    assert "\n" not in str(refused.value)


def test_that_sizes_in_classes_are_only_made_of_measured_ones() -> None:
    fixed = ShapeClass(1.0, LogNormalSizeDistribution(median_um=50.0, log_deviation=0.4))
    with pytest.raises(InputError, match="Only measured sizes"):
        parse_sizes("classes")(fixed)
