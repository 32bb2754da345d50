"""Unions of convex parts against closed forms and Monte Carlo."""

import pickle

import numpy as np
import pytest
import trimesh
from numpy.typing import ArrayLike
from scipy.spatial import ConvexHull

from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry import ConvexCompound, ConvexPolyhedron, HalfSpaces
from regolith_studio.geometry.arrays import FloatArray
from tests.geometry.solids import rotation

CUBE = np.vstack([np.eye(3), -np.eye(3)])


def cuboid(edges: ArrayLike) -> ConvexPolyhedron:
    """About the origin."""
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(CUBE, np.tile(np.asarray(edges) / 2.0, 2)))


def corner_cubes() -> ConvexCompound:
    """Two cubes of edge 2 that share a cube of edge 1 at a corner."""
    return ConvexCompound((cuboid((2, 2, 2)), cuboid((2, 2, 2))), np.array([[0, 0, 0], [1, 1, 1]]))


def holds(compound: ConvexCompound, points: FloatArray) -> FloatArray:
    """Whether points lie in any part."""
    inside = [
        ((points - place) @ part.half_spaces.normals.T <= part.half_spaces.offsets).all(axis=1)
        for part, place in zip(compound.parts, compound.places, strict=True)
    ]
    return np.any(inside, axis=0)


def test_that_two_cubes_that_share_a_corner_have_the_volume_and_area_of_their_union() -> None:
    union = corner_cubes()
    assert union.volume == pytest.approx(15.0)
    assert union.surface_area == pytest.approx(42.0)
    assert union.centroid == pytest.approx((0.5, 0.5, 0.5))
    assert union.exposed_areas == pytest.approx([3, 3, 3, 4, 4, 4, 4, 4, 4, 3, 3, 3])
    assert (union.n_parts, union.n_facets, union.n_vertices, union.n_triangles) == (2, 12, 16, 24)
    assert describe(union)["convex_hull_volume"] == pytest.approx(20.0)


def test_that_touching_cubes_become_one_cuboid_without_the_side_between_them() -> None:
    cuboids = ConvexCompound((cuboid((2, 2, 2)), cuboid((2, 2, 2))), np.array([[0, 0, 0], [2, 0, 0]]))
    assert cuboids.volume == pytest.approx(16.0)
    assert cuboids.surface_area == pytest.approx(40.0)
    assert cuboids.inertia == pytest.approx(np.diag([8.0, 20.0, 20.0]) * 16.0 / 12.0)


def halves(seed: int) -> ConvexCompound:
    """Two different polyhedra that meet in a plane, where they overlap by 2e-8."""
    rng, parts = np.random.default_rng(seed), []
    for side in (-1.0, 1.0):
        cut = [side * 1.0, 0.0, 0.0]
        normals = np.vstack([CUBE, rng.normal(size=(8, 3)), cut])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        offsets = np.concatenate([rng.uniform(0.8, 1.0, len(normals) - 1), [0.3 + 1e-8]])
        parts.append(ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, offsets)))
    return ConvexCompound(tuple(parts), np.array([[0.3, 0.0, 0.0], [-0.3, 0.0, 0.0]]))


@pytest.mark.parametrize("seed", [0, 6, 8, 9, 12, 14])
def test_that_parts_that_touch_leave_a_surface_that_is_closed_in_single_precision(seed: int) -> None:
    """trimesh merges corners nearer than 1e-8 while it reads a mesh: ledges of that width would open it."""
    union = halves(seed).moved(rotation=rotation(seed))
    soup = union.mesh.triangles.astype(np.float32).reshape(-1, 3)
    for read in (
        trimesh.Trimesh(union.mesh.vertices, union.mesh.faces),
        trimesh.Trimesh(soup, np.arange(len(soup)).reshape(-1, 3)),
    ):
        assert read.is_watertight
        assert read.is_winding_consistent
        assert read.volume == pytest.approx(
            sum(ConvexHull(each.vertices).volume for each in union.part_meshes), rel=1e-6
        )


def test_that_the_overlap_of_parts_counts_once_in_the_inertia() -> None:
    bars = ConvexCompound((cuboid((4, 2, 2)), cuboid((4, 2, 2))), np.array([[0, 0, 0], [2, 0, 0]]))
    assert bars.inertia == pytest.approx(np.diag([8.0, 40.0, 40.0]) * 24.0 / 12.0)


def test_that_facets_of_triangles_lie_in_the_planes_of_their_parts() -> None:
    union = corner_cubes().moved(rotation=rotation(3))
    normals = np.concatenate([part.half_spaces.normals for part in union.parts])
    mesh = union.mesh
    cosine = np.einsum("ij,ij->i", mesh.face_area_vectors, normals[union.triangle_facets])
    assert cosine == pytest.approx(mesh.face_areas)
    assert union.facet_parts.tolist() == [0] * 6 + [1] * 6


def test_that_the_volume_agrees_with_points_thrown_at_random() -> None:
    rng = np.random.default_rng(4)
    parts = [
        ConvexPolyhedron.from_half_spaces(
            HalfSpaces(np.vstack([CUBE, rng.normal(size=(6, 3))]), rng.uniform(0.6, 1.0, 12))
        )
        for _ in range(4)
    ]
    union = ConvexCompound(tuple(parts), rng.normal(scale=0.6, size=(4, 3)))
    low, high = union.mesh.bounds
    points = rng.uniform(low, high, (200_000, 3))
    share = float(holds(union, points).mean())
    assert union.volume == pytest.approx(share * np.prod(high - low), rel=0.01)


def test_that_moving_and_pickling_keep_the_union() -> None:
    union = corner_cubes()
    moved = union.moved(shift=(1e3, 0.0, -2.0), rotation=rotation(5), scale=1e-6)
    assert moved.volume == pytest.approx(15.0e-18)
    again = pickle.loads(pickle.dumps(moved))
    assert again.mesh.content_hash == moved.mesh.content_hash


def test_that_a_compound_without_parts_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one part"):
        ConvexCompound((), np.empty((0, 3)))
