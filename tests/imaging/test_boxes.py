"""Boxes of voxels."""

import pytest

from regolith_studio.imaging.volume import box_about, box_between


@pytest.mark.parametrize(
    ("centre", "low", "high"),
    [
        ((50, 50, 5), (45, 45, 0), (55, 55, 8)),
        ((0, 99, 7), (0, 90, 0), (10, 100, 8)),
    ],
)
def test_that_a_box_about_a_voxel_lies_inside_the_volume(centre, low, high) -> None:
    assert box_about(centre, 10, (100, 100, 8)) == box_between(low, high)
