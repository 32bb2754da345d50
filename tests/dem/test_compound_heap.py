"""Heaps of compounds: several convex bodies welded together, with mass and inertia of their union."""

import pickle
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.engine import SimulationResult
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.engines.lammps import ENGINE as LAMMPS
from regolith_studio.dem.engines.lammps.program import LammpsSettings
from regolith_studio.dem.engines.lammps.script import clump_shape
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
from regolith_studio.dem.engines.mujoco.simulation import build_model
from regolith_studio.dem.run_io import read_shapes, save_shapes
from regolith_studio.dem.snapshot import Snapshot
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.particle import Particle
from tests.dataset.example import Coarse, cuboid, elbow_entry, elbow_moments, entry
from tests.geometry.solids import rotation
from tests.tolerance import relative

CASE = ReposeCase(n_particles=40, test=LiftingCylinderTest(diameter=0.04, height=0.2))


@pytest.fixture(scope="module")
def prepared(elbows: Dataset) -> PreparedCase:
    return prepare(elbows, CASE)


def placed_corners(model: mujoco.MjModel, body: int) -> FloatArray:
    """Corners of all geoms of a body in its own frame, shape (k, 3)."""
    corners = []
    for geom in np.flatnonzero(model.geom_bodyid == body):
        mesh = model.geom_dataid[geom]
        first = model.mesh_vertadr[mesh]
        own = model.mesh_vert[first : first + model.mesh_vertnum[mesh]].astype(float)
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
        corners.append(own @ turn.reshape(3, 3).T + model.geom_pos[geom])
    return np.concatenate(corners)


def test_that_a_body_has_a_geom_a_part_and_mass_and_inertia_of_the_union(prepared: PreparedCase) -> None:
    model = build_model(prepared, MujocoSettings()).model
    bodies = np.flatnonzero(model.body_jntnum == 1)
    volumes = np.pi / 6 * (prepared.diameters / prepared.mean_diameter) ** 3
    assert model.body_geomnum[bodies].tolist() == np.where(prepared.class_index == 0, 2, 1).tolist()
    assert model.body_mass[bodies] == pytest.approx(volumes)
    for k in np.flatnonzero(prepared.class_index == 0).tolist():
        wanted = elbow_moments() * volumes[k] ** (5 / 3)
        assert np.sort(model.body_inertia[bodies[k]]) == relative(wanted, rel=1e-9)
        assert model.body_ipos[bodies[k]] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(("engine", "dearer"), [("mujoco", 1.37), ("rapier", 2.5)])
def test_that_the_time_of_a_heap_grows_with_the_parts_as_it_was_measured(engine: str, dearer: float) -> None:
    """Processor time of 150 (MuJoCo) and 300 (Rapier) agglutinates of four parts over that of convex ones."""
    convex = prepare(build_dataset([entry(1)], name="convex"), CASE)
    four = replace(convex, parts=((2, 2, 2, len(convex.shapes[0]) - 6),))
    chosen = engine_named(engine)
    one, more = (chosen.seconds(each, chosen.Settings()) - 1.0 for each in (convex, four))
    assert more / one == pytest.approx(dearer, rel=0.1)
    balls = replace(four, case=replace(CASE, shapes="spheres"))
    assert balls.further_parts == 0.0


def test_that_the_parts_of_a_body_lie_where_the_dataset_has_them(prepared: PreparedCase) -> None:
    model = build_model(prepared, MujocoSettings()).model
    body = int(np.flatnonzero(model.body_geomnum == 2)[0])
    scale = prepared.scales[body - 2] / prepared.mean_diameter
    assert prepared.class_index[body - 2] == 0
    apart = placed_corners(model, body)[:, None] - prepared.shapes[0][None] * scale
    assert np.linalg.norm(apart, axis=2).min(axis=1).max() < 1e-6


