"""Surfaces whose two sides lie so near that smoothing lets them cross."""

import numpy as np
import pytest

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.self_intersection import count_self_intersections
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.crossings import _add_corner_normals, _mark_doubtful, corner_normals, uncrossed
from regolith_studio.imaging.mask_surface import mask_mesh
from tests.filling import filled

SPHERE = icosphere(3)
BALL = Mesh(9.0 * SPHERE.vertices + 12.2, SPHERE.faces)


def plate_and_ring() -> list[np.ndarray]:
    plate = np.zeros((16, 16, 3), dtype=bool)
    plate[:, :, 1] = True
    x, y, z = np.indices((22, 22, 9)) - np.array([10.5, 10.5, 4.0])[:, None, None, None]
    return [plate, (np.abs(np.hypot(x, y) - 7) < 2.4) & (np.abs(z) < 3)]


@pytest.mark.parametrize("case", [0, 1])
def test_that_thin_grains_do_not_cross_themselves(case: int) -> None:
    mask = plate_and_ring()[case]
    found = mask_mesh(mask)
    assert count_self_intersections(found.vertices, found.faces) == 0
    assert found.volume == pytest.approx(mask.sum())


def test_that_corners_go_back_only_where_faces_cross() -> None:
    """A disc two voxels thick, the middle of whose upper side is pushed through the lower."""
    flat = np.array([1.0, 1.0, 0.11])
    disc = Mesh(BALL.vertices * flat, BALL.faces)
    aside = np.linalg.norm(SPHERE.vertices[:, :2], axis=1)
    upper = SPHERE.vertices[:, 2] > 0
    pushed = disc.vertices + np.where(upper & (aside < 0.3), -2.6, 0.02)[:, None] * [0.11, 0.06, 1]
    broken = Mesh(pushed, SPHERE.faces)
    assert count_self_intersections(broken.vertices, broken.faces) > 0
    found = uncrossed(broken, disc)
    assert count_self_intersections(found.vertices, found.faces) == 0
    assert np.array_equal(found.vertices[aside > 0.9], pushed[aside > 0.9])
    assert found.volume == pytest.approx(disc.volume, rel=0.1)


def test_that_a_surface_that_does_not_cross_stays_as_it_is() -> None:
    larger = Mesh(9.3 * SPHERE.vertices + 12.2, SPHERE.faces)
    assert uncrossed(larger, BALL) is larger


def test_that_normals_of_a_ball_point_away_from_its_centre() -> None:
    assert corner_normals(BALL.vertices, BALL.faces) == pytest.approx(SPHERE.vertices, abs=0.02)


def test_that_the_kernels_are_their_python() -> None:
    inside = np.linalg.norm(np.moveaxis(np.indices((24, 24, 24)), 0, -1) - 12.2, axis=-1) < 9.0
    inside[8:16] = False
    normals = corner_normals(BALL.vertices, BALL.faces)
    plain, _ = filled(_add_corner_normals.py_func, (BALL.vertices, BALL.faces), np.zeros(normals.shape))
    assert np.allclose(normals, plain)
    arguments, unmarked = (BALL.vertices, BALL.faces, normals, inside), np.zeros(len(BALL.faces), dtype=bool)
    one, other = (filled(f, arguments, unmarked)[0] for f in (_mark_doubtful, _mark_doubtful.py_func))
    assert np.array_equal(one, other)
    assert 0 < np.count_nonzero(one) < len(one)
