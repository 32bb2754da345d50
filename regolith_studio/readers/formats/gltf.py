"""glTF 2.0 and its binary form GLB: the triangles of the scene with their nodes' transformations."""

import base64
import binascii
import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.formats import MeshFormat, ParsedMesh

_KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC3": 3}
_COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
MAX_INSTANCES = 10_000
MAX_FACES = 20_000_000
MAX_BUFFER_BYTES = 1 << 30


@dataclass(frozen=True)
class _Document:
    """The JSON of a file, and its buffers."""

    json: dict[str, Any]
    buffers: tuple[bytes, ...]

    def row(self, table: str, index: Any) -> dict[str, Any]:
        """One entry of a table of the JSON."""
        rows = self.json.get(table, [])
        if not isinstance(index, int) or not isinstance(rows, list) or not 0 <= index < len(rows):
            raise FileError(f"is not a valid glTF: it points to {table}[{index}], which is not there.")
        if not isinstance(rows[index], dict):
            raise FileError(f"is not a valid glTF: {table}[{index}] is not an object.")
        return dict(rows[index])


def parse(data: bytes, path: Path) -> ParsedMesh:
    """All triangles of the scene in its coordinates; points, lines, materials and motion are left out."""
    try:
        document = _document(data, path)
        parts = _parts(document)
    except (KeyError, TypeError, ValueError, OverflowError, RecursionError, AttributeError) as error:
        raise FileError(f"is not a valid glTF: {_fault(error)}; export it again.") from None
    if not parts:
        raise FileError("is a glTF without triangles.")
    offsets = np.cumsum([0, *(len(points) for points, _ in parts)])
    return ParsedMesh(
        np.concatenate([points for points, _ in parts]),
        np.concatenate([faces + offset for (_, faces), offset in zip(parts, offsets, strict=False)]),
        ("The unit of glTF is the metre.",),
        "m",
    )


