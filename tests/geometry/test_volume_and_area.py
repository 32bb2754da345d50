"""The compiled measures against the mesh's own."""

import numpy as np
import pytest

from regolith_studio.geometry import Mesh
from regolith_studio.geometry.volume_and_area import volume_and_area
from tests.geometry.solids import cuboid, folded_stone


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_that_volume_and_area_are_those_of_the_mesh(scale: float) -> None:
    stone = folded_stone(1).moved(shift=(5.0, -7.0, 3.0), scale=scale)
    assert volume_and_area(stone) == pytest.approx((stone.volume, stone.surface_area), rel=1e-12)


def test_that_a_cuboid_has_the_closed_form_and_nothing_has_nothing() -> None:
    assert volume_and_area(cuboid(3.0, 2.0, 1.0)) == pytest.approx((6.0, 22.0), rel=1e-14)
    assert volume_and_area(Mesh(np.zeros((0, 3)), np.zeros((0, 3)))) == (0.0, 0.0)
