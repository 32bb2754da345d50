"""Tasks of the sandbox process: meshes, positions, tables of numbers and volumes, parsed and checked."""

import codecs
import hashlib
import math
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.io.triangles import used_vertices
from regolith_studio.messages import N_, Message, to_json
from regolith_studio.readers.error_messages import about_file, plural, printable
from regolith_studio.readers.formats import MESH_FORMATS, MeshFormat, ParsedMesh, mesh_suffixes
from regolith_studio.readers.number_rows import named_columns, number_rows
from regolith_studio.readers.position_formats import (
    POSITION_FORMATS,
    ParsedPositions,
    PositionFormat,
    position_suffixes,
)
from regolith_studio.readers.sandbox import SandboxMessage
from regolith_studio.readers.settings import UNITS
from regolith_studio.readers.volume_formats import VOLUME_FORMATS, WITH_AXES, VolumeFormat, volume_suffixes
from regolith_studio.readers.voxels.header import OpenVolume, Sizes, VoxelHeader, checked_header
from regolith_studio.readers.voxels.stored import PlainVoxels
from regolith_studio.readers.zip_members import Place, listed_members, member_bytes

MAX_COORDINATE = 1e40
"""Beyond it the sixth powers in the checks would leave the range of float64."""


def read_mesh_file(request: dict[str, Any]) -> SandboxMessage:
    """Vertices and faces of the file at ``request["path"]``, which may be in an archive."""
    path = Path(request["path"])
    data = path.read_bytes() if "archive" not in request else _member_bytes(request, path)
    parsed, row = parse_mesh(data, path)
    header = {
        "notes": parsed.notes,
        "unit": parsed.unit,
        "format": row.key,
        "shares_vertices": row.shares_vertices,
        "sha256": hashlib.sha256(data).hexdigest(),
    }
    return SandboxMessage(header, (parsed.vertices.astype("<f8"), parsed.faces.astype("<i8")))


def list_archive(request: dict[str, Any]) -> SandboxMessage:
    """Names and places of the meshes and archives in an archive."""
    path = Path(request["path"])
    with about_file(path):
        names, places, refused = listed_members(
            Path(request["archive"]), request["chain"], request["suffixes"]
        )
    text = "\0".join(names).encode("utf-8", "replace")
    rows = np.array(places, dtype="<u8").reshape(-1, len(Place._fields))
    return SandboxMessage({"refused": refused}, (np.frombuffer(text, dtype=np.uint8), rows))


def _member_bytes(request: dict[str, Any], path: Path) -> bytes:
    with about_file(path):
        return member_bytes(Path(request["archive"]), request["chain"])


def parse_mesh(data: bytes, path: Path) -> tuple[ParsedMesh, MeshFormat]:
    """Triangles with finite corners and valid indices, and the format that they came in.

    The content decides where it is unmistakable, the suffix otherwise.

    Raises FileError with a whole sentence that names the file.
    """
    with about_file(path):
        data = without_byte_order_mark(data)
        row, notes = _mesh_format_of(data, path)
        with np.errstate(all="ignore"):
            parsed = row.parse(data, path)
            return _checked_mesh(replace(parsed, notes=notes + parsed.notes)), row


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


def read_named_columns(request: dict[str, Any]) -> SandboxMessage:
    """Columns of descriptors in the table at ``request["path"]``."""
    path = Path(request["path"])
    with about_file(path):
        found = named_columns(path.read_bytes())
    header = {"keys": found.keys, "units": found.units, "notes": found.notes}
    return SandboxMessage(header, found.values)


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
    with about_file(path):
        headers = int(request.get("headers", 1))
        table = number_rows(without_byte_order_mark(data), headers, numeric_headers=headers)
    return SandboxMessage(
        {"names": table.names, "commas": table.separator == ","},
        (np.ascontiguousarray(table.numbers, "<f8"),),
    )


def parse_positions(
    data: bytes, path: Path, columns: tuple[str, ...] = ()
) -> tuple[ParsedPositions, PositionFormat]:
    """Particles with finite positions and positive diameters, and the format that they came in.

    ``columns``: the names of all columns, where the file does not name them or names them wrongly.

    Raises FileError with a whole sentence that names the file.
    """
    with about_file(path):
        if not data:
            raise FileError("is empty: it has no bytes at all.")
        data = without_byte_order_mark(data)
        row = _position_format_of(data, path)
        with np.errstate(all="ignore"):
            if columns and not row.takes_names:
                raise FileError(f"is {row.label}, which names its columns itself; leave the names out.")
            return _checked_positions(row.parse(data, columns)), row


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


MIN_VOXEL_EDGE, MAX_VOXEL_EDGE, MAX_EDGE_RATIO = 1e-5, 1e6, 1e4
"""Range of plausible voxel edges in micrometres, and the largest ratio of two."""
_HEAD = 1024
_PICTURES = (".png", ".bmp", ".jpg", ".jpeg")
_opened: dict[str, tuple[OpenVolume, VolumeFormat]] = {}
"""At most one volume, by the request that opened it."""


def prepare_volume(request: dict[str, Any]) -> SandboxMessage:
    """Import what the format of the file needs; the only step that may take long on a small file."""
    path = Path(request["path"])
    with about_file(path):
        row, _ = volume_format_of(path)
        row.prepare()
    return SandboxMessage({"format": row.key})


