"""Compounds in solvers: one body of several convex parts, with mass and inertia of their union."""

import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.engines import ENGINES
from regolith_studio.dem.engines.lammps.script import clump_shape
from regolith_studio.dem.run_io import read_shapes, save_shapes
from regolith_studio.dem.verification.certificate import verifiable_engine
from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.steps import result_of
from tests.dataset.example import Coarse, cuboid, elbow_entry, elbow_moments, entry
from tests.geometry.solids import rotation
from tests.tolerance import relative

CASE = ReposeCase(n_particles=40, test=LiftingCylinderTest(diameter=0.04, height=0.2))
SOLVERS = [key for key in ("mujoco", "rapier", "box3d") if ENGINES[key].find().there]
UNTURNED = np.tile([1.0, 0.0, 0.0, 0.0], (40, 1))
ASIDE = np.column_stack([20.0 * np.arange(40.0), np.zeros(40), np.full(40, 500.0)])
"""Places so far apart that nothing touches."""


@pytest.fixture(scope="module")
def prepared(elbows: Dataset) -> PreparedCase:
    return prepare(elbows, CASE)


def solver_of(key: str, prepared: PreparedCase) -> Any:
    engine = verifiable_engine(key)
    solver = engine.solver(prepared, engine.Settings())
    solver.begin("settle")
    return solver


def test_that_a_body_of_mujoco_has_mass_and_inertia_of_the_union(prepared: PreparedCase) -> None:
    model = solver_of("mujoco", prepared).model
    bodies = np.flatnonzero(model.body_jntnum == 1)
    volumes = np.pi / 6 * (prepared.diameters / prepared.mean_diameter) ** 3
    assert model.body_mass[bodies] == pytest.approx(volumes)
    for k in np.flatnonzero(prepared.class_index == 0).tolist():
        expected = elbow_moments() * volumes[k] ** (5 / 3)
        assert np.sort(model.body_inertia[bodies[k]]) == relative(expected, rel=1e-9)
        assert model.body_ipos[bodies[k]] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_that_rapier_turns_an_elbow_about_the_axes_of_its_union(prepared: PreparedCase) -> None:
    """The angular velocity after a torque impulse is that of the tensor of inertia."""
    k = int(np.flatnonzero(prepared.class_index == 0)[0])
    body = solver_of("rapier", prepared).particles[k]
    turn = Rotation.from_quat(body.rotation.quaternion).as_matrix()
    size = prepared.scales[k] / prepared.mean_diameter
    inertia = turn @ (prepared.inertias[0] * size**5) @ turn.T
    impulse = np.array([0.1, 0.2, -0.3])
    body.apply_torque_impulse(tuple(impulse.tolist()), True)
    assert body.angvel.to_tuple() == pytest.approx(np.linalg.solve(inertia, impulse), rel=1e-4)
    assert body.mass == pytest.approx(size**3, rel=1e-5)
    assert body.local_center_of_mass.to_tuple() == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(("key", "dearer"), [("mujoco", 1.37), ("rapier", 2.5)])
def test_that_the_time_of_a_heap_grows_with_the_parts_as_it_was_measured(key: str, dearer: float) -> None:
    """Processor time of 150 (MuJoCo) and 300 (Rapier) agglutinates of four parts over that of convex ones."""
    convex = prepare(build_dataset([entry(1)], name="convex"), CASE)
    four = replace(convex, parts=((2, 2, 2, len(convex.shapes[0]) - 6),))
    engine = ENGINES[key]
    one, more = (engine.seconds(each, engine.Settings()) - 1.0 for each in (convex, four))
    assert more / one == pytest.approx(dearer, rel=0.1)
    assert replace(four, case=replace(CASE, shapes="spheres")).further_parts == 0.0


@pytest.mark.parametrize("key", SOLVERS)
def test_that_parts_of_one_body_do_not_touch_each_other(prepared: PreparedCase, key: str) -> None:
    """The parts of an elbow share a corner; far from others it falls freely and does not turn."""
    solver = solver_of(key, prepared)
    solver.place(ASIDE, UNTURNED)
    solver.advance(0.01, 50)
    assert ASIDE - solver.points == pytest.approx(np.tile([0.0, 0.0, 0.125], (40, 1)), abs=4e-3)
    assert solver.orientations == pytest.approx(UNTURNED, abs=1e-6)


@pytest.mark.parametrize("key", SOLVERS)
def test_that_a_cube_between_the_bars_of_an_elbow_touches_nothing(key: str) -> None:
    """It lies within the convex hull, where it would overlap if the elbow were that; within a bar it does."""
    cube = cuboid(0.5, 0.5, 0.5)
    pair = [elbow_entry(), (Particle("cube", cube.mesh), Coarse(cube, np.zeros(3)))]
    dataset = build_dataset(pair, name="pair")
    prepared = prepare(dataset, CASE)
    solver, frame = solver_of(key, prepared), dataset.representatives[0].frame
    outer, inner = (int(np.flatnonzero(prepared.class_index == kind)[0]) for kind in (0, 1))

    def touches(*place: float) -> bool:
        own = frame.rotation @ (rotation(5) @ place - frame.centroid) / frame.scale
        points = ASIDE.copy()
        points[inner] = points[outer] + own * prepared.scales[outer] / prepared.mean_diameter
        solver.place(points, UNTURNED)
        solver.advance(1e-4, 1)
        return bool((solver.overlaps() > 0.0).any())

    assert not touches(3.2, 3.2, 0.5)
    assert touches(1.0, 4.0, 0.5)
    assert touches(4.0, 1.0, 0.5)


def test_that_a_part_thinner_than_rounded_edges_is_refused() -> None:
    simulation = pytest.importorskip("regolith_studio.dem.engines.rapier.simulation")
    with pytest.raises(InputError, match="so thin that nothing is left within Rapier's rounded edges"):
        simulation.inner_parallel_body(cuboid(6.0, 6.0, 0.02).vertices, 0.011)


def test_that_the_shapes_of_a_run_keep_their_parts(prepared: PreparedCase, tmp_path: Path) -> None:
    save_shapes(tmp_path, pickle.loads(pickle.dumps(prepared)))
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


@pytest.mark.slow
@pytest.mark.parametrize("key", [*SOLVERS, "lammps"])
def test_that_elbows_fill_the_cylinder_and_come_to_rest(prepared: PreparedCase, key: str) -> None:
    engine, settings = ENGINES[key], ENGINES[key].Settings()
    if problem := engine.find().problem:
        pytest.skip(problem)
    if key == "lammps":
        test = LiftingCylinderTest(mass=0.003, lift_speed=0.3)
        elbows = build_dataset([elbow_entry()], name="elbows")
        checks = result_of(
            engine.simulate(prepare(elbows, ReposeCase(test, n_particles=40)), settings)
        ).checks
    else:
        settings = replace(settings, time_step=0.03, snapshots=5)
        checks = result_of(engine.simulate(prepared, settings)).checks
        assert checks.max_overlap < 0.1
    assert checks.at_rest
    assert checks.particles_out == 40
    assert 0.2 < checks.solid_fraction < 0.7
