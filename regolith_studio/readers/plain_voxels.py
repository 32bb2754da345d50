"""Voxels that lie in a file as they are: uncompressed, one after the other."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.volume_format import Shape, VoxelHeader

BLOCK = 1 << 25
"""Bytes of a file whose slices are last that are mapped at a time."""


@dataclass(frozen=True)
class PlainVoxels:
    """Slices read straight from their place in the file.

    Parameters
    ----------
    path, offset
        The file, and the byte that the first voxel begins at.
    header
        Shape and type of what is handed over.
    stored
        The type in the file, with its byte order.
    slices_last
        Whether z is the index that runs fastest (Fortran's order of a [z, y, x] array).

    Raises
    ------
    FileError
        If the file is too short for its voxels.
    """

    path: Path
    offset: int
    header: VoxelHeader
    stored: np.dtype[Any]
    slices_last: bool = False

    def __post_init__(self) -> None:
        needed = self.offset + math.prod(self.header.shape) * self.stored.itemsize
        there = self.path.stat().st_size
        if there < needed:
            raise FileError(
                f"is cut short: its voxels need {needed:,} bytes and it has {there:,}; copy it again."
            )

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1 in the machine's byte order, shape (z1 - z0, ny, nx)."""
        if self.slices_last:
            return self._gathered(z0, z1)
        _, ny, nx = self.header.shape
        plane = ny * nx * self.stored.itemsize
        with self.path.open("rb", buffering=0) as file:
            file.seek(self.offset + z0 * plane)
            flat = np.fromfile(file, dtype=self.stored, count=(z1 - z0) * ny * nx)
        if flat.size != (z1 - z0) * ny * nx:
            raise FileError("became shorter while it was read.")
        return flat.astype(self.header.dtype, copy=False).reshape(z1 - z0, ny, nx)

    def close(self) -> None:
        """Nothing is kept open."""

    def _gathered(self, z0: int, z1: int) -> NDArray[Any]:
        nz, ny, nx = self.header.shape
        out = np.empty((z1 - z0, ny, nx), self.header.dtype)
        column = nz * ny * self.stored.itemsize
        step = max(1, BLOCK // column)
        for x0 in range(0, nx, step):
            x1 = min(nx, x0 + step)
            block = np.memmap(
                self.path, self.stored, "r", self.offset + x0 * column, (nz, ny, x1 - x0), order="F"
            )
            out[:, :, x0:x1] = block[z0:z1]
        return out

    def plain(self) -> dict[str, Any]:
        """What the parent needs to read the same voxels itself."""
        return {
            "path": str(self.path),
            "offset": self.offset,
            "stored": self.stored.str,
            "slices_last": self.slices_last,
        }


@dataclass(frozen=True)
class TurnedVoxels:
    """Plain voxels in another order than slices, rows, columns or its reverse.

    Parameters
    ----------
    path, offset, header, stored
        As for :class:`PlainVoxels`.
    order
        The axes, that which runs slowest first: ``yxz``.

    Raises
    ------
    FileError
        If the file is too short for its voxels.
    """

    path: Path
    offset: int
    header: VoxelHeader
    stored: np.dtype[Any]
    order: str

    def __post_init__(self) -> None:
        PlainVoxels(self.path, self.offset, self.header, self.stored)

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1 in the machine's byte order, shape (z1 - z0, ny, nx)."""
        edges = dict(zip("zyx", self.header.shape, strict=True))
        shape = tuple(edges[axis] for axis in self.order)
        stored = np.memmap(self.path, self.stored, "r", self.offset, shape)
        turned = stored.transpose([self.order.index(axis) for axis in "zyx"])
        return np.ascontiguousarray(turned[z0:z1], dtype=self.header.dtype)

    def close(self) -> None:
        """Nothing is kept open."""


def plain_voxels(layout: Mapping[str, Any], shape: Shape, dtype: np.dtype[Any]) -> PlainVoxels:
    """The inverse of :meth:`PlainVoxels.plain`."""
    return PlainVoxels(
        Path(layout["path"]),
        int(layout["offset"]),
        VoxelHeader(shape, dtype),
        np.dtype(str(layout["stored"])),
        bool(layout["slices_last"]),
    )
