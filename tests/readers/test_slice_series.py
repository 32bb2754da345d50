"""Folders of slices: which number counts, which slices are missing, and which images are none."""

import numpy as np
import pytest
import tifffile

from regolith_studio.errors import FileError
from regolith_studio.readers.volumes.files import volume_files
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume
from regolith_studio.readers.voxels.slice_series import slice_series


def write(folder, names, shape=(3, 4)):
    """Slices whose voxels are their place in the list, counted from 1."""
    folder.mkdir(exist_ok=True)
    for place, name in enumerate(names, start=1):
        tifffile.imwrite(folder / name, np.full(shape, place, dtype=np.uint8))
    return folder


def order(folder, **options):
    """What the slices hold, from the first to the last."""
    return read_volume(folder, voxel_size=1.0, **options).array[0, 0].tolist()


SERIES = {
    "leading zeros": [f"slice_{k:03d}.tif" for k in range(1, 13)],
    "no leading zeros": [f"s{k}.tif" for k in range(1, 13)],
    "minus signs": [f"z{k}.tif" for k in range(-5, 19)],
    "minus signs and zeros": [f"z{k:+04d}.tif" for k in range(-5, 6)],
    "a dash before": [f"scan-{k:03d}.tif" for k in range(12)],
    "hexadecimal": [f"s_{k:x}.tif" for k in range(24)],
    "hexadecimal of four digits": [f"s_{k:04X}.tif" for k in range(24)],
    "a constant number behind": [f"scan2_z{k}_ch0.tif" for k in range(1, 25)],
    "a date before": [f"2024-05-{7}_{k}.tif" for k in range(12)],
    "a time that goes up too": [f"im_{k:02d}_t{k * k}.tif" for k in range(1, 12)],
    "two scans that go on": [f"scan{1 + k // 6}_z{k}.tif" for k in range(12)],
    "capitals in the suffix": [f"s{k}.{'TIF' if k % 2 else 'tif'}" for k in range(1, 13)],
}


@pytest.mark.parametrize("kind", SERIES)
def test_that_the_number_that_varies_counts_the_slices(kind, tmp_path):
    names = SERIES[kind]
    folder = write(tmp_path / "scan", names)
    assert volume_files(folder) == (folder,)
    assert order(folder) == list(range(1, len(names) + 1))
    assert describe_volume(folder).notes == ()


def test_that_a_missing_slice_is_named_and_read_as_an_empty_one_where_that_is_allowed(tmp_path):
    folder = write(tmp_path / "scan", [f"z{k:03d}.tif" for k in range(1, 25) if k not in (3, 10, 11, 12)])
    with pytest.raises(FileError, match=r"lacks 4 slices of z#\.tif, numbers 3, 10 to 12; .*--allow-gaps"):
        describe_volume(folder)
    slices = order(folder, allow_gaps=True)
    assert slices == [1, 2, 0, *range(3, 9), 0, 0, 0, *range(9, 21)]
    notes = open_slabs(folder, voxel_size=1.0, allow_gaps=True).notes
    assert [str(note) for note in notes] == ["Slices that are absent were left empty: numbers 3, 10 to 12."]


def test_that_gaps_of_hexadecimal_and_of_negative_numbers_are_found(tmp_path):
    folder = write(tmp_path / "hex", [f"s_{k:x}.tif" for k in range(24) if k != 12])
    with pytest.raises(FileError, match=r"lacks 1 slice of s_#\.tif, number 12;"):
        describe_volume(folder)
    folder = write(tmp_path / "negative", [f"z{k}.tif" for k in range(-5, 6) if k != -2])
    with pytest.raises(FileError, match=r"lacks 1 slice of z#\.tif, number -2;"):
        describe_volume(folder)


def test_that_slices_counted_by_ten_are_neighbours_with_a_note(tmp_path):
    folder = write(tmp_path / "scan", [f"z{k}.tif" for k in range(0, 120, 10)])
    assert order(folder) == list(range(1, 13))
    assert [str(note) for note in describe_volume(folder).notes] == [
        "The numbers of the slices go up by 10; they were taken as neighbours."
    ]
    (folder / "z50.tif").unlink()
    with pytest.raises(FileError, match=r"lacks 1 slice of z#\.tif, number 50"):
        describe_volume(folder)


def test_that_two_series_are_a_choice_by_their_names(tmp_path):
    first, second = [f"a_{k}.tif" for k in range(5)], [f"b_{k}.tif" for k in range(5)]
    folder = write(tmp_path / "scan", [*second, *first])
    header = describe_volume(folder)
    assert [entry.name for entry in header.datasets] == ["a_#.tif", "b_#.tif"]
    assert header.dataset == "a_#.tif"
    assert [str(note) for note in header.notes] == ["The folder holds 2 series of slices; a_#.tif was read."]
    assert order(folder) == [6, 7, 8, 9, 10]
    assert order(folder, dataset="b_#.tif") == [1, 2, 3, 4, 5]
    with pytest.raises(FileError, match=r"has no series “c_#\.tif”; it holds a_#\.tif, b_#\.tif"):
        describe_volume(folder, dataset="c_#.tif")


def test_that_channels_are_series(tmp_path):
    names = [f"z{k}_ch{channel}.tif" for channel in range(2) for k in range(6)]
    header = describe_volume(write(tmp_path / "scan", names))
    assert [(entry.name, entry.shape) for entry in header.datasets] == [
        ("z#_ch0.tif", (4, 3, 6)), ("z#_ch1.tif", (4, 3, 6)),
    ]  # fmt: skip


def test_that_two_slices_of_one_number_are_refused(tmp_path):
    folder = write(tmp_path / "scan", ["z1.tif", "z01.tif", "z2.tif", "z3.tif"])
    with pytest.raises(FileError, match=r"two slices of the number 1: z0?1\.tif and z0?1\.tif"):
        describe_volume(folder)


def test_that_images_which_are_no_slices_are_named(tmp_path):
    folder = write(tmp_path / "scan", [*(f"s_{k:x}.tif" for k in range(24)), "preview.tif"])
    assert order(folder) == list(range(1, 25))
    assert [str(note) for note in describe_volume(folder).notes] == [
        "Left out 1 image whose name does not fit: preview.tif."
    ]


def test_that_words_of_hexadecimal_letters_are_no_numbers():
    names = ["bead.tif", "cafe.tif", "face.tif", "decade.tif", "1.tif"]
    assert slice_series(names) == ([], sorted(names))
    letters = [f"{k}{letter}.tif" for k in range(1, 4) for letter in "ab"]
    assert [each.name for each in slice_series(letters)[0]] == ["#a.tif", "#b.tif"]
