"""A few slices of a volume stand where they do in the whole, and the number of them follows the time."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from regolith_studio.imaging import volume_slabs as module
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import sparse_slices

SHAPE = (6, 8, 21)


class Clock:
    """A volume of slices that hold their number, each of which takes a second to read."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.read_ones = 0.0, []
        values = np.broadcast_to(np.arange(SHAPE[2], dtype=np.uint8), SHAPE)
        self._volume = Volume(values, np.array([1.0, 2.0, 4.0]), "grey", "scan")
        monkeypatch.setattr(module, "time", SimpleNamespace(monotonic=lambda: self.now))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._volume, name)

    def read(self, z0: int, z1: int) -> np.ndarray:
        self.now += 1.0
        self.read_ones.append(z0)
        return self._volume.read(z0, z1)


def test_that_the_middle_comes_first_and_the_distance_is_halved_while_there_is_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = Clock(monkeypatch)
    found = sparse_slices(clock, 8.5)  # the middle, 2 of a distance of 16, and 3 of one of 8 fit in
    assert clock.read_ones[0] == 10
    assert len(set(clock.read_ones)) == len(clock.read_ones)
    gaps = np.diff(found.array[0, 0].astype(int))
    assert found.shape == (6, 8, 5)
    assert set(gaps) == {4}
    assert 10 in found.array[0, 0]
    assert found.voxel_size * found.shape == pytest.approx(np.array([1.0, 2.0, 4.0]) * SHAPE)


def test_that_one_slice_is_read_however_short_the_time_and_all_if_it_is_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one = sparse_slices(Clock(monkeypatch), 0.0)
    assert one.array[0, 0].tolist() == [10]
    every = sparse_slices(Clock(monkeypatch), 100.0)
    assert every.array[0, 0].tolist() == list(range(21))
    assert every.voxel_size.tolist() == [1.0, 2.0, 4.0]


def test_that_a_file_in_order_is_read_from_its_beginning(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock(monkeypatch)
    found = sparse_slices(clock, 4.5, in_order=True)
    assert clock.read_ones == [0, 1, 2, 3, 4]
    assert found.array[0, 0].tolist() == [0, 1, 2, 3, 4]
    assert found.voxel_size.tolist() == [1.0, 2.0, 4.0]


def test_that_large_slices_are_thinned_out_and_no_more_than_so_many_bytes_are_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "SLICE_BYTES", 12)
    monkeypatch.setattr(module, "ALL_BYTES", 100)
    found = sparse_slices(Clock(monkeypatch), 100.0)
    assert found.shape[:2] == (3, 4)
    assert 1 < found.shape[2] <= 100 // 12
    assert found.voxel_size * found.shape == pytest.approx(np.array([1.0, 2.0, 4.0]) * SHAPE)
