"""Decimation: what the library gives to one thread, whoever else asks."""

import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import fast_simplification
import numpy as np
import pytest

from regolith_studio.coarsening.decimated_hull import decimated
from tests.geometry.solids import rough_stone

STONES = [rough_stone(seed) for seed in range(4)]


@pytest.fixture
def hasty() -> Iterator[None]:
    """Threads that take turns as fast as they do in the window."""
    usual = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(usual)


def test_that_a_mesh_is_decimated_as_the_library_does() -> None:
    stone = STONES[0]
    vertices, faces = fast_simplification.simplify(
        np.array(stone.vertices), np.array(stone.faces), target_count=100
    )
    found = decimated(stone, 100)
    assert np.array_equal(found.vertices, vertices)
    assert np.array_equal(found.faces, faces)


@pytest.mark.usefixtures("hasty")
def test_that_threads_get_no_pieces_of_each_others_meshes() -> None:
    alone = [decimated(stone, 20).content_hash for stone in STONES]
    with ThreadPoolExecutor(len(STONES)) as pool:
        together = list(pool.map(lambda stone: decimated(stone, 20).content_hash, 40 * STONES))
    assert together == 40 * alone


def test_that_more_triangles_than_there_are_cannot_be_kept() -> None:
    with pytest.raises(ValueError, match="number of faces"):
        decimated(STONES[0], len(STONES[0].faces) + 1)
