"""Budgets of uncertainty: shares against closed forms and scipy, effects on the angle against Student's t."""

from typing import Any

import numpy as np
import pytest
from scipy.stats import sobol_indices, ttest_rel

from regolith_studio.studies.uncertainty import (
    OUTPUTS,
    RESAMPLED,
    AngleBudget,
    ChainStep,
    DescriptorBudget,
    saltelli_rows,
    sobol_shares,
)

STEPS = tuple(ChainStep(key, key, tuple("abcd")) for key in ("x", "y", "z"))


def results_of(rows: Any) -> Any:
    """y = 3 x + 1 y, and one product, of levels 0 to 3; z does nothing to the first."""
    x, y, z = np.moveaxis(rows, -1, 0)
    return np.stack([3.0 * x + y, x * y + z], axis=-1)


def test_that_shares_are_those_of_a_sum_and_of_scipy() -> None:
    """Var(3 x + y) = 9 v + v: shares .9, .1 and 0, first order and total."""
    results = results_of(saltelli_rows(STEPS, 4096, 1))
    first, total = sobol_shares(results)
    assert first[0] == pytest.approx([0.9, 0.1, 0.0], abs=0.02)
    assert total[0] == pytest.approx([0.9, 0.1, 0.0], abs=0.02)
    names = dict(zip(("f_A", "f_B", "f_AB"), (results[0].T, results[1].T, results[2:]), strict=True))
    names["f_AB"] = names["f_AB"].transpose(0, 2, 1)
    known = sobol_indices(func=names, n=4096)
    assert total == pytest.approx(known.total_order, abs=1e-12)
    assert first == pytest.approx(known.first_order, abs=1e-12)


def test_that_intervals_of_shares_hold_the_true_ones_and_incomplete_points_are_left_out() -> None:
    results = np.ones((5, 64, len(OUTPUTS)))
    results[:, :, 0] = np.exp(0.1 * results_of(saltelli_rows(STEPS, 64, 2))[..., 0])
    results[2, 0] = np.nan
    budget = DescriptorBudget(STEPS, np.ones(len(OUTPUTS)), results, 1000)
    shares = budget.shares
    assert shares is not None
    assert budget.known.shape[1] == 63
    assert (shares[1][0, :, 1] - 1e-12 <= [0.9, 0.1, 0.0]).all()
    assert (shares[1][0, :, 2] + 1e-12 >= [0.9, 0.1, 0.0]).all()
    half = 0.1 * 1.98 * (10 * 1.25) ** 0.5  # about the mean of 3 x + y, not about the present settings
    assert np.log(budget.intervals[0]) == pytest.approx([0.6 - half, 0.6 + half], abs=0.05 * half)


def angle_budget(nominal: Any, changed: dict[str, Any]) -> AngleBudget:
    """Of steps with one other level each."""
    steps = tuple(ChainStep(key, key, ("a", "b")) for key in changed)
    return AngleBudget(steps, nominal, {(key, "b"): angles for key, angles in changed.items()})


def test_that_the_variance_of_a_step_is_that_of_all_its_levels() -> None:
    """Levels of 0, 3 and -3 degrees: 6; and of 0 and 3 where the third is not decided: 2 with it at 0."""
    nominal = 30.0 + np.array([0.1, -0.1, 0.05, -0.05])
    step = ChainStep("facets", "", ("a", "b", "c"))
    noise = np.array([0.0, 0.1, -0.1, 0.0])
    budget = AngleBudget((step,), nominal, {("facets", "b"): nominal + 3, ("facets", "c"): nominal - 3})
    assert budget.step_variances()["facets"] == pytest.approx(6.0)
    open_ = AngleBudget((step,), nominal, {("facets", "b"): nominal + 3, ("facets", "c"): nominal + noise})
    assert open_.step_variances()["facets"] == pytest.approx(2.0)
    assert [effect.decided for effect in open_.effects] == [True, False]


