"""VTK's legacy files: the points of POLYDATA and UNSTRUCTURED_GRID, text or big-endian binary."""

import re

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.position_formats import ParsedPositions, PositionFormat

_TYPES = {
    "char": "i1", "unsigned_char": "u1", "short": "i2", "unsigned_short": "u2", "int": "i4",
    "unsigned_int": "u4", "long": "i8", "unsigned_long": "u8", "vtkidtype": "i8",
    "float": "f4", "double": "f8",
}  # fmt: skip
_SIZES = {"diameter": 1.0, "size": 1.0, "radius": 2.0, "rad": 2.0}
_POINTS = re.compile(rb"^POINTS[ \t]+(\d{1,12})[ \t]+(\w+)[ \t]*\r?\n", re.MULTILINE | re.IGNORECASE)
_SCALARS = re.compile(
    rb"^SCALARS[ \t]+(\S+)[ \t]+(\w+)(?:[ \t]+1)?[ \t]*\r?\n(?:LOOKUP_TABLE[ \t]+\S+[ \t]*\r?\n)?",
    re.MULTILINE | re.IGNORECASE,
)
_ARRAY = re.compile(rb"^(\S+)[ \t]+1[ \t]+(\d{1,12})[ \t]+(\w+)[ \t]*\r?\n", re.MULTILINE)
_POINT_DATA = re.compile(rb"^POINT_DATA[ \t]+(\d{1,12})", re.MULTILINE | re.IGNORECASE)


def parse(data: bytes, _asked: tuple[str, ...]) -> ParsedPositions:
    """Points, and the scalars of theirs that are named diameter or radius."""
    head = data[:1024].splitlines()
    if len(head) < 3 or not head[0].startswith(b"# vtk DataFile"):
        raise FileError("is not a legacy VTK file: its first line lacks the identifier.")
    encoding = head[2].strip().upper()
    if encoding not in (b"ASCII", b"BINARY"):
        raise FileError("is a broken VTK file: its third line is neither ASCII nor BINARY.")
    match = _POINTS.search(data)
    if match is None:
        raise FileError("holds no points: only VTK files of poly data or unstructured grids are read.")
    binary = encoding == b"BINARY"
    count = int(match[1])
    points = _values(data, match.end(), 3 * count, match[2], binary).reshape(-1, 3)
    return ParsedPositions(points, _diameters(data, match.end(), count, binary))


def _diameters(data: bytes, after: int, count: int, binary: bool) -> np.ndarray | None:
    begin = _POINT_DATA.search(data, after)
    if begin is None or int(begin[1]) != count:
        return None
    for match in _SCALARS.finditer(data, begin.end()):
        factor = _SIZES.get(match[1].decode("utf-8", "replace").lower())
        if factor is not None:
            return _values(data, match.end(), count, match[2], binary) * factor
    for match in _ARRAY.finditer(data, begin.end()):
        factor = _SIZES.get(match[1].decode("utf-8", "replace").lower())
        if factor is not None and int(match[2]) == count:
            return _values(data, match.end(), count, match[3], binary) * factor
    return None


def _values(data: bytes, place: int, count: int, kind: bytes, binary: bool) -> np.ndarray:
    name = kind.decode("utf-8", "replace").lower()
    if name not in _TYPES:
        raise FileError(f"is a broken VTK file: there is no type “{printable(name)[:20]}”.")
    if binary:
        dtype = np.dtype(_TYPES[name]).newbyteorder(">")
        if place + count * dtype.itemsize > len(data):
            raise FileError(f"is cut short: it declares {count:,} numbers and ends before.")
        return np.frombuffer(data, dtype, count, place).astype(np.float64)
    # A number takes two bytes or more, and few take more than 32.
    if 2 * count > len(data) - place + 1:
        raise FileError(f"is cut short: it declares {count:,} numbers and ends before.")
    words = data[place : place + 40 * count + 64].split(maxsplit=count)[:count]
    try:
        values = np.array([float(word) for word in words])
    except ValueError:
        raise FileError("is a broken VTK file: a word stands where a number belongs.") from None
    if len(values) < count:
        raise FileError(f"is cut short: it declares {count:,} numbers and has {len(values):,}.")
    return values


FORMAT = PositionFormat(
    "vtk", "a legacy VTK file", (".vtk",), lambda head: head.startswith(b"# vtk DataFile"), parse
)
