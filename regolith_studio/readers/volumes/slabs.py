"""Slabs of a volume, read by the sandbox process, or directly where voxels are stored uncompressed."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError, os_error_reason
from regolith_studio.messages import from_json
from regolith_studio.readers.error_messages import message_about
from regolith_studio.readers.sandbox.parent import (
    BASE_SECONDS,
    START_SECONDS,
    WORK_SECONDS,
    Sandbox,
    checked_size,
    volume_sandbox,
)
from regolith_studio.readers.volumes.files import member_folder, member_names, members_stamp
from regolith_studio.readers.volumes.header import RawLayout
from regolith_studio.readers.voxels.folders import is_zarr
from regolith_studio.readers.voxels.header import MAX_CACHED_BYTES, DatasetEntry, VoxelHeader
from regolith_studio.readers.voxels.stored import PlainVoxels, plain_voxels

SLAB_BYTES = 64 * 1024**2
"""Bytes that the child returns at a time, or one slice where that has more."""
MAX_LAYER_BYTES = 256 * 1024**2
"""Bytes that may be returned at once where a chunk of the file spans so many slices."""
BYTES_OPENED_A_SECOND, BYTES_READ_A_SECOND, BYTES_SKIPPED_A_SECOND = 5e6, 1e7, 3e7
SECONDS_A_SLICE = 2e-3
VOXELS_READ_A_SECOND = 8e6
"""Of text, which is the slowest; added to the time for the bytes."""
MAX_DEFLATE_RATIO = 1032
"""Bytes that a packed byte can stand for; what unpacks to more is no work, since it is empty."""
WALL_TIME_FACTOR = 6.0
"""Ratio of wall time to processor time that a task may reach on a busy machine."""
MIN_MEMORY = 512 * 1024**2

SliceListener = Callable[[int, int], None]
"""Called with the number of slices read and the number of all."""


@dataclass(frozen=True)
class SlabReader:
    """A volume whose header has been read, slices first; nothing of it is in memory.

    Parameters
    ----------
    path, request
        The file, and the arguments of its requests.
    header
        Description of the voxels.
    format
        Key of the format.
    in_order, layer
        Whether the file is best read from its beginning on, and how many slices at a time.
    sandbox
        The sandbox that reads it; by default that for volumes of the current process, so that a reader can be
        sent to the workers of a pool.
    plain
        The voxels themselves, where they lie in the file as they are and need no child.
    """

    path: Path
    request: dict[str, Any] = field(hash=False)
    header: VoxelHeader = field(hash=False)
    format: str
    in_order: bool
    layer: int
    sandbox: Sandbox | None = None
    plain: PlainVoxels | None = field(default=None, hash=False)

    def pieces(self, z0: int, z1: int) -> Iterator[tuple[int, int]]:
        """Ranges of slices that make at most `SLAB_BYTES` bytes each, ending where layers of chunks do."""
        layer, slice_bytes = self.layer, self.header.slice_bytes
        step = max(1, SLAB_BYTES // slice_bytes)
        if 1 < layer <= MAX_LAYER_BYTES // slice_bytes:
            step = max(layer, step - step % layer)
        start = z0
        while start < z1:
            of_layer = start % layer
            end = min(z1, start - of_layer + step if layer <= step else start + min(step, layer - of_layer))
            yield start, end
            start = end

    def _layer_bytes(self, z0: int, z1: int) -> int:
        """Bytes of the layers of chunks, if there are any, that must be unpacked for some of their slices."""
        if self.layer == 1:
            return 0
        first, last = z0 // self.layer * self.layer, -(-z1 // self.layer) * self.layer
        return (min(last, self.header.shape[0]) - first) * self.header.slice_bytes

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (z1 - z0, ny, nx).

        Raises
        ------
        FileError
            If the file is damaged there.
        """
        out = np.empty((z1 - z0, *self.header.shape[1:]), self.header.dtype)
        for start, end in self.pieces(z0, z1):
            out[start - z0 : end - z0] = self._piece(start, end)
        return out

    def _piece(self, z0: int, z1: int) -> NDArray[Any]:
        if self.plain is not None:
            try:
                return self.plain.read(z0, z1)
            except (OSError, FileError) as error:
                reason = (
                    str(error)
                    if isinstance(error, FileError)
                    else f"cannot be read: {os_error_reason(error)}."
                )
                raise FileError(message_about(self.path, reason)) from None
        size = (z1 - z0) * self.header.slice_bytes
        work = WORK_SECONDS + size / BYTES_READ_A_SECOND + (z1 - z0) * SECONDS_A_SLICE
        work += size / self.header.dtype.itemsize / VOXELS_READ_A_SECOND
        if self.in_order:
            work += z0 * self.header.slice_bytes / BYTES_SKIPPED_A_SECOND
        layers = self._layer_bytes(z0, z1)
        file_bytes: int = self.request["stamp"][0]
        work += min(layers, file_bytes * MAX_DEFLATE_RATIO) / BYTES_SKIPPED_A_SECOND
        request = {**self.request, "memory": MIN_MEMORY + 6 * size + min(layers, MAX_CACHED_BYTES)}
        message = (self.sandbox or volume_sandbox()).request_within(
            "volume-slices",
            self.path,
            max(BASE_SECONDS, WALL_TIME_FACTOR * work),
            work,
            z0=z0,
            z1=z1,
            **request,
        )
        voxels = message.arrays[0]
        if voxels.shape != (z1 - z0, *self.header.shape[1:]) or voxels.dtype != self.header.dtype:
            raise FileError(message_about(self.path, "changed while it was read."))
        return voxels


