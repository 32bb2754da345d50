"""Slices of an array that is packed in chunks many slices deep, each of them unpacked once."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.readers.volume_format import KEPT_BYTES

_BLOCK_BYTES = 1 << 26


class ChunkLayers:
    """Reads a chunked HDF5 dataset slice by slice.

    Chunks that share their slices make a layer. A layer that is asked for in parts stays unpacked until its
    last slice has been handed over, as far as :data:`KEPT_BYTES` go; rows beyond are unpacked each time.

    Parameters
    ----------
    dataset
        An ``h5py.Dataset``.
    axes, channel
        A letter of ``tczyx`` for each axis of the dataset, and the index along c.
    kept_bytes
        How much may stay unpacked.
    """

    def __init__(self, dataset: Any, axes: str, channel: int, kept_bytes: int = KEPT_BYTES) -> None:
        self._dataset, self._axes, self._channel = dataset, axes, channel
        self._depth, self._chunk_rows = self._chunk_edge("z"), self._chunk_edge("y")
        self._kept_bytes = kept_bytes
        self._kept: NDArray[Any] | None = None
        self._first = -1

    @property
    def depth(self) -> int:
        """Slices of a layer, which are best read together; 1 where the array is not in chunks."""
        return self._depth

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx).

        Raises
        ------
        OSError, ValueError, RuntimeError
            Whatever h5py raises about damaged chunks.
        """
        if self._depth == 1:
            return self._unpacked(z0, z1, 0, self._edge("y"))
        out = np.empty((z1 - z0, self._edge("y"), self._edge("x")), self._dataset.dtype)
        for first in range(z0 - z0 % self._depth, z1, self._depth):
            last = min(first + self._depth, self._edge("z"))
            low, high = max(z0, first), min(z1, last)
            self._fill(out[low - z0 : high - z0], first, last, low)
        return out

    def _fill(self, out: NDArray[Any], first: int, last: int, low: int) -> None:
        """Slices from `low` on, all of the layer that goes from `first` to `last`."""
        high, rows = low + len(out), 0
        if self._first == first or len(out) < last - first:
            kept = self._layer(first, last)
            rows = kept.shape[1]
            out[:, :rows] = kept[low - first : high - first]
        for start, stop in self._blocks(rows, self._edge("y"), len(out)):
            out[:, start:stop] = self._unpacked(low, high, start, stop)
        if high == last:
            self._kept, self._first = None, -1

    def _layer(self, first: int, last: int) -> NDArray[Any]:
        """The rows of a layer that are kept, shape (last - first, rows, nx)."""
        if self._kept is None or self._first != first:
            self._kept, self._first = None, -1
            row = (last - first) * self._edge("x") * self._dataset.dtype.itemsize
            rows = self._edge("y")
            if row * rows > self._kept_bytes:
                rows = self._kept_bytes // (row * self._chunk_rows) * self._chunk_rows
            kept = np.empty((last - first, rows, self._edge("x")), self._dataset.dtype)
            for start, stop in self._blocks(0, rows, last - first):
                kept[:, start:stop] = self._unpacked(first, last, start, stop)
            self._kept, self._first = kept, first
        return self._kept

    def _blocks(self, start: int, end: int, depth: int) -> Iterator[tuple[int, int]]:
        """Ranges of whole rows of chunks, so that not much is unpacked at a time."""
        row = depth * self._edge("x") * self._dataset.dtype.itemsize * self._chunk_rows
        step = max(1, _BLOCK_BYTES // row) * self._chunk_rows
        for begin in range(start, end, step):
            yield begin, min(begin + step, end)

    def _unpacked(self, z0: int, z1: int, y0: int, y1: int) -> NDArray[Any]:
        """Some rows of some slices, straight from the file, in the order of slices, rows, columns."""
        every = slice(None)
        picked = {"z": slice(z0, z1), "y": slice(y0, y1), "x": every, "c": self._channel, "t": 0}
        part = self._dataset[tuple(picked[axis] for axis in self._axes)]
        kept = [axis for axis in self._axes if axis in "zyx"]
        if "z" not in kept:
            part, kept = part[np.newaxis], ["z", *kept]
        turned: NDArray[Any] = part.transpose([kept.index(axis) for axis in "zyx"])
        return turned

    def _edge(self, axis: str) -> int:
        return int(self._dataset.shape[self._axes.index(axis)]) if axis in self._axes else 1

    def _chunk_edge(self, axis: str) -> int:
        chunks = self._dataset.chunks
        return int(chunks[self._axes.index(axis)]) if chunks and axis in self._axes else 1