def test_that_a_difference_is_decided_as_by_a_paired_t_test() -> None:
    rng = np.random.default_rng(0)
    nominal = 30.0 + rng.standard_normal(8)
    changed = {
        "large": nominal + 3.0 + rng.standard_normal(8),
        "small": nominal + 0.3 * np.array([1, -1] * 4),
    }
    changed["small"] += 0.1
    (large,), (small,) = (angle_budget(nominal, {key: changed[key]}).effects for key in changed)
    known = ttest_rel(changed["large"], nominal).confidence_interval()
    assert (large.low, large.high) == pytest.approx((known.low, known.high))
    assert (large.decided, large.heaps_needed) == (True, None)
    assert not small.decided
    assert 36 <= (small.heaps_needed or 0) <= 44  # (1.96 + a little) * .32 / .1 squared
    budget = angle_budget(nominal, {"large": changed["large"]})
    assert budget.variance == pytest.approx(budget.filling_variance + large.change**2 / 4)
    undecided = angle_budget(nominal, {"small": changed["small"]})
    assert undecided.step_variances()["small"] == 0.0
    assert undecided.half_width_with_undecided > undecided.half_width


@pytest.mark.parametrize(
    ("missing", "scatter", "low", "high"),
    [
        (0.0, 1.0, 0.93, 0.97),
        *(
            pytest.param(*row, marks=pytest.mark.slow)
            for row in ((0.08, 1.0, 0.93, 0.97), (0.0, 2.0, 0.93, 0.97), (0.0, 0.3, 0.9, 0.96))
        ),
    ],
    ids=["complete", "8 % without an angle", "one level scatters twice", "one level scatters a third"],
)
def test_that_intervals_of_three_heaps_in_eight_steps_hold_the_change_as_often_as_they_state(
    missing: float, scatter: float, low: float, high: float
) -> None:
    """Levels that change nothing; a heap has the effect of its seed and noise of 1."""
    rng, held, halves, values = np.random.default_rng(3), [], [], []
    for _ in range(250):
        noise = rng.standard_normal((9, 3)) * np.array([1.0] * 8 + [scatter])[:, None]
        angles = 30.0 + rng.standard_normal(3) + noise
        angles[rng.random(angles.shape) < missing] = np.nan
        budget = angle_budget(angles[0], {str(k): angles[k] for k in range(1, 9)})
        for each in budget.effects:
            held.append(each.low <= 0.0 <= each.high)
            halves.append(each.high - each.change)
        if np.isfinite(budget.half_width):
            known = budget.filling_variance**0.5 * budget.half_width / budget.variance**0.5
            values.append(abs(budget.value - 30.0) <= known)
    assert low <= np.mean(held) <= high
    assert 0.92 <= np.mean(values) <= 0.98
    assert np.median(halves) < 2.2  # Student's of three pairs alone: 4.30 sqrt(2 / 3) 0.83 = 2.9


def test_that_a_level_that_scatters_more_than_all_others_has_the_interval_of_its_own_pairs() -> None:
    rng = np.random.default_rng(1)
    angles = 30.0 + 0.5 * rng.standard_normal((7, 4))
    angles[6] += [9.0, -9.0, 9.0, -9.0]
    angles[3] = angles[0]  # the same grains: heaps of the present settings
    *effects, wide = angle_budget(angles[0], {str(k): angles[k] for k in range(1, 7)}).effects
    known = ttest_rel(angles[6], angles[0]).confidence_interval()
    assert (wide.low, wide.high) == pytest.approx((known.low, known.high))
    assert (effects[2].low, effects[2].high) == (0.0, 0.0)
    assert (effects[2].decided, effects[2].heaps_needed) == (False, None)  # no number of heaps would
    halves = {round(each.high - each.change, 9) for k, each in enumerate(effects) if k != 2}
    squares = angles[[0, 1, 2, 4, 5]]
    squares = squares - squares.mean(axis=0) - squares.mean(axis=1, keepdims=True) + squares.mean()
    # Analysis of variance by two factors: 4 x 3 degrees of freedom, Student's 2.179.
    assert halves == {round(2.1788128296634177 * float((squares**2).sum() / 12 * 2 / 4) ** 0.5, 9)}


def test_that_samples_of_grains_count_where_they_widen_the_spread() -> None:
    same = np.tile([-1.0, 1.0], 5)
    changed = {RESAMPLED: 6.0 * same}
    budget = angle_budget(same, changed)
    (effect,) = budget.effects
    assert effect.decided
    assert effect.change == pytest.approx((35.0 * 10 / 9) ** 0.5)
    assert effect.low < effect.change < effect.high
    (undecided,) = angle_budget(same, {RESAMPLED: 1.5 * same}).effects
    assert not undecided.decided
    assert (undecided.heaps_needed or 0) > 10
