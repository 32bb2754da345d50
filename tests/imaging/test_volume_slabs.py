"""Slabs cover a volume once, with margins where there is room; scratch files are shared, and vanish."""

import pickle
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from regolith_studio.errors import MissingRequirement
from regolith_studio.imaging.volume_slabs import (
    ScratchArrays,
    SharedArray,
    slab_ranges,
    thick_slabs,
    unpacked,
)


@pytest.mark.parametrize("shape", [(5, 5, 1), (7, 3, 8), (100, 100, 103), (3000, 3000, 20)])
def test_that_slabs_cover_every_slice_once(shape: tuple[int, int, int]) -> None:
    ranges = slab_ranges(shape, 100_000)
    slices = [z for first, stop in ranges for z in range(first, stop)]
    assert slices == list(range(shape[2]))
    assert all(stop - first >= 8 for first, stop in ranges[:-1])


class Sequence:
    """A volume that remembers which slices were asked for."""

    voxel_size, kind, name = (1.0, 1.0, 1.0), "grey", "t"

    def __init__(self, array: np.ndarray) -> None:
        self.array, self.shape, self.dtype = array, array.shape, array.dtype
        self.asked: list[int] = []

    def read(self, z0: int, z1: int) -> np.ndarray:
        self.asked.extend(range(z0, z1))
        return self.array[:, :, z0:z1]


@pytest.mark.parametrize("margin", [0, 1, 3, 20])
@pytest.mark.parametrize("depth", [1, 7, 8, 9, 30])
def test_that_thick_slabs_read_each_slice_once_and_in_order(depth: int, margin: int) -> None:
    """At eight slices a slab, the margin is once larger than a slab."""
    volume = Sequence(np.arange(6 * depth).reshape(2, 3, depth))
    slabs = list(thick_slabs(volume, slab_ranges(volume.shape, 48), margin))
    assert volume.asked == list(range(depth))
    assert [(slab.first, slab.stop) for slab in slabs] == slab_ranges(volume.shape, 48)
    for slab in slabs:
        low, high = max(slab.first - margin, 0), min(slab.stop + margin, depth)
        assert np.array_equal(slab.values, volume.array[:, :, low:high])
        assert np.array_equal(slab.values[:, :, slab.inner], volume.array[:, :, slab.first : slab.stop])


def test_that_scratch_arrays_are_the_same_in_memory_and_on_disk(tmp_path: Path) -> None:
    with ScratchArrays() as memory, ScratchArrays(tmp_path) as disk:
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
    with ScratchArrays(tmp_path) as scratch, pytest.raises(MissingRequirement, match="do not fit"):
        scratch.zeros((1024, 1024, 2), np.uint8)
    assert not list(tmp_path.iterdir())


def test_that_a_shared_array_is_sent_as_the_path_of_its_file(tmp_path: Path) -> None:
    with ScratchArrays(tmp_path) as scratch:
        shared = SharedArray(scratch.zeros((300, 200, 100), np.int32))
        shared.array[7, 8, 9] = 3
        sent = pickle.dumps(shared)
        assert len(sent) < 1000
        there = pickle.loads(sent)
        assert there.slices(9, 10)[7, 8, 0] == 3
        there.write(20, np.full((300, 200, 2), 5, np.int32))
        assert np.array_equal(np.unique(shared.slices(20, 22)), [5])
        assert shared.array.sum() == 3 + 300 * 200 * 2 * 5


def test_that_a_volume_that_has_no_parts_is_read_by_this_process_alone() -> None:
    class Stream(Sequence):
        origin = (0.0, 0.0, 0.0)

        def parts(self) -> list[tuple[int, int]]:
            return []

    def refused(*_: object) -> None:
        raise AssertionError("another process would have begun at its first byte again")

    stream = Stream(np.arange(6 * 30).reshape(2, 3, 30))
    steps = unpacked(stream, ScratchArrays(), refused)
    found = []

    def read():
        found.append((yield from steps))

    assert len(list(read())) == len(slab_ranges(stream.shape))
    assert np.array_equal(found[0].array, stream.array)
    assert stream.asked == list(range(30))
