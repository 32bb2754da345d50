"""The solvers that are stepped from here, against theory: mass, inertia, friction, restitution, energy."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.engine import MASS
from regolith_studio.dem.engines import ENGINES
from regolith_studio.dem.initial_packing import enclosing_radii, loose_column
from regolith_studio.dem.verification import scenes
from regolith_studio.dem.verification.bodies import cuboid, scene
from regolith_studio.dem.verification.certificate import verifiable_engine
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.steps import result_of

KEYS = [key for key in ("mujoco", "rapier", "box3d") if ENGINES[key].find().there]


def solver_of(key: str, prepared: PreparedCase) -> Any:
    engine = verifiable_engine(key)
    return engine.solver(prepared, engine.Settings())


def masses_and_moments(key: str, solver: Any) -> tuple[FloatArray, FloatArray]:
    """Of all particles, shape (n,) and (n, 3)."""
    if key == "mujoco":
        bodies = np.flatnonzero(solver.model.body_jntnum == 1)
        return solver.model.body_mass[bodies], solver.model.body_inertia[bodies]
    if key == "box3d":
        return solver.masses, np.linalg.eigvalsh(solver.inertias)
    moments = [body.mass_properties.principal_inertia.to_tuple() for body in solver.particles]
    return np.array([body.mass for body in solver.particles]), np.array(moments)


@pytest.mark.parametrize("key", KEYS)
def test_that_bodies_have_the_mass_and_inertia_of_their_polyhedra_where_the_packing_has_them(
    boxes: Dataset, key: str
) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=60, seed=2))
    solver, length = solver_of(key, prepared), prepared.mean_diameter
    volumes = np.pi / 6 * (prepared.diameters / length) ** 3
    edges = np.array([[1, 1, 1], np.array([3, 2, 1.5]) / 9 ** (1 / 3)])[prepared.class_index]
    squares = (edges * (volumes ** (1 / 3))[:, None]) ** 2
    inertia = volumes[:, None] / 12 * (squares.sum(axis=1)[:, None] - squares)
    masses, moments = masses_and_moments(key, solver)
    assert masses == pytest.approx(volumes, rel=1e-5)
    assert np.sort(moments, axis=1) == pytest.approx(np.sort(inertia, axis=1), rel=1e-5)
    column = loose_column(prepared)
    assert solver.points == pytest.approx(column.points / length, rel=1e-5, abs=1e-5)
    assert solver.orientations == pytest.approx(column.orientations, abs=1e-6)
    assert solver.top + 1e-5 > (column.points[:, 2] + enclosing_radii(prepared)).max() / length


@pytest.mark.parametrize("key", KEYS)
def test_that_energies_are_those_of_a_fall_and_a_state_goes_on(key: str) -> None:
    """Bodies at 30 d that fall for sqrt(d/g): 30 m g d before, and 1/2 m g d of motion."""
    prepared = scene([cuboid(1, 1, 1)], 0.5, 2)
    solver, again = (solver_of(key, prepared) for _ in range(2))
    solver.begin("rest")
    solver.place(np.array([[0.0, 0.0, 30.0], [9.0, 0.0, 30.0]]), np.tile([1.0, 0.0, 0.0, 0.0], (2, 1)))
    solver.advance(0.01, 100)
    potential, kinetic = (energy / MASS / 2 for energy in solver.energies())
    assert kinetic == pytest.approx(0.5, rel=0.03)
    assert potential + kinetic == pytest.approx(30.0, rel=1e-3)
    again.phase = solver.phase
    again.load(solver.state())
    assert again.time == solver.time
    for each in (solver, again):
        each.advance(0.01, 100)
    assert np.abs(again.points - solver.points).max() < 1e-5


@pytest.mark.parametrize("key", [key for key in KEYS if key != "mujoco"])
@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.6, 0.9])
def test_that_a_ball_rebounds_with_the_restitution_that_is_set(key: str, restitution: float) -> None:
    """It falls by two diameters, and rises again by the square of the restitution of that."""
    prepared = scene([cuboid(1, 1, 1)], 0.5, 1)
    contact = replace(prepared.case.contact, restitution=restitution)
    ball = replace(prepared, case=replace(prepared.case, contact=contact, shapes="spheres"))
    solver = solver_of(key, ball)
    solver.begin("rest")
    solver.place(np.array([[0.0, 0.0, 2.5]]), np.array([[1.0, 0.0, 0.0, 0.0]]))
    solver.advance(0.01, 205)
    heights = [solver.points[0, 2]]
    for _ in range(300):
        solver.advance(0.01, 1)
        heights.append(solver.points[0, 2])
    assert np.sqrt(max(max(heights) - 0.5, 0.0) / 2.0) == pytest.approx(restitution, abs=0.05)


@pytest.mark.parametrize("key", KEYS)
def test_that_slabs_feel_their_friction_within_two_percent_and_slide_at_its_angle(key: str) -> None:
    assert result_of(scenes.sliding(ENGINES[key])).passed
    assert key == "mujoco" or result_of(scenes.incline(ENGINES[key])).passed


def pull_apart(key: str, solver: Any, force: float) -> None:
    """Two particles along x, for a step."""
    for k, sign in enumerate((-1.0, 1.0)):
        if key == "mujoco":
            solver.data.qfrc_applied.reshape(-1, 6)[k, 0] = sign * force
        else:
            from robox3d._ffi import lib

            lib.b3Body_ApplyForceToCenter(solver.particles[k], (sign * force, 0.0, 0.0), True)
    solver.advance(solver.settings.time_step, 1)


@pytest.mark.parametrize("key", [key for key in KEYS if key != "rapier"])
@pytest.mark.parametrize("shapes", ["polyhedra", "spheres"])
@pytest.mark.parametrize("bond", [1.0, pytest.param(10.0, marks=pytest.mark.slow)])
def test_that_a_doublet_parts_at_its_pull_off_force(key: str, shapes: Any, bond: float) -> None:
    """Two cubes or balls without gravity, pulled apart by 0.95 and 1.05 of Bond number times weight."""
    prepared = scene([cuboid(1, 1, 1)], 0.5, 2)
    case = replace(prepared.case, shapes=shapes, bond_number=bond)
    side = (np.pi / 6) ** (1 / 3) if shapes == "polyhedra" else 1.0
    for share, parted in ((0.95, False), (1.05, True)):
        solver = solver_of(key, replace(prepared, case=case))
        solver.begin("rest")
        solver.set_gravity(np.zeros(3))
        solver.place(np.array([[0.0, 0.0, 10.0], [side, 0.0, 10.0]]), np.tile([1.0, 0.0, 0.0, 0.0], (2, 1)))
        solver.advance(solver.settings.time_step, 20)
        for _ in range(800 if key == "mujoco" else 400):
            pull_apart(key, solver, share * bond * MASS)
        gap = float(np.linalg.norm(np.diff(solver.points, axis=0))) - side
        assert bool(gap > 1.0) is parted
        assert gap > -0.05
