"""The model that MuJoCo gets: masses, inertia, places, units."""

from functools import partial
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from benchmarks.sliding_friction import FRICTION, SEEDS, TUMBLED, slide
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import ContactParameters
from regolith_studio.dem.case import ReposeCase, prepare
from regolith_studio.dem.engines.mujoco import ENGINE, simulation
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
from regolith_studio.dem.engines.mujoco.simulation import (
    PARTICLE,
    PLATE,
    WALL,
    build_model,
)
from regolith_studio.dem.lifting_cylinder import N_WALLS
from regolith_studio.dem.verification import scenes
from regolith_studio.steps import result_of


def test_that_particles_feel_half_their_friction_while_they_are_filled_in_only(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=60, contact=ContactParameters(static_friction=0.6)))
    solver = simulation.MujocoSolver(prepared, MujocoSettings(fill_friction=0.5))
    felt = {}
    for phase in ("fill", "settle", "lift"):
        solver.begin(phase)
        kinds = solver.model.geom_contype
        felt[phase] = [set(solver.model.geom_friction[kinds == kind, 0]) for kind in (PARTICLE, WALL, PLATE)]
    assert felt == {
        "fill": [{0.3}, {0.3}, {0.8}],
        "settle": [{0.6}, {0.3}, {0.8}],
        "lift": [{0.6}, {0.3}, {0.8}],
    }


def test_that_mujoco_goes_on_with_the_friction_of_the_phase(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=60, contact=ContactParameters(static_friction=0.6)))
    solver, other = (simulation.MujocoSolver(prepared, MujocoSettings()) for _ in range(2))
    solver.begin("fill")
    other.phase = "fill"
    other.load(solver.state())
    assert (other.model.geom_friction == solver.model.geom_friction).all()


def test_that_the_cylinder_is_round_and_as_wide_as_asked(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=60))
    built = build_model(prepared, MujocoSettings())
    assert len(built.walls) == N_WALLS
    places, sizes = built.model.geom_pos[built.walls], built.model.geom_size[built.walls]
    inner = np.hypot(places[:, 0], places[:, 1]) - sizes[:, 0]
    assert inner == pytest.approx(0.01 / prepared.mean_diameter)
    assert built.model.opt.gravity == pytest.approx([0, 0, -1])


def test_that_rolling_resistance_opens_the_dimensions_of_a_contact(boxes: Dataset) -> None:
    case = ReposeCase(contact=ContactParameters(rolling_friction=0.2), n_particles=60)
    assert set(build_model(prepare(boxes, case), MujocoSettings()).model.geom_condim) == {6}
    assert set(
        build_model(prepare(boxes, ReposeCase(n_particles=60)), MujocoSettings()).model.geom_condim
    ) == {3}


def test_that_a_moving_wall_drags_what_touches_it() -> None:
    """The sign of geom_surfacevel: a surface that moves up pulls a body up with it."""
    spec = mujoco.MjSpec()
    wall = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    wall.surfacevel = [0.5, 0, 0, 0, 0, 0]
    body = spec.worldbody.add_body(pos=[0, 0, 0.1])
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.1, 0.1], density=1000)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    assert data.qvel[0] == pytest.approx(0.5, abs=0.05)


@pytest.mark.slow
def test_that_the_memory_for_contacts_grows_with_the_number_and_not_with_its_square(boxes: Dataset) -> None:
    small, large = (
        build_model(prepare(boxes, ReposeCase(n_particles=n)), MujocoSettings()).model.narena
        for n in (500, 2000)
    )
    assert large < 4 * small
    assert 100_000 * 2000 < large < 1e9


@pytest.mark.slow
def test_that_grains_which_slide_fast_feel_the_friction_that_is_set(monkeypatch: pytest.MonkeyPatch) -> None:
    """Coulomb's law on a slope of 50 degrees: boxes that stay flat feel it, those that tumble roll in part.

    With one step for all speeds all bounce, tumble and feel less.
    """
    felt, turn, brick, steps = map(list, zip(*(slide(50.0, seed) for seed in SEEDS), strict=True))
    flat = np.concatenate(felt)[np.concatenate(turn) < TUMBLED]
    assert flat.mean() == pytest.approx(FRICTION, abs=0.01)
    assert flat.std() < 0.02
    assert np.concatenate(felt)[np.concatenate(brick)].mean() == pytest.approx(FRICTION, abs=0.01)
    assert np.mean(felt) == pytest.approx(FRICTION, abs=0.03)
    assert all(min(each) < max(each) == MujocoSettings().time_step for each in steps)
    monkeypatch.setattr(simulation, "MAX_MOVE", 1.0)
    assert np.mean([slide(50.0, seed)[0] for seed in SEEDS]) < 0.75


@pytest.mark.slow
def test_that_cubes_slide_flat_where_a_contact_takes_four_steps() -> None:
    """A rigid cube does not topple while friction is below 1; contacts of two steps turn some over."""
    _, turn, brick, _ = slide(39.66, 2)
    assert turn[brick].max() < TUMBLED < turn[~brick].max()
    felt, turn, _, _ = slide(39.66, 2, None, MujocoSettings(contact_steps=4))
    assert turn.max() < TUMBLED
    assert felt.mean() == pytest.approx(FRICTION, abs=0.02)


@pytest.mark.slow
def test_that_slabs_hold_up_to_the_angle_of_friction_with_softer_contacts_and_a_finer_solution() -> None:
    finer = partial(MujocoSettings, contact_steps=4, tolerance=1e-8)
    engine: Any = SimpleNamespace(Settings=finer, solver=ENGINE.solver)
    usual, tilt = (result_of(scenes.incline(each)) for each in (ENGINE, engine))
    assert (usual.value, tilt.value) == (1.0, 0.2)
    assert tilt.passed
    assert result_of(scenes.fall(engine)).value == pytest.approx(0.04, abs=0.005)


def test_that_a_run_says_which_steps_it_took(boxes: Dataset) -> None:
    prepared, settings = prepare(boxes, ReposeCase(n_particles=120, seed=2)), MujocoSettings()
    solver = simulation.MujocoSolver(prepared, settings)
    solver.data.qvel.reshape(-1, 6)[:, 0] = 0.5
    assert solver.time_step() == settings.time_step  # a fall
    solver.begin("lift")
    assert solver.time_step() == settings.time_step / 2
    solver.data.qvel.reshape(-1, 6)[:, 0] = 1e3
    assert solver.time_step() == settings.time_step / 8
    assert "0.025 (75.0 %); 0.0125 (25.0 %)" in solver.notes({0.025: 3.0, 0.0125: 1.0})[0]
