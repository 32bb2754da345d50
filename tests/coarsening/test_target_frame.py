"""One frame for a particle wherever it lies, and overlap by rays on needles."""

from collections.abc import Callable

import manifold3d
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.core.polyhedron_measures import polyhedron_of
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere
from regolith_studio.readers.particles import sample_particles


def rough_ball(noise: float) -> Mesh:
    ball = icosphere(4)
    random = np.random.default_rng(1).normal(size=(len(ball.vertices), 1))
    return Mesh(ball.vertices * (1.0 + noise * random), ball.faces)


def test_that_moved_turned_and_scaled_particles_have_one_frame() -> None:
    rng = np.random.default_rng(5)
    for particle in sample_particles():
        mesh = particle.mesh
        size = mesh.volume ** (1 / 3)
        there = Target.of(mesh)
        turned = mesh.moved(rotation=Rotation.random(random_state=int(rng.integers(1000))).as_matrix())
        other = Target.of(turned.moved(scale=1.7, shift=10.0 * size * rng.normal(size=3)))
        assert np.array_equal(other.mesh.vertices, there.mesh.vertices)


@pytest.mark.slow
def test_that_a_moved_turned_and_scaled_particle_has_the_same_polyhedron(particle: Mesh) -> None:
    turn = Rotation.random(random_state=3).as_matrix()
    here = coarsen(particle, 12)
    there = coarsen(particle.moved(rotation=turn, scale=0.3).moved(shift=np.array([900.0, -50.0, 3.0])), 12)
    assert there.jaccard_distance == here.jaccard_distance
    assert there.half_spaces is not None
    assert here.half_spaces is not None
    points = here.half_spaces.points @ turn.T * 0.3
    assert there.half_spaces.points == pytest.approx(points, abs=1e-9)


@pytest.mark.slow
def test_that_the_order_of_vertices_and_triangles_does_not_matter(particle: Mesh) -> None:
    rng = np.random.default_rng(6)
    order = rng.permutation(len(particle.vertices))
    faces = np.argsort(order)[particle.faces][rng.permutation(len(particle.faces))]
    shuffled = Mesh(particle.vertices[order], np.roll(faces, 1, axis=1))
    here, there = coarsen(particle, 12), coarsen(shuffled, 12)
    assert there.jaccard_distance == here.jaccard_distance
    assert there.half_spaces is not None
    assert here.half_spaces is not None
    assert there.half_spaces.points == pytest.approx(here.half_spaces.points, rel=1e-9)


def test_that_triangles_without_common_corners_and_unused_vertices_are_the_same_particle() -> None:
    for particle in sample_particles():
        mesh = particle.mesh
        corners = np.vstack([mesh.triangles.reshape(-1, 3), 3.0 * mesh.bounds[1]])
        soup = Mesh(corners, np.arange(3 * len(mesh.faces)).reshape(-1, 3))
        here, there = Target.of(mesh), Target.of(soup)
        assert np.array_equal(there.mesh.vertices, here.mesh.vertices)
        assert np.array_equal(there.mesh.faces, here.mesh.faces)
        assert there.descriptors == here.descriptors


@pytest.mark.parametrize("noise", [0.06, 0.12])
def test_that_the_overlap_of_a_rough_needle_is_that_of_the_ball_that_it_was(noise: float) -> None:
    ball, stretch = rough_ball(noise), np.array([20.0, 1.0, 1.0])
    normals = fibonacci_directions(20)
    round_planes = HalfSpaces(normals, np.ones(20))
    length = np.linalg.norm(normals / stretch, axis=1)
    long_planes = HalfSpaces(normals / stretch / length[:, None], 1.0 / length)

    def overlap(mesh: Mesh, planes: HalfSpaces) -> float:
        target = Target.of(mesh)
        shifted = planes.offsets - planes.normals @ target.centre
        return target.jaccard_distance(target.in_unit_frame(HalfSpaces(planes.normals, shifted)))

    needle = Mesh(ball.vertices * stretch, ball.faces)
    assert overlap(needle, long_planes) == pytest.approx(overlap(ball, round_planes), abs=2e-4)


def test_that_exact_is_1_where_all_constraints_are_met_and_else_0(particle: Mesh) -> None:
    met = coarsen(particle, 20)
    assert met.reason is None
    assert met.steps["exact"] == 1.0
    missed = coarsen(icosphere(2), 12, settings={"retries": 0})
    assert missed.reason is not None
    assert missed.steps["exact"] == 0.0
    cube = Mesh(np.vstack([np.eye(3), -np.eye(3)]), np.empty((0, 3), dtype=np.int64)).hull
    itself = coarsen(cube, 40)
    assert itself.steps["exact"] == float(max(itself.errors.values()) <= 1e-6)


def bent(body: Mesh) -> Mesh:
    x = body.vertices[:, :1]
    return Mesh(body.vertices + np.hstack([0.0 * x, 0.01 * x**2, 1.2 * np.sin(0.5 * x)]), body.faces)


@pytest.mark.parametrize("noise", [0.06, 0.12])
@pytest.mark.parametrize("shape", [lambda body: body, bent], ids=["straight", "bent"])
def test_that_rays_measure_rough_needles_as_a_boolean_does(
    shape: Callable[[Mesh], Mesh], noise: float
) -> None:
    ball = rough_ball(noise)
    target = Target.of(shape(Mesh(ball.vertices * (20.0, 1.0, 1.0), ball.faces)))
    rng = np.random.default_rng(3)
    directions = fibonacci_directions(20) * target.box.extents
    normals = directions / np.linalg.norm(directions, axis=1)[:, None] @ target.box.axes
    reach = np.abs(normals @ target.box.axes.T) @ target.box.extents
    planes = HalfSpaces(normals, rng.uniform(0.25, 0.4, 20) * reach)
    one, other = (
        manifold3d.Manifold(manifold3d.Mesh64(np.array(each.vertices), np.array(each.faces, dtype=np.uint64)))
        for each in (target.mesh, polyhedron_of(planes).mesh)
    )
    shared = (one ^ other).volume()
    distance = 1.0 - shared / (one.volume() + other.volume() - shared)
    assert target.jaccard_distance(planes) == pytest.approx(distance, abs=2e-3)
