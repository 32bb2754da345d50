"""Intersections of half-spaces against closed forms and scipy."""

import pickle

import numpy as np
import pytest
from scipy.spatial import ConvexHull, HalfspaceIntersection

from regolith_studio.errors import GeometryError
from regolith_studio.geometry import ConvexPolyhedron, HalfSpaces
from tests.geometry.solids import rotation

CUBE = np.vstack([np.eye(3), -np.eye(3)])


def random_planes(seed: int, n: int = 20) -> HalfSpaces:
    """Planes in general position that bound a volume, by the six of a cube that all may cut."""
    rng = np.random.default_rng(seed)
    normals = np.vstack([CUBE, rng.normal(size=(n - 6, 3))])
    return HalfSpaces(normals, rng.uniform(0.9, 1.2, n))


def test_that_six_planes_at_distance_one_enclose_volume_eight() -> None:
    cube = ConvexPolyhedron.from_half_spaces(HalfSpaces(CUBE @ rotation(1), np.ones(6)))
    assert cube.volume == pytest.approx(8.0)
    assert cube.surface_area == pytest.approx(24.0)
    assert (cube.n_facets, cube.n_vertices, cube.n_triangles) == (6, 8, 12)
    assert cube.facet_areas == pytest.approx(np.full(6, 4.0))
    assert all(len(facet) == 4 for facet in cube.facets)


def test_that_an_octahedron_of_eight_planes_has_six_vertices() -> None:
    normals = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    solid = ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, np.full(8, 1.0 / np.sqrt(3.0))))
    assert (solid.n_facets, solid.n_vertices, solid.n_triangles) == (8, 6, 8)
    assert solid.volume == pytest.approx(4.0 / 3.0)


@pytest.mark.parametrize("seed", range(8))
def test_that_vertices_and_measures_agree_with_scipy(seed: int) -> None:
    planes = random_planes(seed)
    solid = ConvexPolyhedron.from_half_spaces(planes)
    other = ConvexHull(HalfspaceIntersection(planes.equations, np.zeros(3)).intersections)
    assert solid.volume == pytest.approx(other.volume, rel=1e-9)
    assert solid.surface_area == pytest.approx(other.area, rel=1e-9)
    assert solid.facet_areas.sum() == pytest.approx(solid.surface_area, rel=1e-12)


@pytest.mark.parametrize("seed", range(8))
def test_that_facets_lie_in_their_planes_and_look_outwards(seed: int) -> None:
    solid = ConvexPolyhedron.from_half_spaces(random_planes(seed))
    gap = solid.vertices @ solid.half_spaces.normals.T - solid.half_spaces.offsets
    assert gap.max() < 1e-9
    for facet, plane in zip(solid.facets, range(solid.n_facets), strict=True):
        assert gap[list(facet), plane] == pytest.approx(0.0, abs=1e-9)
    towards = solid.mesh.face_area_vectors @ solid.half_spaces.normals.T
    assert (towards[np.arange(solid.n_triangles), solid.triangle_facets] > 0.0).all()


def test_that_euler_holds_in_general_position() -> None:
    solid = ConvexPolyhedron.from_half_spaces(random_planes(3))
    assert solid.n_vertices == 2 * solid.n_facets - 4
    assert solid.n_triangles == 4 * solid.n_facets - 12


def test_that_redundant_planes_are_dropped() -> None:
    planes = HalfSpaces(np.vstack([CUBE, [[1.0, 1.0, 1.0]]]), [*np.ones(6), 9.0])
    assert ConvexPolyhedron.from_half_spaces(planes).n_facets == 6


@pytest.mark.parametrize("normals", [CUBE[:5], CUBE[:3], CUBE[:1], np.vstack([CUBE[:2], CUBE[3:5]])])
def test_that_unbounded_intersections_are_refused(normals: np.ndarray) -> None:
    with pytest.raises(GeometryError, match="unbounded"):
        ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, np.ones(len(normals))))


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_that_the_unit_does_not_matter(scale: float) -> None:
    planes = random_planes(5)
    plain = ConvexPolyhedron.from_half_spaces(planes)
    scaled = ConvexPolyhedron.from_half_spaces(planes.scaled(scale))
    assert scaled.facets == plain.facets
    assert scaled.volume / scale**3 == pytest.approx(plain.volume, rel=1e-12)


def test_that_moving_moves_planes_and_vertices_alike() -> None:
    solid = ConvexPolyhedron.from_half_spaces(random_planes(6))
    moved = solid.moved(shift=(0.1, -0.2, 0.3), rotation=rotation(2), scale=3.0)
    again = ConvexPolyhedron.from_half_spaces(moved.half_spaces)
    assert moved.volume == pytest.approx(27.0 * solid.volume)
    assert again.volume == pytest.approx(moved.volume, rel=1e-9)
    assert moved.centroid == pytest.approx(3.0 * rotation(2) @ (solid.centroid + np.array([0.1, -0.2, 0.3])))
    with pytest.raises(GeometryError, match="origin"):
        solid.moved(shift=(5.0, 0.0, 0.0))


def test_that_pickling_keeps_everything_and_the_locks() -> None:
    solid = ConvexPolyhedron.from_half_spaces(random_planes(7))
    again = pickle.loads(pickle.dumps(solid))
    assert np.array_equal(again.vertices, solid.vertices)
    assert again.facets == solid.facets
    assert not again.vertices.flags.writeable


def test_that_facets_must_match_the_half_spaces() -> None:
    with pytest.raises(ValueError, match="need as many facets"):
        ConvexPolyhedron(HalfSpaces(CUBE, np.ones(6)), np.zeros((8, 3)), ((0, 1, 2),))
