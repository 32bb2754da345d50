"""DICOM files of several frames and of run lengths, as pydicom writes them."""

import io
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from pydicom import dcmread
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence
from pydicom.uid import UID, ExplicitVRBigEndian, ExplicitVRLittleEndian, ImplicitVRLittleEndian, RLELossless

from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume
from tests.readers.mutations import check_answers, check_refused
from tests.readers.test_dicom import ORIGIN, SHAPE, STEP, X, Y, Z, dicom, series
from tests.readers.test_txm import marked
from tests.readers.test_volume_mutations import answer_of

ORDER = (3, 0, 4, 1, 2)
"""Place of each frame in the volume."""


def group(**tags: object) -> Dataset:
    made = Dataset()
    for name, value in tags.items():
        setattr(made, name, value)
    return made


def placed(place: int, **more: object) -> Dataset:
    """The functional groups of the frame at a place."""
    return group(
        PlanePositionSequence=Sequence([group(ImagePositionPatient=(ORIGIN + place * STEP).tolist())]), **more
    )


def enhanced(path: Path, slices: np.ndarray | None = None, packed: bool = False, **changes: object) -> Path:
    """A file of several frames in another order than their places; positions stand in functional groups."""
    slices = marked(SHAPE) if slices is None else slices
    syntax = changes.pop("syntax", ExplicitVRLittleEndian)
    frames = slices[list(ORDER)]
    data = dcmread(io.BytesIO(dicom(frames[0], 1, syntax=syntax)))
    for tag in ("PixelSpacing", "ImageOrientationPatient", "ImagePositionPatient"):
        delattr(data, tag)
    data.NumberOfFrames = len(frames)
    stored = frames.dtype.newbyteorder(">" if syntax == ExplicitVRBigEndian else "<")
    pixels = frames.astype(stored).tobytes()
    data.PixelData = pixels + b"\0" * (len(pixels) % 2)
    shared = group(
        PixelMeasuresSequence=Sequence([group(PixelSpacing=[Y, X], SliceThickness=Z)]),
        PlaneOrientationSequence=Sequence([group(ImageOrientationPatient=[1, 0, 0, 0, 1, 0])]),
    )
    data.SharedFunctionalGroupsSequence = Sequence([shared])
    data.PerFrameFunctionalGroupsSequence = Sequence([placed(place) for place in ORDER])
    for name, value in changes.items():
        if value is None:
            delattr(data, name)
        else:
            setattr(data, name, value)
    if packed:
        data.compress(RLELossless)
    data.save_as(path, enforce_file_format=True)
    return path


@pytest.mark.parametrize(
    ("syntax", "packed"),
    [
        (ExplicitVRLittleEndian, False),
        (ImplicitVRLittleEndian, False),
        (ExplicitVRBigEndian, False),
        (ExplicitVRLittleEndian, True),
    ],
)
@pytest.mark.parametrize("dtype", ["uint8", "uint16", "int16"])
def test_that_the_frames_of_one_file_are_ordered_by_their_functional_groups(
    dtype: str, syntax: UID, packed: bool, tmp_path: Path
) -> None:
    slices = (marked(SHAPE).astype(np.int64) - (100 if dtype == "int16" else 0)).astype(dtype)
    path = enhanced(tmp_path / "scan.dcm", slices, packed, syntax=syntax)
    volume = read_volume(path, kind="grey")
    assert volume.dtype == np.dtype(dtype)
    assert np.array_equal(volume.array, slices.T)
    assert volume.voxel_size == pytest.approx([1000 * X, 1000 * Y, 1000 * Z])
    assert np.array_equal(open_slabs(path).read(2, 4), slices[2:4].T)


def test_that_each_frame_has_a_scale_of_its_own(tmp_path: Path) -> None:
    scales = Sequence(
        [
            placed(
                place,
                PixelValueTransformationSequence=Sequence(
                    [group(RescaleSlope=str(1 + place), RescaleIntercept="-5")]
                ),
            )
            for place in ORDER
        ]
    )
    path = enhanced(tmp_path / "scan.dcm", PerFrameFunctionalGroupsSequence=scales)
    expected = marked(SHAPE) * (1.0 + np.arange(5))[:, None, None] - 5
    assert np.array_equal(read_volume(path, kind="grey").array, expected.T.astype(np.float32))


def test_that_frames_without_places_keep_their_order(tmp_path: Path) -> None:
    path = enhanced(
        tmp_path / "scan.dcm",
        PerFrameFunctionalGroupsSequence=None,
        SharedFunctionalGroupsSequence=None,
        PixelSpacing=[Y, X],
        SpacingBetweenSlices=Z,
    )
    assert np.array_equal(read_volume(path, kind="grey").array, marked(SHAPE)[list(ORDER)].T)
    header = describe_volume(path)
    assert header.voxel_size == pytest.approx((X, Y, Z))
    assert "ordered by their numbers" in " ".join(header.notes)


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "int16"])
def test_that_a_series_packed_by_run_lengths_is_read(dtype: str, tmp_path: Path) -> None:
    folder = series(tmp_path / "scan", marked(SHAPE).astype(dtype))
    for path in folder.iterdir():
        data = dcmread(path)
        data.compress(RLELossless)
        data.save_as(path, enforce_file_format=True)
    volume = read_volume(folder, kind="grey")
    assert volume.dtype == np.dtype(dtype)
    assert np.array_equal(volume.array, marked(SHAPE).T)


def broken() -> Iterator[tuple[Callable[[Path], object], str]]:
    def short(path: Path) -> None:
        path.write_bytes(enhanced(path).read_bytes()[:-300])

    def wrong_lengths(path: Path) -> None:
        enhanced(path, packed=True)
        data = path.read_bytes()
        at = data.rindex(b"\xfe\xff\x00\xe0") + 8 + 64  # the run lengths of the last frame
        path.write_bytes(data[:at] + b"\x7f" * 40 + data[at + 40 :])

    yield short, "broken DICOM|pixels of .* are not those"
    yield wrong_lengths, "pixels of .* are not those"
    yield lambda path: enhanced(path, NumberOfFrames=4), "states 4 frames and describes 5"
    yield lambda path: enhanced(path, NumberOfFrames=10**6), "states 1,000,000 frames"
    yield lambda path: enhanced(path, Rows=600), "shorter than the 5 frames"
    twice = Sequence([placed(place) for place in (0, 0, 1, 2, 3)])
    yield lambda path: enhanced(path, PerFrameFunctionalGroupsSequence=twice), "two slices at one place"
    few = Sequence([placed(place) for place in (0, 5, 1, 2, 3)])
    yield lambda path: enhanced(path, PerFrameFunctionalGroupsSequence=few), "uneven slices"
    bare = Sequence([placed(0), *(Dataset() for _ in range(4))])
    yield lambda path: enhanced(path, PerFrameFunctionalGroupsSequence=bare), "position of some slices only"


def test_that_frames_that_contradict_their_file_are_refused_with_a_sentence(tmp_path: Path) -> None:
    for number, (write, pattern) in enumerate(broken()):
        path = tmp_path / f"{number}" / "scan.dcm"
        path.parent.mkdir()
        write(path)
        check_refused(path, pattern)


@pytest.mark.slow
@pytest.mark.parametrize("packed", [False, True])
def test_that_four_hundred_mutations_of_frames_give_voxels_or_a_sentence(
    packed: bool, tmp_path: Path
) -> None:
    path = enhanced(tmp_path / "scan.dcm", packed=packed)
    check_answers(path, lambda: answer_of(path), seed=7)
