"""Rays, shared volume and cuts."""

import numpy as np
import pytest

from regolith_studio.coarsening.core.cuts import with_all_facets
from regolith_studio.coarsening.core.intersection import intersect
from regolith_studio.coarsening.core.overlap import exits, shared_charge, shared_volume
from regolith_studio.coarsening.core.planes import gradient_of, levers_of, moved, tangents_of
from regolith_studio.coarsening.core.rays import cast_fibonacci
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.directions import fibonacci_directions, icosphere
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.overlap import jaccard_distance
from regolith_studio.geometry.ray_casting import radial_hits

CUBE = np.vstack([np.eye(3), -np.eye(3)])


def shared(target: Target, normals: FloatArray, offsets: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    rays = target.rays
    radius, plane = np.empty(len(rays.directions)), np.empty(len(rays.directions), dtype=np.int64)
    exits(normals, offsets, rays.directions, radius, plane)
    return shared_volume(rays.first, rays.distance, rays.sign, rays.weight, radius), radius, plane


def test_that_rays_meet_the_same_crossings_as_a_search_over_all_triangles(target: Target) -> None:
    directions = fibonacci_directions(500)
    mesh = target.mesh.moved(shift=(0.35, 0.1, 0.0))
    first, distance, sign = cast_fibonacci(mesh.vertices, mesh.faces, np.ascontiguousarray(directions))
    hits = radial_hits(mesh, np.zeros(3), directions)
    assert np.diff(first).tolist() == np.bincount(hits.ray, minlength=500).tolist()
    assert distance == pytest.approx(hits.distance, rel=1e-12)
    assert (sign == hits.sign).all()


def test_that_a_cube_shares_the_sphere_inside_it() -> None:
    target = Target.of(icosphere(4))
    radius = (3 / (4 * np.pi)) ** (1 / 3)
    assert shared(target, CUBE, np.full(6, 1.01 * radius))[0] == pytest.approx(1.0, abs=1e-12)
    side = 0.8 * radius
    # ball minus six caps of height 0.2 R, which do not overlap
    caps = 6 * np.pi * (0.2 * radius) ** 2 * (radius - 0.2 * radius / 3)
    assert shared(target, CUBE, np.full(6, side))[0] == pytest.approx(1.0 - caps, abs=3e-3)


def test_that_the_jaccard_distance_is_that_of_the_geometry_folder(target: Target) -> None:
    half_spaces = HalfSpaces(CUBE, np.full(6, 0.5))
    other = jaccard_distance(target.mesh, half_spaces, 4000)
    assert target.jaccard_distance(half_spaces) == pytest.approx(other, abs=5e-4)


def test_that_the_derivative_of_the_shared_volume_is_that_of_finite_differences(target: Target) -> None:
    rng = np.random.default_rng(1)
    normals = rng.normal(size=(20, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offsets = rng.uniform(0.5, 0.7, 20)
    rays = target.rays
    _, radius, plane = shared(target, normals, offsets)
    pivots = normals * offsets[:, None]
    frames, levers = tangents_of(normals), levers_of(np.full(20, 0.3), 0.1)
    charge = shared_charge(
        rays.directions, rays.first, rays.distance, rays.sign, rays.weight, offsets, radius, plane, pivots
    )
    step = 1e-8 * rng.normal(size=60)
    ahead = shared(target, *moved(normals, pivots, offsets, frames, levers, step))[0]
    behind = shared(target, *moved(normals, pivots, offsets, frames, levers, -step))[0]
    assert (ahead - behind) / 2 == pytest.approx(gradient_of(charge, frames, levers) @ step, rel=1e-4)


def test_that_a_redundant_plane_comes_back_as_a_facet(target: Target) -> None:
    normals = np.vstack([CUBE, [[0.6, 0.8, 0.0], [0.0, 0.6, 0.8]]])
    offsets = np.append(np.full(6, 0.55), [2.0, 2.0])
    rays = target.rays
    cuts, new_normals, new_offsets = with_all_facets(
        normals, offsets, rays.directions, rays.first, rays.distance, 0.3
    )
    assert cuts == 2
    _, _, triples = intersect(new_normals, new_offsets)
    assert len(np.unique(triples)) == 8
    assert (new_normals[:6] == normals[:6]).all()