def open_volume(request: dict[str, Any]) -> SandboxMessage:
    """The header of the volume that the request names, which stays open for `read_slices`."""
    path = Path(request["path"])
    with about_file(path):
        volume, row = _open_one(request)
    return SandboxMessage(_as_json(volume, row, volume_format_of(path)[1]))


def read_slices(request: dict[str, Any]) -> SandboxMessage:
    """Slices ``request["z0"]`` to ``request["z1"]``, shape (z1 - z0, ny, nx)."""
    path = Path(request["path"])
    with about_file(path):
        volume, _ = _open_one(request)
        z0, z1 = int(request["z0"]), int(request["z1"])
        voxels = read_checked_slices(volume, z0, z1)
    return SandboxMessage({}, (_little(voxels),))


def read_checked_slices(volume: OpenVolume, z0: int, z1: int) -> NDArray[Any]:
    """What the volume gives for the slices, if it is what its header promised.

    Raises FileError if the file holds something else.
    """
    with np.errstate(all="ignore"):
        voxels = volume.read(z0, z1)
    header = volume.header
    if voxels.shape != (z1 - z0, *header.shape[1:]) or voxels.dtype != header.dtype:
        raise FileError("is damaged: its slices are not of the size and type that its header states.")
    return voxels


def open_volume_file(path: Path, request: dict[str, Any]) -> tuple[OpenVolume, VolumeFormat]:
    """An opened volume with a checked header, and the format that it came in.

    Raises FileError with the second half of a sentence.
    """
    row, _ = volume_format_of(path)
    if request.get("axes") and row.key not in WITH_AXES:
        raise FileError(f"is {row.label}, which states its axes itself; leave the axes out.")
    if request.get("allow_gaps") and row.key != "slices":
        raise FileError(f"is {row.label}, not a folder of slices, of which alone some may be absent.")
    row.prepare()
    with np.errstate(all="ignore"):
        volume = row.open(path, request)
    checked_header(volume.header)
    return volume, row


def volume_format_of(path: Path) -> tuple[VolumeFormat, tuple[str, ...]]:
    """The format of a file by its content where that is unmistakable, else by its suffix; and notes.

    Raises FileError if it is not a volume format.
    """
    rows = VOLUME_FORMATS
    if path.is_dir():
        return next((row for row in rows.values() if row.holds(path)), rows["slices"]), ()
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if not head:
        raise FileError("is empty: it has no bytes at all.")
    name = path.name.lower()
    named = next((row for row in rows.values() if name.endswith(row.suffixes)), None)
    shown = next((row for row in rows.values() if row.recognises(head)), None)
    if shown is not None and shown is not named:
        return shown, (
            Message(
                N_("The file is named {suffix} but is {format}."),
                suffix=printable(path.suffix) or "without a suffix",
                format=shown.label,
            ),
        )
    if named is not None:
        return named, ()
    if name.endswith(tuple(mesh_suffixes())):
        raise FileError("is a mesh, not a volume: it is a particle already, open or describe it as it is.")
    if name.endswith(_PICTURES):
        raise FileError("is a single picture; open the folder that holds all slices of the scan.")
    known = ", ".join(sorted(row.suffixes[0] for row in rows.values() if row.suffixes))
    raise FileError(
        f"has an unsupported file type ({printable(path.suffix) or 'no suffix'}); volumes end in {known}."
    )


def _open_one(request: dict[str, Any]) -> tuple[OpenVolume, VolumeFormat]:
    key = repr(
        [request.get(name) for name in ("path", "stamp", "dataset", "raw", "names", "axes", "allow_gaps")]
    )
    if key not in _opened:
        for volume, _ in _opened.values():
            volume.close()
        _opened.clear()
        _opened[key] = open_volume_file(Path(request["path"]), request)
    return _opened[key]


def _as_json(volume: OpenVolume, row: VolumeFormat, notes: tuple[str, ...]) -> dict[str, Any]:
    header = volume.header
    size, doubts = _plausible_size(header)
    return {
        "format": row.key,
        "label": row.label,
        "shape": header.shape,
        "dtype": header.dtype.str,
        "voxel_size": size,
        "unit": header.unit,
        "kind": header.kind,
        "notes": [to_json(note) for note in notes + header.notes + doubts],
        "datasets": [(each.name, each.shape, each.dtype, each.voxel_size) for each in header.datasets],
        "dataset": header.dataset,
        "plain": volume.plain() if isinstance(volume, PlainVoxels) else None,
        "in_order": bool(getattr(volume, "in_order", False)),
        "layer": int(getattr(volume, "layer", 1)),
    }


def _plausible_size(header: VoxelHeader) -> tuple[Sizes | None, tuple[str, ...]]:
    """The stated voxel size, or None and a note where it is implausible."""
    size, unit = header.voxel_size, header.unit
    if size is None:
        return None, ()
    factor = UNITS.get(unit or "", math.nan)
    slim = max(size) > MAX_EDGE_RATIO * min(size)
    if not slim and not any(
        not MIN_VOXEL_EDGE <= edge * factor <= MAX_VOXEL_EDGE for edge in size if factor > 0
    ):
        return size, ()
    shown = " × ".join(f"{edge:.3g}" for edge in size)
    template = N_("The file states a voxel of {size}, which is implausible; give the size of a voxel.")
    return None, (Message(template, size=f"{shown} {unit or ''}".rstrip()),)


def _little(voxels: NDArray[Any]) -> NDArray[Any]:
    return voxels.astype(voxels.dtype.newbyteorder("<"), copy=False)
