"""Triangles in binary files: STL, in which single particles are stored, and glTF 2.0 for viewers.

Files from elsewhere go through the strict readers in :mod:`regolith_studio.readers.formats`.
"""

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def used_vertices(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """The vertices that a face uses, in their order, and the faces by these; the same arrays if all are."""
    used = np.zeros(len(vertices), dtype=np.bool_)
    used[faces] = True
    if used.all():
        return vertices, faces
    return vertices[used], (np.cumsum(used) - 1)[faces]


HEADER_SIZE = 80
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""One triangle of a binary STL file."""

_FIRST_RECORD = HEADER_SIZE + 4  # the number of triangles, uint32, follows the header


def stl_bytes(triangles: NDArray[np.float64], header: str) -> bytes:
    """Triangles as binary STL with unit normals and float32 coordinates.

    ``triangles``: corner coordinates, shape (m, 3, 3): triangle, corner, axis. ``header``: at most 80 ASCII
    characters.

    Raises ValueError if the header is too long or begins with ``solid``, which readers take for the ASCII
    form.
    """
    if len(header) > HEADER_SIZE or not header.isascii() or header.startswith("solid"):
        raise ValueError(
            f"an STL header has at most {HEADER_SIZE} ASCII characters, not beginning with solid: {header!r}"
        )
    a, b, c = np.moveaxis(triangles, 1, 0)
    normals = np.cross(b - a, c - a) / 2
    areas = np.linalg.norm(normals, axis=1)[:, None]
    records = np.zeros(len(triangles), dtype=RECORD)
    records["normal"] = np.divide(normals, areas, out=np.zeros((len(areas), 3)), where=areas > 0)
    records["corners"] = triangles
    count = np.array(len(records), dtype="<u4")
    return header.encode("ascii").ljust(HEADER_SIZE) + count.tobytes() + records.tobytes()


def stl_triangles(content: bytes) -> NDArray[np.float64]:
    """Corner coordinates of the triangles in binary STL, shape (m, 3, 3).

    Raises ValueError if the length is not the one that the number of triangles requires, or a coordinate is
    not finite.
    """
    count = int.from_bytes(content[HEADER_SIZE:_FIRST_RECORD], "little")
    if len(content) < _FIRST_RECORD or len(content) != _FIRST_RECORD + RECORD.itemsize * count:
        raise ValueError("is no complete binary STL")
    corners = np.frombuffer(content, dtype=RECORD, offset=_FIRST_RECORD)["corners"].astype(np.float64)
    if not np.isfinite(corners).all():
        raise ValueError("holds a coordinate that is not finite")
    return corners


Z_UP_TO_Y_UP = (-float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5)))
"""Quaternion (x, y, z, w) of a node that turns the z axis to the y axis, which points up in glTF."""

_FLOAT, _ARRAY_BUFFER = 5126, 34962


class MeshBuffer:
    """Collects meshes in one buffer."""

    def __init__(self) -> None:
        self.binary = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._meshes: list[dict[str, Any]] = []

    def add(
        self, name: str, corners: NDArray[np.float64], normals: NDArray[np.float64], material: int = 0
    ) -> None:
        """Append a mesh of three corners a triangle and the normals there, both of shape (3 t, 3)."""
        attributes = {"POSITION": self._store(corners), "NORMAL": self._store(normals)}
        self._meshes.append({"name": name, "primitives": [{"attributes": attributes, "material": material}]})

    def document(self) -> dict[str, list[dict[str, Any]]]:
        """The entries of the JSON for meshes, accessors, views and the buffer."""
        return {
            "buffers": [{"byteLength": len(self.binary)}],
            "bufferViews": self._views,
            "accessors": self._accessors,
            "meshes": self._meshes,
        }

    def _store(self, values: NDArray[np.float64]) -> int:
        """Append an array of vectors; index of its accessor."""
        stored = values.astype("<f4")
        self._views.append(
            {
                "buffer": 0,
                "byteOffset": len(self.binary),
                "byteLength": stored.nbytes,
                "target": _ARRAY_BUFFER,
            }
        )
        self.binary += stored.tobytes()
        self._accessors.append(
            {
                "bufferView": len(self._views) - 1,
                "componentType": _FLOAT,
                "count": len(stored),
                "type": "VEC3",
                "min": stored.min(axis=0).tolist(),
                "max": stored.max(axis=0).tolist(),
            }
        )
        return len(self._accessors) - 1


def glb_bytes(text: bytes, binary: bytes | bytearray) -> bytes:
    """Header, chunk of JSON, binary chunk; each chunk padded to four bytes."""
    text += b" " * (-len(text) % 4)
    padded = bytes(binary) + b"\0" * (-len(binary) % 4)
    total = 12 + 8 + len(text) + 8 + len(padded)
    return b"".join(
        (
            struct.pack("<4sII", b"glTF", 2, total),
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(padded), b"BIN\0"),
            padded,
        )
    )