def test_that_a_cube_between_the_bars_of_an_elbow_touches_nothing() -> None:
    """It lies within the convex hull, where it would touch if the elbow were that; within a bar it does."""
    cube = cuboid(0.5, 0.5, 0.5)
    pair = [elbow_entry(), (Particle("cube", cube.mesh), Coarse(cube, np.zeros(3)))]
    dataset = build_dataset(pair, name="pair")
    prepared = prepare(dataset, CASE)
    model = build_model(prepared, MujocoSettings()).model
    data = mujoco.MjData(model)
    kinds, frame = prepared.class_index, dataset.representatives[0].frame
    outer, inner = int(np.flatnonzero(kinds == 0)[0]), int(np.flatnonzero(kinds == 1)[0])
    positions = data.qpos.reshape(-1, 7)
    positions[:, :3] += 1e3 * np.arange(len(positions))[:, None]

    def contacts(place: tuple[float, float, float]) -> int:
        own = frame.rotation @ (rotation(5) @ place - frame.centroid) / frame.scale
        middle = np.array([0.0, 0.0, 50.0])
        positions[outer] = [*middle, 1.0, 0.0, 0.0, 0.0]
        positions[inner, :3] = middle + own * prepared.scales[outer] / prepared.mean_diameter
        mujoco.mj_forward(model, data)
        return int(data.ncon)

    assert contacts((3.2, 3.2, 0.5)) == 0
    assert contacts((1.0, 4.0, 0.5)) > 0
    assert contacts((4.0, 1.0, 0.5)) > 0


def test_that_the_shapes_of_a_run_keep_their_parts(prepared: PreparedCase, tmp_path: Path) -> None:
    again = pickle.loads(pickle.dumps(prepared))
    save_shapes(tmp_path, again)
    shapes = read_shapes(tmp_path)
    assert [len(parts) for parts in shapes] == [2, 1]
    assert [len(part) for part in shapes[0]] == [8, 8]
    assert np.array_equal(np.concatenate(shapes[0]), prepared.shapes[0])


def test_that_the_spheres_of_lammps_fill_the_union_and_not_its_hull(prepared: PreparedCase) -> None:
    elbow = clump_shape(prepared.part_vertices[0], 30)
    assert np.linalg.eigvalsh(elbow.inertia) == pytest.approx(elbow_moments(), rel=1e-9)
    assert elbow.errors.volume == pytest.approx(0.0, abs=1e-3)
    assert elbow.errors.jaccard < 0.3
    frame = build_dataset([elbow_entry()]).representatives[0].frame
    between = frame.rotation @ (rotation(5) @ (4.0, 4.0, 0.5) - frame.centroid) / frame.scale
    apart = np.linalg.norm(elbow.spheres[:, :3] - between, axis=1) - elbow.spheres[:, 3]
    assert apart.min() > 0.5 / 20 ** (1 / 3)  # the middle of the corner between the bars is empty


def result_of(steps: Generator[Snapshot, None, SimulationResult]) -> SimulationResult:
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: SimulationResult = end.value
            return result


@pytest.mark.slow
def test_that_elbows_come_to_rest_on_lammps() -> None:
    if problem := LAMMPS.find().problem:
        pytest.skip(problem)
    case = ReposeCase(LiftingCylinderTest(mass=0.003, lift_speed=0.3), n_particles=40)
    elbows = build_dataset([elbow_entry()], name="elbows")
    checks = result_of(LAMMPS.simulate(prepare(elbows, case), LammpsSettings())).checks
    assert checks.at_rest
    assert checks.particles_out == 40
    assert 0.2 < checks.solid_fraction < 0.7


@pytest.mark.slow
@pytest.mark.parametrize("key", ["mujoco", "rapier"])
def test_that_elbows_fill_the_cylinder_and_come_to_rest(prepared: PreparedCase, key: str) -> None:
    engine = engine_named(key)
    settings = replace(engine.Settings(), time_step=0.03, snapshots=5)
    checks = result_of(engine.simulate(prepared, settings)).checks
    assert checks.at_rest
    assert checks.particles_out == len(prepared)
    assert checks.max_overlap < 0.1
    assert 0.2 < checks.solid_fraction < 0.7
