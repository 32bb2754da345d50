"""NIfTI-1 and NIfTI-2 in one file, plain (.nii) or gzipped (.nii.gz)."""

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    Kind,
    OpenVolume,
    VoxelHeader,
    sizes_or_none,
    three_dimensions,
    voxel_type,
)
from regolith_studio.readers.voxels.stored import DeflatedVoxels, InflatedStream, PlainVoxels

_GZIP = b"\x1f\x8b"
_LENGTHS = {348: 1, 540: 2}
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
_MIRRORED = "The axes of the volume are left-handed: particles come in as their mirror images."
_LABELS = 1002
"""Intent code of a volume of labels."""


@dataclass(frozen=True)
class NiftiHeader:
    """The fields of a header that are used, of either version."""

    order: str
    dim: tuple[int, ...]
    datatype: int
    pixdim: tuple[float, ...]
    vox_offset: int
    slope: float
    intercept: float
    units: int
    intent: int
    form: tuple[int, ...]
    rows: tuple[float, ...]


class ScaledVoxels:
    """Voxels that the header says to multiply and shift: float32 (float64 of large types)."""

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
        """Let go of the file."""
        self._voxels.close()


def open_nifti(path: Path, _options: Mapping[str, Any]) -> OpenVolume:
    """A three-dimensional image of one file.

    Raises
    ------
    FileError
        If the header breaks the rules, holds colours, or its voxels are in a second file.
    """
    with path.open("rb") as file:
        packed = file.read(2) == _GZIP
    found = _parsed(_head(path, packed))
    stored = _stored_type(found)
    header = _voxel_header(found, stored)
    voxels: OpenVolume
    if packed:
        voxels = DeflatedVoxels(path, 0, found.vox_offset, header, stored)
    else:
        voxels = PlainVoxels(path, found.vox_offset, header, stored)
    if found.slope in (0.0, 1.0) and (found.slope == 0.0 or found.intercept == 0.0):
        return voxels
    if not (np.isfinite(found.slope) and np.isfinite(found.intercept)):
        return voxels
    scaled = np.dtype(np.float64 if stored.itemsize > 2 else np.float32)
    kind: Kind | None = None
    header = VoxelHeader(header.shape, scaled, header.voxel_size, header.unit, kind, header.notes)
    return ScaledVoxels(voxels, header, found.slope, found.intercept)


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


def _parsed(head: bytes) -> NiftiHeader:
    """The header, whose first number tells version and byte order."""
    for order in "<>":
        length = struct.unpack_from(order + "i", head)[0] if len(head) >= 4 else 0
        version = _LENGTHS.get(length)
        if version and len(head) >= length:
            return _first(head, order) if version == 1 else _second(head, order)
    raise FileError("is no NIfTI file, or is cut short: its header is neither of 348 nor of 540 bytes.")


def _first(head: bytes, order: str) -> NiftiHeader:
    def at(place: int, kinds: str) -> tuple[Any, ...]:
        return struct.unpack_from(order + kinds, head, place)

    if head[344:348] == b"ni1\0":
        raise FileError("keeps its voxels in a second file (.img); save it as one file (.nii).")
    if head[344:348] != b"n+1\0":
        raise FileError("is no NIfTI-1 file: its signature is missing (it may be an Analyze header).")
    offset, slope, intercept = at(108, "3f")
    return NiftiHeader(
        order, at(40, "8h"), at(70, "h")[0], at(76, "8f"), _offset(offset, 348), slope, intercept,
        at(123, "B")[0], at(68, "h")[0], at(252, "2h"), at(280, "12f"),
    )  # fmt: skip


def _second(head: bytes, order: str) -> NiftiHeader:
    def at(place: int, kinds: str) -> tuple[Any, ...]:
        return struct.unpack_from(order + kinds, head, place)

    if head[4:12] == b"ni2\0\r\n\x1a\n":
        raise FileError("keeps its voxels in a second file (.img); save it as one file (.nii).")
    if head[4:12] != b"n+2\0\r\n\x1a\n":
        raise FileError("is no NIfTI-2 file: its signature is missing or damaged.")
    slope, intercept = at(176, "2d")
    return NiftiHeader(
        order, at(16, "8q"), at(12, "h")[0], at(104, "8d"), _offset(at(168, "q")[0], 540), slope, intercept,
        at(500, "i")[0], at(504, "i")[0], at(344, "2i"), at(400, "12d"),
    )  # fmt: skip


def _offset(value: float, length: int) -> int:
    if not (np.isfinite(value) and 0 <= value < 2**40 and value == int(value)) or 0 < value < length:
        raise FileError(f"is a broken NIfTI file: its voxels cannot begin at byte {value:g}.")
    return int(value) or length + 4


def _stored_type(header: NiftiHeader) -> np.dtype[Any]:
    if header.datatype in _REFUSED:
        raise FileError(f"holds {_REFUSED[header.datatype]}; voxels are whole numbers or floats.")
    if header.datatype not in _TYPES:
        raise FileError(f"is a broken NIfTI file: there is no type of number {header.datatype}.")
    return np.dtype(_TYPES[header.datatype]).newbyteorder("<" if header.order == "<" else ">")


def _voxel_header(header: NiftiHeader, stored: np.dtype[Any]) -> VoxelHeader:
    dimensions = header.dim[0]
    if not 1 <= dimensions <= 7:
        raise FileError(f"is a broken NIfTI file: it cannot have {dimensions} dimensions.")
    edges = tuple(int(edge) for edge in header.dim[1 : dimensions + 1])
    shape = three_dimensions(edges[::-1])
    kept = [axis for axis, edge in enumerate(edges) if edge > 1 or dimensions == 3]
    size = (
        sizes_or_none([header.pixdim[axis + 1] for axis in kept])
        if len(kept) == 3 and max(kept) < 3
        else None
    )
    unit = _UNITS.get(header.units & 7) if size else None
    kind: Kind | None = "labels" if header.intent == _LABELS and stored.kind in "ui" else None
    notes = (_MIRRORED,) if _is_mirrored(header) else ()
    return VoxelHeader(shape, voxel_type(stored), size, unit, kind, notes)


def _is_mirrored(header: NiftiHeader) -> bool:
    """Whether the matrix of the header, or else its quaternion, turns right hands into left ones."""
    qform, sform = header.form
    if sform > 0:
        matrix = np.array(header.rows).reshape(3, 4)[:, :3]
        return bool(np.isfinite(matrix).all() and np.linalg.det(matrix) < 0)
    return qform > 0 and header.pixdim[0] < 0


def _recognises(head: bytes) -> bool:
    return head[344:348] == b"n+1\0" or head[4:12] == b"n+2\0\r\n\x1a\n"


FORMAT = VolumeFormat("nifti", "a NIfTI image", (".nii", ".nii.gz"), _recognises, open_nifti)
