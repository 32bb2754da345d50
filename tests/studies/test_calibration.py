"""Calibration: posterior of parameters from noisy runs, and where the next run is made."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.stats import norm

from benchmarks.calibration import calibrate_surrogate
from regolith_studio.errors import InputError
from regolith_studio.studies.calibration import (
    CONFIDENCE,
    CalibrationParameter,
    CalibrationPosterior,
    CalibrationRuns,
    WantedResult,
    calibrate,
    density_of,
    relative_width,
)

FRICTION = CalibrationParameter("static_friction", 0.2, 1.2)
QUANTILE = 1.6449
"""Of the normal distribution, for an interval of 90 %."""


def angle(value: float, error: float) -> WantedResult:
    return WantedResult("angle", value, error, scale=5.0, noise=1.7)


def line(target: WantedResult, noise: float) -> CalibrationPosterior:
    """Runs at 21 frictions that lie on the line 10 + 20 x."""
    friction = np.linspace(0.2, 1.2, 21)
    results = 10.0 + 20.0 * (friction - 0.2)
    runs = CalibrationRuns.of(friction, results, np.full(21, noise), 1, 1)
    return calibrate([FRICTION], [target], runs)


def test_that_exact_runs_on_a_line_give_the_normal_posterior_of_its_inverse() -> None:
    """Error of the target over the slope: 1 degree over 20 degrees."""
    found = line(angle(20.0, 1.0), noise=0.02)
    assert found.best == pytest.approx([0.7], abs=0.005)
    half = QUANTILE / 20.0
    assert found.intervals[0] == pytest.approx([0.7 - half, 0.7 + half], abs=0.004)
    where, density = density_of(found, FRICTION, 0)
    assert density.mean() == pytest.approx(1.0)
    assert where[np.argmax(density)] == pytest.approx(0.7, abs=0.05)


def test_that_the_best_value_lies_in_its_interval() -> None:
    """The density is highest at the end of the range, which is in no equal-tailed interval."""
    found = line(angle(9.0, 1.0), noise=0.5)
    assert np.argmax(found.weights) == np.argmin(found.points[:, 0])
    assert found.intervals[0, 0] <= found.best[0] <= found.intervals[0, 1]


def test_that_the_noise_of_runs_widens_the_interval() -> None:
    exact, noisy = (line(angle(20.0, 0.2), noise) for noise in (0.02, 1.7))
    assert np.ptp(noisy.intervals[0]) > 1.5 * np.ptp(exact.intervals[0])


def test_that_nothing_is_known_before_the_first_run() -> None:
    found = calibrate([FRICTION], [angle(25.0, 1.0)], CalibrationRuns.of([], [], [], 1, 1))
    outside = (1.0 - CONFIDENCE) / 2
    assert found.intervals[0] == pytest.approx([0.2 + outside, 1.2 - outside], abs=0.02)


def test_that_a_result_which_no_value_gives_is_far_from_the_prediction() -> None:
    assert line(angle(20.0, 1.0), noise=0.5).misfit < 0.5
    assert line(angle(45.0, 1.0), noise=0.5).misfit > 5.0


def test_that_no_run_is_proposed_beside_one_without_a_result() -> None:
    empty = CalibrationRuns.of([], [], [], 1, 1)
    first = calibrate([FRICTION], [angle(25.0, 1.0)], empty).next_values
    runs = CalibrationRuns.of(first, [np.nan], [np.nan], 1, 1)
    again = calibrate([FRICTION], [angle(25.0, 1.0)], runs).next_values
    assert abs(again - first) >= 0.1


def test_that_two_results_tell_two_parameters_apart_where_one_does_not() -> None:
    """Angle 10 + 10 x + 10 y, density 1500 + 100 x - 100 y; wanted are those of x = .4, y = .6."""
    rolling = CalibrationParameter("rolling_friction", 0.0, 1.0)
    x, y = np.meshgrid(np.linspace(0.0, 1.0, 5), np.linspace(0.0, 1.0, 5))
    values = np.column_stack([0.2 + x.ravel(), y.ravel()])
    density = WantedResult("bulk_density", 1480.0, 2.0, scale=75.0, noise=15.0)
    both = np.column_stack([10 * (1 + x + y).ravel(), (1500 + 100 * (x - y)).ravel()])
    errors = np.full_like(both, 0.05)
    targets = [angle(20.0, 0.2), density]
    one = calibrate(
        [FRICTION, rolling], targets[:1], CalibrationRuns.of(values, both[:, 0], errors[:, 0], 2, 1)
    )
    two = calibrate([FRICTION, rolling], targets, CalibrationRuns.of(values, both, errors, 2, 2))
    assert np.ptp(one.intervals, axis=1).min() > 0.7
    assert np.ptp(two.intervals, axis=1).max() < 0.15
    assert two.best == pytest.approx([0.6, 0.6], abs=0.05)


def test_that_choices_have_the_probabilities_of_bayes_theorem() -> None:
    """Exactly known angles of three datasets; the prior is uniform, the likelihood normal."""
    dataset = CalibrationParameter.of_choices("dataset", ["blocky", "round", "flat"])
    angles = np.array([26.0, 22.0, 31.0])
    runs = CalibrationRuns.of([0.0, 1.0, 2.0], angles, np.full(3, 0.01), 1, 1)
    found = calibrate([dataset], [angle(25.0, 2.0)], runs)
    likelihood = norm.pdf(25.0, angles, 2.0)
    places, density = density_of(found, dataset, 0)
    assert places.tolist() == [0.0, 1.0, 2.0]
    assert density / 3 == pytest.approx(likelihood / likelihood.sum(), abs=0.002)
    assert found.best == 0.0


def test_that_no_choice_is_closer_to_one_than_to_another() -> None:
    """The prediction does not depend on the order in which the choices are given."""
    dataset = CalibrationParameter.of_choices("dataset", list("abcd"))
    angles, order = np.array([26.0, 22.0, 31.0]), np.array([2, 3, 0])
    one = CalibrationRuns.of([0.0, 1.0, 2.0], angles, np.full(3, 1.0), 1, 1)
    other = CalibrationRuns.of(order, angles, np.full(3, 1.0), 1, 1)
    first, second = (
        density_of(calibrate([dataset], [angle(25.0, 2.0)], r), dataset, 0)[1] for r in (one, other)
    )
    assert second[[*order, 1]] == pytest.approx(first)


def test_that_a_dataset_without_runs_is_not_ruled_out_by_one_that_fits() -> None:
    """The first gives angle and bulk density at x = .7; nothing speaks against the second."""
    dataset = CalibrationParameter.of_choices("dataset", ["tried", "not tried"])
    values = np.column_stack([np.linspace(0.2, 1.2, 5), np.zeros(5)])
    results = np.column_stack([np.linspace(15.0, 35.0, 5), np.full(5, 1600.0)])
    runs = CalibrationRuns.of(values, results, np.tile([1.7, np.nan], (5, 1)), 2, 2)
    density = WantedResult("bulk_density", 1600.0, 20.0, scale=80.0, noise=16.0)
    found = calibrate([FRICTION, dataset], [angle(25.0, 1.0), density], runs)
    assert density_of(found, dataset, 1)[1][1] / 2 > 0.1
    assert found.next_values[1] == 1.0


def test_that_a_friction_and_a_dataset_are_found_together() -> None:
    """Angles 10 + 20 x and 14 + 20 x, densities 1600 and 1700; wanted are those of the second at x = .5."""
    dataset = CalibrationParameter.of_choices("dataset", ["loose", "dense"])
    friction, number = np.repeat(np.linspace(0.2, 1.2, 6), 2), np.tile([0.0, 1.0], 6)
    results = np.column_stack([10 + 4 * number + 20 * (friction - 0.2), 1600 + 100 * number])
    runs = CalibrationRuns.of(np.column_stack([friction, number]), results, np.full((12, 2), 0.1), 2, 2)
    density = WantedResult("bulk_density", 1700.0, 20.0, scale=80.0, noise=16.0)
    found = calibrate([FRICTION, dataset], [angle(20.0, 0.5), density], runs)
    assert found.best == pytest.approx([0.5, 1.0], abs=0.02)
    assert np.ptp(found.intervals[0]) < 0.15
    assert density_of(found, dataset, 1)[1][1] / 2 > 0.99


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: CalibrationParameter("friction", 1.0, 0.2), "from a lower to a higher value, got 1 to 0.2"),
        (lambda: CalibrationParameter("friction", 0.0, np.inf), "from a lower to a higher value"),
        (lambda: angle(25.0, -1.0), "must not be negative, got -1"),
        (lambda: angle(np.nan, 1.0), "must be a number"),
    ],
)
def test_that_ranges_and_targets_are_checked(make: Callable[[], object], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        make()


def test_that_the_same_runs_propose_the_same_next_run() -> None:
    assert calibrate_surrogate(3, runs=2).values == calibrate_surrogate(3, runs=2).values


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_that_intervals_of_100_surrogates_cover_the_truth_and_shrink_to_a_third() -> None:
    """12 runs with a noise of 1.7 degrees, a target with a standard error of half a degree."""
    cases = [calibrate_surrogate(seed) for seed in range(100)]
    assert 85 <= sum(case.covers() for case in cases) <= 95
    assert np.mean([case.shrinkage() for case in cases]) <= 1 / 3


def test_that_the_prior_has_all_points_and_its_own_width_and_runs_leave_less() -> None:
    dataset = CalibrationParameter.of_choices("dataset", ["a", "b", "c", "d"])
    nothing = CalibrationRuns.of([], [], [], 2, 1)
    before = calibrate([FRICTION, dataset], [angle(30.0, 1.0)], nothing)
    assert before.effective_points == pytest.approx(len(before.points), rel=0.01)
    assert relative_width(before, FRICTION, 0) == pytest.approx(1.0, abs=0.02)
    assert relative_width(before, dataset, 1) == pytest.approx(1.0)
    after = line(angle(20.0, 1.0), noise=0.02)
    half = QUANTILE / 20.0
    assert relative_width(after, FRICTION, 0) == pytest.approx(2 * half / CONFIDENCE, abs=0.01)
    assert after.effective_points < 0.3 * len(after.points)
