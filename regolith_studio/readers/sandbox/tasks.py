"""Tasks of the sandbox process: meshes, positions and tables of numbers, parsed and checked."""

import codecs
import hashlib
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.io.triangles import used_vertices
from regolith_studio.readers.error_messages import message_about, plural, printable
from regolith_studio.readers.formats import MESH_FORMATS, MeshFormat, ParsedMesh, mesh_suffixes
from regolith_studio.readers.number_rows import number_rows
from regolith_studio.readers.position_formats import (
    POSITION_FORMATS,
    ParsedPositions,
    PositionFormat,
    position_suffixes,
)
from regolith_studio.readers.sandbox.messages import SandboxMessage
from regolith_studio.readers.volume_formats import VOLUME_FORMATS, volume_suffixes

MAX_COORDINATE = 1e40
"""Beyond it the sixth powers in the checks would leave the range of float64."""


def read_mesh_file(request: dict[str, Any]) -> SandboxMessage:
    """Vertices and faces of the file at ``request["path"]``."""
    path = Path(request["path"])
    data = path.read_bytes()
    parsed, row = parse_mesh(data, path)
    header = {
        "notes": parsed.notes,
        "unit": parsed.unit,
        "format": row.key,
        "shares_vertices": row.shares_vertices,
        "sha256": hashlib.sha256(data).hexdigest(),
    }
    return SandboxMessage(header, (parsed.vertices.astype("<f8"), parsed.faces.astype("<i8")))


def parse_mesh(data: bytes, path: Path) -> tuple[ParsedMesh, MeshFormat]:
    """Triangles with finite corners and valid indices, and the format that they came in.

    The content decides where it is unmistakable, the suffix otherwise.

    Raises
    ------
    FileError
        With a whole sentence that names the file.
    """
    try:
        data = without_byte_order_mark(data)
        row, notes = _mesh_format_of(data, path)
        with np.errstate(all="ignore"):
            parsed = row.parse(data, path)
            return _checked_mesh(replace(parsed, notes=notes + parsed.notes)), row
    except FileError as error:
        raise FileError(message_about(path, str(error))) from None


def without_byte_order_mark(data: bytes) -> bytes:
    """Text without a byte order mark; UTF-16 is converted to UTF-8."""
    if data.startswith(codecs.BOM_UTF8):
        return data[len(codecs.BOM_UTF8) :]
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", "replace").encode()
    return data


def _mesh_format_of(data: bytes, path: Path) -> tuple[MeshFormat, tuple[str, ...]]:
    if not data:
        raise FileError("is empty: it has no bytes at all.")
    suffix = path.suffix.lower()
    suffix_or_none = printable(path.suffix) or "without a suffix"
    named = next((row for row in MESH_FORMATS.values() if suffix in row.suffixes), None)
    shown = next((row for row in MESH_FORMATS.values() if row.recognises(data[:1024])), None)
    if shown is not None and shown is not named:
        return shown, (f"The file is named {suffix_or_none} but holds {shown.label}.",)
    if named is not None:
        return named, ()
    if path.name.lower().endswith(tuple(volume_suffixes() - set(VOLUME_FORMATS["raw"].suffixes))):
        raise FileError(
            "is a volume of voxels, not a mesh: make particles of it with “regolith-studio extract”, or on "
            "the page Scan of the window."
        )
    raise FileError(
        f"has an unsupported file type ({suffix or 'no suffix'}); "
        f"supported are meshes in {', '.join(sorted(mesh_suffixes()))}."
    )


def _checked_mesh(parsed: ParsedMesh) -> ParsedMesh:
    vertices, faces = parsed.vertices, parsed.faces
    if not len(vertices):
        raise FileError("holds an empty mesh: it has no vertices.")
    if not len(faces):
        raise FileError(
            f"is a point cloud: its number of points is {len(vertices):,}, and it has no faces; "
            "reconstruct a surface first."
        )
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise FileError(f"has faces that point to vertices beyond its {len(vertices):,}.")
    notes = parsed.notes + _unused_note(vertices, faces)
    good = np.asarray((np.abs(vertices) < MAX_COORDINATE).all(axis=1))
    kept = np.asarray(good[faces].all(axis=1))
    if not kept.any():
        raise FileError("has no face whose corners are all finite numbers; export it again.")
    if not kept.all():
        lost, first = np.count_nonzero(~kept), int(np.argmin(kept))
        counted = "1 face" if lost == 1 else f"{lost:,} faces"
        notes += (
            f"Left out {counted} with a corner that is not a finite number, face {first + 1:,} "
            f"{'of' if lost == 1 else 'the first of'} {len(faces):,}.",
        )
    vertices, faces = used_vertices(vertices, faces[kept])
    return replace(parsed, vertices=vertices, faces=faces, notes=notes)


