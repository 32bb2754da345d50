"""A look at the directories of a TIFF file before a library follows them: all inside the file, no loops.

TIFF 6.0 and BigTIFF. What is checked here is what makes readers hang, allocate without end or read
elsewhere: the chain of directories, the places that tags point to, the size of images and strips.
"""

import re
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

from regolith_studio.errors import FileError
from regolith_studio.readers.units import unit_named
from regolith_studio.readers.voxels.header import Sizes, sizes_or_none

MOST_PAGES = 100_000
MOST_TAGS = 512
LARGEST_EDGE = 1 << 20
_SIZES = {
    1: 1,
    2: 1,
    3: 2,
    4: 4,
    5: 8,
    6: 1,
    7: 1,
    8: 2,
    9: 4,
    10: 8,
    11: 4,
    12: 8,
    13: 4,
    16: 8,
    17: 8,
    18: 8,
}
_WHOLE = {1: "B", 3: "H", 4: "I", 13: "I", 16: "Q"}
_WIDTH, _LENGTH, _BITS, _SAMPLES, _ROWS = 256, 257, 258, 277, 278
_TILE_WIDTH, _TILE_LENGTH, _DEPTH, _TILE_DEPTH = 322, 323, 32997, 32998
_OFFSETS, _COUNTS = (273, 324), (279, 325)

Tags = dict[int, tuple[int, ...]]


def check_tiff(path: Path) -> int:
    """The number of pages of a TIFF file whose directories all make sense.

    Raises
    ------
    FileError
        If the file is cut short, its directories go in circles, or an image has an impossible size.
    """
    with path.open("rb") as file:
        walk = _Walk(file, path.stat().st_size)
        pages = 0
        for tags in walk.directories():
            _check_page(tags, walk.size, pages + 1)
            pages += 1
            if pages > MOST_PAGES:
                raise FileError(f"has more than {MOST_PAGES:,} pages: it is damaged.")
    if not pages:
        raise FileError("is a TIFF without a single page.")
    return pages


class _Walk:
    """The directories of one file, in the order of their chain."""

    def __init__(self, file: BinaryIO, size: int) -> None:
        self.size = size
        self._file = file
        if not size:
            raise FileError("is empty: it has no bytes at all.")
        head = self._at(0, 16, short=8)
        self._order = {b"II": "<", b"MM": ">"}.get(head[:2], "")
        version = struct.unpack(f"{self._order or '<'}H", head[2:4])[0]
        if not self._order or version not in (42, 43):
            raise FileError("is no TIFF file: it does not begin as one.")
        self._big = version == 43
        self._count, self._entry, self._next = ("Q", "HHQ8s", "Q") if self._big else ("H", "HHI4s", "I")
        if self._big and (len(head) < 16 or struct.unpack(f"{self._order}HH", head[4:8]) != (8, 0)):
            raise FileError("is a broken BigTIFF file: its header makes no sense.")
        self._first = struct.unpack_from(f"{self._order}{self._next}", head, 8 if self._big else 4)[0]

    def directories(self) -> Iterator[Tags]:
        """The whole numbers among the tags of each page."""
        place, seen = self._first, set[int]()
        while place:
            if place in seen:
                raise FileError("is a broken TIFF file: its pages go round in a circle.")
            seen.add(place)
            tags, place = self._directory(place)
            yield tags

    def _directory(self, place: int) -> tuple[Tags, int]:
        count_size, entry_size = struct.calcsize("<" + self._count), struct.calcsize("<" + self._entry)
        count = struct.unpack(self._order + self._count, self._at(place, count_size))[0]
        if not 0 < count <= MOST_TAGS:
            raise FileError(f"is a broken TIFF file: a page has {count:,} tags.")
        next_size = struct.calcsize("<" + self._next)
        rows = self._at(place + count_size, count * entry_size + next_size)
        tags: Tags = {}
        for row in struct.iter_unpack(self._order + self._entry, rows[: count * entry_size]):
            tag, kind, number, value = row
            tags[tag] = self._value(tag, kind, number, value)
        return tags, struct.unpack(self._order + self._next, rows[count * entry_size :])[0]

    def _value(self, tag: int, kind: int, number: int, value: bytes) -> tuple[int, ...]:
        size = number * _SIZES.get(kind, 0)
        if size <= len(value):
            data = value[:size]
        else:
            pointer = struct.unpack(self._order + self._next, value)[0]
            if pointer + size > self.size:
                raise FileError(f"is cut short or broken: its tag {tag} points beyond the end of the file.")
            if kind not in _WHOLE or tag not in _NEEDED:
                return ()
            data = self._at(pointer, size)
        if kind not in _WHOLE:
            return ()
        return struct.unpack(f"{self._order}{number}{_WHOLE[kind]}", data)

    def _at(self, place: int, size: int, short: int | None = None) -> bytes:
        self._file.seek(min(place, self.size))
        data = self._file.read(size)
        if len(data) < (size if short is None else short):
            raise FileError("is cut short or broken: a page of it lies beyond the end of the file.")
        return data


