"""XYZ: a count, a comment, then a row for each particle; the extended form names its columns."""

import re

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import plural, printable
from regolith_studio.readers.number_rows import number_rows
from regolith_studio.readers.position_formats import NamedColumns, ParsedPositions, PositionFormat, sized

_PROPERTIES = re.compile(r'Properties="?([\w:]+)')
_SIZES = {"radius": True, "diameter": False, "rad": True, "size": False}
_LATER = "The file holds {} time steps; the last was read."


def parse(data: bytes) -> ParsedPositions:
    """Positions of the last frame; a plain table of three or four columns is also called XYZ.

    Raises
    ------
    FileError
        If a frame is cut short or its rows are no positions.
    """
    lines = data.splitlines()
    if not _is_count(lines):
        return _table(data)
    place = frames = 0
    last: tuple[int, int] = (0, 0)
    while place < len(lines) and lines[place].strip():
        count = _count(lines[place], place)
        last = (place, count)
        place += 2 + count
        frames += 1
    start, count = last
    rows = [line.split() for line in lines[start + 2 : start + 2 + count]]
    if len(rows) < count or not count:
        raise FileError(f"is cut short: it declares {count:,} particles and has {len(rows):,}.")
    columns, width = _columns(lines[start + 1].decode("utf-8", "replace"), len(rows[0]))
    numbers = _numbers(rows, columns, width)
    unit = NamedColumns((0, 1, 2), 3 if columns.size is not None else None, columns.is_radius)
    notes = (_LATER.format(frames),) if frames > 1 else ()
    return ParsedPositions(numbers[:, :3], sized(numbers, unit), notes=notes)


def _table(data: bytes) -> ParsedPositions:
    numbers = number_rows(data).numbers
    if numbers.shape[1] not in (3, 4):
        raise FileError(f"has {plural(numbers.shape[1], 'column')}; x, y, z and perhaps a diameter are read.")
    note = "The fourth column has no name; it was interpreted as the diameter."
    if numbers.shape[1] == 3:
        return ParsedPositions(numbers)
    return ParsedPositions(numbers[:, :3], numbers[:, 3], notes=(note,))


def _is_count(lines: list[bytes]) -> bool:
    return bool(lines) and re.fullmatch(rb"\s*\d{1,12}\s*", lines[0]) is not None


def _count(line: bytes, place: int) -> int:
    if not re.fullmatch(rb"\s*\d{1,12}\s*", line):
        shown = printable(line[:20].decode("utf-8", "replace"))
        raise FileError(f"is a broken XYZ file: line {place + 1:,} should count particles, and is “{shown}”.")
    return int(line)


def _columns(comment: str, width: int) -> tuple[NamedColumns, int]:
    """Where the positions and the size stand; without properties after the name of the species."""
    stated = _PROPERTIES.search(comment)
    if stated is None:
        first = 1 if width in (4, 5) else 0
        return NamedColumns((first, first + 1, first + 2), first + 3 if width == 5 else None, True), width
    parts = stated[1].split(":")
    place, axes, size, is_radius = 0, None, None, True
    for name, _kind, count in zip(parts[::3], parts[1::3], parts[2::3], strict=False):
        step = int(count) if count.isdigit() and len(count) < 4 else 0
        if name.lower() in ("pos", "position") and step == 3:
            axes = (place, place + 1, place + 2)
        if name.lower() in _SIZES and step == 1:
            size, is_radius = place, _SIZES[name.lower()]
        place += step
    if axes is None:
        raise FileError("is an extended XYZ file without positions: its properties name no pos.")
    return NamedColumns(axes, size, is_radius), place


def _numbers(rows: list[list[bytes]], columns: NamedColumns, width: int) -> np.ndarray:
    """The columns x, y, z and the size of all rows."""
    picked = [*(columns.axes or ()), *([columns.size] if columns.size is not None else [])]
    try:
        return np.array([[float(row[column]) for column in picked] for row in rows])
    except (ValueError, IndexError):
        raise FileError(f"is a broken XYZ file: not all its rows are {width} valid columns.") from None


FORMAT = PositionFormat("xyz", "an XYZ file", (".xyz", ".extxyz"), lambda _head: False, parse)
