"""Length, width and thickness against closed forms, and against chords between many points."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from regolith_studio.geometry.feret import length_width_thickness
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from tests.geometry.solids import cuboid, random_polyhedron, rotation


def test_that_an_ellipsoid_has_its_axes() -> None:
    ball = icosphere(4)
    body = Mesh(ball.vertices * [1.5, 1.0, 0.6], ball.faces).moved(rotation=rotation(3), shift=(4, -2, 7))
    assert length_width_thickness(body) == pytest.approx((3.0, 2.0, 1.2), rel=3e-3)


def test_that_a_cube_has_its_diagonals() -> None:
    """The space diagonal; the diagonal of a face; along (1, 1, -2) the chord ends where one edge does."""
    cube = cuboid(2.0, 2.0, 2.0).moved(rotation=rotation(5))
    expected = 2.0 * np.array([np.sqrt(3.0), np.sqrt(2.0), np.sqrt(6.0) / 2])
    assert length_width_thickness(cube) == pytest.approx(expected, rel=1e-9)


def test_that_a_regular_tetrahedron_has_two_edges_and_their_distance() -> None:
    points = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / np.sqrt(8.0)
    solid = Mesh(points, np.empty((0, 3), dtype=np.int64)).hull
    assert length_width_thickness(solid) == pytest.approx((1.0, 1.0, np.sqrt(0.5)), rel=1e-9)


@pytest.mark.parametrize("seed", [1, 2])
def test_that_no_chord_between_surface_points_is_longer(seed: int) -> None:
    """Chords of 2,000 random surface points, those within half a degree of perpendicular for the width."""
    solid = random_polyhedron(seed, n_facets=14, stretch=0.5)
    length, width, thickness = length_width_thickness(solid.hull)
    generator = np.random.default_rng(seed)
    triangles = solid.triangles[
        generator.choice(len(solid.faces), 2000, p=solid.face_areas / solid.surface_area)
    ]
    points = np.einsum("nk,nkx->nx", generator.dirichlet([1, 1, 1], 2000), triangles)
    vertices = solid.vertices
    distances = cdist(vertices, vertices)
    first, second = np.unravel_index(int(distances.argmax()), distances.shape)
    assert length == pytest.approx(distances.max(), rel=1e-12)
    along = (vertices[second] - vertices[first]) / length
    ways = points[:, None] - points
    apart = np.linalg.norm(ways, axis=2) + np.eye(len(points))
    level = np.abs(ways @ along) / apart < 0.005
    assert apart[level].max() < width * 1.005
    assert apart[level].max() > width * 0.93
    assert thickness < width < length
