"""The mean incidence against numerical integration."""

import numpy as np
import pytest
from scipy.integrate import dblquad

from regolith_studio.geometry import Mesh
from regolith_studio.geometry.mean_incidence import mean_incidence
from regolith_studio.geometry.sphere_points import icosphere
from tests.geometry.solids import cuboid, rotation, rough_stone


def test_that_a_ball_is_met_squarely() -> None:
    assert mean_incidence(icosphere(5), np.zeros(3)) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("centre", [(0.0, 0.0, 0.0), (0.1, -0.3, 0.2), (0.9, 0.0, 0.6), (0.5, 0.1, 0.1)])
def test_that_a_cube_agrees_with_quadrature(centre: tuple[float, ...]) -> None:
    total = 0.0
    for axis in range(3):
        p, q = (centre[k] for k in range(3) if k != axis)
        for height in (abs(0.5 - centre[axis]), abs(0.5 + centre[axis])):
            if height == 0.0:
                continue
            total += dblquad(
                lambda x, y, h=height: h / np.sqrt(h * h + x * x + y * y),
                -0.5 - p,
                0.5 - p,
                -0.5 - q,
                0.5 - q,
            )[0]
    turn = rotation(2)
    cube = cuboid(1.0, 1.0, 1.0).moved(rotation=turn)
    assert mean_incidence(cube, turn @ centre) == pytest.approx(total / 6.0, rel=1e-7)


def test_that_cutting_faces_in_smaller_ones_changes_nothing() -> None:
    stone = rough_stone(1, level=1)
    a, b, c = np.moveaxis(stone.triangles, 1, 0)
    middle = (a + b + c) / 3.0
    pieces = np.concatenate(
        [np.stack(corner, 1) for corner in ((a, b, middle), (b, c, middle), (c, a, middle))]
    )
    finer = Mesh(pieces.reshape(-1, 3), np.arange(3 * len(pieces)).reshape(-1, 3))
    centre = np.array([0.05, 0.02, -0.1])
    assert mean_incidence(finer, centre) == pytest.approx(mean_incidence(stone, centre), rel=1e-12)
