"""Slices that are Windows bitmaps: their decoder trusts the header, so that it is checked before."""

import struct
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.read import describe_volume, read_volume

VOXELS = np.random.default_rng(3).integers(0, 255, (3, 6, 7)).astype(np.uint8)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for number, image in enumerate(VOXELS):
        imageio.imwrite(tmp_path / f"slice_{number}.bmp", image)
    return tmp_path


def test_that_bitmaps_are_slices(folder: Path) -> None:
    assert np.array_equal(read_volume(folder, voxel_size=1.0, kind="grey").array.T, VOXELS)


def test_that_one_slice_alone_leads_to_its_folder(folder: Path) -> None:
    with pytest.raises(
        FileError, match=r"slice_1\.bmp is a single picture; open the folder that holds all slices"
    ):
        describe_volume(folder / "slice_1.bmp")


@pytest.mark.parametrize(
    ("place", "kind", "value", "words"),
    [
        (10, "<I", 4_000_000_000, "slice_1.bmp ends before its pixels do"),
        (18, "<i", 70_000, "slice_1.bmp ends before its pixels do"),
        (22, "<i", -600, "slice_1.bmp ends before its pixels do"),
        (46, "<I", 100_000, "slice_1.bmp ends before its pixels do"),
        (14, "<I", 12, "slice_1.bmp has no header of a Windows bitmap; save it as PNG"),
        (28, "<H", 7, "slice_1.bmp has no header of a Windows bitmap; save it as PNG"),
        (30, "<I", 1, "slice_1.bmp is a packed bitmap; save it unpacked, or as PNG"),
    ],
)
def test_that_a_header_that_promises_what_is_not_there_is_refused(
    folder: Path, place: int, kind: str, value: int, words: str
) -> None:
    data = bytearray((folder / "slice_1.bmp").read_bytes())
    struct.pack_into(kind, data, place, value)
    (folder / "slice_1.bmp").write_bytes(data)
    with pytest.raises(FileError, match=words):
        read_volume(folder, voxel_size=1.0, kind="grey")
