"""A folder of slices: one TIFF, PNG or BMP file for each."""

import re
import struct
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message, count_message
from regolith_studio.readers.error_messages import display_name, printable
from regolith_studio.readers.number_rows import float_or_nan
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    MAX_SLICE_BYTES,
    DatasetEntry,
    Sizes,
    VoxelHeader,
    format_shape,
    sizes_or_none,
    voxel_type,
)
from regolith_studio.readers.voxels.scanner_headers import text_fields
from regolith_studio.readers.voxels.slice_series import (
    SLICE_SUFFIXES,
    SliceSeries,
    number_ranges,
    slice_series,
)
from regolith_studio.readers.voxels.tiff import check_page, open_tiff_file, stated_size

_COUNTER = re.compile(r"\d+$")
_BMP = struct.Struct("<10xIIiiHHIIxxxxxxxxI")
"""Place of the pixels, length of the header, width, height, planes, bits, packing, size, colours."""


class SliceFiles:
    """Slices that are files of their own, opened one after the other."""

    def __init__(self, paths: list[Path | None], header: VoxelHeader) -> None:
        self.header = header
        self._paths = paths

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx); absent ones are zero."""
        _, ny, nx = self.header.shape
        out = np.empty((z1 - z0, ny, nx), self.header.dtype)
        for place, path in enumerate(self._paths[z0:z1]):
            if path is None:
                out[place] = 0
                continue
            image = _image(path)
            if image.shape != (ny, nx) or image.dtype != self.header.dtype:
                raise FileError(
                    f"is not a volume: its slice {display_name(path)} has {format_shape(image.shape[::-1])} "
                    f"pixels of {image.dtype}, the first one {nx} × {ny} of {self.header.dtype}."
                )
            out[place] = image
        return out

    def close(self) -> None:
        """Do nothing: no file is kept open."""


def open_slices(path: Path, options: Mapping[str, Any]) -> SliceFiles:
    """The series ``options["dataset"]`` among the files ``options["names"]``, by default the longest."""
    series, _ = slice_series(map(str, options.get("names") or ()))
    if not series:
        raise FileError(
            "holds no slices: three images or more whose names differ in a number only, such as "
            f"slice_001.tif ({', '.join(SLICE_SUFFIXES)})."
        )
    chosen = _chosen(series, options.get("dataset"))
    names = chosen.in_place(bool(options.get("allow_gaps")))
    paths = [None if name is None else path / name for name in names]
    first = _image(path / chosen.files[0])
    size, unit, notes = _logged(path / chosen.files[0]) or _stated(path / chosen.files[0])
    several = len(series) > 1
    return SliceFiles(
        paths,
        VoxelHeader(
            (len(paths), first.shape[0], first.shape[1]),
            first.dtype,
            size,
            unit,
            None,
            (*_notes(path, series, chosen, options.get("dataset")), *notes),
            tuple(map(partial(_entry, path), series)) if several else (),
            chosen.name if several else None,
        ),
    )


def _chosen(series: list[SliceSeries], wanted: Any) -> SliceSeries:
    if wanted is None:
        return max(series, key=lambda each: len(each.files))  # of several the first by its name
    for each in series:
        if each.name == str(wanted):
            return each
    names = ", ".join(printable(each.name)[:40] for each in series[:4])
    raise FileError(f"has no series “{printable(str(wanted))[:40]}”; it holds {names}.")


def _notes(folder: Path, series: list[SliceSeries], chosen: SliceSeries, wanted: Any) -> tuple[str, ...]:
    """Which series of several was read, which slices are absent, and which images are no slices."""
    notes: list[str] = []
    if wanted is None and len(series) > 1:
        template = N_("The folder holds {count} series of slices; {name} was read.")
        notes.append(Message(template, count=len(series), name=printable(chosen.name)[:60]))
    if chosen.missing:
        template = N_("Slices that are absent were left empty: {numbers}.")
        notes.append(Message(template, numbers=number_ranges(chosen.missing, chosen.step)))
    if chosen.step > 1:
        template = N_("The numbers of the slices go up by {step}; they were taken as neighbours.")
        notes.append(Message(template, step=chosen.step))
    slices = {name for each in series for name in each.files}
    others = sorted(
        entry.name
        for entry in folder.iterdir()
        if entry.suffix.lower() in SLICE_SUFFIXES and entry.name not in slices and entry.name[0] != "."
    )
    if others:
        shown = ", ".join(printable(name)[:30] for name in others[:3]) + (", …" if len(others) > 3 else "")
        notes.append(
            count_message(
                N_("Left out 1 image whose name does not fit: {names}."),
                N_("Left out {count} images whose names do not fit: {names}."),
                len(others),
                names=shown,
            )
        )
    return tuple(notes)


def _entry(folder: Path, series: SliceSeries) -> DatasetEntry:
    first = _image(folder / series.files[0])
    return DatasetEntry(series.name, (first.shape[1], first.shape[0], len(series.files)), first.dtype.name)


def _image(path: Path) -> NDArray[Any]:
    """One slice, shape (ny, nx), in the machine's byte order."""
    try:
        image = _tiff(path) if path.suffix.lower() in (".tif", ".tiff") else _picture(path)
    except (FileError, MemoryError, OSError) as error:
        if isinstance(error, FileError):
            raise FileError(f"cannot be read: its slice {display_name(path)} {error}") from None
        raise
    except Exception:  # noqa: BLE001 (each codec has errors of its own)
        raise FileError(f"cannot be read: its slice {display_name(path)} is damaged.") from None
    image = image.squeeze() if image.ndim > 2 else image
    if image.ndim != 2 or not image.size:
        raise FileError(f"cannot be read: its slice {display_name(path)} is not a single grey image.")
    return image.astype(voxel_type(image.dtype), copy=False)


