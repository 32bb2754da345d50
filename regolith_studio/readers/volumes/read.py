"""Read volumes of voxels: their header, all voxels, a box, or slab by slab.

Slabs are read by the sandbox process, or directly where voxels are stored uncompressed.
"""

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError, InputError, os_error_reason
from regolith_studio.imaging.volume import Origin, Volume, VolumeKind
from regolith_studio.io.machine_memory import machine_memory
from regolith_studio.messages import from_json
from regolith_studio.readers.error_messages import message_about, printable
from regolith_studio.readers.sandbox.parent import (
    BASE_SECONDS,
    START_SECONDS,
    WORK_SECONDS,
    checked_size,
    volume_sandbox,
)
from regolith_studio.readers.volumes.files import member_folder, member_names, members_stamp
from regolith_studio.readers.volumes.header import (
    RawLayout,
    VolumeHeader,
    VoxelSize,
    guess_kind,
    voxel_size_in_micrometres,
)
from regolith_studio.readers.voxels.header import MAX_CACHED_BYTES, DatasetEntry, Shape, Sizes, VoxelHeader
from regolith_studio.readers.voxels.slice_series import is_zarr
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

    - ``path``, ``request``: the file, and the arguments of its requests.
    - ``header``: description of the voxels.
    - ``format``: key of the format.
    - ``in_order``, ``layer``: whether the file is best read from its beginning on, and how many slices at a
      time.
    - ``plain``: the voxels themselves, where they lie in the file as they are and need no child.
    """

    path: Path
    request: dict[str, Any] = field(hash=False)
    header: VoxelHeader = field(hash=False)
    format: str
    in_order: bool
    layer: int
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

        Raises FileError if the file is damaged there.
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
        message = volume_sandbox().request_within(
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
    axes: str | None = None,
    allow_gaps: bool = False,
) -> SlabReader:
    """A volume's header, read and checked by the child.

    Raises FileError with one sentence if it is not a volume, is damaged, or holds several and none was
    named.
    """
    reader, path = volume_sandbox(), path.absolute()  # workers may run in other folders
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
        path, request, header, str(answer["format"]), bool(answer["in_order"]), int(answer["layer"]),
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


Bounds = tuple[tuple[int, int], tuple[int, int], tuple[int, int]]
"""First voxel and the one after the last, along x, y and z."""

MAX_MEMORY_SHARE = 0.5
"""A volume that takes more of the machine's memory is read in slabs only."""
_SAMPLES, _SAMPLE_BYTES = (0.5, 0.3, 0.7), 32 * 1024**2


@dataclass(frozen=True)
class VolumeFile:
    """A volume of any size, read a few slices at a time; indexed [x, y, z] as `Volume` is.

    - ``shape``: voxels along x, y and z.
    - ``dtype``: type of a voxel.
    - ``voxel_size``: edges along x, y and z in micrometres.
    - ``kind``: ``labels`` or ``grey``.
    - ``name``: as the user knows the volume.
    - ``notes``: sentences that a user should read.
    """

    shape: Shape
    dtype: np.dtype[Any]
    voxel_size: Sizes
    kind: VolumeKind
    name: str
    notes: tuple[str, ...]
    _file: SlabReader

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1, shape (nx, ny, z1 - z0), in Fortran's order.

        Raises FileError if the file is damaged there.
        """
        if not 0 <= z0 < z1 <= self.shape[2]:
            raise ValueError(f"slices {z0} to {z1} are not within 0 to {self.shape[2]}")
        voxels = self._file.read(z0, z1)
        if self.kind == "labels":
            voxels = _checked_labels(self._file.path, voxels)
        return voxels.T

    def parts(self) -> list[tuple[int, int]]:
        """Ranges of slices that several processes may read, each its own; none of a packed stream."""
        return [] if self.in_order else list(self._file.pieces(0, self.shape[2]))

    @property
    def origin(self) -> Origin:
        """Centre of the first voxel: the origin."""
        return 0.0, 0.0, 0.0

    @property
    def in_order(self) -> bool:
        """Whether the file must be unpacked from its beginning."""
        return self._file.in_order

    def coarser(self, most_voxels: int) -> "VolumeFile | None":
        """The finest level of the same volume with at most so many voxels, if the file has one.

        A level belongs to the same volume if it has fewer voxels along every axis and fills the same space
        within two of its own voxels.
        """
        here = self._file.header
        if here.voxel_size is None:
            return None
        channel = re.search(r"\[\d+\]$", here.dataset or "")
        fitting = [
            level
            for level in here.datasets
            if math.prod(level.shape) <= most_voxels
            and level.name.endswith(channel[0] if channel else "")
            and _is_coarser(level, here.shape[::-1], here.voxel_size)
        ]
        if not fitting:
            return None
        best = max(fitting, key=lambda level: math.prod(level.shape))
        factors = np.array(self.shape) / np.array(best.shape)
        size = (np.array(self.voxel_size) * factors).tolist()
        return open_slabs(self._file.path, dataset=best.name, voxel_size=size, kind=self.kind)

    def mapped(self) -> NDArray[Any] | None:
        """The voxels where they lie in the file, shape (nx, ny, nz), or ``None`` where they are packed."""
        plain = self._file.plain
        if plain is None or plain.slices_last or plain.stored != self.dtype:
            return None
        if self.kind == "labels" and self.dtype.kind != "u":
            return None  # they are checked as they are read
        return np.memmap(plain.path, plain.stored, "r", plain.offset, self.shape[::-1]).T

    def slabs(self, depth: int) -> Iterator[tuple[int, NDArray[Any]]]:
        """The volume from below: the first slice's index, and up to `depth` slices."""
        for z0 in range(0, self.shape[2], depth):
            yield z0, self.read(z0, min(z0 + depth, self.shape[2]))


