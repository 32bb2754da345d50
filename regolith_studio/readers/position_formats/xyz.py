"""XYZ: a count, a comment, then a row for each particle; the extended form names its columns."""

import re

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.number_rows import float_or_nan, utf8_text
from regolith_studio.readers.position_formats import (
    NAME_THEM,
    NamedColumns,
    Numbers,
    ParsedPositions,
    PositionFormat,
    asked_columns,
    counts_first,
    named_columns,
    named_rows,
)

_PROPERTIES = re.compile(r'Properties="?([\w:]+)')
_COUNT = re.compile(rb"\s*\d{1,12}\s*")
_SIZES = {"radius": True, "diameter": False, "rad": True, "size": False}
_LATER = "The file holds {} time steps; the last was read."
_UNNAMED = "The columns have no names; they were interpreted as {}."
_WITH_SPECIES = {4: ("species", "x", "y", "z"), 7: ("species", "x", "y", "z", "vx", "vy", "vz")}
"""What columns are where the first is a name or a whole number."""


def parse(data: bytes, asked: tuple[str, ...]) -> ParsedPositions:
    """Positions of the last frame."""
    lines = utf8_text(data).splitlines()
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
    comment = lines[start + 1].decode("utf-8", "replace")
    notes = (_LATER.format(frames),) if frames > 1 else ()
    columns, more = _columns(comment, rows, asked)
    return named_rows(_numbers(rows, columns), columns, notes + more)


def _count(line: bytes, place: int) -> int:
    if not _COUNT.fullmatch(line):
        shown = printable(line[:20].decode("utf-8", "replace"))
        raise FileError(f"is a broken XYZ file: line {place + 1:,} should count particles, and is “{shown}”.")
    return int(line)


def _columns(
    comment: str, rows: list[list[bytes]], asked: tuple[str, ...]
) -> tuple[NamedColumns, tuple[str, ...]]:
    """Where the positions and the size stand, and a note where that was concluded from the numbers."""
    stated = _PROPERTIES.search(comment)
    if asked:
        return asked_columns(asked, len(rows[0])), ()
    if stated is not None:
        return _of_properties(stated[1].split(":")), ()
    width = len(rows[0])
    if width == 3:
        return named_columns(("x", "y", "z")), ()
    names = _WITH_SPECIES.get(width, ())
    is_word = bool(names) and bool(np.isnan(float_or_nan(rows[0][0])))
    if not names or not (is_word or counts_first(_numbers(rows, NamedColumns((1, 2, 3), 0)))):
        raise FileError(f"has {width} columns that it does not name; {NAME_THEM}.")
    if is_word and width == 4:
        return named_columns(names), ()
    shown = ("species" if is_word else "type", *names[1:])
    return named_columns(names), (_UNNAMED.format(", ".join(shown)),)


def _of_properties(parts: list[str]) -> NamedColumns:
    """The columns of an extended XYZ file: name, kind and count of each."""
    place, axes, size, is_radius = 0, None, None, True
    for name, _kind, count in zip(parts[::3], parts[1::3], parts[2::3], strict=False):
        step = int(count) if re.fullmatch(r"[0-9]{1,3}", count) else 0
        if name.lower() in ("pos", "position") and step == 3:
            axes = (place, place + 1, place + 2)
        if name.lower() in _SIZES and step == 1:
            size, is_radius = place, _SIZES[name.lower()]
        place += step
    if axes is None:
        raise FileError("is an extended XYZ file without positions: its properties name no pos.")
    return NamedColumns(axes, size, is_radius)


def _numbers(rows: list[list[bytes]], columns: NamedColumns) -> Numbers:
    """All columns; those that are not needed are not a number."""
    width = len(rows[0])
    numbers = np.full((len(rows), width), np.nan)
    needed = [*(columns.axes or ()), *([columns.size] if columns.size is not None else [])]
    try:
        numbers[:, needed] = [[float(row[column]) for column in needed] for row in rows]
    except (ValueError, IndexError):
        raise FileError(f"is a broken XYZ file: not all its rows are {width} valid columns.") from None
    return numbers


def _recognises(head: bytes) -> bool:
    lines = head.splitlines()
    return len(lines) > 1 and _COUNT.fullmatch(lines[0]) is not None


FORMAT = PositionFormat("xyz", "an XYZ file", (".extxyz",), _recognises, parse, takes_names=True)
"""A file called .xyz that does not begin with a count is a table."""