_NEEDED = frozenset(
    (_WIDTH, _LENGTH, _BITS, _SAMPLES, _ROWS, _TILE_WIDTH, _TILE_LENGTH, _DEPTH, _TILE_DEPTH)
) | frozenset(_OFFSETS + _COUNTS)


def _check_page(tags: Tags, size: int, page: int) -> None:
    edges = [_one(tags, tag, default) for tag, default in ((_WIDTH, 0), (_LENGTH, 0), (_DEPTH, 1))]
    if not all(0 < edge <= LARGEST_EDGE for edge in edges):
        raise FileError(f"is a broken TIFF file: page {page:,} is {edges[0]:,} × {edges[1]:,} pixels.")
    for tag in (_TILE_WIDTH, _TILE_LENGTH, _TILE_DEPTH):
        if not 0 < _one(tags, tag, 1) <= LARGEST_EDGE:
            raise FileError(f"is a broken TIFF file: the tiles of page {page:,} have no size.")
    if not 0 < _one(tags, _SAMPLES, 1) <= 1024 or not all(0 < bits <= 64 for bits in tags.get(_BITS, (1,))):
        raise FileError(f"is a broken TIFF file: the pixels of page {page:,} have no size.")
    _check_segments(tags, size, page)


def _check_segments(tags: Tags, size: int, page: int) -> None:
    """Strips or tiles: as many as the image needs, each inside the file."""
    offsets = next((tags[tag] for tag in _OFFSETS if tag in tags), ())
    counts = next((tags[tag] for tag in _COUNTS if tag in tags), ())
    if not offsets:
        raise FileError(f"is a broken TIFF file: page {page:,} has no pixels.")
    if len(counts) > len(offsets):
        raise FileError(f"is a broken TIFF file: page {page:,} has more strip sizes than strips.")
    for place, count in zip(offsets, counts, strict=False):
        if place + count > size:
            raise FileError(
                f"is cut short: the pixels of page {page:,} end at byte {place + count:,} of {size:,}."
            )
    if len(offsets) < _segments_needed(tags):
        raise FileError(f"is a broken TIFF file: page {page:,} lacks some of its pixels.")


def _segments_needed(tags: Tags) -> int:
    width, length, depth = (_one(tags, tag, 1) for tag in (_WIDTH, _LENGTH, _DEPTH))
    if _TILE_WIDTH in tags and _TILE_LENGTH in tags:
        tiles = -(-width // _one(tags, _TILE_WIDTH, 1)) * -(-length // _one(tags, _TILE_LENGTH, 1))
        return tiles * -(-depth // _one(tags, _TILE_DEPTH, 1))
    rows = min(max(_one(tags, _ROWS, length), 1), length)
    return -(-length // rows) * depth


def _one(tags: Tags, tag: int, default: int) -> int:
    values = tags.get(tag, ())
    return values[0] if values else default


Stated = tuple[Sizes | None, str | None, tuple[str, ...]]

_PHYSICAL = re.compile(r"\bPhysicalSize([XYZ])(Unit)?=\"([^\"]{1,40})\"")
_LONGEST_DESCRIPTION = 100_000
_INCH, _CENTIMETRE = 25.4, 10.0
"""Millimetres."""
_PRINTERS = (72, 96, 100, 150, 180, 200, 240, 300, 360, 400, 600, 720, 1200, 2400)
"""Resolutions, in dots per inch, that programs write when they know none."""
_CUBIC = "The file states the width of a pixel only; the slices were taken to be as far apart."


def stated_size(file: Any) -> Stated:
    """Edges along x, y and z in a unit, the unit, and notes; None where the file does not say.

    Parameters
    ----------
    file
        An open ``tifffile.TiffFile``.
    """
    page = file.pages.first
    description = str(page.description or "")[:_LONGEST_DESCRIPTION]
    if file.is_imagej:
        return _imagej(file.imagej_metadata or {}, page)
    if "<OME" in description:
        return _ome(description)
    return _resolution(page)


def _imagej(metadata: dict[str, Any], page: Any) -> Stated:
    unit = unit_named(str(metadata.get("unit", "")))
    pixel = _pixel(page)
    if unit is None or pixel is None:
        return None, None, ()
    spacing = metadata.get("spacing")
    size = sizes_or_none((*pixel, _number(spacing, pixel[0])))
    return size, unit if size else None, () if spacing is not None else (_CUBIC,)


def _ome(description: str) -> Stated:
    found: dict[str, str] = {}
    for axis, unit, text in _PHYSICAL.findall(description):
        found.setdefault(axis + unit, text)
    if "X" not in found:
        return None, None, ()
    unit = unit_named(found.get("XUnit", "µm"))
    if any(unit_named(found.get(f"{axis}Unit", "µm")) != unit for axis in "YZ" if axis in found):
        return None, None, ("The file states voxel edges in different units; they were passed over.",)
    width = _number(found["X"], 0.0)
    size = sizes_or_none((width, _number(found.get("Y"), width), _number(found.get("Z"), width)))
    return size, unit if size else None, () if "Z" in found else (_CUBIC,)


def _resolution(page: Any) -> Stated:
    """Pixels per inch or centimetre, unless it is only what a printer would want."""
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
