"""Depths that are looked for only near the surface, against scipy's that are looked for everywhere."""

import numpy as np
import pytest
from scipy import ndimage

from regolith_studio.imaging.depth import DEEPEST, _fill_squared, depth
from tests.filling import filled


def masks() -> list[np.ndarray]:
    generator = np.random.default_rng(0)
    holes = generator.random((24, 19, 31)) < 0.995
    blobs = ndimage.gaussian_filter(generator.standard_normal((21, 22, 23)), 2.0) > 0.0
    return [holes, blobs, ~blobs, blobs[:, ::2], np.zeros((3, 4, 5), dtype=bool)]


@pytest.mark.parametrize("case", range(5))
def test_that_depths_are_those_of_scipy_where_they_matter(case: int) -> None:
    mask = masks()[case]
    expected = np.minimum(ndimage.distance_transform_edt(mask), DEEPEST)
    assert depth(mask) == pytest.approx(expected, abs=1e-6)


def test_that_a_mask_without_an_outside_is_deep_everywhere() -> None:
    assert (depth(np.ones((3, 4, 5), dtype=bool)) == DEEPEST).all()


def test_that_the_kernel_is_its_python() -> None:
    mask = masks()[1][:9, :8, :7].copy()
    farthest = np.full(mask.shape, 9, dtype=np.int32)
    one, other = (filled(f, (mask, 3), farthest)[0] for f in (_fill_squared, _fill_squared.py_func))
    assert np.array_equal(one, other)
