"""Pictures of the slices of a volume that may be larger than the memory."""

import math
from collections.abc import Generator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.imaging.volume_slabs import SliceSource

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
