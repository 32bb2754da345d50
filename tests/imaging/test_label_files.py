"""Label volumes that are written are read back, by libraries and by the program, voxel for voxel."""

import gzip
import re
from pathlib import Path

import h5py
import numpy as np
import pytest
import tifffile

from regolith_studio.errors import InputError
from regolith_studio.imaging import label_files
from regolith_studio.imaging.label_files import LABEL_SUFFIXES, write_label_file
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import slab_ranges
from regolith_studio.readers.volumes.read import read_volume

EDGES = np.array([1.25, 2.5, 4.0])


def labels_of(highest: int) -> Volume:
    """Boxes of labels, one corner marked so that no axis is swapped or mirrored."""
    array = np.zeros((30, 21, 26), dtype=np.int64)
    array[2:9, 3:15, 4:10], array[12:28, 5:19, 12:25] = 1, 2
    array[0, 1, 2] = highest
    return Volume(array, EDGES, "labels", "scan", (0.0, 3.0, 0.5))


def written(path: Path, labels: Volume, monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    monkeypatch.setattr(label_files, "slab_ranges", lambda shape: slab_ranges(shape, 30 * 21 * 8))
    return list(write_label_file(path, labels, int(labels.array.max())))


@pytest.mark.parametrize("highest", [3, 70_000])
@pytest.mark.parametrize("suffix", LABEL_SUFFIXES)
def test_that_labels_are_read_back_with_their_voxel_size(
    suffix: str, highest: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    labels = labels_of(highest)
    steps = written(tmp_path / f"labels{suffix}", labels, monkeypatch)
    assert steps == [(1, 4), (2, 4), (3, 4), (4, 4)]
    back = read_volume(tmp_path / f"labels{suffix}", kind="labels")
    assert np.array_equal(back.array, labels.array)
    assert back.voxel_size == pytest.approx(EDGES)
    assert back.dtype == (np.uint16 if highest == 3 else np.uint32)


def test_that_other_libraries_read_slices_rows_and_columns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    labels = labels_of(9)
    for suffix in (".tif", ".h5", ".nrrd"):
        written(tmp_path / f"labels{suffix}", labels, monkeypatch)
    with tifffile.TiffFile(tmp_path / "labels.tif") as file:
        assert file.is_ome
        assert file.series[0].axes == "ZYX"
        assert np.array_equal(file.series[0].asarray(), labels.array.T)
        assert 'PhysicalSizeZ="4.0"' in file.ome_metadata
    with h5py.File(tmp_path / "labels.h5") as file:
        assert np.array_equal(file["labels"][()], labels.array.T)
        assert file["labels"].attrs["element_size_um"].tolist() == [4.0, 2.5, 1.25]
    header, _, packed = (tmp_path / "labels.nrrd").read_bytes().partition(b"\n\n")
    voxels = np.frombuffer(gzip.decompress(packed), "<u2").reshape(labels.shape[::-1])
    assert np.array_equal(voxels, labels.array.T)
    assert re.search(rb"space directions: \(1.25,0.0,0.0\) \(0.0,2.5,0.0\) \(0.0,0.0,4.0\)", header)
    assert b"space origin: (0.0,7.5,2.0)" in header


@pytest.mark.parametrize("suffix", LABEL_SUFFIXES)
def test_that_equal_labels_give_equal_bytes(
    suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = [tmp_path / f"{name}{suffix}" for name in "ab"]
    for path in paths:
        written(path, labels_of(3), monkeypatch)
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_that_a_file_that_is_stopped_leaves_nothing(tmp_path: Path) -> None:
    steps = write_label_file(tmp_path / "labels.nrrd", labels_of(3), 3)
    next(steps)
    steps.close()
    assert not list(tmp_path.iterdir())


def test_that_labels_of_another_format_are_refused(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"Labels are written as \.tif, \.tiff, \.nrrd, .*, not as labels\.png"
    ):
        next(write_label_file(tmp_path / "labels.png", labels_of(3), 3))
