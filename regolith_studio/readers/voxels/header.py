"""The header and the slices that every volume format provides, and checks of both.

Inside the readers a volume is indexed [z, y, x], slices first, as nearly all files hold it; the
public door (``readers.volumes``) turns it to the [x, y, z] of ``imaging.Volume``.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.settings import in_one_unit

Shape = tuple[int, int, int]
Sizes = tuple[float, float, float]
Kind = Literal["labels", "grey"]

VOXEL_TYPES = frozenset(("b1", "u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f2", "f4", "f8"))
MAX_EDGE = 1 << 20
MAX_SLICE_BYTES = 1 << 30
"""Bytes of the largest slice that is read; twice that of a detector 16,384 pixels wide."""
MIRRORED = "The axes of the volume are left-handed: particles come in as their mirror images."
SKEWED = "The axes of the volume are not at right angles to each other; they were taken as if they were."
MAX_CACHED_BYTES = 1 << 29
"""Bytes of a layer of HDF5 chunks that are cached unpacked."""


@dataclass(frozen=True)
class DatasetEntry:
    """One volume of a file that can hold several: its name, its voxels along x, y and z, their type.

    `voxel_size` has their edges along x, y and z in the unit of the file, where volumes differ in them.
    """

    name: str
    shape: tuple[int, ...]
    dtype: str
    voxel_size: Sizes | None = None


@dataclass(frozen=True)
class VoxelHeader:
    """Description of the voxels in a file, read before any of them is decoded.

    - ``shape``: slices, rows, columns: (nz, ny, nx).
    - ``dtype``: type of the voxels in memory, in native byte order.
    - ``voxel_size``: edges along x, y and z, in `unit`; None where the file does not state it.
    - ``unit``: a key of ``readers.settings.UNITS``; None where the file does not state it.
    - ``kind``: where the file itself states it.
    - ``notes``: sentences for the user.
    - ``datasets``, ``dataset``: the arrays that the file offers, and the name of the one that this is.
    """

    shape: Shape
    dtype: np.dtype[Any]
    voxel_size: Sizes | None = None
    unit: str | None = None
    kind: Kind | None = None
    notes: tuple[str, ...] = ()
    datasets: tuple[DatasetEntry, ...] = ()
    dataset: str | None = None

    @property
    def slice_bytes(self) -> int:
        """Bytes of one slice."""
        return self.shape[1] * self.shape[2] * self.dtype.itemsize

    @property
    def nbytes(self) -> int:
        """Bytes of all voxels."""
        return self.shape[0] * self.slice_bytes


class OpenVolume(Protocol):
    """An opened file: its header, and its slices.

    Optional attributes: ``in_order``, if it is best read sequentially, and ``layer``, the number of slices
    that are best read together.
    """

    @property
    def header(self) -> VoxelHeader:
        """Description of the voxels."""

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx)."""

    def close(self) -> None:
        """Close the file."""


def three_dimensions(shape: tuple[int, ...]) -> Shape:
    """The shape without its edges of one voxel, which must leave three (or the last three).

    Raises FileError if no volume has such a shape.
    """
    edges = [int(edge) for edge in shape]
    if any(edge < 1 for edge in edges):
        raise FileError(f"holds no voxels: its shape is {format_shape(shape)}.")
    while len(edges) > 3 and 1 in edges:
        edges.remove(1)
    if len(edges) != 3:
        raise FileError(
            f"is not a volume: its shape is {format_shape(shape)}, and three dimensions are needed."
        )
    if max(edges) > MAX_EDGE:
        raise FileError(f"is damaged: no volume can have the shape {format_shape(shape)}.")
    return edges[0], edges[1], edges[2]


def stated_axes(axes: str, dimensions: int) -> str:
    """The letters that a user gave for an array's axes, each of ``tczyx`` once, the slowest first.

    Raises FileError if they do not fit the array.
    """
    letters = axes.lower()
    if len(letters) != dimensions:
        raise FileError(
            f"has an array of {dimensions} dimensions; the axes “{printable(axes)[:12]}” do not fit."
        )
    if len(set(letters)) != dimensions or not {"z", "y", "x"} <= set(letters) <= set("tczyx"):
        raise FileError(
            f"has axes x, y and z, each once, and perhaps t and c; “{printable(axes)[:12]}” is wrong."
        )
    return letters


def voxel_type(dtype: np.dtype[Any]) -> np.dtype[Any]:
    """The type in the machine's byte order, if voxels can have it.

    Raises FileError if they cannot.
    """
    if dtype.hasobject:
        raise FileError("holds Python objects, which could run programs; save it as plain numbers.")
    if dtype.kind == "c":
        raise FileError("holds complex numbers; save their magnitude.")
    if dtype.names or dtype.subdtype or f"{dtype.kind}{dtype.itemsize}" not in VOXEL_TYPES:
        raise FileError(f"holds {_type_name(dtype)} values; voxels are whole numbers or floats.")
    return dtype.newbyteorder("=")


def checked_header(header: VoxelHeader) -> VoxelHeader:
    """The header, if its slices are of a size that can be read.

    Raises FileError if a single slice is too large.
    """
    if header.slice_bytes > MAX_SLICE_BYTES:
        size = header.slice_bytes / 1024**3
        shown = f"{size:,.0f}" if size >= 100 else f"{size:.3g}"
        raise FileError(f"has slices of {shown} GiB; at most 1 GiB is read at a time.")
    return header


def sizes_or_none(values: tuple[float, ...] | list[float]) -> Sizes | None:
    """Three positive finite edges, or None."""
    edges = tuple(abs(float(value)) for value in values)
    if len(edges) == 3 and all(1e-12 < edge < 1e12 for edge in edges):
        return edges[0], edges[1], edges[2]
    return None


def stated_edges(edges: Sequence[float], names: Sequence[str | None]) -> tuple[Sizes | None, str | None]:
    """Edges along x, y and z in one unit, and its key, from the edge and unit that a file states for each.

    Without units that are known, the edges stay and the unit is None, so that it is asked for.
    """
    size = sizes_or_none(list(edges))
    if size is None:
        return None, None
    in_unit = in_one_unit(size, names)
    if in_unit is None:
        return size, None
    return sizes_or_none(list(in_unit[0])), in_unit[1]


def hand_note(edges: Sequence[float]) -> tuple[str, ...]:
    """The note that axes are left-handed, where an odd number of the signed steps along them is negative."""
    return (MIRRORED,) if math.prod(edges) < 0.0 else ()


def format_shape(shape: tuple[int, ...]) -> str:
    """``512 × 512 × 100``, cut short where it is long."""
    edges = [f"{edge}" for edge in shape[:6]]
    return " × ".join(edges + (["…"] if len(shape) > 6 else [])) or "that of a single number"


def _type_name(dtype: np.dtype[Any]) -> str:
    names = {"S": "text", "U": "text", "M": "dates", "m": "spans of time", "V": "unnamed bytes"}
    return "structured" if dtype.names else f"“{names.get(dtype.kind, str(dtype)[:40])}”"
