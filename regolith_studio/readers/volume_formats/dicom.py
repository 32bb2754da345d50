"""DICOM series: the slices of one scan, a file each or frames of one file, ordered by their positions.

Edges, orientation and positions are those of PS3.3 C.7.6.2: PixelSpacing is the distance of rows, then of
columns, and ImageOrientationPatient the direction of a row, then of a column, all in millimetres.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message
from regolith_studio.readers.error_messages import display_name, printable
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.dicom_file import DicomFrame, PackedPixelsError, frames_of, pixels_of
from regolith_studio.readers.voxels.folders import DICOM_SUFFIXES, dicom_names
from regolith_studio.readers.voxels.header import (
    DatasetEntry,
    Sizes,
    VoxelHeader,
    sizes_or_none,
    three_dimensions,
)

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
    """The series ``options["dataset"]`` of a folder, by default the longest, or that of the file given.

    Raises
    ------
    FileError
        If a file is broken or packed, or the slices are of several sizes or do not lie at equal distances.
    """
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
    """The frames of each series, and the files that hold none that can be read.

    Raises
    ------
    FileError
        If a file is damaged, or all are of another kind or packed.
    """
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
    """A note about files without an image of the series.

    Raises
    ------
    FileError
        If one of them is of the series and packed.
    """
    for error in others.values():
        if error is not None and error.series in ("", chosen):
            raise error
    if not others:
        return ()
    names = [printable(name)[:30] for name in others]
    shown = ", ".join(names[:3]) + (", …" if len(names) > 3 else "")
    template = N_("Left out {count} files that hold no image of the series: {names}.")
    return (Message(template, count=len(names), names=shown),)


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


def _size(slices: list[DicomFrame]) -> Sizes | None:
    """Edges of a voxel of a series in millimetres; None if it is no volume or does not state them."""
    try:
        return sizes_or_none([*slices[0].spacing, _ordered(slices)[1]])
    except FileError:
        return None


def _ordered(slices: list[DicomFrame]) -> tuple[list[DicomFrame], float, tuple[str, ...]]:
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
