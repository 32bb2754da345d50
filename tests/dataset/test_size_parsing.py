"""Size distributions written in one line."""

import numpy as np
import pytest

from regolith_studio.dataset.build import ShapeClass
from regolith_studio.dataset.size_distributions import (
    DiscreteSizeDistribution,
    LogNormalSizeDistribution,
    RosinRammlerSizeDistribution,
    SieveSizeDistribution,
)
from regolith_studio.dataset.size_parsing import parse_sizes
from regolith_studio.errors import InputError

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
