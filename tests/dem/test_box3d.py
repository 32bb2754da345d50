"""Box3D as an engine, against theory: friction between two coefficients, rolling resistance, restitution."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

pytest.importorskip("robox3d")


from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engines.box3d.simulation import Box3dSolver
from regolith_studio.dem.lifting_cylinder import SubstepSettings
from regolith_studio.dem.verification.bodies import cuboid, lowest_heights, random_polyhedron, scene
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray


def on_slope(prepared: PreparedCase, slope: float, heights: FloatArray) -> Box3dSolver:
    """Bodies at rest on a slope down x, `slope` in radians."""
    solver = Box3dSolver(prepared, SubstepSettings())
    n = len(prepared)
    solver.begin("rest")
    places = np.column_stack([np.zeros(n), 3.0 * np.arange(n), heights])
    solver.place(places, np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)))
    solver.set_gravity(np.array([np.sin(slope), 0.0, -np.cos(slope)]))
    return solver


def with_values(prepared: PreparedCase, **values: float) -> PreparedCase:
    """The case with other contact or test parameters."""
    case = prepared.case
    test = {name: value for name, value in values.items() if name in case.test.__dataclass_fields__}
    contact = {name: value for name, value in values.items() if name not in test}
    return replace(
        prepared,
        case=replace(case, test=replace(case.test, **test), contact=replace(case.contact, **contact)),
    )


@pytest.mark.parametrize("friction", [0.2, 0.8])
def test_that_the_plate_has_a_friction_of_its_own(friction: float) -> None:
    """Box3D takes the geometric mean of two coefficients; boxes of 0.6 feel the plate's."""
    prepared = with_values(scene([cuboid(2, 2, 1)], 0.6, 4), plate_friction=friction)
    slope = np.radians(50.0)
    solver = on_slope(prepared, slope, lowest_heights(prepared))
    solver.advance(0.05, 100)
    half = solver.points.copy()
    solver.advance(0.05, 100)
    acceleration = (solver.points - half)[:, 0].mean() * 8 / 3 / solver.time**2
    assert np.tan(slope) - acceleration / np.cos(slope) == pytest.approx(friction, rel=0.01)


@pytest.mark.parametrize("rolling", [0.1, 0.3])
def test_that_rolling_balls_speed_up_beyond_the_angle_of_rolling_resistance_and_stop_below(
    rolling: float,
) -> None:
    """A resisting torque of c R N slows a ball on slopes below arctan c."""
    prepared = with_values(scene([cuboid(1, 1, 1)], 0.8, 4), rolling_friction=rolling)
    balls = replace(prepared, case=replace(prepared.case, shapes="spheres"))
    speeds = []
    for offset in (-2.0, 2.0):
        slope = float(np.arctan(rolling) + np.radians(offset))
        solver = on_slope(balls, slope, np.full(4, 0.5))
        rolls = np.tile([0.3, 0.0, 0.0, 0.0, 0.6, 0.0], (4, 1))
        solver._move(solver._poses(), rolls)
        solver.advance(0.05, 400)
        speeds.append(solver._velocities()[:, 0])
    assert np.abs(speeds[0]).max() < 1e-3
    expected = 0.3 + 20.0 * (np.sin(slope) - rolling * np.cos(slope)) / 1.4
    assert speeds[1] == pytest.approx(expected, rel=0.02)


def test_that_the_kinetic_energy_is_that_of_spinning_bodies() -> None:
    """In the solver's units, where the mass of a body is pi/6."""
    prepared = scene([random_polyhedron(3)], 0.5, 2)
    solver = on_slope(prepared, 0.0, np.full(2, 30.0))
    fast = np.zeros((2, 6))
    fast[:, 3:] = (0.3, -0.2, 0.5)
    turns = Rotation.random(2, random_state=4).as_quat()
    solver._move(np.column_stack([np.full((2, 3), 30.0), turns]), fast)
    mesh = random_polyhedron(3).mesh
    inertia = mesh.inertia / mesh.volume ** (5 / 3) * (np.pi / 6) ** (5 / 3)
    spins = Rotation.from_quat(turns).apply(fast[:, 3:], inverse=True)
    expected = 0.5 * np.einsum("ni,ij,nj->", spins, inertia, spins)
    assert solver.energies()[1] == pytest.approx(expected, rel=1e-3)


def test_that_vertices_which_single_precision_cannot_tell_apart_are_one() -> None:
    """Four planes of a coarsened particle may meet in two vertices 1e-10 apart."""
    shape = random_polyhedron(3)
    prepared = scene([shape], 0.5, 1)
    (vertices,) = prepared.shapes
    doubled = np.vstack([vertices, vertices[0] + 1e-10])
    solver = Box3dSolver(replace(prepared, shapes=(doubled,)), SubstepSettings())
    assert solver.masses == pytest.approx([np.pi / 6])
    with pytest.raises(InputError, match="makes no hull of a polyhedron of 8 vertices"):
        Box3dSolver(replace(prepared, shapes=(1e-6 * cuboid(1, 1, 1).vertices,)), SubstepSettings())