def _is_coarser(level: DatasetEntry, shape: Shape, voxel_size: Sizes) -> bool:
    """Whether a level is another picture of a volume of `shape` with larger voxels."""
    if level.voxel_size is None or len(level.shape) != 3 or not all(np.less(level.shape, shape)):
        return False
    own = np.array(level.voxel_size)
    return bool((np.abs(own * level.shape - np.array(voxel_size) * shape) <= 2 * own).all())


def describe_volume(
    path: str | Path,
    *,
    dataset: str | None = None,
    axes: str | None = None,
    allow_gaps: bool = False,
    raw: RawLayout | None = None,
) -> VolumeHeader:
    """Read the header of a volume; at most a few slices are decoded.

    - ``path``: a file of one of ``VOLUME_FORMATS``, or a folder of slices.
    - ``dataset``: which volume of a file that holds several; by default the likeliest.
    - ``axes``: letters of the array's axes, the slowest first, where an NPY or HDF5 file does not state them
      (default ``zyx``, slices first) or states them wrongly.
    - ``allow_gaps``: whether slices that are absent from a folder become empty ones, instead of a refusal.
    - ``raw``: layout of a raw file.

    Raises FileError with one sentence if the file cannot be read.
    """
    file = open_slab_reader(Path(path), dataset, raw, axes, allow_gaps)
    header = file.header
    nz, ny, nx = header.shape
    return VolumeHeader(
        path=file.path,
        format=file.format,
        shape=(nx, ny, nz),
        dtype=header.dtype,
        voxel_size=header.voxel_size,
        unit=header.unit,
        kind=header.kind or _guess_kind(file),
        datasets=header.datasets,
        dataset=header.dataset,
        bytes=header.nbytes,
        notes=header.notes,
    )


def read_volume(
    path: str | Path,
    *,
    dataset: str | None = None,
    axes: str | None = None,
    allow_gaps: bool = False,
    voxel_size: VoxelSize | None = None,
    unit: str | None = None,
    kind: VolumeKind | None = None,
    bounds: Bounds | None = None,
    raw: RawLayout | None = None,
    on_progress: SliceListener | None = None,
) -> Volume:
    """The voxels of a volume, or of a box in it, in memory.

    Parameters
    ----------
    path, dataset, axes, allow_gaps, raw
        As for `describe_volume`.
    voxel_size
        One edge, or three along x, y and z, in `unit` (micrometres without one); by default that
        of the file.
    unit
        Unit of `voxel_size`, or of the file's own numbers; ``voxel:SIZE`` gives both.
    kind
        ``labels`` or ``grey``; by default guessed.
    bounds
        The box of voxels to read.
    on_progress
        Called after each slab with the number of slices read and of all; may raise to cancel.

    Raises
    ------
    FileError
        With one sentence if the file cannot be read or is too large for the memory.
    InputError
        If the voxel size is unknown, or the box lies outside the volume.
    """
    file = open_slab_reader(Path(path), dataset, raw, axes, allow_gaps)
    edges = voxel_size_in_micrometres(file.path, file.header, voxel_size, unit)
    box = _checked_bounds(file, bounds)
    _check_memory(file, box)
    kind = kind or file.header.kind or _guess_kind(file)
    array = _read_box(file, box, on_progress)
    if kind == "labels":
        array = _checked_labels(file.path, array)
    (z0, _), (y0, _), (x0, _) = box
    return Volume(array.T, np.array(edges), kind, _name_of(file), (float(x0), float(y0), float(z0)))


