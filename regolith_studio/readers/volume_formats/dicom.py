"""DICOM series: the slices of one scan, a file each or frames of one file, ordered by their positions.

Edges, orientation and positions are those of PS3.3 C.7.6.2: PixelSpacing is the distance of rows, then of
columns, and ImageOrientationPatient the direction of a row, then of a column, all in millimetres. What
differs between the frames of one file stands in its functional groups (PS3.3 C.7.6.16), one item a frame,
and what they share in one item for all.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message, count_message
from regolith_studio.readers.error_messages import any_fault, display_name, printable
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    DatasetEntry,
    Sizes,
    VoxelHeader,
    sizes_or_none,
    three_dimensions,
)
from regolith_studio.readers.voxels.slice_series import DICOM_SUFFIXES, dicom_names, is_dicom

MAX_FRAMES = 1 << 16
_PER_FRAME, _SHARED = "PerFrameFunctionalGroupsSequence", "SharedFunctionalGroupsSequence"
_GROUPS = {
    "PixelSpacing": "PixelMeasuresSequence",
    "SpacingBetweenSlices": "PixelMeasuresSequence",
    "SliceThickness": "PixelMeasuresSequence",
    "ImagePositionPatient": "PlanePositionSequence",
    "ImageOrientationPatient": "PlaneOrientationSequence",
    "RescaleSlope": "PixelValueTransformationSequence",
    "RescaleIntercept": "PixelValueTransformationSequence",
}
"""The functional group of each tag that may differ between frames."""
_TAGS = (
    "SeriesInstanceUID",
    "InstanceNumber",
    "Rows",
    "Columns",
    "BitsAllocated",
    "BitsStored",
    "PixelRepresentation",
    "SamplesPerPixel",
    "NumberOfFrames",
    _PER_FRAME,
    _SHARED,
    *_GROUPS,
)
_RLE, _BIG_ENDIAN = "1.2.840.10008.1.2.5", "1.2.840.10008.1.2.2"
_READ = ("1.2.840.10008.1.2", "1.2.840.10008.1.2.1", _BIG_ENDIAN, _RLE)
"""Transfer syntaxes whose pixels are read: unpacked ones, and run lengths, which pydicom unpacks itself."""


@dataclass(frozen=True, eq=False)
class DicomFrame:
    """One frame of a file: its series and numbers, its pixels, and where they are.

    `number` is that of the file, `frame` that in the file, from 0, of `count`. `layout` is rows, columns, and
    the stored type; `spacing` the edges along x and y in millimetres; `directions` those of rows and columns,
    shape (2, 3); `step` the stated distance to the next slice, which is the thickness where `is_thickness`.
    `rounding` is the last digit of the position, and `unused` the number of high bits that are not stored.
    """

    path: Path
    series: str
    number: int
    frame: int
    count: int
    packed: bool
    layout: tuple[int, int, str]
    spacing: tuple[float, float]
    position: NDArray[np.float64] | None
    directions: NDArray[np.float64] | None
    slope: float
    intercept: float
    step: float
    is_thickness: bool
    rounding: float
    unused: int


class PackedPixelsError(FileError):
    """A file whose pixels are packed in a way that is not read; `series` is that which it states."""

    def __init__(self, sentence: str, series: str) -> None:
        super().__init__(sentence)
        self.series = series


def frames_of(path: Path) -> list[DicomFrame]:
    """What a file states of its frames, without their pixels; none for a file of another kind than an image.

    Raises FileError if its frames are no grey images, or are packed by something else than run lengths.
    """
    data = _parsed(path, stop_before_pixels=True, specific_tags=list(_TAGS))
    name = display_name(path)
    if not _is_image(data):
        return []
    syntax = str(getattr(data.file_meta, "TransferSyntaxUID", ""))
    if syntax not in _READ:
        raise PackedPixelsError(
            f"holds {name}, whose pixels are packed; unpack the series, for example with gdcmconv.",
            str(data.get("SeriesInstanceUID", "")) if "Columns" in data else "",  # cut short otherwise
        )
    try:
        layout = _layout(data, name, syntax)
        count = int(data.get("NumberOfFrames", 1) or 1)
        groups = _groups(data, count, name)
        needed = count * layout[0] * layout[1] * np.dtype(layout[2]).itemsize
        if syntax != _RLE and count > 1 and needed > path.stat().st_size:
            raise FileError(f"holds {name}, which is shorter than the {count:,} frames that it states.")
        return [_frame(path, data, groups, k, count, syntax == _RLE, layout) for k in range(count)]
    except FileError:
        raise
    except Exception:  # noqa: BLE001 (values are converted when they are asked for, and fail in many ways)
        raise FileError(f"holds {name}, whose header is damaged or lacks the size of its image.") from None


def _is_image(data: Any) -> bool:
    """Whether a file has the size of an image, or is not of a class that is known to have none."""
    try:
        uid = getattr(data.file_meta, "MediaStorageSOPClassUID", "")
        name = str(getattr(uid, "name", uid))
    except Exception:  # noqa: BLE001 (values are converted when they are asked for, and fail in many ways)
        return True
    return "Image" in name or name == str(uid) or "Rows" in data or "Columns" in data


def _layout(data: Any, name: str, syntax: str) -> tuple[int, int, str]:
    rows, columns, bits = (int(data[tag].value) for tag in ("Rows", "Columns", "BitsAllocated"))
    grey = int(data.get("SamplesPerPixel", 1) or 1) == 1
    if not grey or bits not in (8, 16, 32) or not rows > 0 < columns:
        raise FileError(f"holds {name}, which is not one grey image of 8, 16 or 32 bits.")
    letter = "i" if data.get("PixelRepresentation", 0) else "u"
    return rows, columns, f"{'>' if syntax == _BIG_ENDIAN else '<'}{letter}{bits // 8}"


def _groups(data: Any, count: int, name: str) -> list[list[Any]]:
    """The items that describe each frame, the one of its own first; the file itself is the last."""
    own = data.get(_PER_FRAME) or []
    if not 1 <= count <= MAX_FRAMES or (own and len(own) != count):
        raise FileError(
            f"holds {name}, which states {count:,} frames and describes {len(own):,}; export it again."
        )
    shared = list(data.get(_SHARED) or [])
    return [[*own[k : k + 1], *shared, data] for k in range(count)]


def _frame(
    path: Path,
    data: Any,
    groups: list[list[Any]],
    k: int,
    count: int,
    packed: bool,
    layout: tuple[int, int, str],
) -> DicomFrame:
    spacing = _numbers(groups[k], "PixelSpacing", 2)
    directions = _numbers(groups[k], "ImageOrientationPatient", 6)
    slope, intercept = (
        float(_value(groups[k], tag) or default)
        for tag, default in (("RescaleSlope", 1), ("RescaleIntercept", 0))
    )
    if not np.isfinite([slope, intercept]).all():
        raise ValueError("no finite scale")
    distance, thickness = (_value(groups[k], tag) for tag in ("SpacingBetweenSlices", "SliceThickness"))
    bits = int(data["BitsAllocated"].value)
    unused = bits - int(data.get("BitsStored", bits) or bits)
    if not 0 <= unused < bits:
        raise ValueError("more bits are stored than there are")
    return DicomFrame(
        path,
        str(data.get("SeriesInstanceUID", "")),
        int(data.get("InstanceNumber", 0) or 0),
        k,
        count,
        packed,
        layout,
        (0.0, 0.0) if spacing is None else (float(spacing[1]), float(spacing[0])),
        _numbers(groups[k], "ImagePositionPatient", 3),
        None if directions is None else directions.reshape(2, 3),
        slope,
        intercept,
        float(distance or thickness or 0.0),
        not distance and bool(thickness),
        _rounding(_value(groups[k], "ImagePositionPatient")),
        unused,
    )


def _rounding(position: Any) -> float:
    """One in the last digit of decimal numbers that a file holds as text; 0 where it has no position."""
    if position is None:
        return 0.0
    exponents = [Decimal(str(each)).as_tuple().exponent for each in position]
    return float(10.0 ** min(each for each in exponents if isinstance(each, int)))


def _value(items: list[Any], tag: str) -> Any:
    """The first value of a tag in the items of a frame, in its functional group or in the file itself."""
    for item in items:
        for place in (*list(item.get(_GROUPS[tag]) or [])[:1], item):
            element = place.get(tag)
            if element is not None and element != "":
                return element
    return None


def _numbers(items: list[Any], tag: str, count: int) -> NDArray[np.float64] | None:
    """A list of finite numbers; None where the file has no such tag."""
    value = _value(items, tag)
    if value is None:
        return None
    numbers = np.array([float(each) for each in value])
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        raise ValueError(tag)
    return numbers


def _parsed(path: Path, **options: Any) -> Any:
    import pydicom

    with any_fault(f"holds {display_name(path)}, which is a broken DICOM file; copy it again."):
        if not is_dicom(path):
            raise FileError(f"holds {display_name(path)}, which does not begin as DICOM; copy it again.")
        return pydicom.dcmread(path, **options)


def pixels_of(frames: Sequence[DicomFrame]) -> Iterator[NDArray[Any]]:
    """The stored values of frames, shape (rows, columns) each; those of one file are read together.

    Raises FileError if a file has other pixels than its header states.
    """
    for path, run in groupby(frames, key=lambda each: each.path):
        there = list(run)
        if there[0].count == 1 and not there[0].packed:
            yield from map(_pixels, there)
        else:
            yield from _unpacked(path, there)


def _pixels(frame: DicomFrame) -> NDArray[Any]:
    """The pixels of a file of one frame, as they lie there."""
    data = _parsed(frame.path, specific_tags=["PixelData"])
    rows, columns, stored = frame.layout
    element = data.get("PixelData")
    needed = rows * columns * np.dtype(stored).itemsize
    if not isinstance(element, bytes) or not needed <= len(element) <= needed + 1:
        count = len(element) if isinstance(element, bytes) else 0
        raise FileError(
            f"is damaged: its slice {display_name(frame.path)} has {count:,} bytes of pixels "
            f"and needs {needed:,}."
        )
    pixels = np.frombuffer(element, stored, rows * columns).reshape(rows, columns)
    if not frame.unused:
        return pixels
    own = pixels.astype(pixels.dtype.newbyteorder("="))
    return (
        own << frame.unused
    ) >> frame.unused  # overlays out, and the sign into the bits that are not stored


def _unpacked(path: Path, frames: list[DicomFrame]) -> Iterator[NDArray[Any]]:
    """Frames of a file of several or packed ones, by the decoders of pydicom itself."""
    import pydicom

    rows, columns, stored = frames[0].layout
    decoder = "pydicom" if frames[0].packed else ""
    with any_fault(f"is damaged: the pixels of {display_name(path)} are not those that its header states."):
        wanted = [each.frame for each in frames]
        unpacked = list(pydicom.iter_pixels(path, raw=True, indices=wanted, decoding_plugin=decoder))
        if len(unpacked) != len(frames) or any(each.shape != (rows, columns) for each in unpacked):
            raise ValueError("other frames")
    yield from (each.astype(np.dtype(stored).newbyteorder("="), copy=False) for each in unpacked)


SPACING_TOLERANCE = 0.01
"""Difference between two distances of slices, and offset of a slice within its plane, over one distance."""
MAX_ROUNDING = 0.1
"""Of positions, over the distance of slices."""
_THICKNESS = N_("The slices state no distance from each other; their thickness was taken for it.")
_BY_NUMBER = N_("The slices state no positions; they were ordered by their numbers.")


class DicomVoxels:
    """Slices that are frames of files, read one after the other, with their slopes and intercepts."""

    def __init__(self, slices: list[DicomFrame], header: VoxelHeader) -> None:
        self.header = header
        self._slices = slices

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx)."""
        out = np.empty((z1 - z0, *self.header.shape[1:]), self.header.dtype)
        wanted = self._slices[z0:z1]
        for place, (each, pixels) in enumerate(zip(wanted, pixels_of(wanted), strict=True)):
            if self.header.dtype.kind == "f":
                out[place] = pixels * each.slope + each.intercept
            else:
                out[place] = pixels
        return out

    def close(self) -> None:
        """Do nothing: no file is kept open."""


