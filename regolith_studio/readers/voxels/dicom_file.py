"""Frames of one DICOM file: where each lies, and its pixels.

An ordinary file holds one frame. A multi-frame file holds several; what differs between them stands in its
functional groups (PS3.3 C.7.6.16), one item a frame, and what they share in one item for all.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import display_name
from regolith_studio.readers.voxels.folders import is_dicom

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

    Raises
    ------
    FileError
        If its frames are no grey images, or are packed by something else than run lengths.
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
            found = place.get(tag)
            if found is not None and found != "":
                return found
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

    try:
        if not is_dicom(path):
            raise FileError(f"holds {display_name(path)}, which does not begin as DICOM; copy it again.")
        return pydicom.dcmread(path, **options)
    except (FileError, MemoryError):
        raise
    except Exception:  # noqa: BLE001 (whatever a parser trips over is the file's fault)
        raise FileError(f"holds {display_name(path)}, which is a broken DICOM file; copy it again.") from None


def pixels_of(frames: Sequence[DicomFrame]) -> Iterator[NDArray[Any]]:
    """The stored values of frames, shape (rows, columns) each; those of one file are read together.

    Raises
    ------
    FileError
        If a file has other pixels than its header states.
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
    found = data.get("PixelData")
    needed = rows * columns * np.dtype(stored).itemsize
    if not isinstance(found, bytes) or not needed <= len(found) <= needed + 1:
        count = len(found) if isinstance(found, bytes) else 0
        raise FileError(
            f"is damaged: its slice {display_name(frame.path)} has {count:,} bytes of pixels "
            f"and needs {needed:,}."
        )
    pixels = np.frombuffer(found, stored, rows * columns).reshape(rows, columns)
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
    try:
        wanted = [each.frame for each in frames]
        found = list(pydicom.iter_pixels(path, raw=True, indices=wanted, decoding_plugin=decoder))
        if len(found) != len(frames) or any(each.shape != (rows, columns) for each in found):
            raise ValueError("other frames")
    except MemoryError:
        raise
    except Exception:  # noqa: BLE001 (whatever a decoder trips over is the file's fault)
        raise FileError(
            f"is damaged: the pixels of {display_name(path)} are not those that its header states."
        ) from None
    yield from (each.astype(np.dtype(stored).newbyteorder("="), copy=False) for each in found)
