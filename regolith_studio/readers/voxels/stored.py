"""Voxels as files store them: uncompressed or deflated, in the file itself or in one beside it."""

import math
import os
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.voxels.header import Shape, VoxelHeader, format_shape

BLOCK = 1 << 25
"""Bytes of a file whose slices are last that are mapped at a time."""


@dataclass(frozen=True)
class PlainVoxels:
    """Slices read straight from their place in the file.

    - ``path``, ``offset``: the file, and the byte that the first voxel begins at.
    - ``header``: shape and type of the voxels in memory.
    - ``stored``: the type in the file, with its byte order.
    - ``slices_last``: whether z is the index that runs fastest (Fortran's order of a [z, y, x] array).

    Raises FileError if the file is too short for its voxels.
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
        """Do nothing: no file is kept open."""

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
class TransposedVoxels:
    """Plain voxels in another order than slices, rows, columns or its reverse.

    ``path``, ``offset``, ``header``, ``stored``: as for :class:`PlainVoxels`. ``order``: the axes, that
    which runs slowest first: ``yxz``.

    Raises FileError if the file is too short for its voxels.
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
        """Do nothing: no file is kept open."""


def exact_voxels(path: Path, offset: int, header: VoxelHeader, stored: np.dtype[Any]) -> PlainVoxels:
    """The voxels of a file that has just as many bytes as they need.

    Raises FileError if it has others: then the shape or the type is not what it is.
    """
    there, needed = path.stat().st_size, offset + math.prod(header.shape) * stored.itemsize
    if there != needed:
        raise FileError(
            f"has {there:,} bytes, but {format_shape(header.shape[::-1])} voxels of {stored.name} after "
            f"{offset:,} bytes of header make {needed:,}."
        )
    return PlainVoxels(path, offset, header, stored)


def plain_voxels(layout: Mapping[str, Any], shape: Shape, dtype: np.dtype[Any]) -> PlainVoxels:
    """The inverse of :meth:`PlainVoxels.plain`."""
    return PlainVoxels(
        Path(layout["path"]),
        int(layout["offset"]),
        VoxelHeader(shape, dtype),
        np.dtype(str(layout["stored"])),
        bool(layout["slices_last"]),
    )


_CHUNK = 1 << 20
_GZIP_OR_ZLIB = 47
"""Window bits with which zlib detects the gzip or zlib wrapper of a stream."""


class InflatedStream:
    """The bytes of a gzip or zlib stream in a file, a piece at a time.

    ``path``, ``offset``: the file, and where in it the stream begins.
    """

    def __init__(self, path: Path, offset: int = 0) -> None:
        self._file: BinaryIO = path.open("rb")
        self._file.seek(offset)
        self._inflater = zlib.decompressobj(_GZIP_OR_ZLIB)
        self._waiting = b""
        self.place = 0

    def readinto(self, view: memoryview) -> None:
        """Fill the view.

        Raises FileError if the stream is broken or ends before.
        """
        while view:
            piece = self._piece(len(view))
            view[: len(piece)] = piece
            view = view[len(piece) :]

    def skip(self, count: int) -> None:
        """Skip so many bytes."""
        while count:
            count -= len(self._piece(min(count, _CHUNK)))

    def check_end(self) -> None:
        """Verify the checksums after the last byte; what follows the voxels is unpacked for that.

        Raises FileError if it is wrong or missing.
        """
        if not self._inflater.eof:
            while self._piece(_CHUNK, may_end=True):
                pass

    def _piece(self, most: int, may_end: bool = False) -> bytes:
        while True:
            if not self._waiting:
                self._waiting = self._file.read(_CHUNK)
            try:
                piece = self._inflater.decompress(self._waiting, most)
            except zlib.error:
                raise FileError(
                    "is damaged: its compressed voxels cannot be unpacked; copy it again."
                ) from None
            ended = not self._waiting
            self._waiting = self._inflater.unconsumed_tail
            if piece:
                self.place += len(piece)
                return piece
            if self._inflater.eof and may_end:
                return b""
            if self._inflater.eof:
                self._next_member()
            elif ended:
                raise FileError("is cut short: its compressed voxels end too early; copy it again.")

    def _next_member(self) -> None:
        """Gzip allows several streams one after the other (as bgzip and pigz write them)."""
        self._waiting = self._inflater.unused_data or self._file.read(_CHUNK)
        if self._waiting[:2] != b"\x1f\x8b":
            raise FileError("is cut short: its compressed voxels end too early; copy it again.")
        self._inflater = zlib.decompressobj(_GZIP_OR_ZLIB)

    def close(self) -> None:
        """Close the file."""
        self._file.close()


@dataclass
class DeflatedVoxels:
    """Slices of a gzip or zlib stream; reading backwards starts again at the beginning.

    - ``path``, ``start``: the file, and where in it the stream begins.
    - ``offset``: bytes of the unpacked stream before the first voxel.
    - ``header``: shape and type of the voxels in memory.
    - ``stored``: the type in the file, with its byte order.
    - ``open_stream``: what unpacks the stream, from the file and the stream's place in it.
    """

    path: Path
    start: int
    offset: int
    header: VoxelHeader
    stored: np.dtype[Any]
    open_stream: Callable[[Path, int], InflatedStream] = InflatedStream
    in_order: bool = True
    _stream: InflatedStream | None = field(default=None, init=False)

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1 in the machine's byte order, shape (z1 - z0, ny, nx)."""
        nz, ny, nx = self.header.shape
        place = self.offset + z0 * ny * nx * self.stored.itemsize
        if self._stream is None or self._stream.place > place:
            self.close()
            self._stream = self.open_stream(self.path, self.start)
        out = np.empty((z1 - z0, ny, nx), self.stored)
        try:
            self._stream.skip(place - self._stream.place)
            self._stream.readinto(out.data.cast("B"))
            if z1 == nz:
                self._stream.check_end()
        except FileError:
            self.close()
            raise
        return out.astype(self.header.dtype, copy=False)

    def close(self) -> None:
        """Close the file."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None


MAX_NAME_LENGTH = 255
"""Bytes of a file's name that file systems allow."""


def beside(path: Path, name: str) -> Path:
    """The file of that name in the folder of `path`.

    Raises FileError if the name leads elsewhere, or there is no such regular file.
    """
    shown = printable(name)[:60]
    if not _is_bare(name):
        raise FileError(f"points to voxels in “{shown}”; only a file in the same folder is read.")
    target = path.parent / name
    if target.is_symlink() and Path(os.path.realpath(target)).parent != Path(os.path.realpath(path.parent)):
        raise FileError(f"points to voxels in “{shown}”, which is a link to another folder.")
    if not target.is_file():
        raise FileError(f"needs the file “{shown}” beside it, which is not there.")
    if target.samefile(path):
        raise FileError("points to itself for its voxels.")
    return target


def _is_bare(name: str) -> bool:
    """Whether this is a plain file name without folders."""
    if not name or name in (".", "..") or "\0" in name or "\\" in name:
        return False
    return len(name.encode("utf-8", "replace")) <= MAX_NAME_LENGTH and Path(name).name == name


def start_before_end(path: Path, header: VoxelHeader, stored: np.dtype[np.generic]) -> int:
    """The byte at which voxels begin that end with their file.

    Raises FileError if the file is shorter than they are.
    """
    start = path.stat().st_size - math.prod(header.shape) * stored.itemsize
    if start < 0:
        raise FileError("is cut short: it holds fewer voxels than its header states.")
    return start