def open_dicom(path: Path, options: Mapping[str, Any]) -> DicomVoxels:
    """The series ``options["dataset"]`` of a folder, by default the longest, or that of the file given."""
    folder = path if path.is_dir() else path.parent
    names = [str(name) for name in options.get("names") or dicom_names(folder)]
    series, others = _series(folder, names)
    wanted = options.get("dataset")
    if wanted is None and not path.is_dir():
        wanted = _series_named(path)
    if wanted is not None and str(wanted) not in series:
        raise FileError(f"has no series “{printable(str(wanted))[:70]}”; it holds {len(series)}.")
    chosen = str(wanted) if wanted is not None else max(series, key=lambda key: len(series[key]))
    left_out = _left_out(others, chosen)
    slices, step, notes = _ordered(series[chosen])
    notes += left_out
    if wanted is None and len(series) > 1:
        template = N_("The folder holds {count} series; the longest was read.")
        notes = (Message(template, count=len(series)), *notes)
    return DicomVoxels(slices, _header(slices, step, notes, series, chosen))


_Others = dict[str, PackedPixelsError | None]
"""Files without an image, and those whose image is packed."""


def _series(folder: Path, names: list[str]) -> tuple[dict[str, list[DicomFrame]], _Others]:
    """The frames of each series, and the files that hold none that can be read."""
    series: dict[str, list[DicomFrame]] = {}
    others: _Others = {}
    for name in names:
        try:
            frames = frames_of(folder / name)
        except PackedPixelsError as error:
            others[name] = error
            continue
        if not frames:
            others[name] = None
            continue
        series.setdefault(frames[0].series, []).extend(frames)
    if not series:
        packed = next((error for error in others.values() if error is not None), None)
        raise packed or FileError("holds no image: its DICOM files are of other kinds.")
    return series, others