def _parts(document: _Document) -> list[tuple[NDArray[np.float64], NDArray[np.int64]]]:
    """Vertices and faces of all primitives that are surfaces, each as often as the scene shows it."""
    parts = []
    total = 0
    for primitive, matrix in _instances(document):
        placed = _placed(primitive, matrix, document)
        if placed is not None:
            parts.append(placed)
            total += max(len(placed[0]) // 3, len(placed[1]))
        if total > MAX_FACES:
            raise FileError(f"has more than {MAX_FACES:,} faces, which is more than can be read.")
    return parts


def _fault(error: Exception) -> str:
    """What is wrong with the description, in words."""
    match error:
        case json.JSONDecodeError(lineno=line, colno=column):
            return f"its JSON breaks in line {line}, column {column}"
        case UnicodeDecodeError():
            return "its JSON is not text"
        case KeyError():
            return f"an entry of its description lacks its “{error.args[0]}”"
        case RecursionError():
            return "its JSON nests too deeply"
    return "an entry of its description is of a wrong type or length"


def _document(data: bytes, path: Path) -> _Document:
    text, binary = _chunks(data) if data[:4] == b"glTF" else (data, b"")
    document = json.loads(text)
    if not isinstance(document, dict) or "asset" not in document:
        raise FileError("is not a glTF: its JSON has no “asset”.")
    for extension in _COMPRESSED:
        if extension in document.get("extensionsRequired", []):
            raise FileError(
                f"is compressed with {extension}, which is not read; export it without compression."
            )
    rows = document.get("buffers", [])
    buffers = [_buffer(row, binary if index == 0 else b"", path) for index, row in enumerate(rows)]
    return _Document(document, tuple(buffers))


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    """The JSON and the binary chunk of a GLB."""
    if len(data) < 20:
        raise FileError("is cut short: it ends inside the header of a GLB.")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise FileError(f"is a GLB of version {version}; only version 2 is read.")
    if length > len(data):
        raise FileError(f"is cut short: it declares {length:,} bytes and has {len(data):,}; copy it again.")
    chunks: dict[bytes, bytes] = {}
    place = 12
    while place + 8 <= length:
        size, kind = struct.unpack_from("<I4s", data, place)
        if place + 8 + size > len(data):
            raise FileError("is cut short: a chunk of the GLB goes beyond its end.")
        chunks.setdefault(kind, data[place + 8 : place + 8 + size])
        place += 8 + size
    if b"JSON" not in chunks:
        raise FileError("is not a valid GLB: it has no JSON chunk.")
    return chunks[b"JSON"], chunks.get(b"BIN\0", b"")


def _buffer(row: dict[str, str], binary: bytes, path: Path) -> bytes:
    uri = row.get("uri")
    if uri is None:
        return binary
    if uri.startswith("data:"):
        try:
            return base64.b64decode(uri.partition(",")[2], validate=True)
        except binascii.Error:
            raise FileError("is not a valid glTF: an embedded buffer is not base64.") from None
    if Path(uri).name != uri or ":" in uri or "\\" in uri:
        raise FileError(f"refers to “{uri[:60]}”; only files in its own folder are read.")
    beside = path.parent / uri
    if not beside.is_file() or beside.is_symlink():
        raise FileError(f"needs the file {uri[:60]} beside it, which is not there.")
    if beside.stat().st_size > MAX_BUFFER_BYTES:
        raise FileError(f"needs the file {uri[:60]}, which is larger than 1 GiB.")
    return beside.read_bytes()


def _instances(document: _Document) -> list[tuple[dict[str, Any], NDArray[np.float64]]]:
    """Each primitive of each node of the scene, with the node's transformation."""
    scenes = document.json.get("scenes")
    if scenes:
        roots = document.row("scenes", document.json.get("scene", 0)).get("nodes", [])
    else:
        roots = list(range(len(document.json.get("nodes", []))))
    instances: list[tuple[dict[str, Any], NDArray[np.float64]]] = []
    waiting = [(node, np.eye(4), 0) for node in roots]
    visited = 0
    while waiting:
        index, above, depth = waiting.pop()
        visited += 1
        if visited > MAX_INSTANCES or depth > 200:
            raise FileError("is not a valid glTF: its nodes form a cycle, or are too many.")
        node = document.row("nodes", index)
        matrix = above @ _matrix(node)
        waiting += [(child, matrix, depth + 1) for child in node.get("children", [])]
        if "mesh" in node:
            instances += [
                (primitive, matrix) for primitive in document.row("meshes", node["mesh"])["primitives"]
            ]
    return instances


def _matrix(node: dict[str, Any]) -> NDArray[np.float64]:
    """Transformation of a node: its matrix, or scale, then rotation (x, y, z, w), then translation."""
    if "matrix" in node:
        # the sixteen numbers go column by column
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", (0, 0, 0, 1)), dtype=np.float64)
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.array(node.get("scale", (1, 1, 1)), dtype=np.float64)
    matrix[:3, 3] = np.array(node.get("translation", (0, 0, 0)), dtype=np.float64)
    return matrix


def _placed(
    primitive: dict[str, Any], matrix: NDArray[np.float64], document: _Document
) -> tuple[NDArray[np.float64], NDArray[np.int64]] | None:
    """Vertices and faces of a primitive in the scene's coordinates; ``None`` for points and lines."""
    mode = primitive.get("mode", _TRIANGLES)
    if mode not in (_TRIANGLES, _STRIP, _FAN) or "POSITION" not in primitive["attributes"]:
        return None
    points = _accessor(primitive["attributes"]["POSITION"], document, "VEC3")
    if "indices" in primitive:
        order = _accessor(primitive["indices"], document, "SCALAR")[:, 0].astype(np.int64)
    else:
        order = np.arange(len(points), dtype=np.int64)
    faces = _faces(order, mode)
    if len(faces) and int(faces.max()) >= len(points):
        raise FileError(
            f"is not a valid glTF: a face points to vertex {faces.max()} of {len(points):,} (counted from 0)."
        )
    # a mirroring node turns faces inside out
    if np.linalg.det(matrix[:3, :3]) < 0:
        faces = faces[:, ::-1]
    with np.errstate(all="ignore"):
        return points @ matrix[:3, :3].T + matrix[:3, 3], faces


def _faces(order: NDArray[np.int64], mode: int) -> NDArray[np.int64]:
    if mode == _TRIANGLES:
        return order[: len(order) // 3 * 3].reshape(-1, 3)
    if mode == _FAN:
        return np.column_stack([np.full(max(len(order) - 2, 0), order[:1].sum()), order[1:-1], order[2:]])
    faces = np.column_stack([order[:-2], order[1:-1], order[2:]])
    # every second triangle of a strip runs the other way round
    faces[1::2] = faces[1::2, ::-1]
    return faces


def _accessor(index: Any, document: _Document, kind: str) -> NDArray[np.float64]:
    """Numbers of an accessor, shape (count, width)."""
    row = document.row("accessors", index)
    if "sparse" in row or "bufferView" not in row:
        raise FileError("has sparse accessors, which are not read; export it as STL or PLY.")
    if row["type"] != kind or row["componentType"] not in _KINDS:
        raise FileError(
            f"is not a valid glTF: accessor {index} is of type “{str(row['type'])[:20]}”, not {kind}."
        )
    view = document.row("bufferViews", row["bufferView"])
    document.row("buffers", view["buffer"])
    source = document.buffers[int(view["buffer"])]
    part = np.dtype(_KINDS[row["componentType"]])
    width, count = _WIDTHS[kind], int(row["count"])
    stride = int(view.get("byteStride") or part.itemsize * width)
    start = int(view.get("byteOffset", 0)) + int(row.get("byteOffset", 0))
    needed = start + (count - 1) * stride + part.itemsize * width
    if count < 0 or start < 0 or stride < part.itemsize * width or (count and needed > len(source)):
        raise FileError(
            f"is cut short: accessor {index} needs {needed:,} bytes of a buffer of {len(source):,}."
        )
    if count > 3 * MAX_FACES:
        raise FileError(f"has {count:,} values in one accessor, which is more than can be read.")
    raw = np.ndarray((count, width), dtype=part, buffer=source, offset=start, strides=(stride, part.itemsize))
    values = raw.astype(np.float64)
    if row.get("normalized") and part.kind in "iu":
        values = np.maximum(values / np.iinfo(part).max, -1.0)
    return values


def _recognises(head: bytes) -> bool:
    return head[:4] == b"glTF"


FORMAT = MeshFormat("gltf", "glTF", (".glb", ".gltf"), _recognises, parse, states_unit=True)
