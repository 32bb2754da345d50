"""DICOM series: the slices of one scan, a file each, ordered by their positions.

Edges, orientation and positions are those of PS3.3 C.7.6.2: PixelSpacing is the distance of rows, then of
columns, and ImageOrientationPatient the direction of a row, then of a column, all in millimetres.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message
from regolith_studio.readers.error_messages import display_name, printable
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.folders import DICOM_SUFFIXES, dicom_names, is_dicom
from regolith_studio.readers.voxels.header import (
    DatasetEntry,
    Sizes,
    VoxelHeader,
    sizes_or_none,
    three_dimensions,
)

SPACING_TOLERANCE = 0.01
"""Difference between two distances of slices, and offset of a slice within its plane, over one distance."""
_TAGS = (
    "SeriesInstanceUID", "InstanceNumber", "Rows", "Columns", "BitsAllocated", "PixelRepresentation",
    "SamplesPerPixel", "NumberOfFrames", "PixelSpacing", "ImagePositionPatient", "ImageOrientationPatient",
    "RescaleSlope", "RescaleIntercept", "SpacingBetweenSlices", "SliceThickness",
)  # fmt: skip
_UNPACKED = ("1.2.840.10008.1.2", "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2")
_BIG_ENDIAN = "1.2.840.10008.1.2.2"
_BY_NUMBER = N_("The slices state no positions; they were ordered by their numbers.")


@dataclass(frozen=True, eq=False)
class _Slice:
    """One file: its series and number, its pixels, and where they are.

    `layout` is rows, columns, and the stored type; `spacing` the edges along x and y in millimetres;
    `directions` those of rows and columns, shape (2, 3); `step` the stated distance to the next slice.
    """

    path: Path
    series: str
    number: int
    layout: tuple[int, int, str]
    spacing: tuple[float, float]
    position: NDArray[np.float64] | None
    directions: NDArray[np.float64] | None
    slope: float
    intercept: float
    step: float


class DicomVoxels:
    """Slices that are files of their own, read one after the other, with their slopes and intercepts."""

    def __init__(self, slices: list[_Slice], header: VoxelHeader) -> None:
        self.header = header
        self._slices = slices

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx)."""
        out = np.empty((z1 - z0, *self.header.shape[1:]), self.header.dtype)
        for place, each in enumerate(self._slices[z0:z1]):
            pixels = _pixels(each)
            if self.header.dtype.kind == "f":
                pixels = pixels * each.slope + each.intercept
            out[place] = pixels
        return out

    def close(self) -> None:
        """Do nothing: no file is kept open."""


def open_dicom(path: Path, options: Mapping[str, Any]) -> DicomVoxels:
    """The series ``options["dataset"]`` of a folder, by default the longest, or that of the file given.

    Raises
    ------
    FileError
        If a file is broken or packed, or the slices are of several sizes or do not lie at equal distances.
    """
    folder = path if path.is_dir() else path.parent
    names = [str(name) for name in options.get("names") or dicom_names(folder)]
    series: dict[str, list[_Slice]] = {}
    for name in names:
        each = _described(folder / name)
        series.setdefault(each.series, []).append(each)
    wanted = options.get("dataset")
    if wanted is None and not path.is_dir():
        wanted = _described(path).series
    if wanted is not None and str(wanted) not in series:
        raise FileError(f"has no series “{printable(str(wanted))[:70]}”; it holds {len(series)}.")
    chosen = str(wanted) if wanted is not None else max(series, key=lambda key: len(series[key]))
    slices, step, notes = _ordered(series[chosen])
    if wanted is None and len(series) > 1:
        template = N_("The folder holds {count} series; the longest was read.")
        notes = (Message(template, count=len(series)), *notes)
    return DicomVoxels(slices, _header(slices, step, notes, series, chosen))


