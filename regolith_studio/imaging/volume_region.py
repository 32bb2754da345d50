"""A box in a volume, and voxels averaged to larger ones, read slab by slab."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.imaging.bounding_boxes import Box
from regolith_studio.imaging.volume import Origin, VolumeKind
from regolith_studio.imaging.volume_slabs import SLAB_VOXELS, SliceSource


@dataclass(frozen=True, eq=False)
class VolumeRegion:
    """The voxels of a box, or the means of cubes of them; a ``SliceSource`` itself.

    Parameters
    ----------
    source
        The whole volume.
    box
        What of it is used.
    bin
        Edge of the cubes in voxels. Voxels at the far faces of the box that fill no cube are left out.
        Means of integers are rounded, half to even, and keep their type.

    Raises
    ------
    InputError
        If the box has no voxel or reaches beyond the volume, is thinner than one cube, or if labels, which
        have no mean, are to be averaged.
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
