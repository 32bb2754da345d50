"""Compounds on Rapier: one body of several convex parts, with mass and inertia of their union."""

import numpy as np
import pytest

pytest.importorskip("rapier3d")

from rapier3d import Rotation3, Vec3
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.engines.rapier.simulation import RapierSolver, inner_parallel_body
from regolith_studio.dem.lifting_cylinder import SubstepSettings
from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from tests.dataset.example import Coarse, cuboid, elbow_entry, elbow_moments
from tests.geometry.solids import rotation
from tests.tolerance import relative

CASE = ReposeCase(n_particles=40, test=LiftingCylinderTest(diameter=0.04, height=0.2))


@pytest.fixture(scope="module")
def prepared(elbows: Dataset) -> PreparedCase:
    return prepare(elbows, CASE)


def test_that_rapier_gives_a_body_mass_and_inertia_of_the_union(prepared: PreparedCase) -> None:
    bodies = RapierSolver(prepared, SubstepSettings()).particles
    volumes = np.pi / 6 * (prepared.diameters / prepared.mean_diameter) ** 3
    assert [body.mass for body in bodies] == pytest.approx(volumes.tolist(), rel=1e-5)
    for k in np.flatnonzero(prepared.class_index == 0).tolist():
        moments = np.sort(bodies[k].mass_properties.principal_inertia.to_tuple())
        assert moments == relative(elbow_moments() * volumes[k] ** (5 / 3), rel=1e-5)
        assert bodies[k].local_center_of_mass.to_tuple() == (0.0, 0.0, 0.0)


def test_that_rapier_turns_an_elbow_about_the_axes_of_its_union(prepared: PreparedCase) -> None:
    """The angular velocity after a torque impulse is that of the tensor of inertia."""
    k = int(np.flatnonzero(prepared.class_index == 0)[0])
    body = RapierSolver(prepared, SubstepSettings()).particles[k]
    turn = Rotation.from_quat(body.rotation.quaternion).as_matrix()
    size = prepared.scales[k] / prepared.mean_diameter
    inertia = turn @ (prepared.inertias[0] * size**5) @ turn.T
    impulse = np.array([0.1, 0.2, -0.3])
    body.apply_torque_impulse(tuple(impulse.tolist()), True)
    assert body.angvel.to_tuple() == pytest.approx(np.linalg.solve(inertia, impulse), rel=1e-4)


def test_that_parts_of_one_body_do_not_touch_each_other_on_rapier(elbows: Dataset) -> None:
    """The parts of an elbow share a corner; far from others it falls freely and does not turn."""
    solver = RapierSolver(prepare(elbows, CASE), SubstepSettings())
    for k, body in enumerate(solver.particles):
        body.translation = Vec3(20.0 * k, 0.0, 500.0)
    solver.begin("settle")
    solver.advance(0.01, 50)
    assert all(pair.manifolds == [] for pair in solver.world.narrow_phase.contact_pairs())
    for body in solver.particles:
        assert body.angvel.to_tuple() == (0.0, 0.0, 0.0)
        assert body.linvel.z == pytest.approx(-0.5, rel=1e-5)


def test_that_rapier_lets_a_cube_between_the_bars_of_an_elbow() -> None:
    """It lies within the convex hull, where it would overlap if the elbow were that; within a bar it does."""
    cube = cuboid(0.5, 0.5, 0.5)
    pair = [elbow_entry(), (Particle("cube", cube.mesh), Coarse(cube, np.zeros(3)))]
    dataset = build_dataset(pair, name="pair")
    solver = RapierSolver(prepare(dataset, CASE), SubstepSettings())
    kinds, frame = solver.prepared.class_index, dataset.representatives[0].frame
    outer, inner = int(np.flatnonzero(kinds == 0)[0]), int(np.flatnonzero(kinds == 1)[0])
    for k, body in enumerate(solver.particles):
        body.translation, body.rotation = Vec3(20.0 * k, 0.0, 500.0), Rotation3.identity()

    def overlaps_at(place: tuple[float, float, float]) -> bool:
        own = frame.rotation @ (rotation(5) @ place - frame.centroid) / frame.scale
        middle = np.array([0.0, 0.0, 50.0])
        solver.particles[outer].translation = Vec3(*middle.tolist())
        reach = middle + own * solver.prepared.scales[outer] / solver.unit_length
        solver.particles[inner].translation = Vec3(*reach.tolist())
        solver.world.step()
        pairs = solver.world.narrow_phase.contact_pairs()
        touching = any(point.dist < 0.0 for pair in pairs for each in pair.manifolds for point in each.points)
        assert touching == (len(solver.overlaps()) > 0)
        return touching

    assert not overlaps_at((3.2, 3.2, 0.5))
    assert overlaps_at((1.0, 4.0, 0.5))
    assert overlaps_at((4.0, 1.0, 0.5))


def test_that_a_part_thinner_than_rounded_edges_is_refused() -> None:
    plate = cuboid(6.0, 6.0, 0.02)
    with pytest.raises(InputError, match="so thin that nothing is left within Rapier's rounded edges"):
        inner_parallel_body(plate.vertices, 0.011)
