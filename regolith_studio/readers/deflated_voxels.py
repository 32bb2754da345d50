"""Voxels in a compressed stream, which can only be read from its beginning to its end."""

import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.volume_format import VoxelHeader

_CHUNK = 1 << 20
_GZIP_OR_ZLIB = 47
"""Window bits with which zlib finds out by itself which of its two wrappers a stream has."""


class InflatedStream:
    """The bytes of a gzip or zlib stream in a file, a piece at a time.

    Parameters
    ----------
    path, offset
        The file, and where in it the stream begins.
    """

    def __init__(self, path: Path, offset: int = 0) -> None:
        self._file: BinaryIO = path.open("rb")
        self._file.seek(offset)
        self._inflater = zlib.decompressobj(_GZIP_OR_ZLIB)
        self._waiting = b""
        self.place = 0

    def readinto(self, view: memoryview) -> None:
        """Fill the view.

        Raises
        ------
        FileError
            If the stream is broken or ends before.
        """
        while view:
            piece = self._piece(len(view))
            view[: len(piece)] = piece
            view = view[len(piece) :]

    def skip(self, count: int) -> None:
        """Pass over so many bytes."""
        while count:
            count -= len(self._piece(min(count, _CHUNK)))

    def check_end(self) -> None:
        """See that the checksum behind the last byte is right, unless the stream goes on.

        Raises
        ------
        FileError
            If it is wrong or missing.
        """
        if not self._inflater.eof:
            self._piece(1, may_end=True)

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
        """Let go of the file."""
        self._file.close()


@dataclass
class DeflatedVoxels:
    """Slices of a gzip or zlib stream; going back means to begin again.

    Parameters
    ----------
    path, start
        The file, and where in it the stream begins.
    offset
        Bytes of the unpacked stream before the first voxel.
    header
        Shape and type of what is handed over.
    stored
        The type in the file, with its byte order.
    """

    path: Path
    start: int
    offset: int
    header: VoxelHeader
    stored: np.dtype[Any]
    in_order: bool = True
    _stream: InflatedStream | None = field(default=None, init=False)

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1 in the machine's byte order, shape (z1 - z0, ny, nx)."""
        nz, ny, nx = self.header.shape
        place = self.offset + z0 * ny * nx * self.stored.itemsize
        if self._stream is None or self._stream.place > place:
            self.close()
            self._stream = InflatedStream(self.path, self.start)
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
        """Let go of the file."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None
