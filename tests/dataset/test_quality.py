"""Error over the number of representatives, and the noise that it is held against."""

import numpy as np
import pytest
from scipy.stats import wasserstein_distance

from regolith_studio.dataset.representatives import (
    choose_representatives,
    curve_counts,
    quality_steps,
    quality_table,
    representation_error,
)
from regolith_studio.errors import InputError
from regolith_studio.steps import result_of

from .test_representatives import population


def test_that_a_curve_chooses_what_each_number_alone_would_choose() -> None:
    rows = population(200)
    curve = result_of(quality_steps(rows, (3, 10, 25)))
    for choice, point in zip(curve.choices, curve.points, strict=True):
        alone = choose_representatives(rows, point.count)
        assert np.array_equal(choice.chosen, alone.chosen)
        assert np.array_equal(choice.labels, alone.labels)
        assert representation_error(rows, alone) == point.errors


def test_that_every_particle_standing_for_itself_leaves_no_error() -> None:
    rows = population(60)
    (point,) = result_of(quality_steps(rows, (60,))).points
    assert max(point.errors.values()) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("weighting", ["number", "volume"])
def test_that_more_representatives_come_closer_until_the_noise_is_reached(weighting: str) -> None:
    curve = result_of(quality_steps(population(400), (1, 5, 20, 100, 400), weighting=weighting))
    means = [point.mean for point in curve.points]
    assert means == sorted(means, reverse=True)
    assert curve.sufficient_count in ((20, 100, 400) if weighting == "number" else (5, 20, 100, 400))
    assert all(
        point.mean > curve.noise_mean for point in curve.points if point.count < curve.sufficient_count
    )


def test_that_lengths_are_those_of_particles_with_their_representatives_shape() -> None:
    rows = population(80)
    chosen = choose_representatives(rows, 4)
    diameters = np.cbrt(6 / np.pi * np.array([row["volume"] for row in rows]))
    shortest = np.array([row["min_diameter"] for row in rows])
    stands = [
        shortest[chosen.chosen[label]] / diameters[chosen.chosen[label]] * diameter
        for label, diameter in zip(chosen.labels, diameters, strict=True)
    ]
    expected = wasserstein_distance(shortest, stands) / shortest.std()
    assert representation_error(rows, chosen)["min_diameter"] == pytest.approx(expected)


def test_that_counts_fit_the_population_and_hold_the_wanted_number() -> None:
    assert curve_counts(7) == (1, 2, 3, 4, 5, 6)
    assert 10 in curve_counts(3000)
    assert curve_counts(3000)[-1] == 200
    assert 33 in curve_counts(100, 33)


def test_that_more_representatives_than_particles_are_refused() -> None:
    with pytest.raises(InputError, match="Between 1 and 20"):
        result_of(quality_steps(population(20), (5, 21)))


def test_that_the_table_ends_with_the_noise() -> None:
    curve = result_of(quality_steps(population(100), (1, 10)))
    table = quality_table(curve)
    assert [row[0] for row in table.rows] == [1, 10, None]
    assert table.rows[-1][1] == pytest.approx(curve.noise_mean)
    assert table.column("sphericity")[1] == pytest.approx(curve.points[1].errors["sphericity"])
