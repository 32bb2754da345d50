"""NIfTI-1 and NIfTI-2 in one file, plain (.nii) or gzipped (.nii.gz)."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    MIRRORED,
    SKEWED,
    Kind,
    OpenVolume,
    Sizes,
    VoxelHeader,
    sizes_or_none,
    three_dimensions,
    voxel_type,
)
from regolith_studio.readers.voxels.stored import DeflatedVoxels, InflatedStream, PlainVoxels

_GZIP = b"\x1f\x8b"
_TYPES = {
    2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4", 1024: "i8", 1280: "u8",
}  # fmt: skip
_REFUSED = {
    1: "single bits",
    32: "complex numbers",
    128: "colours",
    1536: "numbers of 128 bits",
    1792: "complex numbers",
    2048: "complex numbers",
    2304: "colours",
}
_UNITS = {1: "m", 2: "mm", 3: "um"}
MAX_DIFFERENCE = 0.01
"""Of an edge by pixdim and by the matrix, over the edge."""
MAX_SKEW = 1e-3
"""Cosine of two axes of the matrix."""
_LABELS = 1002
"""Intent code of a volume of labels."""


_NIFTI1 = {
    "dim": (40, "8i2"), "intent": (68, "i2"), "datatype": (70, "i2"), "pixdim": (76, "8f4"),
    "offset": (108, "f4"), "slope": (112, "f4"), "intercept": (116, "f4"), "units": (123, "u1"),
    "forms": (252, "2i2"), "rows": (280, "12f4"),
}  # fmt: skip
_NIFTI2 = {
    "datatype": (12, "i2"), "dim": (16, "8i8"), "pixdim": (104, "8f8"), "offset": (168, "i8"),
    "slope": (176, "f8"), "intercept": (184, "f8"), "forms": (344, "2i4"), "rows": (400, "12f8"),
    "units": (500, "i4"), "intent": (504, "i4"),
}  # fmt: skip
"""Place and type of the fields that are used, by the definitions nifti1.h and nifti2.h."""

Fields = dict[str, Any]
Order = Literal["<", ">"]
_ORDERS: tuple[Order, Order] = ("<", ">")


class ScaledVoxels:
    """Voxels to be scaled by slope and intercept: float32 (float64 for types of 32 bits and more)."""

    def __init__(self, voxels: OpenVolume, header: VoxelHeader, slope: float, intercept: float) -> None:
        self.header = header
        self.in_order = bool(getattr(voxels, "in_order", False))
        self._voxels, self._slope, self._intercept = voxels, slope, intercept

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx)."""
        scaled = self._voxels.read(z0, z1).astype(self.header.dtype)
        scaled *= self.header.dtype.type(self._slope)
        scaled += self.header.dtype.type(self._intercept)
        return scaled

    def close(self) -> None:
        """Close the file."""
        self._voxels.close()


def open_nifti(path: Path, _options: Mapping[str, Any]) -> OpenVolume:
    """A three-dimensional image of one file."""
    with path.open("rb") as file:
        packed = file.read(2) == _GZIP
    order, fields = _fields(_head(path, packed))
    stored = _stored_type(fields, order)
    header = _voxel_header(fields, stored)
    start, slope, intercept = int(fields["offset"]), float(fields["slope"]), float(fields["intercept"])
    voxels: OpenVolume
    if packed:
        voxels = DeflatedVoxels(path, 0, start, header, stored)
    else:
        voxels = PlainVoxels(path, start, header, stored)
    # By nifti1.h, a slope of 0 says that the voxels are not scaled.
    if slope == 0.0 or (slope, intercept) == (1.0, 0.0) or not np.isfinite([slope, intercept]).all():
        return voxels
    scaled = np.dtype(np.float64 if stored.itemsize > 2 else np.float32)
    return ScaledVoxels(voxels, replace(header, dtype=scaled, kind=None), slope, intercept)


def _head(path: Path, packed: bool) -> bytes:
    if not packed:
        with path.open("rb") as file:
            return file.read(540)
    stream = InflatedStream(path)
    head = bytearray(540)
    try:
        stream.readinto(memoryview(head))
    finally:
        stream.close()
    return bytes(head)


def _fields(head: bytes) -> tuple[Order, Fields]:
    """Byte order and fields; the header's first number is its own length."""
    for order in _ORDERS:
        length = int.from_bytes(head[:4], "little" if order == "<" else "big")
        if length in (348, 540) and len(head) >= length:
            _check_signature(head, length)
            places = _NIFTI1 if length == 348 else _NIFTI2
            fields = {
                name: np.frombuffer(head, np.dtype(kind).newbyteorder(order), 1, place)[0]
                for name, (place, kind) in places.items()
            }
            return order, {**fields, "offset": _offset(float(fields["offset"]), length)}
    raise FileError("is not a NIfTI file, or is cut short: its header is neither of 348 nor of 540 bytes.")