def open_slab_reader(
    path: Path,
    dataset: str | None = None,
    raw: RawLayout | None = None,
    sandbox: Sandbox | None = None,
    axes: str | None = None,
    allow_gaps: bool = False,
) -> SlabReader:
    """A volume's header, read and checked by the child.

    Raises
    ------
    FileError
        With one sentence if it is not a volume, is damaged, or holds several and none was named.
    """
    reader, path = sandbox or volume_sandbox(), path.absolute()  # workers may run in other folders
    if not path.is_dir():
        checked_size(path, largest=None)
    names = member_names(path)
    if path.is_dir() or names:
        size, stamp = members_stamp(member_folder(path), names)
    else:
        size = checked_size(path, largest=None)
        stamp = [size, path.stat().st_mtime_ns]
    request = {
        "stamp": stamp,
        "dataset": dataset,
        "raw": None if raw is None else raw.as_request(),
        "names": [] if path.is_dir() and is_zarr(path) else list(names),
        "axes": axes,
        "allow_gaps": allow_gaps,
    }
    reader.request_within("volume-prepare", path, START_SECONDS)
    work = WORK_SECONDS + size / BYTES_OPENED_A_SECOND
    answer = reader.request_within(
        "volume-open", path, max(BASE_SECONDS, WALL_TIME_FACTOR * work), work, memory=MIN_MEMORY, **request
    ).header
    header = _header_from(answer)
    plain = answer["plain"] and plain_voxels(answer["plain"], header.shape, header.dtype)
    return SlabReader(
        path, request, header, str(answer["format"]), bool(answer["in_order"]), int(answer["layer"]), sandbox,
        plain or None,
    )  # fmt: skip


def _dataset_from(values: list[Any]) -> DatasetEntry:
    name, shape, dtype, size = values
    edges = None if size is None else (float(size[0]), float(size[1]), float(size[2]))
    return DatasetEntry(name, tuple(shape), dtype, edges)


def _header_from(answer: dict[str, Any]) -> VoxelHeader:
    """The header that the child has sent as plain values."""
    nz, ny, nx = answer["shape"]
    size = answer["voxel_size"]
    return VoxelHeader(
        shape=(int(nz), int(ny), int(nx)),
        dtype=np.dtype(str(answer["dtype"])).newbyteorder("="),
        voxel_size=None if size is None else (float(size[0]), float(size[1]), float(size[2])),
        unit=answer["unit"],
        kind=answer["kind"],
        notes=tuple(map(from_json, answer["notes"])),
        datasets=tuple(map(_dataset_from, answer["datasets"])),
        dataset=answer["dataset"],
    )
