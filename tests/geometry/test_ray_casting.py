"""Rays from one origin: every crossing once, at the right distance."""

import pickle

import numpy as np
import pytest

from regolith_studio.geometry import Mesh
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.ray_casting import RadialHits, radial_hits
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere
from tests.geometry.solids import cuboid, folded_stone, random_polyhedron, rotation, rough_stone, tetrahedron


def winding(hits: RadialHits, n_rays: int) -> IntArray:
    """Sum of the signs of each ray."""
    return np.bincount(hits.ray, weights=hits.sign, minlength=n_rays).astype(np.int64)


def awkward_directions(mesh: Mesh, origin: FloatArray) -> FloatArray:
    """Exactly through vertices and, up to rounding, through edges; along the axes; nearly so."""
    corners = mesh.vertices - origin
    first, second = corners[mesh.faces[:, 0]], corners[mesh.faces[:, 1]]
    axes = np.vstack([np.eye(3), -np.eye(3)])
    beside = corners * (1.0 + 1e-15 * np.array([1.0, -2.0, 3.0]))
    return np.vstack([corners, first + second, 0.3 * first + 0.7 * second, axes, beside])


@pytest.mark.parametrize("level", [0, 1, 2, 3])
@pytest.mark.parametrize("origin", [(0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.2, -0.3, 0.05)])
def test_that_rays_through_vertices_and_edges_of_a_sphere_leave_it_once(
    level: int, origin: tuple[float, ...]
) -> None:
    sphere = icosphere(level)
    rays = awkward_directions(sphere, np.array(origin))
    hits = radial_hits(sphere, origin, rays)
    assert np.array_equal(hits.ray, np.arange(len(rays)))
    assert set(hits.sign) == {1}
    ends = origin + hits.distance[:, None] * rays / np.linalg.norm(rays, axis=1, keepdims=True)
    assert hits.distance[: len(sphere.vertices)] == pytest.approx(
        np.linalg.norm(sphere.vertices - origin, axis=1), rel=1e-12
    )
    assert np.linalg.norm(ends, axis=1).max() <= 1.0 + 1e-12


@pytest.mark.parametrize("seed", range(6))
def test_that_the_signs_of_every_ray_add_up_to_one_inside_and_to_zero_outside(seed: int) -> None:
    stone = folded_stone(seed)
    for origin, total in (((0.0, 0.0, 0.0), 1), ((5.0, 1.0, 0.0), 0)):
        rays = np.vstack([awkward_directions(stone, np.array(origin)), fibonacci_directions(3000)])
        hits = radial_hits(stone, origin, rays)
        assert set(winding(hits, len(rays))) == {total}


@pytest.mark.parametrize("solid", [cuboid(2.0, 2.0, 2.0), tetrahedron(3.0), random_polyhedron(3)])
@pytest.mark.parametrize("shift", [(0.0, 0.0, 0.0), (0.1, 0.2, -0.1)])
def test_that_large_faces_with_edges_through_the_axes_are_met_once(
    solid: Mesh, shift: tuple[float, ...]
) -> None:
    rays = np.vstack([awkward_directions(solid, np.array(shift)), fibonacci_directions(500)])
    assert np.array_equal(winding(radial_hits(solid, shift, rays), len(rays)), np.ones(len(rays)))


def test_that_faces_seen_edge_on_from_the_origin_do_not_disturb() -> None:
    near, far = cuboid(2.0, 2.0, 2.0), cuboid(1.0, 1.0, 1.0).moved(shift=(3.5, 0.5, 0.5))
    both = Mesh(np.vstack([near.vertices, far.vertices]), np.vstack([near.faces, far.faces + 8]))
    assert (both.vertices[8:, 1:].min(axis=0) == 0.0).all()
    rays = np.vstack([awkward_directions(both, np.zeros(3)), fibonacci_directions(500)])
    assert set(winding(radial_hits(both, (0.0, 0.0, 0.0), rays), len(rays))) == {1}


