"""DICOM series as pydicom writes them: voxels, edges and order right, 40 and more broken ones refused."""

import io
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pydicom
import pytest
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.encaps import encapsulate
from pydicom.uid import (
    UID,
    BasicTextSRStorage,
    CTImageStorage,
    ExplicitVRBigEndian,
    ExplicitVRLittleEndian,
    ImplicitVRLittleEndian,
    MediaStorageDirectoryStorage,
    RLELossless,
)

from regolith_studio.errors import FileError
from regolith_studio.jobs.extraction_jobs import volume_sha256
from regolith_studio.readers.volumes.files import volume_files
from regolith_studio.readers.volumes.read import describe_volume, open_slabs, read_volume
from regolith_studio.session.file_kinds import FileKind, kind_of
from tests.readers.mutations import check_answers, check_refused
from tests.readers.test_txm import marked
from tests.readers.test_volume_mutations import answer_of

SHAPE = (5, 6, 7)
X, Y, Z, STEP = 0.010, 0.020, 0.050, np.array([0.0, 0.0, 0.050])
"""Edges of a voxel in millimetres."""
ORIGIN = np.array([-3.0, 4.0, 10.0])
SERIES = "1.2.826.0.1.3680043.8.498.1"
JPEG = UID("1.2.840.10008.1.2.4.70")
Change = Callable[[Dataset], None]


def dicom(
    image: np.ndarray, number: int, syntax: UID = ExplicitVRLittleEndian, series: str = SERIES, **tags: object
) -> bytes:
    """One slice, at its place above the first one; tags of value None are left out."""
    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = syntax
    data.file_meta.MediaStorageSOPClassUID = data.SOPClassUID = CTImageStorage
    data.file_meta.MediaStorageSOPInstanceUID = data.SOPInstanceUID = f"{series}.{number}"
    data.SeriesInstanceUID, data.InstanceNumber = series, number
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.Rows, data.Columns = image.shape
    data.BitsAllocated = data.BitsStored = 8 * image.dtype.itemsize
    data.HighBit, data.PixelRepresentation = data.BitsStored - 1, int(image.dtype.kind == "i")
    data.PixelSpacing = [Y, X]
    data.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    data.ImagePositionPatient = (ORIGIN + number * STEP).tolist()
    pixels = image.astype(image.dtype.newbyteorder(">" if syntax == ExplicitVRBigEndian else "<")).tobytes()
    data.PixelData = encapsulate([pixels]) if syntax == JPEG else pixels + b"\0" * (len(pixels) % 2)
    data["PixelData"].VR = "OW" if data.BitsAllocated > 8 else "OB"
    for name, value in tags.items():
        if value is None:
            delattr(data, name)
        else:
            setattr(data, name, value)
    file = io.BytesIO()
    data.save_as(file, enforce_file_format=True)
    return file.getvalue()


def series(folder: Path, slices: np.ndarray | None = None, **options: object) -> Path:
    """A folder of slices whose names are in another order than their places."""
    folder.mkdir(exist_ok=True)
    slices = marked(SHAPE) if slices is None else slices
    for number, image in enumerate(slices):
        name = f"IM{(number * 3 + 1) % len(slices):03d}.dcm"
        (folder / name).write_bytes(dicom(image, number, **options))
    return folder


@pytest.mark.parametrize("syntax", [ExplicitVRLittleEndian, ImplicitVRLittleEndian, ExplicitVRBigEndian])
@pytest.mark.parametrize("dtype", ["uint8", "uint16", "int16", "int32"])
def test_that_every_voxel_is_in_its_place_with_its_edges(dtype: str, syntax: UID, tmp_path: Path) -> None:
    slices = marked(SHAPE).astype(dtype) - (0 if dtype[0] == "u" else 100)
    folder = series(tmp_path / "scan", slices.astype(dtype), syntax=syntax)
    header = describe_volume(folder)
    assert (header.shape, header.dtype, header.unit) == (SHAPE[::-1], np.dtype(dtype), "mm")
    assert header.voxel_size == pytest.approx((X, Y, Z))
    volume = read_volume(folder, kind="grey")
    assert volume.voxel_size == pytest.approx((10.0, 20.0, 50.0))
    assert np.array_equal(volume.array.T, slices)
    assert np.array_equal(open_slabs(folder, kind="grey").read(2, 4).T, slices[2:4])


