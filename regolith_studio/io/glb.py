"""Binary glTF 2.0: meshes of triangles with a normal at each corner, and the container of JSON and binary."""

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