def _tiff(path: Path) -> NDArray[Any]:
    with open_tiff_file(path) as file:
        if len(file.pages) != 1:
            raise FileError(f"has {len(file.pages):,} pages: it is a stack of its own.")
        page: Any = file.pages.first
        if page.nbytes > MAX_SLICE_BYTES:
            raise FileError("is larger than 1 GiB.")
        check_page(page, path.stat().st_size, 0)
        decoded: NDArray[Any] = page.asarray(maxworkers=1)
    return decoded


def _picture(path: Path) -> NDArray[Any]:
    import imagecodecs

    data = path.read_bytes()
    if data.startswith(b"\x89PNG\r\n\x1a\n") and len(data) > 24:
        edges = int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")
        decode = imagecodecs.png_decode
    elif data.startswith(b"BM") and len(data) > _BMP.size:
        edges = _bmp_edges(data)
        decode = imagecodecs.bmp_decode
    else:
        raise FileError("is neither a PNG nor a BMP image.")
    if not 0 < edges[0] * edges[1] <= MAX_SLICE_BYTES // 8:
        raise FileError(f"cannot have {edges[0]:,} × {edges[1]:,} pixels.")
    decoded: NDArray[Any] = decode(data)
    return decoded


def _bmp_edges(data: bytes) -> tuple[int, int]:
    """Width and height of a bitmap; the decoder trusts its header, so that all of it is checked."""
    begin, header, width, height, planes, bits, packing, _, colours = _BMP.unpack_from(data)
    if header < 40 or planes != 1 or bits not in (1, 4, 8, 16, 24, 32) or width <= 0:
        raise FileError("has no header of a Windows bitmap; save it as PNG.")
    if packing != 0:
        raise FileError("is a packed bitmap; save it unpacked, or as PNG.")
    table = 4 * (colours or (1 << bits if bits <= 8 else 0))
    row = (width * bits + 31) // 32 * 4
    if colours > 256 or not 14 + header + table <= begin <= len(data) - row * abs(height):
        raise FileError("ends before its pixels do.")
    return width, abs(height)


def _logged(path: Path) -> tuple[Sizes, str, tuple[str, ...]] | None:
    """The size that the log of a Bruker SkyScan states, if one lies beside the slices with their name."""
    stem = _COUNTER.sub("", path.stem)
    for log in sorted(path.parent.glob("*.log")):
        if log.stem != stem or not log.is_file():
            continue
        try:
            fields = text_fields(log)
        except FileError as error:
            raise FileError(f"has the log {display_name(log)} beside its slices, which {error}") from None
        pixel = fields.get("reconstruction/pixel size (um)") or fields.get(
            "acquisition/image pixel size (um)"
        )
        step = float_or_nan(fields.get("reconstruction/section to section step", "1"))
        edge = float_or_nan(pixel or "")
        size = sizes_or_none([edge, edge, edge * step])
        if size is not None:
            return size, "um", ()
    return None


def _stated(path: Path) -> Any:
    if path.suffix.lower() not in (".tif", ".tiff"):
        return None, None, ()
    with open_tiff_file(path) as file:
        return stated_size(file)


def _prepare() -> None:
    import imagecodecs  # noqa: F401
    import tifffile  # noqa: F401


FORMAT = VolumeFormat("slices", "a folder of slices", (), lambda _head: False, open_slices, _prepare)
