"""The checks after a run: what they count, and a sentence for each that fails."""

import numpy as np
import pytest

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dem.case import ReposeCase, prepare
from regolith_studio.dem.engine import check_run, measure_filling
from regolith_studio.dem.snapshot import ParticleState

SOUND = {
    "energy_gain": 0.0,
    "kinetic_energy": 1e-5,
    "at_rest": True,
    "filling": (0.03, 0.55),
    "lowest": np.zeros(1),
}
PAIR = SOUND | {"lowest": np.zeros(2)}


def test_that_a_sound_run_has_nothing_to_say() -> None:
    checks = check_run(np.array([0.5, 1.4]), np.array([0.001, 0.003]), **PAIR)
    assert checks.problems == ()
    assert (checks.particles_in, checks.particles_out) == (2, 2)
    assert (checks.mean_overlap, checks.max_overlap) == pytest.approx((0.002, 0.003))
    assert check_run(np.array([0.5]), np.empty(0), **SOUND).mean_overlap == 0.0


def test_that_every_failed_check_is_a_sentence() -> None:
    wrong = PAIR | {"energy_gain": 0.2, "at_rest": False}
    checks = check_run(np.array([0.5, -3.0]), np.array([0.15]), **wrong, problems=["The solver was hot."])
    first, lost, deep, overlap, energy, moving = checks.problems
    assert first == "The solver was hot."
    assert lost == "1 of 2 particles fell through the plate."
    assert deep == "100.0 % of the contacts are deeper than 2 % of the mean diameter."
    assert overlap == "Particles overlap by up to 15.0 % of the mean diameter."
    assert "0.2 m g d" in energy
    assert "still moving" in moving


def test_that_the_depth_in_the_plate_is_that_of_the_lowest_particle_that_has_not_fallen_through() -> None:
    heights, lowest = np.array([0.4, 0.5, -3.0, 1.5]), np.array([-0.006, -0.012, -3.4, 1.0])
    assert check_run(heights, np.empty(0), **SOUND | {"lowest": lowest}).plate_depth == 0.012
    above = SOUND | {"lowest": np.array([0.1])}
    assert check_run(np.array([0.6]), np.empty(0), **above).plate_depth == 0.0


@pytest.mark.parametrize("copies", [1, 100])
@pytest.mark.parametrize(("deep", "passed"), [(0, True), (9, True), (11, False)])
def test_that_the_share_of_deep_contacts_decides_whatever_the_number_of_particles(
    copies: int, deep: int, passed: bool
) -> None:
    """Of a thousand contacts that overlap one in a hundred may be deep; gaps are no contacts."""
    some = np.concatenate([np.full(deep, 0.03), np.full(1000 - deep, 0.001), np.zeros(5000), [-0.01]])
    checks = check_run(np.array([0.5]), np.tile(some, copies), **SOUND)
    assert checks.deep_contacts == pytest.approx(deep / 1000)
    assert (checks.problems == ()) is passed


def test_that_one_contact_at_which_particles_pass_through_each_other_fails_a_run() -> None:
    some = np.append(np.full(10_000, 0.001), 0.11)
    assert [*map(str, check_run(np.array([0.5]), some, **SOUND).problems)] == [
        "Particles overlap by up to 11.0 % of the mean diameter."
    ]


def test_that_a_filling_is_as_solid_as_its_volume_over_the_cylinder_s(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=400))
    n, top = len(prepared), 0.028
    heights = np.linspace(0.0, top, n) - prepared.diameters / 2
    points = np.column_stack([np.zeros((n, 2)), heights])
    turns = np.tile([1.0, 0, 0, 0], (n, 1))
    height, share = measure_filling(
        prepared, ParticleState(points, prepared.diameters, turns, prepared.class_index)
    )
    assert height == pytest.approx(0.98 * top, rel=1e-3)
    assert share == pytest.approx(0.015 / 3075 / (np.pi * 0.01**2 * height))
