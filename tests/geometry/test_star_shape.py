"""The proof that a mesh is star-shaped, against rays that are cast and triangles that are compared."""

import numpy as np
import pytest

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import inspect, is_star_shaped
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.geometry.self_intersection import count_self_intersections
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere

BALL = icosphere(3)


def rough(seed, level=3, spread=0.4):
    """A ball with random radii: star-shaped about the origin."""
    ball = icosphere(level)
    radii = np.exp(np.random.default_rng(seed).normal(0.0, spread, len(ball.vertices)))
    return Mesh(ball.vertices * radii[:, None], ball.faces)


def star_shaped(mesh, point=(0.0, 0.0, 0.0)):
    return is_star_shaped(mesh.vertices, mesh.faces, point)


@pytest.mark.parametrize("seed", range(5))
def test_that_a_ball_with_random_radii_is_star_shaped_and_crosses_nothing(seed):
    mesh = rough(seed)
    assert star_shaped(mesh)
    hits = radial_hits(mesh, np.zeros(3), fibonacci_directions(2_000))
    assert np.array_equal(hits.ray, np.arange(2_000))
    assert (hits.sign == 1).all()
    assert count_self_intersections(mesh.vertices, mesh.faces) == 0 == inspect(mesh).self_intersections


@pytest.mark.parametrize("seed", range(5))
def test_that_a_point_sees_all_exactly_where_every_ray_leaves_once(seed):
    mesh = rough(seed, level=1, spread=0.15)
    for point in np.random.default_rng(seed).uniform(-0.8, 0.8, (40, 3)):
        hits = radial_hits(mesh, point, fibonacci_directions(20_000))
        once = len(hits.ray) == 20_000 and bool((hits.sign == 1).all())
        assert star_shaped(mesh, point) <= once
        if star_shaped(mesh, point) != once:  # a sliver between two rays
            corners = mesh.triangles - point
            seen = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
            assert seen.min() <= 0.0


def test_that_a_point_outside_sees_nothing_of_it_all():
    assert not star_shaped(BALL, (1.5, 0.0, 0.0))


def test_that_an_inside_out_ball_is_not_star_shaped():
    assert not star_shaped(Mesh(BALL.vertices, BALL.faces[:, ::-1]))


def test_that_a_direction_that_is_covered_twice_is_noticed():
    twice = Mesh(
        np.concatenate([BALL.vertices, 2.0 * BALL.vertices]),
        np.concatenate([BALL.faces, BALL.faces + len(BALL.vertices)]),
    )
    assert not star_shaped(twice)


def test_that_crossings_of_a_ball_turned_through_itself_are_still_counted():
    vertices = BALL.vertices.copy()
    vertices[0] *= -1.5
    mesh = Mesh(vertices, BALL.faces)
    assert inspect(mesh).self_intersections == count_self_intersections(vertices, BALL.faces) > 0


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("shift", [0.0, 1e3])
def test_that_health_does_not_depend_on_place_and_size(scale, shift):
    mesh = rough(3).moved(shift=(shift, 0.0, 0.0), scale=scale)
    health = inspect(mesh)
    assert health.sound
    assert health.self_intersections == 0
    assert not health.problems
