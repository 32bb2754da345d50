"""Volumes check themselves and do not change."""

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.imaging.volume import Volume

LABELS = np.zeros((3, 4, 5), dtype=np.uint16)


def test_that_a_volume_is_locked_without_locking_the_array_of_its_maker() -> None:
    array = LABELS.copy()
    volume = Volume(array, (1.0, 1.0, 1.0), "labels", "test")
    with pytest.raises(ValueError, match="read-only"):
        volume.array[0, 0, 0] = 1
    array[0, 0, 0] = 1


@pytest.mark.parametrize(
    ("array", "size", "kind", "message"),
    [
        (np.zeros((3, 4)), (1, 1, 1), "grey", "three dimensions"),
        (np.zeros((0, 4, 4)), (1, 1, 1), "grey", "three dimensions"),
        (np.zeros((3, 4, 5)), (1, 0, 1), "grey", "positive"),
        (np.zeros((3, 4, 5)), (1, 1, 1), "labels", "whole numbers"),
        (np.zeros((3, 4, 5), dtype=complex), (1, 1, 1), "grey", "not numbers"),
    ],
)
def test_that_what_is_no_volume_is_refused(array, size, kind, message) -> None:
    with pytest.raises(InputError, match=message):
        Volume(array, size, kind, "test")
