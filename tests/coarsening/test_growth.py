"""Many facets on rough particles: grown out of few, all real, all descriptors met."""

import itertools

import numpy as np
import pytest
from scipy.spatial import ConvexHull, HalfspaceIntersection

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.exact.growth import stages, with_waiting
from regolith_studio.coarsening.result import Coarsened
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from tests.coarsening.conftest import bumpy

CONDITIONS = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")


@pytest.fixture(scope="module", params=[2, 5])
def rough(request: pytest.FixtureRequest) -> Coarsened:
    return coarsen(bumpy(request.param, roughness=0.3), 100, "exact", seed=1)


def facets_by_scipy(planes: HalfSpaces) -> int:
    """Directions of the hull's triangles, counted without the program's own intersection."""
    corners = HalfspaceIntersection(planes.equations, np.zeros(3)).intersections
    hull = ConvexHull(corners, qhull_options="QJ1e-13")
    facing = (hull.equations[:, :3] @ planes.normals.T).argmax(axis=1)
    return len(np.unique(facing))


def test_that_rough_particles_get_a_hundred_facets_and_keep_all_descriptors(rough: Coarsened) -> None:
    assert max(rough.errors[key] for key in CONDITIONS) <= 1e-6
    assert rough.reason is None
    assert rough.n_faces == 100
    assert (rough.n_vertices, rough.n_triangles) == (196, 388)


def test_that_scipy_finds_the_same_facets_and_volume(rough: Coarsened) -> None:
    planes = rough.half_spaces
    assert facets_by_scipy(planes) == 100
    corners = HalfspaceIntersection(planes.equations, np.zeros(3)).intersections
    assert ConvexHull(corners).volume == pytest.approx(rough.target["volume"], rel=1e-6)


def test_that_the_same_seed_gives_the_same_hundred_facets() -> None:
    one, two = (coarsen(bumpy(5, roughness=0.3), 100, "exact", seed=3) for _ in range(2))
    assert np.array_equal(one.half_spaces.equations, two.half_spaces.equations)


@pytest.mark.parametrize(("few", "many"), [(20, 51), (20, 100), (50, 100), (20, 300)])
def test_that_stages_rise_to_the_number_asked_for(few: int, many: int) -> None:
    sizes = [few, *stages(few, many)]
    assert sizes[-1] == many
    assert all(below < above <= 3 * below for below, above in itertools.pairwise(sizes))


def test_that_waiting_half_spaces_leave_a_cube_a_cube() -> None:
    normals = np.vstack([np.eye(3), -np.eye(3)])
    planes = HalfSpaces(*with_waiting(normals, np.ones(6), 40))
    assert len(planes) == 40
    corners = HalfspaceIntersection(planes.equations, np.zeros(3)).intersections
    assert ConvexHull(corners).volume == pytest.approx(8.0, rel=1e-12)


def test_that_missing_facets_are_said() -> None:
    octahedron = Mesh(np.vstack([np.eye(3), -np.eye(3)]), np.empty((0, 3), dtype=np.int64)).hull
    found = coarsen(octahedron, 20, "exact")
    assert found.n_faces < 20
    assert found.reason is not None
    if max(found.errors[key] for key in CONDITIONS) <= 1e-6:
        assert f"{found.n_faces} facets instead of 20" in found.reason
