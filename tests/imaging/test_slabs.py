"""Slabs cover a volume once, with margins where there is room, and scratch files vanish."""

import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from regolith_studio.errors import EnvironmentProblem
from regolith_studio.imaging.slabs import Scratch, read_with_margin, slab_ranges
from regolith_studio.imaging.volume import Volume


@pytest.mark.parametrize("shape", [(5, 5, 1), (7, 3, 8), (100, 100, 103), (3000, 3000, 20)])
def test_that_slabs_cover_every_slice_once(shape: tuple[int, int, int]) -> None:
    ranges = slab_ranges(shape, 100_000)
    slices = [z for first, stop in ranges for z in range(first, stop)]
    assert slices == list(range(shape[2]))
    assert all(stop - first >= 8 for first, stop in ranges[:-1])


@pytest.mark.parametrize(("first", "stop"), [(0, 4), (3, 7), (8, 10), (0, 10)])
def test_that_a_margin_is_cut_off_again(first: int, stop: int) -> None:
    volume = Volume(np.arange(60).reshape(2, 3, 10), (1, 1, 1), "grey", "t")
    thick, inner = read_with_margin(volume, first, stop, 2)
    assert np.array_equal(thick[:, :, inner], volume.array[:, :, first:stop])
    assert thick.shape[2] == min(stop + 2, 10) - max(first - 2, 0)


def test_that_scratch_arrays_are_the_same_in_memory_and_on_disk(tmp_path: Path) -> None:
    with Scratch() as memory, Scratch(tmp_path) as disk:
        for scratch in (memory, disk):
            array = scratch.zeros((3, 4, 5), np.int32)
            array[1, 2, 3] = 7
            assert array.shape == (3, 4, 5)
            assert array.flags.f_contiguous
            assert array.sum() == 7
        assert len(list(tmp_path.rglob("*.raw"))) == 1
    assert not list(tmp_path.iterdir())


def test_that_a_full_disk_is_one_sentence_and_no_crash(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=2**20))
    with Scratch(tmp_path) as scratch, pytest.raises(EnvironmentProblem, match="do not fit"):
        scratch.zeros((1024, 1024, 2), np.uint8)
    assert not list(tmp_path.iterdir())
