"""Volumes that are read slab by slab, so that they never have to be in memory whole.

A slab is a run of slices along z. Whatever reads one, a file or an array, is a :class:`SliceSource`;
what is written slab by slab lies in a :class:`ScratchArrays`, in memory or in files that vanish with it.
Tasks for other processes hold a :class:`SharedArray`, the path of such a file, and read their own parts.

:func:`sparse_slices` reads a few slices for a limited time, as a coarse volume that fills the same space;
a :class:`VolumeRegion` is a box in a volume, with voxels averaged to larger ones.
"""

import contextlib
import math
import shutil
import tempfile
import time
import weakref
from collections.abc import Callable, Generator, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.imaging.volume import Box, Origin, Volume, VolumeKind
from regolith_studio.io.checkpoint import Checkpoint

ParallelMap = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
"""As the built-in ``map``, lazily and in order; others apply picklable functions in several processes."""
SLAB_VOXELS = 2**24
"""Voxels that are worked on at a time, unless a few slices are more."""
_MIN_SLICES = 8
BATCH_VOXELS = 2**19
"""Voxels from which on small pieces of work are no longer put together to one task."""
_Item = TypeVar("_Item")
_Done = TypeVar("_Done")


class SliceSource(Protocol):
    """Anything that gives slices of a volume: a :class:`~regolith_studio.imaging.volume.Volume`, a file.

    `shape` is (nx, ny, nz), `dtype` the type of a voxel, `voxel_size` its edges along x, y, z in
    micrometres, `origin` the place of its first voxel (as in a ``Volume``), and `kind` says ``labels`` or
    ``grey``. ``read(z0, z1)`` gives the slices
    ``z0 <= z < z1``, shape (nx, ny, z1 - z0). ``parts()`` are ranges of slices that several processes may
    read, each its own; none where one process must read all in order.
    """

    @property
    def shape(self) -> tuple[int, int, int]: ...

    @property
    def dtype(self) -> np.dtype[Any]: ...

    @property
    def voxel_size(self) -> ArrayLike: ...

    @property
    def origin(self) -> Origin: ...

    @property
    def kind(self) -> VolumeKind: ...

    @property
    def name(self) -> str: ...

    def read(self, z0: int, z1: int, /) -> NDArray[Any]: ...

    def parts(self) -> list[tuple[int, int]]: ...


def slab_ranges(shape: tuple[int, int, int], voxels: int = SLAB_VOXELS) -> list[tuple[int, int]]:
    """First and last-but-one slice of each slab of about `voxels` voxels, at least eight slices thick."""
    nx, ny, nz = shape
    thickness = max(voxels // (nx * ny), _MIN_SLICES)
    return [(first, min(first + thickness, nz)) for first in range(0, nz, thickness)]


@dataclass(frozen=True, eq=False)
class ThickSlab:
    """A slab with slices more on either side, where there are any.

    - ``first``, ``stop``: the slab's first slice and the one after its last.
    - ``values``: shape (nx, ny, thickness with margins).
    - ``inner``: where the slab is in `values`, along z.
    """

    first: int
    stop: int
    values: NDArray[Any]
    inner: slice


def thick_slabs(source: SliceSource, ranges: list[tuple[int, int]], margin: int) -> Iterator[ThickSlab]:
    """The slabs `ranges` of a volume, each with `margin` slices more on either side where there are any.

    Every slice is read once and in order, since a file that is one compressed stream must begin anew to go
    back: what two slabs share is kept from one to the next.
    """
    kept: NDArray[Any] | None = None
    begin = end = max(ranges[0][0] - margin, 0) if ranges else 0
    for first, stop in ranges:
        low, high = max(first - margin, 0), min(stop + margin, source.shape[2])
        parts = [] if kept is None else [kept[:, :, low - begin :]]
        if high > end:
            parts.append(source.read(end, high))
        values = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=2)
        begin, end = max(stop - margin, 0), high
        # A view would hold the whole slab in memory.
        kept = values[:, :, begin - low :].copy(order="F") if end > begin else None
        yield ThickSlab(first, stop, values, slice(first - low, stop - low))


