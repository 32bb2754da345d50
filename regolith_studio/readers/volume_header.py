"""What a volume's file says about itself, and how its voxel size becomes micrometres."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.readers.sentences import shown_name
from regolith_studio.readers.units import unit_factor
from regolith_studio.readers.volume_format import DatasetEntry, Kind, Shape, Sizes

VoxelSize = float | Sequence[float]


@dataclass(frozen=True)
class RawLayout:
    """What a raw file does not say about itself.

    Parameters
    ----------
    shape
        Voxels along x, y and z; x runs fastest in the file.
    dtype
        Type of a voxel, ``uint8``, ``int16``, ``float32``, ...
    byte_order
        ``little`` or ``big``.
    offset
        Bytes before the first voxel.

    Raises
    ------
    InputError
        If no voxels can be like that.
    """

    shape: Shape
    dtype: str = "uint8"
    byte_order: str = "little"
    offset: int = 0

    def __post_init__(self) -> None:
        if len(self.shape) != 3 or any(not 0 < int(edge) < 2**31 for edge in self.shape):
            raise InputError(f"A raw volume has three positive edges, got {tuple(self.shape)}.")
        if self.byte_order not in ("little", "big"):
            raise InputError(f"The byte order is little or big, not {self.byte_order}.")
        if self.offset < 0:
            raise InputError(f"The header of a raw file cannot have {self.offset} bytes.")
        try:
            known = np.dtype(self.dtype).kind in "uibf"
        except TypeError:
            known = False
        if not known:
            raise InputError(
                f"There is no voxel type “{self.dtype}”; write for example uint8, uint16 or float32."
            )

    def as_request(self) -> dict[str, Any]:
        """Plain values for the reading child."""
        stored = np.dtype(self.dtype).newbyteorder("<" if self.byte_order == "little" else ">")
        return {"shape": [int(edge) for edge in self.shape], "dtype": stored.str, "offset": int(self.offset)}


@dataclass(frozen=True)
class VolumeHeader:
    """What is known of a volume before it is read.

    Parameters
    ----------
    path
        The file, or the folder of slices.
    format
        Key of the format: ``tiff``, ``slices``, ``npy``, ``raw``, ...
    shape
        Voxels along x, y and z.
    dtype
        Type of a voxel in memory.
    voxel_size
        Edges along x, y and z in `unit`; None where the file does not say.
    unit
        Key of ``readers.units.UNITS``; None where the file does not say.
    kind
        ``labels`` or ``grey``, as guessed from a few slices; the caller may know better.
    datasets, dataset
        The volumes in the file where it can hold several, and the name of this one.
    bytes
        Memory that the whole volume takes.
    notes
        Sentences that a user should read.
    """

    path: Path
    format: str
    shape: Shape
    dtype: np.dtype[Any]
    voxel_size: Sizes | None
    unit: str | None
    kind: Kind
    datasets: tuple[DatasetEntry, ...]
    dataset: str | None
    bytes: int
    notes: tuple[str, ...] = ()

    def micrometres(self, voxel_size: VoxelSize | None = None, unit: str | None = None) -> Sizes:
        """Edges of a voxel along x, y and z in micrometres, as `voxel_size_in_micrometres` says."""
        return voxel_size_in_micrometres(self.path, (self.voxel_size, self.unit), voxel_size, unit)


def voxel_size_in_micrometres(
    path: Path,
    stated: tuple[Sizes | None, str | None],
    voxel_size: VoxelSize | None,
    unit: str | None,
) -> Sizes:
    """Edges of a voxel: those given, else those that the file states.

    Parameters
    ----------
    stated
        Edges and unit of the file, each None where it does not say.
    voxel_size
        One edge or three (x, y, z) in `unit`, or in micrometres without one.
    unit
        With no `voxel_size`: the unit of the file's own numbers, or ``voxel:SIZE``.

    Raises
    ------
    InputError
        If nobody says how large a voxel is, or the size is not positive.
    """
    if voxel_size is None and unit is not None and unit.startswith("voxel"):
        voxel_size, unit = unit_factor(unit), "um"
    if voxel_size is not None:
        given = (voxel_size,) * 3 if isinstance(voxel_size, int | float) else tuple(voxel_size)
        factor = unit_factor(unit or "um")
        edges = [float(edge) * factor for edge in given]
        if len(edges) != 3 or not all(math.isfinite(edge) and edge > 0.0 for edge in edges):
            raise InputError(f"A voxel has one edge or three positive ones, got {voxel_size}.")
        return edges[0], edges[1], edges[2]
    sizes, its_unit = stated
    if sizes is None:
        raise InputError(
            f"{shown_name(path)} does not say how large a voxel is; give the size in micrometres."
        )
    if unit is None and its_unit is None:
        shown = " × ".join(f"{edge:g}" for edge in sizes)
        raise InputError(
            f"{shown_name(path)} says that a voxel is {shown}, but not in which unit; give the unit."
        )
    factor = unit_factor(unit or str(its_unit))
    return sizes[0] * factor, sizes[1] * factor, sizes[2] * factor