def test_that_a_shell_is_entered_and_left_in_the_order_of_distance() -> None:
    ball = icosphere(2)
    outer, inner = 3.0 * ball.vertices, 2.0 * ball.vertices
    n = len(ball.vertices)
    vertices = np.vstack([ball.vertices, inner, outer])
    shell = Mesh(vertices, np.vstack([ball.faces, ball.faces[:, ::-1] + n, ball.faces + 2 * n]))
    hits = radial_hits(shell, np.zeros(3), fibonacci_directions(400))
    assert np.array_equal(hits.sign.reshape(-1, 3), np.tile([1, -1, 1], (400, 1)))
    by_ray = hits.distance.reshape(-1, 3)
    assert by_ray[:, 1:] == pytest.approx(by_ray[:, :1] * [2.0, 3.0], rel=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_that_all_crossings_agree_with_trimesh(seed: int) -> None:
    pytest.importorskip("rtree", reason="trimesh casts rays with rtree")
    import trimesh

    stone = folded_stone(seed, level=2)
    rays = fibonacci_directions(200) @ rotation(seed).T
    hits = radial_hits(stone, np.zeros(3), rays)
    other = trimesh.Trimesh(stone.vertices, stone.faces, process=False)
    places, ray, _ = other.ray.intersects_location(np.zeros((200, 3)), rays, multiple_hits=True)
    distance = np.linalg.norm(places, axis=1)
    order = np.lexsort((distance, ray))
    assert np.array_equal(hits.ray, ray[order])
    assert hits.distance == pytest.approx(distance[order], rel=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_that_all_crossings_agree_with_a_plain_search(seed: int) -> None:
    stone, rays = folded_stone(seed, level=2), fibonacci_directions(300) @ rotation(seed).T
    corner, ab, ac = stone.triangles[:, 0], *(stone.triangles[:, k] - stone.triangles[:, 0] for k in (1, 2))
    across = np.cross(rays[:, None], ac[None])
    determinant = np.einsum("kfi,fi->kf", across, ab)
    u = -np.einsum("kfi,fi->kf", across, corner) / determinant
    other = np.cross(-corner, ab)
    v = np.einsum("ki,fi->kf", rays, other) / determinant
    t = np.einsum("fi,fi->f", ac, other) / determinant
    ray, face = np.nonzero((u > 0) & (v > 0) & (u + v < 1) & (t > 0))
    order = np.lexsort((t[ray, face], ray))
    hits = radial_hits(stone, np.zeros(3), rays)
    assert np.array_equal(hits.ray, ray[order])
    assert np.array_equal(hits.face, face[order])
    assert hits.distance == pytest.approx(t[ray, face][order], rel=1e-9)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_that_distances_scale_with_the_unit_and_not_with_the_directions(scale: float) -> None:
    stone, rays = rough_stone(1), fibonacci_directions(300)
    plain = radial_hits(stone, np.zeros(3), rays)
    scaled = radial_hits(stone.moved(scale=scale), np.zeros(3), rays * 7.0)
    assert np.array_equal(plain.face, scaled.face)
    assert scaled.distance / scale == pytest.approx(plain.distance, rel=1e-12)


def test_that_rays_that_meet_nothing_have_no_hits() -> None:
    assert len(radial_hits(Mesh(np.zeros((0, 3)), np.zeros((0, 3))), np.zeros(3), np.eye(3))) == 0
    assert len(radial_hits(cuboid(1.0, 1.0, 1.0), (9.0, 0.0, 0.0), np.eye(3))) == 0


def test_that_a_direction_without_length_is_refused() -> None:
    with pytest.raises(ValueError, match="vanish"):
        radial_hits(cuboid(1.0, 1.0, 1.0), np.zeros(3), np.zeros((1, 3)))


def test_that_hits_survive_pickling_read_only() -> None:
    hits = pickle.loads(pickle.dumps(radial_hits(cuboid(1.0, 1.0, 1.0), np.zeros(3), np.eye(3))))
    assert not hits.distance.flags.writeable
    assert hits.distance == pytest.approx(0.5)