def _series_named(path: Path) -> str:
    frames = frames_of(path)
    if not frames:
        raise FileError("holds no image: it is DICOM of another kind; open the folder of the slices.")
    return frames[0].series


def _left_out(others: _Others, chosen: str) -> tuple[str, ...]:
    """A note about files without an image of the series."""
    for error in others.values():
        if error is not None and error.series in ("", chosen):
            raise error
    if not others:
        return ()
    names = [printable(name)[:30] for name in others]
    shown = ", ".join(names[:3]) + (", …" if len(names) > 3 else "")
    return (
        count_message(
            N_("Left out 1 file that holds no image of the series: {names}."),
            N_("Left out {count} files that hold no image of the series: {names}."),
            len(names),
            names=shown,
        ),
    )


def _header(
    slices: list[DicomFrame],
    step: float,
    notes: tuple[str, ...],
    series: dict[str, list[DicomFrame]],
    chosen: str,
) -> VoxelHeader:
    rows, columns, stored = slices[0].layout
    scaled = any((each.slope, each.intercept) != (1.0, 0.0) for each in slices)
    size = sizes_or_none([*slices[0].spacing, step])
    entries = tuple(
        DatasetEntry(
            uid, (each.layout[1], each.layout[0], len(usable)), np.dtype(each.layout[2]).name, _size(usable)
        )
        for uid, usable in series.items()
        for each in usable[:1]
    )
    return VoxelHeader(
        three_dimensions((len(slices), rows, columns)),
        np.dtype(np.float32) if scaled else np.dtype(stored).newbyteorder("="),
        size,
        "mm" if size else None,
        None,
        notes,
        entries,
        chosen,
    )


