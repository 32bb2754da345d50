"""Particles drawn from a dataset follow its weights and sizes."""

import numpy as np
import pytest

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.sampling import sample_dataset
from regolith_studio.dataset.size_distributions import (
    DiscreteSizeDistribution,
    LogNormalSizeDistribution,
    ShapeClass,
)
from regolith_studio.errors import InputError

from .example import entry


def dataset(weighting="number"):
    classes = [
        ShapeClass(3, LogNormalSizeDistribution(median_um=50.0, log_deviation=0.3)),
        ShapeClass(1, DiscreteSizeDistribution.of([25, 125], [9, 1])),
    ]
    return build_dataset([entry(0), entry(1)], classes, weighting=weighting)


def test_that_classes_and_sizes_come_in_their_shares() -> None:
    drawn = sample_dataset(dataset(), 40_000, seed=1)
    assert (drawn.class_index == 0).mean() == pytest.approx(0.75, abs=0.01)
    assert np.median(drawn.diameter[drawn.class_index == 0]) == pytest.approx(50.0, rel=0.01)
    assert (drawn.diameter[drawn.class_index == 1] == 125.0).mean() == pytest.approx(0.1, abs=0.01)


def test_that_weights_by_volume_are_met_by_the_volume_of_what_is_drawn() -> None:
    drawn = sample_dataset(dataset("volume"), 200_000, seed=2)
    volume = drawn.diameter**3
    assert volume[drawn.class_index == 0].sum() / volume.sum() == pytest.approx(0.75, abs=0.01)


def test_that_the_scale_gives_a_unit_volume_the_diameter_drawn() -> None:
    drawn = sample_dataset(dataset(), 10, seed=3)
    assert drawn.scale**3 == pytest.approx(np.pi / 6 * drawn.diameter**3)


def test_that_a_seed_gives_the_same_particles_again() -> None:
    one, again, other = (sample_dataset(dataset(), 100, seed) for seed in (4, 4, 5))
    assert np.array_equal(one.diameter, again.diameter)
    assert np.array_equal(one.class_index, again.class_index)
    assert not np.array_equal(one.diameter, other.diameter)


def test_that_none_can_be_drawn_but_not_fewer() -> None:
    assert len(sample_dataset(dataset(), 0, 0).diameter) == 0
    with pytest.raises(InputError):
        sample_dataset(dataset(), -1, 0)
