"""Half-spaces: normalised, locked, and measured from the origin."""

import pickle

import numpy as np
import pytest
from scipy.spatial import HalfspaceIntersection

from regolith_studio.errors import GeometryError
from regolith_studio.geometry import HalfSpaces
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.half_spaces import BLOCK, exits, inscribed_ball
from regolith_studio.geometry.sphere_points import fibonacci_directions

CUBE = np.vstack([np.eye(3), -np.eye(3)])


def test_that_normals_are_normalised_and_offsets_kept() -> None:
    planes = HalfSpaces(3.0 * CUBE, np.arange(1.0, 7.0))
    assert planes.normals == pytest.approx(CUBE)
    assert planes.offsets == pytest.approx(np.arange(1.0, 7.0))
    assert len(planes) == 6


def test_that_foot_points_define_the_planes_of_equation_6() -> None:
    feet = np.random.default_rng(0).normal(size=(12, 3))
    planes = HalfSpaces.from_points(feet)
    assert planes.points == pytest.approx(feet)
    assert np.einsum("ij,ij->i", planes.normals, feet) == pytest.approx(planes.offsets)


def test_that_equations_have_the_sign_of_scipy() -> None:
    planes = HalfSpaces(CUBE, np.arange(1.0, 7.0))
    corners = HalfspaceIntersection(planes.equations, np.zeros(3)).intersections
    assert corners.max(axis=0) == pytest.approx([1.0, 2.0, 3.0])
    assert corners.min(axis=0) == pytest.approx([-4.0, -5.0, -6.0])


def test_that_radii_of_a_cube_are_those_of_its_slabs() -> None:
    directions = fibonacci_directions(500)
    wanted = 1.0 / np.abs(directions).max(axis=1)
    assert HalfSpaces(CUBE, np.ones(6)).radii(directions) == pytest.approx(wanted)


def test_that_radii_are_infinite_where_no_plane_is_met() -> None:
    planes = HalfSpaces(CUBE[:5], np.ones(5))
    assert planes.radii(np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])) == pytest.approx([np.inf, 1.0])


def test_that_scaling_multiplies_the_offsets() -> None:
    assert HalfSpaces(CUBE, np.ones(6)).scaled(2.5).offsets == pytest.approx(2.5)


def test_that_planes_without_the_origin_inside_are_refused() -> None:
    with pytest.raises(GeometryError, match="smallest offset"):
        HalfSpaces(CUBE, [1.0, 1.0, 0.0, 1.0, 1.0, 1.0])
    with pytest.raises(GeometryError, match="origin"):
        HalfSpaces.from_points(np.zeros((1, 3)))
    with pytest.raises(ValueError, match="vanish"):
        HalfSpaces(np.zeros((1, 3)), [1.0])
    with pytest.raises(ValueError, match="shape"):
        HalfSpaces(CUBE, np.ones(5))


def test_that_pickling_keeps_the_locks_and_the_callers_arrays_stay_writeable() -> None:
    normals, offsets = CUBE.copy(), np.ones(6)
    planes = HalfSpaces(normals, offsets)
    again = pickle.loads(pickle.dumps(planes))
    normals[0] = offsets[0] = 7.0
    assert planes.offsets[0] == again.offsets[0] == 1.0
    assert np.array_equal(again.normals, planes.normals)
    assert not again.normals.flags.writeable
    assert not again.offsets.flags.writeable


def test_that_the_largest_ball_of_a_moved_corner_touches_its_four_planes() -> None:
    """x, y, z >= 0 and x + y + z <= 1: the centre is at r along each axis, with r = 1 / (3 + sqrt(3))."""
    normals = np.vstack([-np.eye(3), np.full(3, 1 / np.sqrt(3))])
    shift = np.array([5.0, -2.0, 1.0])
    offsets = np.array([0.0, 0.0, 0.0, 1 / np.sqrt(3)]) + normals @ shift
    centre, radius = inscribed_ball(normals, offsets)
    assert radius == pytest.approx(1 / (3 + np.sqrt(3)), rel=1e-9)
    np.testing.assert_allclose(centre, shift + radius, atol=1e-9)


def test_that_half_spaces_without_a_common_point_have_a_ball_of_negative_radius() -> None:
    normals = np.vstack([np.eye(3), -np.eye(3)])
    assert inscribed_ball(normals, np.array([-1.0, 1, 1, -1, 1, 1]))[1] == pytest.approx(-1.0)


def left(
    normals: FloatArray, offsets: FloatArray, rays: FloatArray, run: object = exits
) -> tuple[FloatArray, IntArray]:
    radius, plane = np.full(len(rays), np.nan), np.full(len(rays), -1)
    run(normals, offsets, rays, radius, plane)  # type: ignore[operator]
    return radius, plane


@pytest.mark.parametrize("n_planes", [4, 5, 20, 51])
@pytest.mark.parametrize("n_rays", [1, BLOCK, BLOCK + 3, 2000])
def test_that_each_ray_ends_on_the_nearest_plane(n_planes: int, n_rays: int) -> None:
    rng = np.random.default_rng(n_planes)
    normals = fibonacci_directions(n_planes) + 0.1 * rng.normal(size=(n_planes, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = rng.uniform(0.5, 0.8, n_planes)
    rays = np.ascontiguousarray(fibonacci_directions(n_rays))
    radius, plane = left(normals, offsets, rays)
    with np.errstate(divide="ignore"):
        reach = offsets / (rays @ normals.T)
    reach[reach <= 0.0] = np.inf
    assert plane.tolist() == reach.argmin(axis=1).tolist()
    assert radius == pytest.approx(reach.min(axis=1), rel=1e-14)


def test_that_rays_that_meet_no_plane_go_on_for_ever() -> None:
    rays = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.8, 0.0]])
    radius, _ = left(np.array([[1.0, 0.0, 0.0]]), np.array([0.5]), rays)
    assert radius == pytest.approx([0.5, np.inf, np.inf, 0.5 / 0.6])


def test_that_of_planes_that_tie_the_first_is_named() -> None:
    rays = np.array([[1.0, 0.0, 0.0]])
    for copies in (2, 3, 4):
        planes = np.vstack([[0.0, 1.0, 0.0], np.tile([1.0, 0.0, 0.0], (copies, 1))])
        assert left(planes, np.ones(copies + 1), rays)[1].tolist() == [1]