def _size(slices: list[DicomFrame]) -> Sizes | None:
    """Edges of a voxel of a series in millimetres; None if it is no volume or does not state them."""
    try:
        return sizes_or_none([*slices[0].spacing, _ordered(slices)[1]])
    except FileError:
        return None


def _ordered(slices: list[DicomFrame]) -> tuple[list[DicomFrame], float, tuple[str, ...]]:
    """The slices from the first to the last, their distance in millimetres (0 if unknown), and notes.

    They go up along the normal of rows and columns, so that x, y and z are right-handed.
    """
    first = slices[0]
    for each in slices:
        if (each.layout, each.spacing) != (first.layout, first.spacing):
            raise FileError(
                f"is not a volume: {display_name(each.path)} has another size or pixel than the first slice."
            )
    if all(each.position is None for each in slices):
        numbers = [(each.number, each.frame) for each in slices]
        if len(set(numbers)) != len(numbers):
            raise FileError(
                "states neither positions nor different numbers of its slices, so that they have no order."
            )
        return sorted(slices, key=lambda each: (each.number, each.frame)), first.step, _by_number(first)
    places = _places(slices)
    order = np.argsort(places[:, 2], kind="stable")
    places = places[order]
    if len(slices) == 1:
        return slices, first.step, _thickness(first)
    gaps = np.diff(places[:, 2])
    step = float(gaps.mean())
    if gaps.min() <= SPACING_TOLERANCE * np.median(gaps):
        raise FileError("has two slices at one place; export one series into a folder of its own.")
    rounding = min(*(each.rounding for each in slices), MAX_ROUNDING * step)  # trailing zeros are not written
    # Both positions of a gap are rounded, by half of the last digit each.
    if np.abs(gaps - step).max() > max(SPACING_TOLERANCE * step, 1.01 * rounding):
        raise FileError(
            f"has uneven slices, {gaps.min():.4g} to {gaps.max():.4g} mm apart: "
            "some are missing, or it is no volume."
        )
    drift = places[:, :2] - places[0, :2]
    if np.abs(drift).max() > max(SPACING_TOLERANCE * step, 0.55 * rounding):
        raise FileError(
            "has slices that are shifted against each other (a tilted gantry); resample it first."
        )
    return [slices[k] for k in order], step, ()