@pytest.mark.parametrize("signed", [0, 1])
@pytest.mark.parametrize("stored", [9, 12, 16])
@pytest.mark.parametrize("packed", [False, True])
def test_that_bits_above_those_stored_are_no_part_of_a_value(packed, stored, signed, tmp_path: Path) -> None:
    """Signed numbers of 12 bits have their sign in bit 11; overlays may lie above it."""
    folder = tmp_path / "scan"
    folder.mkdir()
    noise = np.random.default_rng(stored).integers(0, 1 << 16, SHAPE, dtype=np.uint16)
    tags = {"BitsStored": stored, "HighBit": stored - 1, "PixelRepresentation": signed}
    for number, image in enumerate(noise):
        (folder / f"{number}.dcm").write_bytes(dicom(image, number, **tags))
        if packed:
            data = pydicom.dcmread(folder / f"{number}.dcm")
            data.compress(RLELossless)
            data.save_as(folder / f"{number}.dcm", enforce_file_format=True)
    expected = np.stack([pydicom.dcmread(folder / f"{k}.dcm").pixel_array for k in range(SHAPE[0])])
    array = read_volume(folder, kind="grey").array.T
    assert array.dtype == ("int16" if signed else "uint16")
    assert np.array_equal(array, expected)
    assert array.max() < 1 << (stored - signed)


def stranger(kind: UID, series_uid: str = "1.2.3.4") -> bytes:
    """A file of DICOM without an image: a directory, a report."""
    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data.file_meta.MediaStorageSOPClassUID = kind
    data.file_meta.MediaStorageSOPInstanceUID = "1.2.3.5"
    data.SeriesInstanceUID = series_uid
    file = io.BytesIO()
    data.save_as(file, enforce_file_format=True)
    return file.getvalue()


def test_that_files_without_an_image_of_the_series_are_left_out_and_named(tmp_path: Path) -> None:
    folder = series(tmp_path / "scan")
    (folder / "DICOMDIR").write_bytes(stranger(MediaStorageDirectoryStorage))
    (folder / "report.dcm").write_bytes(stranger(BasicTextSRStorage, SERIES))
    (folder / "scout.dcm").write_bytes(dicom(marked(SHAPE)[0], 0, JPEG, "1.2.3.4"))
    assert np.array_equal(read_volume(folder, kind="grey").array.T, marked(SHAPE))
    assert [str(note) for note in describe_volume(folder).notes] == [
        "Left out 3 files that hold no image of the series: DICOMDIR, report.dcm, scout.dcm."
    ]
    (folder / "slice.dcm").write_bytes(dicom(marked(SHAPE)[0], 7, JPEG))
    with pytest.raises(FileError, match=r"holds slice\.dcm, whose pixels are packed"):
        describe_volume(folder)


@pytest.mark.parametrize("digits", [4, 5, 8])
def test_that_positions_are_even_within_their_own_rounding(digits: int, tmp_path: Path) -> None:
    folder = tmp_path / "scan"
    folder.mkdir()
    step = 0.00731
    for number in range(40):
        place = [f"{x:.{digits}f}" for x in (0.0, 0.0, 1.0 + number * step)]
        (folder / f"{number}.dcm").write_bytes(dicom(marked(SHAPE)[0], number, ImagePositionPatient=place))
    assert describe_volume(folder).voxel_size[2] == pytest.approx(step, rel=0.003)
    (folder / "20.dcm").unlink()
    with pytest.raises(FileError, match="some are missing"):
        describe_volume(folder)


