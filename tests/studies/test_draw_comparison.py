"""Draws against their sample in units of sampling noise: for tables whose distributions are known."""

import numpy as np
import pytest

from regolith_studio.studies.population import KEYS
from regolith_studio.studies.population_distances import DistributionComparison


def table_of(rng, n, **shifts):
    """Descriptors of `n` particles: log-normal sizes and normal shapes, each moved by shifts in sigma."""
    columns = {
        "equivalent_radius": np.exp(2.0 + 0.3 * (rng.normal(size=n) + shifts.get("equivalent_radius", 0.0))),
        "aspect_ratio": 1.8 + 0.2 * (rng.normal(size=n) + shifts.get("aspect_ratio", 0.0)),
        "sphericity": 0.8 + 0.02 * (rng.normal(size=n) + shifts.get("sphericity", 0.0)),
        "convexity": 0.9 + 0.02 * (rng.normal(size=n) + shifts.get("convexity", 0.0)),
    }
    columns["surface_area"] = 4 * np.pi * columns["equivalent_radius"] ** 2 / columns["sphericity"]
    return np.column_stack([columns[key] for key in KEYS])


def compared(measured, drawn, cut=None, model="hull_field", l_max=10):
    nothing = np.empty((0, len(KEYS)))
    return DistributionComparison(KEYS, measured, drawn, nothing if cut is None else cut, model, l_max, 30)


@pytest.mark.slow
def test_that_particles_of_the_same_source_are_told_apart_in_one_case_of_twenty():
    rng = np.random.default_rng(0)
    pairs = [compared(table_of(rng, 150), table_of(rng, 80)) for _ in range(150)]
    largest = [pair.in_noise().max() > pair.noise.limit for pair in pairs]
    assert 1 <= sum(largest) <= 15, "7.5 are expected; the binomial distribution has 99 % within 2 to 15"


def test_that_distances_of_the_same_source_are_one_in_the_mean():
    rng = np.random.default_rng(1)
    ratios = [compared(table_of(rng, 150), table_of(rng, 80)).in_noise() for _ in range(12)]
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.15)


def test_that_the_descriptor_that_is_off_stands_first_and_is_named():
    rng = np.random.default_rng(2)
    found = compared(table_of(rng, 200), table_of(rng, 100, convexity=2.0))
    table = found.table()
    assert table.rows[0][0] == "convexity"
    assert len(table.rows) == 2 * len(KEYS)
    assert table.column("wasserstein_in_floors")[0] > 5
    assert "Convexity by" in found.assessment()
    assert "recombined and sample_matched" in found.assessment()


def test_that_a_degree_that_is_too_low_is_named_with_the_one_that_the_sample_has():
    rng = np.random.default_rng(3)
    smooth = {"sphericity": 2.0, "convexity": 2.0}
    measured, drawn, cut = table_of(rng, 200), table_of(rng, 100, **smooth), table_of(rng, 200, **smooth)
    assert "cut at l_max = 10" in compared(measured, drawn, cut).assessment()
    assert "draw with l_max 30, from recombined" in compared(measured, drawn, cut).assessment()
    assert compared(measured, drawn, cut, model="recombined").assessment().endswith("draw with l_max 30.")


def test_that_few_particles_are_not_compared():
    rng = np.random.default_rng(4)
    found = compared(table_of(rng, 200), table_of(rng, 19, convexity=9.0))
    assert not found.comparable
    assert "not compared" in found.assessment()


def test_that_draws_like_the_sample_are_said_to_be_so():
    rng = np.random.default_rng(5)
    said = compared(table_of(rng, 200), table_of(rng, 100)).assessment()
    assert said == "100 draws differ from 200 measured particles by no more than sampling noise."
