"""Traits of TIFF files: what tifffile steps over in broken ones, and the voxel size that a file states."""

import logging
import math
import re
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from regolith_studio.errors import FileError
from regolith_studio.messages import N_
from regolith_studio.readers.voxels.header import Sizes, sizes_or_none, stated_edges

Stated = tuple[Sizes | None, str | None, tuple[str, ...]]

_PHYSICAL = re.compile(r"\bPhysicalSize([XYZ])(Unit)?=\"([^\"]{1,40})\"")
_MAX_DESCRIPTION = 100_000
_INCH, _CENTIMETRE = 25.4, 10.0
"""Millimetres."""
_PRINTERS = (72, 96, 100, 150, 180, 200, 240, 300, 360, 400, 600, 720, 1200, 2400)
"""Resolutions for printing, in dots per inch, that programs write by default."""
_CUBIC = N_(
    "The file states the width of a pixel only; the slices were assumed to be the same distance apart."
)


class _ErrorLog(logging.Handler):
    """What tifffile logs as errors while it is in use."""

    def __init__(self) -> None:
        super().__init__(logging.ERROR)
        self.messages: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.messages.append(record.getMessage())

    def __enter__(self) -> Self:
        logging.getLogger("tifffile").addHandler(self)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        logging.getLogger("tifffile").removeHandler(self)


def open_tiff_file(path: Path) -> Any:
    """Open a ``tifffile.TiffFile`` and check that all pages can be found.

    Where the chain of pages is broken or circular, or strips are missing, tifffile only logs an error and
    returns the pages that it has found: a truncated file would become a smaller volume. Hence the log is
    checked.

    Raises FileError if it is not a TIFF file, or tifffile has logged an error.
    """
    import tifffile

    if not path.stat().st_size:
        raise FileError("is empty: it has no bytes at all.")
    file: Any = None
    with _ErrorLog() as log:
        try:
            file = tifffile.TiffFile(path, mode="r", is_ome=False, _multifile=False)
            pages, _series = len(file.pages), file.series
        except MemoryError:
            raise
        except Exception as error:  # noqa: BLE001 (whatever a parser trips over is the file's fault)
            message = str(error)
            if file is not None:
                file.close()
            if "not a TIFF file" in message or "invalid TIFF version" in message:
                raise FileError("is not a TIFF file: it does not begin as one.") from None
            raise FileError("is a broken TIFF file, or is cut short; copy or export it again.") from None
    if log.messages or not pages:
        file.close()
        raise FileError(
            "is a broken TIFF file, or is cut short: not all of its pages are there; copy or export it again."
        )
    return file


def check_page(page: Any, size: int, number: int) -> None:
    """Check that the strips or tiles of a page are all there and lie within the `size` bytes of the file.

    tifffile fills missing pixels with zeros.

    Raises FileError if not, naming the page by its `number`, counted from 0.
    """
    for place, count in zip(page.dataoffsets, page.databytecounts, strict=False):
        if place + count > size:
            raise FileError(
                f"is cut short: the pixels of page {number + 1:,} end at byte {place + count:,} of {size:,}."
            )
    if page.dtype is None or len(page.dataoffsets) < math.prod(page.chunked):
        raise FileError(f"is a broken TIFF file: page {number + 1:,} lacks some of its pixels.")


def stated_size(file: Any) -> Stated:
    """Edges along x, y and z in a unit, the unit, and notes; None where the file does not state it.

    ``file``: an open ``tifffile.TiffFile``.
    """
    page = file.pages.first
    description = str(page.description or "")[:_MAX_DESCRIPTION]
    if file.is_imagej:
        return _imagej(file.imagej_metadata or {}, page)
    if "<OME" in description:
        return _ome(description)
    return _resolution(page)


def _imagej(metadata: dict[str, Any], page: Any) -> Stated:
    pixel = _pixel(page)
    if pixel is None:
        return None, None, ()
    spacing, unit = metadata.get("spacing"), str(metadata.get("unit", ""))
    edges = (*pixel, _number(spacing, pixel[0]))
    size, key = stated_edges(edges, (unit, *(str(metadata.get(name, unit)) for name in ("yunit", "zunit"))))
    if key is None:
        return None, None, ()
    return size, key, () if spacing is not None else (_CUBIC,)


def _ome(description: str) -> Stated:
    fields: dict[str, str] = {}
    for axis, unit, text in _PHYSICAL.findall(description):
        fields.setdefault(axis + unit, text)
    if "X" not in fields:
        return None, None, ()
    names = {axis: fields.get(f"{axis}Unit", "µm") for axis in "XYZ"}
    edges = [_number(fields.get(axis, fields["X"]), 0.0) for axis in "XYZ"]
    size, unit = stated_edges(edges, [names[axis if axis in fields else "X"] for axis in "XYZ"])
    return size, unit, () if "Z" in fields else (_CUBIC,)


def _resolution(page: Any) -> Stated:
    """Pixels per inch or centimetre, unless it is a resolution for printing."""
    tag = page.tags.get("ResolutionUnit")
    pixel = _pixel(page)
    millimetres = {2: _INCH, 3: _CENTIMETRE}.get(int(tag.value)) if tag is not None else None
    if millimetres is None or pixel is None:
        return None, None, ()
    edges = [edge * millimetres for edge in pixel]
    if any(abs(_INCH / edge / dots - 1.0) < 0.01 for edge in edges for dots in _PRINTERS) or max(edges) > 1.0:
        return None, None, ()
    size = sizes_or_none((edges[0], edges[1], edges[0]))
    return size, "mm" if size else None, (_CUBIC,) if size else ()


def _pixel(page: Any) -> tuple[float, float] | None:
    """Width and height of a pixel: the inverse of the two resolution tags."""
    edges = []
    for name in ("XResolution", "YResolution"):
        tag = page.tags.get(name)
        if tag is None or not isinstance(tag.value, tuple) or len(tag.value) != 2 or not all(tag.value):
            return None
        edges.append(float(tag.value[1]) / float(tag.value[0]))
    return edges[0], edges[1]


def _number(value: Any, default: float) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        return default