def test_that_a_thickness_is_taken_for_a_distance_with_a_note_only(tmp_path: Path) -> None:
    folder = series(tmp_path / "scan", ImagePositionPatient=None, SliceThickness=0.07)
    assert describe_volume(folder).voxel_size == pytest.approx((X, Y, 0.07))
    assert [str(note) for note in describe_volume(folder).notes] == [
        "The slices state no positions; they were ordered by their numbers.",
        "The slices state no distance from each other; their thickness was taken for it.",
    ]
    assert np.array_equal(read_volume(folder, kind="grey").array.T, marked(SHAPE))
    folder = series(
        tmp_path / "other", ImagePositionPatient=None, SliceThickness=0.07, SpacingBetweenSlices=0.08
    )
    assert describe_volume(folder).voxel_size == pytest.approx((X, Y, 0.08))
    assert len(describe_volume(folder).notes) == 1


def test_that_any_file_of_a_series_opens_all_of_it(tmp_path: Path) -> None:
    folder = series(tmp_path / "scan")
    for name in ("IM000.dcm", "IM003.dcm"):
        assert np.array_equal(read_volume(folder / name, kind="grey").array.T, marked(SHAPE))
        assert volume_sha256(folder / name) == volume_sha256(folder)
    assert volume_files(folder) == (folder,)
    assert volume_files(tmp_path) == (folder,)
    assert kind_of(folder) is kind_of(folder / "IM000.dcm") is FileKind.VOLUME


def test_that_files_without_a_suffix_are_known_by_their_content(tmp_path: Path) -> None:
    folder = series(tmp_path / "scan")
    for path in list(folder.iterdir()):
        path.rename(folder / path.stem)
    (folder / "DIRECTORY").write_text("none")
    assert np.array_equal(read_volume(folder / "IM002", kind="grey").array.T, marked(SHAPE))


@pytest.mark.parametrize("turned", [(0, 1, 0, 1, 0, 0), (-1, 0, 0, 0, 1, 0), (0, 1, 0, 0, 0, -1)])
def test_that_slices_go_up_along_the_normal_of_their_rows_and_columns(turned: tuple, tmp_path: Path) -> None:
    """The volume is right-handed, whatever way the scanner counted."""
    normal = np.cross(turned[:3], turned[3:])
    folder = tmp_path / "scan"
    folder.mkdir()
    for number, image in enumerate(marked(SHAPE)):
        place = (ORIGIN - number * Z * normal).tolist()
        data = dicom(image, number, ImageOrientationPatient=list(turned), ImagePositionPatient=place)
        (folder / f"{number}.dcm").write_bytes(data)
    assert np.array_equal(read_volume(folder, kind="grey").array.T, marked(SHAPE)[::-1])


def test_that_slope_and_intercept_of_each_slice_are_applied(tmp_path: Path) -> None:
    folder = tmp_path / "scan"
    folder.mkdir()
    for number, image in enumerate(marked(SHAPE)):
        data = dicom(image, number, RescaleSlope=f"{number + 0.5}", RescaleIntercept="-1024")
        (folder / f"{number}.dcm").write_bytes(data)
    volume = read_volume(folder, kind="grey")
    slopes = np.arange(SHAPE[0])[:, None, None] + 0.5
    assert volume.dtype == np.float32
    assert np.array_equal(volume.array.T, (marked(SHAPE) * slopes - 1024).astype(np.float32))


def test_that_of_several_series_the_longest_is_read_or_that_of_the_file(tmp_path: Path) -> None:
    folder = series(tmp_path / "scan")
    for number, image in enumerate(marked((3, 4, 5))):
        (folder / f"b{number}.dcm").write_bytes(dicom(image, number, series=f"{SERIES}.9"))
    header = describe_volume(folder)
    assert header.shape == SHAPE[::-1]
    assert {(each.name, each.shape) for each in header.datasets} == {
        (SERIES, (7, 6, 5)),
        (f"{SERIES}.9", (5, 4, 3)),
    }
    assert all(each.voxel_size == pytest.approx((X, Y, Z)) for each in header.datasets)
    assert "2 series; the longest" in " ".join(header.notes)
    assert describe_volume(folder, dataset=f"{SERIES}.9").shape == (5, 4, 3)
    assert describe_volume(folder / "b1.dcm").shape == (5, 4, 3)


def with_slice(number: int, **tags: object) -> Change:
    """A series whose slice `number` has other tags."""

    def write(folder: Path) -> None:
        series(folder)
        (folder / f"IM{(number * 3 + 1) % 5:03d}.dcm").write_bytes(
            dicom(marked(SHAPE)[number], number, **tags)
        )

    return write


