"""TIFF stacks: one file of many pages, as ImageJ, OME and scanners write them."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message
from regolith_studio.readers.error_messages import any_fault
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    OpenVolume,
    VoxelHeader,
    format_shape,
    three_dimensions,
    voxel_type,
)
from regolith_studio.readers.voxels.stored import PlainVoxels
from regolith_studio.readers.voxels.tiff import check_page, open_tiff_file, stated_size

MAX_CHANNELS = 8
_CHANNELS = re.compile(r"<Pixels\b[^>]*\bSize[CT]=\"(?!1\")(\d+)\"")


class TiffPages:
    """A stack whose pages are decoded one at a time."""

    def __init__(self, file: Any, pages: list[Any], header: VoxelHeader) -> None:
        self.header = header
        self._file = file
        self._pages = pages

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx)."""
        _, ny, nx = self.header.shape
        out = np.empty((z1 - z0, ny, nx), self.header.dtype)
        for place, page in enumerate(self._pages[z0:z1]):
            decoded = self._decoded(page, z0 + place)
            if decoded.size != ny * nx:
                raise FileError(
                    f"is damaged: page {z0 + place + 1:,} has {decoded.size:,} pixels, not {nx:,} × {ny:,}."
                )
            out[place] = decoded.reshape(ny, nx)
        return out

    def _decoded(self, page: Any, number: int) -> NDArray[Any]:
        with any_fault(f"is damaged: the pixels of page {number + 1:,} cannot be decoded; export it again."):
            check_page(page, self._file.filehandle.size, number)
            decoded: NDArray[Any] = page.asarray(maxworkers=1)
        return decoded

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def open_tiff(path: Path, _options: Mapping[str, Any]) -> OpenVolume:
    """A stack of pages of one size and type."""
    file = open_tiff_file(path)
    try:
        return _stack(path, file)
    except Exception as error:
        file.close()
        if isinstance(error, FileError | MemoryError):
            raise
        raise FileError("is a broken TIFF file; export it again.") from None


def _stack(path: Path, file: Any) -> OpenVolume:
    series = max(file.series, key=lambda each: each.size)
    page = series.keyframe
    if page.dtype is None:
        raise FileError("is a broken TIFF file: its pixels have no size.")
    size, unit, notes = stated_size(file)
    notes += _check_colours(series, page)
    shape = three_dimensions(tuple(series.shape))
    if len(file.series) > 1:
        _check_run(series)
        notes += (
            Message(
                N_("The file holds {count} series of images; the largest was read."), count=len(file.series)
            ),
        )
    header = VoxelHeader(shape, voxel_type(np.dtype(series.dtype)), size, unit, None, notes)
    if series.dataoffset is not None:
        file.close()
        stored = np.dtype(series.dtype).newbyteorder(file.byteorder)
        return PlainVoxels(path, int(series.dataoffset), header, stored)
    pages = list(series.pages)
    if len(pages) != shape[0] or any(each is None for each in pages):
        raise FileError(
            f"is not a stack of slices: its {len(pages):,} pages do not make the shape {format_shape(shape)}."
        )
    return TiffPages(file, pages, header)


def _check_run(series: Any) -> None:
    """Refuse a stack that would lose pages from its midst."""
    places = [page.index for page in series.pages if page is not None]
    if places != list(range(places[0], places[0] + len(places))):
        raise FileError("is not a stack of slices: among its pages are some of another size or type.")


def _check_colours(series: Any, page: Any) -> tuple[str, ...]:
    """Refuse colours; more channels than any microscope has are slices that were named so by mistake."""
    others = [edge for axis, edge in zip(series.axes, series.shape, strict=True) if axis not in "SCYX"]
    notes: tuple[str, ...] = ()
    for axis, edge in zip(series.axes, series.shape, strict=True):
        if axis == "C" and edge > MAX_CHANNELS and max(others, default=1) == 1:
            notes = (
                Message(
                    N_("The file calls its {count} images channels; they were interpreted as slices."),
                    count=edge,
                ),
            )
        elif axis in "SC" and edge > 1:
            raise FileError(f"holds {edge} colours or channels; save one of them as greys.")
    channels = _CHANNELS.search(page.description[:100_000])
    if channels:
        raise FileError(f"holds {channels[1]} channels or times; save one of them alone.")
    return notes


def _prepare() -> None:
    import imagecodecs  # noqa: F401 (tifffile asks for it when it meets the first compressed page)
    import tifffile  # noqa: F401


def _recognises(head: bytes) -> bool:
    return head[:4] in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")


FORMAT = VolumeFormat(
    "tiff", "a TIFF stack", (".tif", ".tiff", ".btf", ".tf8"), _recognises, open_tiff, _prepare
)
