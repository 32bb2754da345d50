"""Zingg's classes of cuboids."""

import pytest

from regolith_studio.descriptors.describe import describe
from regolith_studio.descriptors.zingg import zingg_class
from tests.geometry.solids import cuboid


@pytest.mark.parametrize(
    ("edges", "form"),
    [
        ((1.0, 1.0, 1.0), "equant"),
        ((3.0, 3.0, 1.0), "disc"),
        ((3.0, 1.0, 1.0), "rod"),
        ((9.0, 3.0, 1.0), "blade"),
    ],
)
def test_that_a_cuboid_falls_in_its_class(edges: tuple[float, float, float], form: str) -> None:
    assert zingg_class(describe(cuboid(*edges))) == form