def bad_series() -> Iterator[tuple[Callable[[Path], object], str]]:
    def cut(share: float) -> Callable[[Path], None]:
        def write(folder: Path) -> None:
            path = series(folder) / "IM002.dcm"
            path.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])

        return write

    for share in (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99):
        yield (
            cut(share),
            "begin as DICOM|broken DICOM|is damaged|header is damaged|are packed|states the position of some",
        )
    for z in (10.21, 10.26, 1e6, 11.0):
        yield with_slice(4, ImagePositionPatient=[-3.0, 4.0, z]), "uneven slices"
    for number in (0, 2):
        yield with_slice(4, ImagePositionPatient=(ORIGIN + number * STEP).tolist()), "two slices at one place"
    for x in (-3.1, -2.999, 7.0):
        yield with_slice(2, ImagePositionPatient=[x, 4.0, 10.1]), "shifted against each other"
    for turned in ([0, 1, 0, 1, 0, 0], [1, 0, 0, 0, 0.9, 0.4], [0, 0, 1, 0, 1, 0]):
        yield with_slice(3, ImageOrientationPatient=turned), "lies in another direction"
    for turned in ([1, 0, 0, 1, 0, 0], [2, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 0]):
        yield lambda folder, t=turned: series(folder, ImageOrientationPatient=t), "not at right angles"
    yield with_slice(1, ImagePositionPatient=None), "position of some slices only"
    yield lambda folder: series(folder, ImageOrientationPatient=None), "or no directions"
    yield lambda folder: series(folder, ImagePositionPatient=None, InstanceNumber=7), "no order"
    for spacing in ([0.02, 0.011], [0.0, 0.0], [5, 5]):
        yield with_slice(2, PixelSpacing=spacing), "another size or pixel"
    yield lambda folder: series(folder, syntax=JPEG), "pixels are packed"
    for name, value in (
        ("Rows", 0), ("Columns", 0), ("BitsAllocated", 12), ("BitsAllocated", 64), ("SamplesPerPixel", 3),
    ):  # fmt: skip
        yield lambda folder, n=name, v=value: series(folder, **{n: v}), "not one grey image"
    yield lambda folder: series(folder, NumberOfFrames=2), "two slices at one place"
    yield lambda folder: series(folder, NumberOfFrames=900), "shorter than the 900 frames"
    for name in ("Rows", "Columns", "BitsAllocated"):
        yield lambda folder, n=name: series(folder, **{n: None}), "lacks the size"
    for name, value in (("Rows", 60), ("Columns", 6000), ("BitsAllocated", 32), ("BitsAllocated", 8)):
        yield (
            lambda folder, n=name, v=value: series(folder, **{n: v}),
            "bytes of pixels and needs|header is damaged",
        )
    yield lambda folder: series(folder, PixelData=None), "0 bytes of pixels and needs"
    yield with_slice(0, Rows=5), "another size or pixel"


def test_that_each_broken_series_is_refused_with_the_sentence_of_its_kind(tmp_path: Path) -> None:
    corpus = list(bad_series())
    assert len(corpus) >= 40
    for number, (write, pattern) in enumerate(corpus):
        folder = tmp_path / f"{number}"
        write(folder)
        check_refused(folder, pattern)


@pytest.mark.slow
@pytest.mark.parametrize("syntax", [ExplicitVRLittleEndian, ImplicitVRLittleEndian])
def test_that_four_hundred_mutations_give_voxels_or_a_sentence(syntax: UID, tmp_path: Path) -> None:
    folder = series(tmp_path / "scan", syntax=syntax)
    check_answers(folder / "IM002.dcm", lambda: answer_of(folder))


def test_that_a_missing_library_is_named_with_its_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pydicom", None)
    shutil.copytree(series(tmp_path / "scan"), tmp_path / "copy")
    assert answer_of(tmp_path / "copy") == (
        'is DICOM, which needs pydicom, an extra: pip install "regolith-studio[dicom]".'
    )