def _unused_note(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> tuple[str, ...]:
    used = np.zeros(len(vertices), dtype=np.bool_)
    used[faces] = True
    unused = len(vertices) - int(np.count_nonzero(used))
    if not unused:
        return ()
    return (f"Left out {plural(unused, 'point')} that no triangle uses.",)


MAX_POSITION = 1e30


def read_positions_file(request: dict[str, Any]) -> SandboxMessage:
    """Points and perhaps diameters of the file at ``request["path"]``."""
    path = Path(request["path"])
    parsed, row = parse_positions(path.read_bytes(), path, tuple(map(str, request.get("columns") or ())))
    header = {
        "format": row.key,
        "label": row.label,
        "notes": parsed.notes,
        "unit": parsed.unit,
        "diameter_unit": parsed.diameter_unit,
    }
    arrays = (parsed.points, *(() if parsed.diameters is None else (parsed.diameters,)))
    return SandboxMessage(header, tuple(np.ascontiguousarray(array, "<f8") for array in arrays))


def read_number_rows(request: dict[str, Any]) -> SandboxMessage:
    """The rows of the text at ``request["path"]`` below at most ``request["headers"]`` lines of header."""
    path = Path(request["path"])
    data = path.read_bytes()
    try:
        headers = int(request.get("headers", 1))
        table = number_rows(without_byte_order_mark(data), headers, numeric_headers=headers)
    except FileError as error:
        raise FileError(message_about(path, str(error))) from None
    return SandboxMessage(
        {"names": table.names, "commas": table.separator == ","},
        (np.ascontiguousarray(table.numbers, "<f8"),),
    )


def parse_positions(
    data: bytes, path: Path, columns: tuple[str, ...] = ()
) -> tuple[ParsedPositions, PositionFormat]:
    """Particles with finite positions and positive diameters, and the format that they came in.

    Parameters
    ----------
    columns
        The names of all columns, where the file does not name them or names them wrongly.

    Raises
    ------
    FileError
        With a whole sentence that names the file.
    """
    try:
        if not data:
            raise FileError("is empty: it has no bytes at all.")
        data = without_byte_order_mark(data)
        row = _position_format_of(data, path)
        with np.errstate(all="ignore"):
            if columns and not row.takes_names:
                raise FileError(f"is {row.label}, which names its columns itself; leave the names out.")
            return _checked_positions(row.parse(data, columns)), row
    except FileError as error:
        raise FileError(message_about(path, str(error))) from None


def _position_format_of(data: bytes, path: Path) -> PositionFormat:
    rows = POSITION_FORMATS.values()
    shown = next((row for row in rows if row.recognises(data[:1024])), None)
    named = next((row for row in rows if path.suffix.lower() in row.suffixes), None)
    if shown is None and named is None:
        raise FileError(
            f"has an unsupported file type ({printable(path.suffix) or 'no suffix'}); positions end in "
            f"{', '.join(sorted(position_suffixes()))}."
        )
    return shown or named  # type: ignore[return-value]


def _checked_positions(parsed: ParsedPositions) -> ParsedPositions:
    points, diameters = parsed.points, parsed.diameters
    if not len(points):
        raise FileError("holds no particles.")
    good = np.asarray((np.abs(points) < MAX_POSITION).all(axis=1))
    if diameters is not None:
        good &= (diameters > 0.0) & (diameters < MAX_POSITION)
    if not good.any():
        raise FileError("has no particle whose position and size are valid numbers.")
    lost = len(points) - int(np.count_nonzero(good))
    if not lost:
        return parsed
    note = f"Left out {lost:,} of {len(points):,} particles whose position or size is not a valid number."
    kept = None if diameters is None else diameters[good]
    return replace(parsed, points=points[good], diameters=kept, notes=(*parsed.notes, note))


def spin(_request: dict[str, Any]) -> SandboxMessage:
    """Use the processor without end; for tests of the limits."""
    while True:
        pass


def sleep(_request: dict[str, Any]) -> SandboxMessage:
    """Sleep without end; for tests of the limits."""
    time.sleep(3600.0)
    return SandboxMessage({})