def _thickness(first: DicomFrame) -> tuple[str, ...]:
    return (_THICKNESS,) if first.is_thickness else ()


def _by_number(first: DicomFrame) -> tuple[str, ...]:
    return (_BY_NUMBER, *_thickness(first))


def _places(slices: list[DicomFrame]) -> NDArray[np.float64]:
    """Position of each slice along its rows, its columns and their normal, shape (n, 3), in millimetres."""
    row_and_column = slices[0].directions
    if row_and_column is None or any(each.position is None for each in slices):
        raise FileError("states the position of some slices only, or no directions; export it again.")
    for each in slices:
        if each.directions is None or np.abs(each.directions - row_and_column).max() > 1e-3:
            raise FileError(
                f"is not a volume: {display_name(each.path)} lies in another direction than the first slice."
            )
    lengths = np.linalg.norm(row_and_column, axis=1)
    if np.abs(lengths - 1.0).max() > 1e-2 or abs(row_and_column[0] @ row_and_column[1]) > 1e-2:
        raise FileError("is damaged: its rows and columns are not at right angles.")
    axes = np.vstack([row_and_column, np.cross(*row_and_column)])
    return np.array([axes @ each.position for each in slices if each.position is not None])


def _prepare() -> None:
    try:
        import pydicom
    except ImportError:
        raise FileError(
            'is DICOM, which needs pydicom, an extra: pip install "regolith-studio[dicom]".'
        ) from None
    pydicom.config.settings.reading_validation_mode = pydicom.config.IGNORE


FORMAT = VolumeFormat(
    "dicom",
    "a DICOM series",
    DICOM_SUFFIXES,
    lambda head: head[128:132] == b"DICM",
    open_dicom,
    _prepare,
    lambda folder: bool(dicom_names(folder)),
)