class ScratchArrays:
    """Arrays for the time of one calculation: in memory, or in files of a temporary folder.

    The folder vanishes when the scratch is closed, is forgotten, or the program ends.

    ``folder``: where the temporary folder is made, and after that this folder itself; ``None`` for arrays in
    memory. ``checkpoint``: holds the finished slabs of a probability map, if there is one.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._count = 0
        self.folder: Path | None = None
        self.checkpoint: Checkpoint | None = None
        self._clear = None
        if folder is not None:
            # Workers map the files by these paths, whatever folder they run in.
            self.folder = Path(tempfile.mkdtemp(dir=folder, prefix="regolith-")).absolute()
            self._clear = weakref.finalize(self, _removed, self.folder)

    def __enter__(self) -> "ScratchArrays":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def zeros(self, shape: tuple[int, int, int], dtype: DTypeLike) -> NDArray[Any]:
        """Zeros of shape (nx, ny, nz) whose slices along z are contiguous.

        Raises MissingRequirement if the disk has no room for them: a file that outgrows its disk ends the
        process.
        """
        slices_first = shape[::-1]
        if self.folder is None:
            return np.zeros(slices_first, dtype).T
        needed = math.prod(shape) * np.dtype(dtype).itemsize
        free = shutil.disk_usage(self.folder).free
        if needed > free:
            raise MissingRequirement(
                f"{needed / 2**30:.3g} GiB of temporary files do not fit into {self.folder.parent}, "
                f"which has {free / 2**30:.3g} GiB left."
            )
        self._count += 1
        path = self.folder / f"{self._count}.raw"
        return np.memmap(path, dtype=np.dtype(dtype), mode="w+", shape=slices_first).T

    def drop(self, array: NDArray[Any]) -> None:
        """Remove the file of an array of :meth:`zeros` that is not needed any more."""
        path = Path(str(array.filename)) if isinstance(array, np.memmap) else None
        if path is not None and path.parent == self.folder:
            with contextlib.suppress(PermissionError):  # Windows removes no mapped files; `close` tries again
                path.unlink()

    def close(self) -> None:
        """Remove the files; arrays that are still in use keep what they show where the system allows it."""
        if self._clear is not None:
            self._clear()


def _removed(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)


class SharedArray:
    """An array of :class:`ScratchArrays` that tasks read and write in parts.

    Sent to another process it is the path of its file, which is mapped anew there. What a process writes by
    :meth:`write` is in the file when the call returns; what it writes into a mapped array itself
    others see after :meth:`publish`.

    ``array``: shape (nx, ny, nz), slices contiguous.
    """

    def __init__(self, array: NDArray[Any]) -> None:
        self.array = array

    def __reduce__(self) -> tuple[Callable[..., "SharedArray"], tuple[Any, ...]]:
        if not isinstance(self.array, np.memmap):
            raise TypeError("an array in memory cannot be shared with other processes")
        return _mapped, (str(self.array.filename), self.array.shape, self.array.dtype.str)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along x, y and z."""
        nx, ny, nz = self.array.shape
        return nx, ny, nz

    def slices(self, first: int, stop: int) -> NDArray[Any]:
        """The slices ``first <= z < stop``."""
        return np.asarray(self.array[:, :, first:stop])

    def thick(self, first: int, stop: int, margin: int) -> "ThickSlab":
        """The slices with `margin` more on either side, where there are any."""
        low, high = max(first - margin, 0), min(stop + margin, self.shape[2])
        return ThickSlab(first, stop, self.slices(low, high), slice(first - low, stop - low))

    def write(self, first: int, values: NDArray[Any]) -> None:
        """Replace the slices from `first` on, shape (nx, ny, n)."""
        if not isinstance(self.array, np.memmap):
            self.array[:, :, first : first + values.shape[2]] = values
            return
        nx, ny, _ = self.shape
        with Path(str(self.array.filename)).open("r+b", buffering=0) as file:
            file.seek(first * nx * ny * self.array.itemsize)
            np.ascontiguousarray(values.T, dtype=self.array.dtype).tofile(file)

    def publish(self) -> None:
        """Write to the file what was written into the array, so that other machines find it there."""
        if isinstance(self.array, np.memmap):
            self.array.flush()


def _mapped(name: str, shape: tuple[int, int, int], dtype: str) -> SharedArray:
    return SharedArray(np.memmap(name, np.dtype(dtype), "r", shape=shape[::-1]).T)


def unpacked(
    source: SliceSource, scratch: ScratchArrays, run: ParallelMap = map
) -> Generator[tuple[int, int], None, Volume]:
    """All voxels of a volume in an array of `scratch`; tells how many of how many parts are read.

    ``source``: a :class:`~regolith_studio.imaging.volume.Volume`, which is returned as it is, or what reads
    slices. ``run``: reads the parts; a volume that must be read in order is read by this process.
    """
    if isinstance(source, Volume):
        return source
    array = scratch.zeros(source.shape, source.dtype)
    parts = source.parts()
    apply = run if parts else map
    copied = apply(partial(_copy_slices, source, SharedArray(array)), parts or slab_ranges(source.shape))
    for done, _ in enumerate(copied, start=1):
        yield done, len(parts)
    return Volume(array, np.asarray(source.voxel_size, float), source.kind, source.name, source.origin)


def _copy_slices(source: SliceSource, target: SharedArray, part: tuple[int, int]) -> None:
    first, stop = part
    target.write(first, source.read(first, stop))