def _header(
    slices: list[_Slice], step: float, notes: tuple[str, ...], series: dict[str, list[_Slice]], chosen: str
) -> VoxelHeader:
    rows, columns, stored = slices[0].layout
    scaled = any((each.slope, each.intercept) != (1.0, 0.0) for each in slices)
    size = sizes_or_none([*slices[0].spacing, step])
    entries = tuple(
        DatasetEntry(
            uid, (each.layout[1], each.layout[0], len(found)), np.dtype(each.layout[2]).name, _size(found)
        )
        for uid, found in series.items()
        for each in found[:1]
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


def _size(slices: list[_Slice]) -> Sizes | None:
    """Edges of a voxel of a series in millimetres; None if it is no volume or does not state them."""
    try:
        return sizes_or_none([*slices[0].spacing, _ordered(slices)[1]])
    except FileError:
        return None


def _described(path: Path) -> _Slice:
    """What a file states of its slice, without its pixels.

    Raises
    ------
    FileError
        If it is no single grey image that lies there unpacked.
    """
    data = _parsed(path, stop_before_pixels=True, specific_tags=list(_TAGS))
    name = display_name(path)
    syntax = str(getattr(data.file_meta, "TransferSyntaxUID", ""))
    if syntax not in _UNPACKED:
        raise FileError(
            f"holds {name}, whose pixels are packed; unpack the series, for example with gdcmconv."
        )
    try:
        rows, columns, bits = (int(data[tag].value) for tag in ("Rows", "Columns", "BitsAllocated"))
        signed = bool(data.get("PixelRepresentation", 0))
        single = (
            int(data.get("SamplesPerPixel", 1) or 1) == 1 and int(data.get("NumberOfFrames", 1) or 1) == 1
        )
        if not single or bits not in (8, 16, 32) or not rows > 0 < columns:
            raise FileError(f"holds {name}, which is not one grey image of 8, 16 or 32 bits.")
        letter = "i" if signed else "u"
        order = ">" if syntax == _BIG_ENDIAN else "<"
        spacing = _numbers(data, "PixelSpacing", 2)
        directions = _numbers(data, "ImageOrientationPatient", 6)
        slope, intercept = (
            float(data.get(tag) or default) for tag, default in (("RescaleSlope", 1), ("RescaleIntercept", 0))
        )
        if not np.isfinite([slope, intercept]).all():
            raise ValueError("no finite scale")
        return _Slice(
            path,
            str(data.get("SeriesInstanceUID", "")),
            int(data.get("InstanceNumber", 0) or 0),
            (rows, columns, f"{order}{letter}{bits // 8}"),
            (0.0, 0.0) if spacing is None else (float(spacing[1]), float(spacing[0])),
            _numbers(data, "ImagePositionPatient", 3),
            None if directions is None else directions.reshape(2, 3),
            slope,
            intercept,
            float(data.get("SpacingBetweenSlices") or data.get("SliceThickness") or 0.0),
        )
    except FileError:
        raise
    except Exception:  # noqa: BLE001 (values are converted when they are asked for, and fail in many ways)
        raise FileError(f"holds {name}, whose header is damaged or lacks the size of its image.") from None


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


def _numbers(data: Any, tag: str, count: int) -> NDArray[np.float64] | None:
    """A list of finite numbers; None where the file has no such tag."""
    value = data.get(tag)
    if value is None or value == "":
        return None
    numbers = np.array([float(each) for each in value])
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        raise ValueError(tag)
    return numbers


def _ordered(slices: list[_Slice]) -> tuple[list[_Slice], float, tuple[str, ...]]:
    """The slices from the first to the last, their distance in millimetres (0 if unknown), and notes.

    They go up along the normal of rows and columns, so that x, y and z are right-handed.

    Raises
    ------
    FileError
        If they are of several sizes or directions, or not at equal distances.
    """
    first = slices[0]
    for each in slices:
        if (each.layout, each.spacing) != (first.layout, first.spacing):
            raise FileError(
                f"is not a volume: {display_name(each.path)} has another size or pixel than the first slice."
            )
    if all(each.position is None for each in slices):
        numbers = [each.number for each in slices]
        if len(set(numbers)) != len(numbers):
            raise FileError(
                "states neither positions nor different numbers of its slices, so that they have no order."
            )
        return sorted(slices, key=lambda each: each.number), first.step, (_BY_NUMBER,)
    places = _places(slices)
    order = np.argsort(places[:, 2], kind="stable")
    places = places[order]
    if len(slices) == 1:
        return slices, first.step, ()
    gaps = np.diff(places[:, 2])
    step = float(gaps.mean())
    if gaps.min() <= SPACING_TOLERANCE * np.median(gaps):
        raise FileError("has two slices at one place; export one series into a folder of its own.")
    if np.abs(gaps - step).max() > SPACING_TOLERANCE * step:
        raise FileError(
            f"has uneven slices, {gaps.min():.4g} to {gaps.max():.4g} mm apart: "
            "some are missing, or it is no volume."
        )
    drift = places[:, :2] - places[0, :2]
    if np.abs(drift).max() > SPACING_TOLERANCE * step:
        raise FileError(
            "has slices that are shifted against each other (a tilted gantry); resample it first."
        )
    return [slices[k] for k in order], step, ()


def _places(slices: list[_Slice]) -> NDArray[np.float64]:
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


def _pixels(each: _Slice) -> NDArray[Any]:
    """The stored values of a slice, shape (rows, columns)."""
    data = _parsed(each.path, specific_tags=["PixelData"])
    rows, columns, stored = each.layout
    found = data.get("PixelData")
    needed = rows * columns * np.dtype(stored).itemsize
    if not isinstance(found, bytes) or not needed <= len(found) <= needed + 1:
        count = len(found) if isinstance(found, bytes) else 0
        raise FileError(
            f"is damaged: its slice {display_name(each.path)} has {count:,} bytes of pixels "
            f"and needs {needed:,}."
        )
    return np.frombuffer(found, stored, rows * columns).reshape(rows, columns)


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
