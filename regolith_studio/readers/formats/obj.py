"""Wavefront OBJ: polygonal faces; materials, groups, normals and texture coordinates are ignored."""

from pathlib import Path

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.formats import MeshFormat, ParsedMesh
from regolith_studio.readers.polygons import triangulated

_FREE_FORM = frozenset((b"curv", b"curv2", b"surf", b"cstype", b"deg", b"bzp", b"bsp"))
_KNOWN = frozenset(
    b"v vt vn vp f fo l p o g s mg usemtl mtllib maplib usemap parm trim hole scrv sp end con shadow_obj "
    b"trace_obj bevel c_interp d_interp lod ctech stech call csh bmat step res cdc cdp".split()
)


def parse(data: bytes, _path: Path) -> ParsedMesh:
    """Vertices and triangulated faces of all groups."""
    if b"\0" in data[:4096]:
        raise FileError("is not an OBJ: it holds binary data.")
    rows = [line.split() for line in data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines()]
    positions = [row for row in rows if row and row[0] == b"v"]
    vertices = _positions(positions)
    corners, sizes, unknown, free_form = _polygons(rows, len(positions))
    if not positions:
        raise FileError("is not an OBJ: it has no line that begins with “v”, so no vertices.")
    if not sizes and free_form:
        raise FileError("holds free-form curves or surfaces only; export it as a triangle mesh.")
    notes: tuple[str, ...] = ("Free-form curves or surfaces in the file were left out.",) if free_form else ()
    if unknown:
        notes += (f"{unknown:,} lines of the file that are not OBJ were ignored.",)
    flat, count = np.array(corners, dtype=np.int64), np.array(sizes, dtype=np.int64)
    return ParsedMesh(vertices, triangulated(vertices, flat, count), notes)


def _positions(rows: list[list[bytes]]) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    try:
        values = [(float(row[1]), float(row[2]), float(row[3])) for row in rows]
    except (ValueError, IndexError):
        raise FileError(_first_fault(rows)) from None
    return np.array(values, dtype=np.float64).reshape(-1, 3)


def _first_fault(rows: list[list[bytes]]) -> str:
    for number, row in enumerate(rows, start=1):
        if len(row) < 4:
            return f"is not a valid OBJ: vertex {number:,} has {len(row) - 1} coordinates, not three."
        for word in row[1:4]:
            try:
                float(word)
            except ValueError:
                shown = word[:24].decode("ascii", "replace")
                return f"is not a valid OBJ: vertex {number:,} has “{shown}” where a number belongs."
    return "is not a valid OBJ: its vertices cannot be read."


def _polygons(rows: list[list[bytes]], total: int) -> tuple[list[int], list[int], int, bool]:
    """Corners, sizes, number of lines that are no OBJ, and whether there are free-form surfaces."""
    corners: list[int] = []
    sizes: list[int] = []
    seen = unknown = 0
    free_form = False
    for row in rows:
        word = row[0] if row else b"#"
        if word == b"v":
            seen += 1
        elif word in (b"f", b"fo"):
            indices = _face(row[1:], seen, total, len(sizes) + 1)
            corners += indices
            sizes.append(len(indices))
        elif word in _FREE_FORM:
            free_form = True
        elif word not in _KNOWN and not word.startswith(b"#"):
            unknown += 1
    return corners, sizes, unknown, free_form


def _face(words: list[bytes], seen: int, total: int, number: int) -> list[int]:
    """Zero-based vertex indices; negative ones count back from the last vertex `seen`."""
    try:
        given = [int(word.partition(b"/")[0]) for word in words]
    except ValueError:
        shown = b" ".join(words)[:40].decode("ascii", "replace")
        raise FileError(f"is not a valid OBJ: face {number:,} is “{shown}”.") from None
    indices = [index - 1 if index > 0 else seen + index for index in given]
    for index, written in zip(indices, given, strict=True):
        if written == 0 or not 0 <= index < total:
            raise FileError(
                f"is not a valid OBJ: face {number:,} points to vertex {written} "
                f"of {total:,} (counted from 1)."
            )
    return indices


def _recognises(_head: bytes) -> bool:
    return False


FORMAT = MeshFormat("obj", "OBJ", (".obj",), _recognises, parse)