def open_slabs(
    path: str | Path,
    *,
    dataset: str | None = None,
    axes: str | None = None,
    allow_gaps: bool = False,
    voxel_size: VoxelSize | None = None,
    unit: str | None = None,
    kind: VolumeKind | None = None,
    raw: RawLayout | None = None,
) -> VolumeFile:
    """A volume that is read slab by slab and so may be larger than the memory.

    Parameters and errors are those of `read_volume`.
    """
    file = open_slab_reader(Path(path), dataset, raw, axes, allow_gaps)
    edges = voxel_size_in_micrometres(file.path, file.header, voxel_size, unit)
    nz, ny, nx = file.header.shape
    kind = kind or file.header.kind or _guess_kind(file)
    dtype = np.dtype(np.int64) if kind == "labels" and file.header.dtype.kind == "f" else file.header.dtype
    return VolumeFile((nx, ny, nz), dtype, edges, kind, _name_of(file), file.header.notes, file)


@lru_cache(maxsize=4)  # a file is opened for its header, and again for its voxels
def _guess_kind(file: SlabReader) -> VolumeKind:
    """The kind, guessed from slices from the middle, or from what comes first where that is quicker."""
    depth, slice_bytes = file.header.shape[0], file.header.slice_bytes
    if file.in_order:
        depth = min(depth, max(1, 4 * _SAMPLE_BYTES // slice_bytes))
    unpacked = slice_bytes * min(file.layer, depth)  # a slice is unpacked with the layer of chunks it lies in
    n_samples = max(1, min(len(_SAMPLES), _SAMPLE_BYTES // unpacked))
    places = sorted({int(share * depth) for share in _SAMPLES[:n_samples]})
    return guess_kind(np.concatenate([file.read(place, place + 1) for place in places]))


def _checked_bounds(file: SlabReader, bounds: Bounds | None) -> Bounds:
    """The box in the order of the file: slices, rows, columns."""
    if bounds is None:
        nz, ny, nx = file.header.shape
        return (0, nz), (0, ny), (0, nx)
    edges = file.header.shape[::-1]
    if len(bounds) != 3 or any(not 0 <= a < b <= n for (a, b), n in zip(bounds, edges, strict=False)):
        raise InputError(f"The box {bounds} does not lie within the {edges} voxels of {file.path.name}.")
    return bounds[2], bounds[1], bounds[0]


def _check_memory(file: SlabReader, box: Bounds) -> None:
    voxels = 1
    for first, last in box:
        voxels *= last - first
    size = voxels * file.header.dtype.itemsize
    limit = machine_memory() * MAX_MEMORY_SHARE
    if size > limit:
        raise FileError(
            message_about(
                file.path,
                f"has {size / 1024**3:.3g} GiB of voxels, more than half of this machine's memory; "
                "choose a part of it, or have it read in slabs.",
            )
        )


def _read_box(file: SlabReader, box: Bounds, on_progress: SliceListener | None) -> NDArray[Any]:
    (z0, z1), (y0, y1), (x0, x1) = box
    out = np.empty((z1 - z0, y1 - y0, x1 - x0), file.header.dtype)
    for start, end in file.pieces(z0, z1):
        out[start - z0 : end - z0] = file.read(start, end)[:, y0:y1, x0:x1]
        if on_progress is not None:
            on_progress(end - z0, z1 - z0)
    return out


def _checked_labels(path: Path, array: NDArray[Any]) -> NDArray[Any]:
    """Labels as whole numbers, none of which is negative."""
    if array.dtype.kind in "if" and array.size and (low := array.min()) < 0:
        raise FileError(
            message_about(
                path, f"holds the label {low:g}; labels are not negative. Read greys as such (--kind grey)."
            )
        )
    if array.dtype.kind != "f":
        return array
    if not np.isfinite(array).all() or (array != np.floor(array)).any():
        raise FileError(message_about(path, "holds numbers with fractions; labels are whole numbers."))
    return array.astype(np.int64)


def _name_of(file: SlabReader) -> str:
    dataset = file.header.dataset
    return printable(f"{file.path.name}/{dataset}" if dataset else file.path.name)