def in_batches(
    run: ParallelMap,
    function: Callable[[_Item], _Done],
    items: Iterable[_Item],
    n_voxels: Callable[[_Item], int],
) -> Iterator[_Done]:
    """Apply a function to items in order, several small ones in a task, so that tasks are worth sending.

    ``n_voxels``: size of an item; a task has :data:`BATCH_VOXELS` at least, where there are as many.
    """
    for results in run(partial(_apply_to_each, function), _batches(items, n_voxels)):
        yield from results


def _batches(items: Iterable[_Item], n_voxels: Callable[[_Item], int]) -> Iterator[list[_Item]]:
    batch: list[_Item] = []
    size = 0
    for item in items:
        batch.append(item)
        size += n_voxels(item)
        if size >= BATCH_VOXELS:
            yield batch
            batch, size = [], 0
    if batch:
        yield batch


def _apply_to_each(function: Callable[[_Item], _Done], items: list[_Item]) -> list[_Done]:
    return [function(item) for item in items]


SLICE_BYTES, ALL_BYTES = 2**22, 2**26
"""Bytes of one slice, and of all: larger slices are thinned out, and no more are read."""


def sparse_slices(source: SliceSource, seconds: float, *, in_order: bool = False) -> Volume:
    """The middle slice, and as many others at equal distances as can be read within `seconds`.

    The distance is halved until the time ends or every slice is read; slices of the last, unfinished halving
    are left out. The voxels of the result are longer along z, and wider where slices are thinned out.

    ``in_order``: take the first slices instead, for a file that must be unpacked from its beginning; the
    result then fills only their part of the volume.
    """
    nx, ny, nz = source.shape
    slice_bytes = nx * ny * source.dtype.itemsize
    thin = max(1, math.ceil(math.sqrt(slice_bytes / SLICE_BYTES)))
    most = max(1, ALL_BYTES * thin**2 // slice_bytes)
    runs = _first_places(nz, most) if in_order else _halved_distances(nz, most)
    places, values = _read_while(source, runs, thin, time.monotonic() + seconds)
    size = np.asarray(source.voxel_size, float) * np.array([nx, ny, nz]) / values.shape
    if in_order:
        size[2] = np.asarray(source.voxel_size, float)[2] * places.step
    return Volume(values, size, source.kind, source.name)


def _read_while(
    source: SliceSource, runs: Iterator[range], thin: int, end: float
) -> tuple[range, NDArray[Any]]:
    """The last of the runs of places whose slices could all be read until `end`, at least the first run."""
    read: dict[int, NDArray[Any]] = {}
    places = range(0)
    for run in runs:
        for z in run:
            if places and time.monotonic() > end:
                break
            if z not in read:
                read[z] = source.read(z, z + 1)[::thin, ::thin, 0]
        else:
            places = run
            continue
        break
    return places, np.stack([read[z] for z in places], axis=2)


def _halved_distances(count: int, most: int) -> Iterator[range]:
    """The middle of `count` places, then all at a distance that is halved each time, at most `most`."""
    distance = 1 << max(count - 1, 1).bit_length()
    while distance >= 1 and len(run := range(count // 2 % distance, count, distance)) <= most:
        yield run
        distance //= 2


def _first_places(count: int, most: int) -> Iterator[range]:
    for stop in range(1, min(count, most) + 1):
        yield range(stop)


@dataclass(frozen=True, eq=False)
class VolumeRegion:
    """The voxels of a box, or the means of cubes of them; a ``SliceSource`` itself.

    - ``source``: the whole volume.
    - ``box``: what of it is used.
    - ``bin``: edge of the cubes in voxels. Voxels at the far faces of the box that fill no cube are left
      out. Means of integers are rounded, half to even, and keep their type.

    Raises InputError if the box has no voxel or reaches beyond the volume, is thinner than one cube, or if
    labels, which have no mean, are to be averaged.
    """

    source: SliceSource
    box: Box
    bin: int = 1

    def __post_init__(self) -> None:
        for axis, side, edge in zip("xyz", self.box, self.source.shape, strict=True):
            if not 0 <= side.start < side.stop <= edge:
                raise InputError(
                    f"The region {side.start}:{side.stop} along {axis} does not lie within the {edge} voxels "
                    f"of {self.source.name}."
                )
            if side.stop - side.start < self.bin:
                raise InputError(
                    f"The region of {side.stop - side.start} voxels along {axis} is thinner than {self.bin} "
                    "voxels, which are to become one."
                )
        if self.bin > 1 and self.source.kind == "labels":
            raise InputError(f"{self.source.name} holds labels, which have no mean; leave the binning out.")

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along x, y and z."""
        nx, ny, nz = ((side.stop - side.start) // self.bin for side in self.box)
        return nx, ny, nz

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of a voxel."""
        return self.source.dtype

    @property
    def voxel_size(self) -> FloatArray:
        """Edges of a voxel along x, y and z in micrometres."""
        return np.asarray(self.source.voxel_size, dtype=np.float64) * self.bin

    @property
    def origin(self) -> Origin:
        """Centre of the first voxel, in voxels of this region from the centre of the first whole one."""
        before = zip(self.source.origin, self.box, strict=True)
        x, y, z = ((first + side.start + (self.bin - 1) / 2) / self.bin for first, side in before)
        return x, y, z

    @property
    def kind(self) -> VolumeKind:
        """``labels`` or ``grey``."""
        return self.source.kind

    @property
    def name(self) -> str:
        """As the user knows the volume."""
        return self.source.name

    def read(self, z0: int, z1: int, /) -> NDArray[Any]:
        """The slices ``z0 <= z < z1``, shape (nx, ny, z1 - z0), in Fortran's order."""
        nx, ny, _ = self.shape
        out = np.empty((nx, ny, z1 - z0), self.dtype, order="F")
        whole_nx, whole_ny, _ = self.source.shape
        step = max(1, SLAB_VOXELS // (whole_nx * whole_ny * self.bin))
        for first in range(z0, z1, step):
            stop = min(first + step, z1)
            out[:, :, first - z0 : stop - z0] = self._means(first, stop)
        return out

    def parts(self) -> list[tuple[int, int]]:
        """Ranges of slices that processes may read each by itself: those of the whole volume."""
        start, nz = self.box[2].start, self.shape[2]
        ends = [-((start - stop) // self.bin) for _, stop in self.source.parts()]
        inner = sorted({end for end in ends if 0 < end < nz})
        return list(pairwise([0, *inner, nz])) if ends else []

    def _means(self, z0: int, z1: int) -> NDArray[Any]:
        """The slices from one slab of the whole volume."""
        (x, y, z), (nx, ny, _) = self.box, self.shape
        slab = self.source.read(z.start + z0 * self.bin, z.start + z1 * self.bin)
        slab = slab[x.start : x.start + nx * self.bin, y.start : y.start + ny * self.bin]
        if self.bin == 1:
            return slab
        with np.errstate(invalid="ignore", over="ignore"):  # infinities, whose mean is not finite
            total = slab
            for axis in (2, 1, 0):
                parts = np.moveaxis(total, axis, 0)
                sums = parts[:: self.bin].astype(np.float64)  # exact for integers up to 2^53
                for k in range(1, self.bin):
                    sums += parts[k :: self.bin]
                total = np.moveaxis(sums, 0, axis)
            mean = total / self.bin**3
        return (mean if self.dtype.kind == "f" else np.rint(mean)).astype(self.dtype)


COARSE_BYTES = 2**28
"""Of the copy with fewer voxels; 512^3 voxels of 16 bits."""


@dataclass(frozen=True, eq=False)
class SliceImages:
    """Slices in the three directions.

    In a file whose slices along z follow each other, a slice along x is scattered over every page: it is
    taken from a copy of every `step`-th voxel instead.

    - ``array``: the voxels, shape (nx, ny, nz), in memory or mapped from a file.
    - ``coarse``: every `step`-th voxel along each axis, in memory; ``None`` where `array` is in memory
      itself.
    - ``step``: 1 where there is no copy.
    """

    array: NDArray[Any]
    coarse: NDArray[Any] | None = None
    step: int = 1

    def picture(self, axis: int, number: int) -> NDArray[Any]:
        """The slice `number` along `axis`; along x one of every `step`-th voxel."""
        if axis == 0 and self.coarse is not None:
            return np.asarray(self.coarse[min(number // self.step, len(self.coarse) - 1)])
        return np.array(np.moveaxis(self.array, axis, 0)[number])  # take would copy all the volume first

    @property
    def sample(self) -> NDArray[Any]:
        """Voxels from all over the volume, in memory."""
        return self.array if self.coarse is None else self.coarse


def coarse_copy(source: SliceSource) -> Generator[tuple[int, int], None, tuple[NDArray[Any], int]]:
    """Every n-th voxel of a volume and n, read slice by slice; tells how many are done, of how many."""
    nx, ny, nz = source.shape
    step = max(1, math.ceil((nx * ny * nz * source.dtype.itemsize / COARSE_BYTES) ** (1 / 3)))
    places = range(0, nz, step)
    copy = np.empty((len(places), -(-ny // step), -(-nx // step)), source.dtype)
    for at, z in enumerate(places):
        copy[at] = source.read(z, z + 1)[::step, ::step, 0].T
        yield at + 1, len(places)
    return copy.T, step
