"""A volume of voxels, as a scanner or a segmentation leaves it; boxes within it; the scans that ship."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, LockedRecord, locked_floats
from regolith_studio.resources import resource

SampleVolume = Literal["labels", "grey"]
SampleScan = Literal["synthetic", "gradient"]
"""The plain scan, and one with a gradient of grey values, cupping and rings that no threshold segments."""

Box = tuple[slice, slice, slice]
"""Voxels along x, y and z; each slice has a start and a stop and no step."""


def box_between(low: Sequence[int], high: Sequence[int]) -> Box:
    """The box ``low <= voxel < high``."""
    x, y, z = (slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    return x, y, z


def box_about(centre: Sequence[int], edge: int, shape: Sequence[int]) -> Box:
    """A cube of `edge` voxels around a voxel, moved to lie inside a volume of this shape, or smaller."""
    size = np.minimum(edge, shape)
    low = np.clip(np.array(centre) - size // 2, 0, np.array(shape) - size)
    return box_between(low.tolist(), (low + size).tolist())


def n_voxels(box: Box) -> int:
    """Voxels in a box."""
    return int(np.prod([side.stop - side.start for side in box]))


def grown(box: Box, margin: int, limits: Box) -> Box:
    """The box with a margin on all sides, but not beyond its limits."""
    low = [max(side.start - margin, limit.start) for side, limit in zip(box, limits, strict=True)]
    high = [min(side.stop + margin, limit.stop) for side, limit in zip(box, limits, strict=True)]
    return box_between(low, high)


def within(box: Box, outer: Box) -> Box:
    """Where a box lies in the array that `outer` cuts out."""
    low = [side.start - frame.start for side, frame in zip(box, outer, strict=True)]
    return box_between(low, [a + side.stop - side.start for a, side in zip(low, box, strict=True)])


def touches(box: Box, shape: tuple[int, int, int]) -> bool:
    """Whether a box reaches the border of a volume."""
    return any(side.start == 0 or side.stop == n for side, n in zip(box, shape, strict=True))


VolumeKind = Literal["labels", "grey"]
Origin = tuple[float, float, float]
"""A place in a volume along x, y and z, in voxels from the centre of the first one."""


@dataclass(frozen=True, eq=False)
class Volume(LockedRecord):
    """Voxels on a rectangular grid.

    The array is not copied, since volumes can fill the memory: the volume holds a read-only view,
    and whoever made the array must leave it alone.

    - ``array``: shape (nx, ny, nz), indexed [x, y, z]; files that keep slices first are transposed where
      they are read. Whole numbers where `kind` is ``labels``, 0 being no particle.
    - ``voxel_size``: edge lengths of a voxel along x, y and z, in micrometres, shape (3,).
    - ``kind``: ``labels`` (each particle its own number) or ``grey``.
    - ``name``: as the user knows the volume.
    - ``origin``: place of the centre of voxel [0, 0, 0] in the whole volume that this is a part of, in
      voxels.

    Raises InputError if the array is not three-dimensional, empty or of a type that `kind` cannot have.
    """

    array: NDArray[Any]
    voxel_size: FloatArray
    kind: VolumeKind
    name: str
    origin: Origin = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        view = np.asanyarray(self.array).view()
        view.flags.writeable = False
        sizes = locked_floats(self.voxel_size, (3,), "voxel_size")
        if not (sizes > 0).all():
            raise InputError(f"The edges of a voxel must be positive, got {sizes.tolist()} µm.")
        if view.ndim != 3 or view.size == 0:
            raise InputError(f"A volume has three dimensions, {self.name} has shape {view.shape}.")
        if self.kind == "labels" and view.dtype.kind not in "uib":
            raise InputError(f"Labels are whole numbers, {self.name} holds {view.dtype} values.")
        if view.dtype.kind not in "uibf":
            raise InputError(f"The voxels of {self.name} are {view.dtype}, not numbers.")
        object.__setattr__(self, "array", view)
        object.__setattr__(self, "voxel_size", sizes)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along x, y and z."""
        nx, ny, nz = self.array.shape
        return nx, ny, nz

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of a voxel."""
        return self.array.dtype

    def read(self, z0: int, z1: int, /) -> NDArray[Any]:
        """The slices ``z0 <= z < z1``, shape (nx, ny, z1 - z0)."""
        return self.array[:, :, z0:z1]

    def parts(self) -> list[tuple[int, int]]:
        """None: the array is that of this process."""
        return []


def sample_file(kind: SampleVolume | Literal["strokes"], scan: SampleScan = "synthetic") -> Path:
    """Path of a shipped scan; ``strokes`` are voxels that were painted on the scan ``gradient``.

    Raises MissingRequirement if the installation lacks its samples.
    """
    return resource("samples", "ct", f"{scan}-{kind}.tif")


def sample_volume(kind: SampleVolume = "labels", scan: SampleScan = "synthetic") -> Volume:
    """A shipped synthetic scan, of 60 grains or of 30: its label volume, or its grey values.

    Only the program's own files are read here; volumes of users go through ``readers``.

    Raises MissingRequirement if the installation lacks its samples.
    """
    import tifffile  # takes longer than the rest of this module, which the window imports

    with tifffile.TiffFile(sample_file(kind, scan)) as file:
        slices: Any = file.asarray()
        metadata = file.imagej_metadata or {}
        pixels, length = file.pages.first.tags["XResolution"].value
    size = (length / pixels, length / pixels, float(metadata["spacing"]))
    return Volume(slices.T, np.array(size), kind, f"sample:ct/{scan}-{kind}")