def _check_signature(head: bytes, length: int) -> None:
    magic = head[344:348] if length == 348 else head[4:12]
    if magic in (b"ni1\0", b"ni2\0\r\n\x1a\n"):
        raise FileError("keeps its voxels in a second file (.img); save it as one file (.nii).")
    if length == 348 and magic != b"n+1\0":
        raise FileError("is not a NIfTI-1 file: its signature is missing (it may be an Analyze header).")
    if length == 540 and magic != b"n+2\0\r\n\x1a\n":
        raise FileError("is not a NIfTI-2 file: its signature is missing or damaged.")


def _offset(value: float, length: int) -> int:
    if not (np.isfinite(value) and 0 <= value < 2**40 and value == int(value)) or 0 < value < length:
        raise FileError(f"is a broken NIfTI file: its voxels cannot begin at byte {value:g}.")
    # 0 where it is not stated: after the header come the four bytes that announce extensions.
    return int(value) or length + 4


def _stored_type(fields: Fields, order: Order) -> np.dtype[Any]:
    code = int(fields["datatype"])
    if code in _REFUSED:
        raise FileError(f"holds {_REFUSED[code]}; voxels are whole numbers or floats.")
    if code not in _TYPES:
        raise FileError(f"is a broken NIfTI file: there is no type of number {code}.")
    return np.dtype(_TYPES[code]).newbyteorder(order)


def _voxel_header(fields: Fields, stored: np.dtype[Any]) -> VoxelHeader:
    dimensions = int(fields["dim"][0])
    if not 1 <= dimensions <= 7:
        raise FileError(f"is a broken NIfTI file: it cannot have {dimensions} dimensions.")
    edges = tuple(int(edge) for edge in fields["dim"][1 : dimensions + 1])
    shape = three_dimensions(edges[::-1])
    kept = [axis for axis, edge in enumerate(edges) if edge > 1 or dimensions == 3]
    size, doubts = _size(fields) if len(kept) == 3 and max(kept) < 3 else (None, ())
    unit = _UNITS.get(int(fields["units"]) & 7) if size else None
    kind: Kind | None = "labels" if fields["intent"] == _LABELS and stored.kind in "ui" else None
    notes = (MIRRORED,) if _is_mirrored(fields) else ()
    return VoxelHeader(shape, voxel_type(stored), size, unit, kind, doubts + notes)


def _size(fields: Fields) -> tuple[Sizes | None, tuple[str, ...]]:
    """The edges that pixdim states, unless the affine matrix states others; and notes."""
    size = sizes_or_none([float(edge) for edge in fields["pixdim"][1:4]])
    matrix = np.array(fields["rows"], dtype=np.float64).reshape(3, 4)[:, :3]
    lengths = np.linalg.norm(matrix, axis=0)
    if fields["forms"][1] <= 0 or not np.isfinite(matrix).all() or not lengths.all():
        return size, ()
    unit = matrix / lengths
    skewed = (SKEWED,) if np.abs(unit.T @ unit - np.eye(3)).max() > MAX_SKEW else ()
    if size is None:
        return sizes_or_none(lengths.tolist()), skewed
    if np.abs(lengths / size - 1.0).max() <= MAX_DIFFERENCE:
        return size, skewed
    shown = [" × ".join(f"{edge:.4g}" for edge in edges) for edges in (size, lengths)]
    template = N_(
        "The file states voxels of {pixdim} and, by its matrix, of {matrix}; give the size of a voxel."
    )
    return None, (Message(template, pixdim=shown[0], matrix=shown[1]), *skewed)


def _is_mirrored(fields: Fields) -> bool:
    """Whether the matrix of the header, or else its quaternion, turns right hands into left ones."""
    qform, sform = fields["forms"]
    if sform > 0:
        matrix = np.array(fields["rows"], dtype=np.float64).reshape(3, 4)[:, :3]
        return bool(np.isfinite(matrix).all() and np.linalg.det(matrix) < 0)
    # A quaternion has no mirror: pixdim[0], qfac of nifti1.h, is the sign of the third axis.
    return bool(qform > 0 and fields["pixdim"][0] < 0)


def _recognises(head: bytes) -> bool:
    return head[344:348] == b"n+1\0" or head[4:12] == b"n+2\0\r\n\x1a\n"


FORMAT = VolumeFormat("nifti", "a NIfTI image", (".nii", ".nii.gz"), _recognises, open_nifti)
