"""Where rays leave half-spaces, against numpy."""

import numpy as np
import pytest

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.exits import BLOCK, exits
from regolith_studio.geometry.sphere_points import fibonacci_directions


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
