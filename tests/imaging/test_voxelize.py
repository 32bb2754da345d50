"""Shares of voxels inside a mesh: against boxes, whose shares are products, and against volumes."""

import numpy as np
import pytest

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.grain_surface import coverage

CORNERS = np.array(list(np.ndindex(2, 2, 2)), dtype=float)
HULL = Mesh(CORNERS, np.empty((0, 3), dtype=np.int64)).hull


def overlap(low: float, high: float, count: int) -> np.ndarray:
    """How much of each voxel, half on either side of its number, lies between two places."""
    edges = np.arange(count)
    return np.clip(np.minimum(high, edges + 0.5) - np.maximum(low, edges - 0.5), 0.0, None)


@pytest.mark.parametrize("shift", [0.0, -1.7])
def test_that_a_box_covers_the_product_of_what_its_sides_cover(shift: float) -> None:
    """Sides along x and y lie where thirds of voxels end; the second box sticks out of the grid."""
    low, high = np.array([1.5, 2.5 - 1 / 3, 1.2]) + shift * np.array([0, 0, 1]), np.array([4.5, 5.5, 5.83])
    box = Mesh(low + HULL.vertices * (high - low), HULL.faces)
    x, y, z = (overlap(a, b, 9) for a, b in zip(low, high, strict=True))
    expected = x[:, None, None] * y[None, :, None] * z[None, None, :]
    assert coverage(box, (9, 9, 9)) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("centre", [(10.0, 10.0, 10.0), (10.31, 9.77, 10.12)])
def test_that_shares_add_up_to_the_volume(centre: tuple[float, float, float]) -> None:
    sphere = icosphere(4)
    ball = Mesh(np.array(centre) + 7.0 * sphere.vertices, sphere.faces)
    share = coverage(ball, (21, 21, 21))
    assert share.sum() == pytest.approx(ball.volume, rel=2e-3)
    assert share.min() > -1e-6
    assert share.max() < 1 + 1e-6
    assert share[10, 10, 10] == pytest.approx(1.0)
