"""Read volumes of voxels: their header, all voxels, a box, or slab by slab."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError, InputError
from regolith_studio.imaging.volume import Origin, Volume, VolumeKind
from regolith_studio.io.machine_memory import machine_memory
from regolith_studio.readers.error_messages import message_about, printable
from regolith_studio.readers.sandbox.parent import Sandbox
from regolith_studio.readers.volumes.header import (
    RawLayout,
    VolumeHeader,
    VoxelSize,
    guess_kind,
    voxel_size_in_micrometres,
)
from regolith_studio.readers.volumes.slabs import SlabReader, SliceListener, open_slab_reader
from regolith_studio.readers.voxels.header import DatasetEntry, Shape, Sizes

Bounds = tuple[tuple[int, int], tuple[int, int], tuple[int, int]]
"""First voxel and the one after the last, along x, y and z."""

MAX_MEMORY_SHARE = 0.5
"""A volume that takes more of the machine's memory is read in slabs only."""
_SAMPLES, _SAMPLE_BYTES = (0.5, 0.3, 0.7), 32 * 1024**2


@dataclass(frozen=True)
class VolumeFile:
    """A volume of any size, read a few slices at a time; indexed [x, y, z] as `Volume` is.

    Parameters
    ----------
    shape
        Voxels along x, y and z.
    dtype
        Type of a voxel.
    voxel_size
        Edges along x, y and z in micrometres.
    kind
        ``labels`` or ``grey``.
    name
        As the user knows the volume.
    notes
        Sentences that a user should read.
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

        Raises
        ------
        FileError
            If the file is damaged there.
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

    def slabs(self, depth: int, overlap: int = 0) -> Iterator[tuple[int, NDArray[Any]]]:
        """The volume from below: the first slice's index, and up to `depth` + `overlap` slices.

        Each slab begins `depth` slices after the one before; with an overlap it holds the first
        slices of the next one too.
        """
        for z0 in range(0, self.shape[2], depth):
            yield z0, self.read(z0, min(z0 + depth + overlap, self.shape[2]))


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
    sandbox: Sandbox | None = None,
) -> VolumeHeader:
    """Read the header of a volume; at most a few slices are decoded.

    Parameters
    ----------
    path
        A file of one of ``VOLUME_FORMATS``, or a folder of slices.
    dataset
        Which volume of a file that holds several; by default the likeliest.
    axes
        Letters of the array's axes, the slowest first, where an NPY or HDF5 file does not state
        them (default ``zyx``, slices first) or states them wrongly.
    allow_gaps
        Whether slices that are absent from a folder become empty ones, instead of a refusal.
    raw
        Layout of a raw file.
    sandbox
        The child process that parses the file; by default the one of this process for volumes.

    Raises
    ------
    FileError
        With one sentence if the file cannot be read.
    """
    file = open_slab_reader(Path(path), dataset, raw, sandbox, axes, allow_gaps)
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
    sandbox: Sandbox | None = None,
    on_progress: SliceListener | None = None,
) -> Volume:
    """The voxels of a volume, or of a box in it, in memory.

    Parameters
    ----------
    path, dataset, axes, allow_gaps, raw, sandbox
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
    file = open_slab_reader(Path(path), dataset, raw, sandbox, axes, allow_gaps)
    edges = voxel_size_in_micrometres(file.path, (file.header.voxel_size, file.header.unit), voxel_size, unit)
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
    sandbox: Sandbox | None = None,
) -> VolumeFile:
    """A volume that is read slab by slab and so may be larger than the memory.

    Parameters and errors are those of `read_volume`.
    """
    file = open_slab_reader(Path(path), dataset, raw, sandbox, axes, allow_gaps)
    edges = voxel_size_in_micrometres(file.path, (file.header.voxel_size, file.header.unit), voxel_size, unit)
    nz, ny, nx = file.header.shape
    kind = kind or file.header.kind or _guess_kind(file)
    dtype = np.dtype(np.int64) if kind == "labels" and file.header.dtype.kind == "f" else file.header.dtype
    return VolumeFile((nx, ny, nz), dtype, edges, kind, _name_of(file), file.header.notes, file)


@lru_cache(maxsize=4)  # a file is opened for its header, and again for its voxels
def _guess_kind(file: SlabReader) -> VolumeKind:
    """The kind, judged by slices from the middle, or from what comes first where that is quicker."""
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
