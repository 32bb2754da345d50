"""OFF, as Geomview defines it, with what programs make of it: comments, colours, counts in the first line."""

import re
from pathlib import Path

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.formats import MeshFormat, ParsedMesh
from regolith_studio.readers.polygons import triangulated

_KEYWORD = re.compile(rb"\s*((?:ST)?C?N?4?n?OFF)(?![A-Za-z])", re.ASCII)
MAX_ROWS = 1 << 40

_COMMENT = re.compile(rb"#[^\r\n]*")


def parse(data: bytes, _path: Path) -> ParsedMesh:
    """Vertices and triangulated faces; colours, normals and texture coordinates are ignored."""
    text = _COMMENT.sub(b"", data)
    keyword = _KEYWORD.match(text)
    kind = keyword[1].decode() if keyword else "OFF"
    if "n" in kind:
        raise FileError(f"is an OFF file of any dimension ({kind}); only OFF in three dimensions is read.")
    rows = [
        row for row in (line.split() for line in text[keyword.end() if keyword else 0 :].splitlines()) if row
    ]
    if rows and rows[0][0].upper() == b"BINARY":
        raise FileError("is a binary OFF, which is not read; export it as ASCII OFF, PLY or STL.")
    n_vertices, n_faces, rows = _counts(rows)
    vertices, rows = _vertices(rows, n_vertices, kind)
    corners, sizes = _polygons(rows, n_faces, n_vertices)
    return ParsedMesh(vertices, triangulated(vertices, corners, sizes))


def _counts(rows: list[list[bytes]]) -> tuple[int, int, list[list[bytes]]]:
    words = [word for row in rows[:3] for word in row][:3]
    try:
        n_vertices, n_faces = int(words[0]), int(words[1])
    except (IndexError, ValueError):
        raise FileError("is not an OFF: the counts of vertices and faces are missing at its top.") from None
    if not (0 <= n_vertices < MAX_ROWS and 0 <= n_faces < MAX_ROWS):
        raise FileError(f"is not an OFF: it counts {n_vertices:.3g} vertices and {n_faces:.3g} faces.")
    taken = 3 if len(rows[0]) == 1 else 1
    if len(rows[0]) == 2 and n_vertices and len(rows) > 1 and len(rows[1]) == 1:
        taken = 2
    return n_vertices, n_faces, rows[taken:]


def _vertices(
    rows: list[list[bytes]], count: int, kind: str
) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.float64]], list[list[bytes]]]:
    width = 4 if "4" in kind else 3
    if count > len(rows):
        raise FileError(
            f"is cut short: it declares {count:,} vertices and ends after {len(rows):,} lines of numbers."
        )
    try:
        values = np.array([[float(word) for word in row[:width]] for row in rows[:count]], dtype=np.float64)
    except ValueError:
        raise FileError(_first_fault(rows[:count], width)) from None
    values = values.reshape(count, -1) if count else np.zeros((0, width))
    if values.shape[1] != width:
        raise FileError(f"is not a valid OFF: its vertices have {values.shape[1]} coordinates, not {width}.")
    if width == 4:
        with np.errstate(all="ignore"):
            values = values[:, :3] / values[:, 3:]
    return values, rows[count:]


def _first_fault(rows: list[list[bytes]], width: int) -> str:
    for number, row in enumerate(rows):
        if len(row) < width:
            return f"is not a valid OFF: vertex {number:,} has {len(row)} coordinates, not {width}."
        for word in row[:width]:
            try:
                float(word)
            except ValueError:
                shown = word[:24].decode("ascii", "replace")
                return f"is not a valid OFF: vertex {number:,} has “{shown}” where a number belongs."
    return "is not a valid OFF: its vertices cannot be read."


def _polygons(
    rows: list[list[bytes]], count: int, n_vertices: int
) -> tuple[np.ndarray[tuple[int], np.dtype[np.int64]], np.ndarray[tuple[int], np.dtype[np.int64]]]:
    """Corners and sizes of the faces; what follows the indices in a line is colour."""
    corners: list[int] = []
    sizes: list[int] = []
    line = 0
    for face in range(count):
        if line >= len(rows):
            raise FileError(f"is cut short: it declares {count:,} faces and ends after {face:,}.")
        words, line = list(rows[line]), line + 1
        try:
            size = int(words[0])
            while len(words) <= size and line < len(rows):
                words, line = words.__iadd__(rows[line]), line + 1
            indices = [int(word) for word in words[1 : size + 1]]
        except ValueError:
            raise FileError(f"is not a valid OFF: face {face:,} is not made of whole numbers.") from None
        if size < 1 or len(indices) < size:
            raise FileError(
                f"is not a valid OFF: face {face:,} declares {size} corners and has {len(indices)}."
            )
        if min(indices) < 0 or max(indices) >= n_vertices:
            raise FileError(
                f"is not a valid OFF: face {face:,} points to vertex {max(indices, key=abs)} "
                f"of {n_vertices:,} (counted from 0)."
            )
        corners += indices
        sizes.append(size)
    return np.array(corners, dtype=np.int64), np.array(sizes, dtype=np.int64)


def _recognises(head: bytes) -> bool:
    return bool(_KEYWORD.match(_COMMENT.sub(b"", head)))


FORMAT = MeshFormat("off", "OFF", (".off",), _recognises, parse)
