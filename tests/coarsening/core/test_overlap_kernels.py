"""Rays, shared volume and cuts."""

import numpy as np
import pytest

from regolith_studio.coarsening.core.facet_insertion import fill_neighbours, insert_lost_facets
from regolith_studio.coarsening.core.overlap import (
    add_shared_charges,
    crossings_of,
    shared_by_planes,
    shared_volume,
)
from regolith_studio.coarsening.core.polyhedron_measures import (
    fill_gradient,
    fill_moved,
    measure_polyhedron,
    tangents_of,
)
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.half_spaces import HalfSpaces, exits
from regolith_studio.geometry.ray_casting import jaccard_distance, radial_hits
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere
from tests.filling import filled

CUBE = np.vstack([np.eye(3), -np.eye(3)])


def shared(target: Target, normals: FloatArray, offsets: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    rays = target.rays
    radius, plane = np.empty(len(rays.directions)), np.empty(len(rays.directions), dtype=np.int64)
    exits(normals, offsets, rays.directions, radius, plane)
    return shared_volume(rays.first, rays.distance, rays.sign, rays.weight, radius), radius, plane


def test_that_a_cube_shares_the_sphere_inside_it() -> None:
    target = Target.of(icosphere(3))  # the box of a finer ball takes seconds
    radius = (3 / (4 * np.pi)) ** (1 / 3)
    assert shared(target, CUBE, np.full(6, 1.01 * radius))[0] == pytest.approx(1.0, abs=1e-12)
    side = 0.8 * radius
    # ball minus six caps of height 0.2 R, which do not overlap
    caps = 6 * np.pi * (0.2 * radius) ** 2 * (radius - 0.2 * radius / 3)
    assert shared(target, CUBE, np.full(6, side))[0] == pytest.approx(1.0 - caps, abs=3e-3)


@pytest.mark.parametrize("n_facets", [4, 5, 6, 7, 20])
@pytest.mark.parametrize("shift", [0.0, 0.35])
def test_that_the_shared_volume_does_not_need_the_planes_that_rays_meet(
    target: Target, n_facets: int, shift: float
) -> None:
    """Seen from beside its middle, the particle is crossed several times by some rays and never by others."""
    rng = np.random.default_rng(n_facets)
    normals = np.vstack([CUBE, rng.normal(size=(20, 3))])[-n_facets:]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offsets, directions = rng.uniform(0.4, 0.7, n_facets), fibonacci_directions(2_100)
    mesh = target.mesh.moved(shift=(shift, 0.1, 0.0))
    hits = radial_hits(mesh, np.zeros(3), directions)
    first = np.concatenate([[0], np.cumsum(np.bincount(hits.ray, minlength=2_100))])
    crossings = first, np.array(hits.distance), hits.sign.astype(np.float64)
    dual = normals / offsets[:, None]
    radius = 1.0 / np.maximum((directions @ dual.T).max(axis=1), 1e-300)
    expected = shared_volume(*crossings, 1e-3, radius)
    table = crossings_of(directions, *crossings)
    for function in (shared_by_planes, shared_by_planes.py_func):  # type: ignore[attr-defined]
        if function is shared_by_planes or n_facets == 4:
            with np.errstate(divide="ignore"):
                found = function(dual, table, 1e-3)
            assert found == pytest.approx(expected, rel=1e-12)


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
    tangents, scales = tangents_of(normals), np.full(20, 0.3)
    table = rays.directions, rays.first, rays.distance, rays.sign, rays.weight
    charges, _ = filled(add_shared_charges, (*table, offsets, radius, plane, pivots, 2.0), np.zeros((20, 4)))
    gradient, _ = filled(fill_gradient, (charges, tangents, scales), np.empty(60))
    step, planes = 1e-8 * rng.normal(size=60), (normals, pivots, offsets, tangents, scales)
    ahead, behind = (
        shared(target, *filled(fill_moved, (*planes, way * step), normals, offsets, tangents)[:2])[0]
        for way in (1.0, -1.0)
    )
    assert ahead - behind == pytest.approx(gradient @ step, rel=1e-4)


@pytest.mark.parametrize("n_facets", [6, 60])
def test_that_neighbouring_corners_share_two_planes(n_facets: int) -> None:
    normals = np.random.default_rng(3).normal(size=(n_facets, 3))
    normals[:6] = CUBE
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    polyhedron = measure_polyhedron(normals, np.full(n_facets, 0.5))
    neighbours, _ = filled(
        fill_neighbours, (polyhedron.edges,), np.empty((len(polyhedron.triples), 3), dtype=np.int64)
    )
    shared = (polyhedron.triples[:, None, :, None] == polyhedron.triples[None, :, None, :]).sum(axis=(2, 3))
    assert (neighbours == [np.flatnonzero(row == 2) for row in shared]).all()


def test_that_a_redundant_plane_comes_back_as_a_facet(target: Target) -> None:
    normals = np.vstack([CUBE, [[0.6, 0.8, 0.0], [0.0, 0.6, 0.8]]])
    offsets = np.append(np.full(6, 0.55), [2.0, 2.0])
    rays = target.rays
    cuts, new_normals, new_offsets = insert_lost_facets(
        normals, offsets, rays.directions, rays.first, rays.distance, 0.3
    )
    assert cuts == 2
    assert len(np.unique(measure_polyhedron(new_normals, new_offsets).triples)) == 8
    assert (new_normals[:6] == normals[:6]).all()
