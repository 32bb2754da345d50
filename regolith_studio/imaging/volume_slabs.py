"""Volumes that are read slab by slab, so that they never have to be in memory whole.

A slab is a run of slices along z. Whatever reads one, a file or an array, is a :class:`SliceSource`;
what is written slab by slab lies in a :class:`ScratchArrays`, in memory or in files that vanish with it.
"""

import math
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from regolith_studio.errors import MissingRequirement
from regolith_studio.imaging.volume import Origin, VolumeKind

ParallelMap = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
"""As the built-in ``map``, lazily and in order; others apply picklable functions in several processes."""
SLAB_VOXELS = 2**24
"""Voxels that are worked on at a time, unless a few slices are more."""
_MIN_SLICES = 8


class SliceSource(Protocol):
    """Anything that gives slices of a volume: a :class:`~regolith_studio.imaging.volume.Volume`, a file.

    `shape` is (nx, ny, nz), `dtype` the type of a voxel, `voxel_size` its edges along x, y, z in
    micrometres, `origin` the place of its first voxel (as in a ``Volume``), and `kind` says ``labels`` or
    ``grey``. ``read(z0, z1)`` gives the slices
    ``z0 <= z < z1``, shape (nx, ny, z1 - z0).
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


def slab_ranges(shape: tuple[int, int, int], voxels: int = SLAB_VOXELS) -> list[tuple[int, int]]:
    """First and last-but-one slice of each slab of about `voxels` voxels, at least eight slices thick."""
    nx, ny, nz = shape
    thickness = max(voxels // (nx * ny), _MIN_SLICES)
    return [(first, min(first + thickness, nz)) for first in range(0, nz, thickness)]


@dataclass(frozen=True, eq=False)
class ThickSlab:
    """A slab with slices more on either side, where there are any.

    Parameters
    ----------
    first, stop
        The slab's first slice and the one after its last.
    values
        Shape (nx, ny, thickness with margins).
    inner
        Where the slab is in `values`, along z.
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
        kept = values[:, :, begin - low :].copy(order="F") if end > begin else None
        yield ThickSlab(first, stop, values, slice(first - low, stop - low))


class ScratchArrays:
    """Arrays for the time of one calculation: in memory, or in files of a temporary folder.

    The folder vanishes when the scratch is closed, is forgotten, or the program ends.

    Parameters
    ----------
    folder
        Where the temporary folder is made; ``None`` keeps everything in memory.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._count = 0
        self._folder, self._clear = None, None
        if folder is not None:
            self._folder = Path(tempfile.mkdtemp(dir=folder, prefix="regolith-"))
            self._clear = weakref.finalize(self, _removed, self._folder)

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

        Raises
        ------
        MissingRequirement
            If the disk has no room for them: a file that outgrows its disk ends the process.
        """
        slices_first = shape[::-1]
        if self._folder is None:
            return np.zeros(slices_first, dtype).T
        needed = math.prod(shape) * np.dtype(dtype).itemsize
        free = shutil.disk_usage(self._folder).free
        if needed > free:
            raise MissingRequirement(
                f"{needed / 2**30:.3g} GiB of temporary files do not fit into {self._folder.parent}, "
                f"which has {free / 2**30:.3g} GiB left."
            )
        self._count += 1
        path = self._folder / f"{self._count}.raw"
        return np.memmap(path, dtype=np.dtype(dtype), mode="w+", shape=slices_first).T

    def close(self) -> None:
        """Remove the files; arrays that are still in use keep what they show where the system allows it."""
        if self._clear is not None:
            self._clear()


def _removed(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
