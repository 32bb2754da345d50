"""The child's part of reading positions and tables: bytes to checked numbers."""

import codecs
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.number_rows import number_rows
from regolith_studio.readers.position_format import ParsedPositions, PositionFormat
from regolith_studio.readers.position_formats import position_formats, position_suffixes
from regolith_studio.readers.protocol import Message
from regolith_studio.readers.sentences import printable, sentence_about

LARGEST_COORDINATE = 1e30


def read_positions_file(request: dict[str, Any]) -> Message:
    """Points and perhaps diameters of the file at ``request["path"]``."""
    path = Path(request["path"])
    parsed, row = parse_positions(path.read_bytes(), path)
    header = {
        "format": row.key,
        "label": row.label,
        "notes": parsed.notes,
        "unit": parsed.unit,
        "diameter_unit": parsed.diameter_unit,
    }
    arrays = (parsed.points, *(() if parsed.diameters is None else (parsed.diameters,)))
    return Message(header, tuple(np.ascontiguousarray(array, "<f8") for array in arrays))


def read_number_rows(request: dict[str, Any]) -> Message:
    """The rows of the text at ``request["path"]`` below at most ``request["headers"]`` lines of header."""
    path = Path(request["path"])
    data = path.read_bytes()
    try:
        headers = int(request.get("headers", 1))
        table = number_rows(without_mark(data), headers, numeric_headers=headers)
    except FileError as error:
        raise FileError(sentence_about(path, str(error))) from None
    first = next((line for line in data.splitlines() if line.strip()[:1].isdigit()), b"")
    return Message(
        {"names": table.names, "commas": b"," in first}, (np.ascontiguousarray(table.numbers, "<f8"),)
    )


def parse_positions(data: bytes, path: Path) -> tuple[ParsedPositions, PositionFormat]:
    """Particles with finite positions and positive diameters, and the format that they came in.

    Raises
    ------
    FileError
        With a whole sentence that names the file.
    """
    try:
        if not data:
            raise FileError("is empty: it has no bytes at all.")
        data = without_mark(data)
        row = _format_of(data, path)
        with np.errstate(all="ignore"):
            return _checked(row.parse(data)), row
    except FileError as error:
        raise FileError(sentence_about(path, str(error))) from None


def without_mark(data: bytes) -> bytes:
    """Text without the byte order mark that some editors put first, and never in UTF-16."""
    if data.startswith(codecs.BOM_UTF8):
        return data[len(codecs.BOM_UTF8) :]
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", "replace").encode()
    return data


def _format_of(data: bytes, path: Path) -> PositionFormat:
    rows = position_formats().values()
    shown = next((row for row in rows if row.recognises(data[:1024])), None)
    named = next((row for row in rows if path.suffix.lower() in row.suffixes), None)
    if shown is None and named is None:
        raise FileError(
            f"holds no positions that are read here ({printable(path.suffix) or 'no suffix'}); they end in "
            f"{', '.join(sorted(position_suffixes()))}."
        )
    return shown or named  # type: ignore[return-value]


def _checked(parsed: ParsedPositions) -> ParsedPositions:
    points, diameters = parsed.points, parsed.diameters
    if not len(points):
        raise FileError("holds no particles.")
    good = np.asarray((np.abs(points) < LARGEST_COORDINATE).all(axis=1))
    if diameters is not None:
        good &= (diameters > 0.0) & (diameters < LARGEST_COORDINATE)
    if not good.any():
        raise FileError("has no particle whose position and size are proper numbers.")
    lost = len(points) - int(np.count_nonzero(good))
    if not lost:
        return parsed
    note = f"Left out {lost:,} of {len(points):,} particles whose position or size is no proper number."
    kept = None if diameters is None else diameters[good]
    return replace(parsed, points=points[good], diameters=kept, notes=(*parsed.notes, note))
