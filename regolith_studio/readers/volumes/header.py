"""Headers of volumes: what a file states, the layout of raw files, voxel sizes, and the kind of voxels."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.readers.error_messages import display_name
from regolith_studio.readers.sandbox.parent import checked_size
from regolith_studio.readers.settings import unit_factor
from regolith_studio.readers.voxels.header import DatasetEntry, Kind, Shape, Sizes, VoxelHeader

VoxelSize = float | Sequence[float]


@dataclass(frozen=True)
class RawLayout:
    """Layout of a raw file, which has no header.

    - ``shape``: voxels along x, y and z; x runs fastest in the file.
    - ``dtype``: type of a voxel, ``uint8``, ``int16``, ``float32``, ...
    - ``byte_order``: ``little`` or ``big``.
    - ``offset``: bytes before the first voxel.

    Raises InputError if no voxels can be like that.
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
    """Description of a volume before it is read.

    - ``path``: the file, or the folder of slices.
    - ``format``: key of the format: ``tiff``, ``slices``, ``npy``, ``raw``, ...
    - ``shape``: voxels along x, y and z.
    - ``dtype``: type of a voxel in memory.
    - ``voxel_size``: edges along x, y and z in `unit`; None where the file does not state it.
    - ``unit``: key of ``readers.settings.UNITS``; None where the file does not state it.
    - ``kind``: ``labels`` or ``grey``, as guessed from a few slices; the caller may know better.
    - ``datasets``, ``dataset``: the volumes in the file where it can hold several, and the name of this one.
    - ``bytes``: memory that the whole volume takes.
    - ``notes``: sentences that a user should read.
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

    def micrometres(self) -> Sizes:
        """Edges of a voxel along x, y and z in micrometres, see `voxel_size_in_micrometres`."""
        return voxel_size_in_micrometres(self.path, self, None, None)


def voxel_size_in_micrometres(
    path: Path,
    header: "VolumeHeader | VoxelHeader",
    voxel_size: VoxelSize | None,
    unit: str | None,
) -> Sizes:
    """Edges of a voxel: those given, else those that the file states.

    - ``header``: of the file, with its edges and unit.
    - ``voxel_size``: one edge or three (x, y, z) in `unit`, or in micrometres without one.
    - ``unit``: with no `voxel_size`: the unit of the file's own numbers, or ``voxel:SIZE``.

    Raises InputError if the voxel size is unknown or not positive.
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
    sizes, its_unit = header.voxel_size, header.unit
    if sizes is None and header.notes:  # they may say that the file states two
        notes = " ".join(header.notes)
        raise InputError(f"Give the size of a voxel of {display_name(path)} in micrometres. {notes}")
    if sizes is None:
        raise InputError(
            f"{display_name(path)} does not state the size of a voxel; give the size in micrometres."
        )
    if unit is None and its_unit is None:
        shown = " × ".join(f"{edge:g}" for edge in sizes)
        raise InputError(f"{display_name(path)} states a voxel of {shown} without a unit; give the unit.")
    factor = unit_factor(unit or str(its_unit))
    return sizes[0] * factor, sizes[1] * factor, sizes[2] * factor


_EDGES = re.compile(r"(?<!\d)(\d{1,6})([x×_])(\d{1,6})\2(\d{1,6})(?!\d)", re.IGNORECASE)
_TYPE = re.compile(
    r"u?int(?:8|16|32|64)|float(?:32|64)|(?<!\d)(?:8|16|32)[-_ ]?bit|[ui](?:8|16|32)|f(?:32|64)",
    re.IGNORECASE,
)
_BIG = re.compile(r"(?<![a-z])(?:be|big(?:[-_ ]?endian)?|msb)(?![a-z])", re.IGNORECASE)
_BY_SIZE = {1: "uint8", 2: "uint16", 4: "float32", 8: "float64"}
_MAX_HEADER = 1 << 16


def layout_from_name(path: Path) -> RawLayout | None:
    """The layout that the file's name states and its size confirms, or None.

    The name must hold the voxels along x, y and z; the type may stand there too, and follows from the
    size otherwise. What the file has more than the voxels, up to 64 KiB, is a header before them.

    Raises FileError if there is no such file.
    """
    size = checked_size(path, largest=None)
    match = _EDGES.search(path.stem)
    if match is None:
        return None
    shape = (int(match[1]), int(match[3]), int(match[4]))
    voxels = math.prod(shape)
    if not voxels:
        return None
    dtype = _type_in(path.stem[: match.start()] + " " + path.stem[match.end() :])
    if dtype is None:
        dtype = _BY_SIZE.get(size // voxels)
    if dtype is None:
        return None
    offset = size - voxels * np.dtype(dtype).itemsize
    if not 0 <= offset <= _MAX_HEADER:
        return None
    return RawLayout(shape, dtype, "big" if _BIG.search(path.stem) else "little", offset)


def _type_in(text: str) -> str | None:
    """The voxel type that a name holds, as numpy calls it."""
    match = _TYPE.search(text)
    if match is None:
        return None
    word = match[0].lower()
    if word.startswith(("uint", "int", "float")):
        return word
    number = re.sub(r"\D", "", word)
    return {"u": "uint", "i": "int", "f": "float"}.get(word[0], "uint") + number


MIN_EQUAL_NEIGHBOURS = 0.7
"""Share of neighbours with the same value, outside the background; noisy greys reach 0.2."""
MAX_PIECES = 3.0
"""Pieces that a label has in a slice, on average; a phase or a mask has one for each grain."""
MAX_CLASSES = 8
"""Classes of a segmentation that numbers all of them, as ilastik's simple one does."""


def guess_kind(slices: NDArray[Any]) -> Kind:
    """``labels`` if each particle seems to have its own number, else ``grey``.

    Labels are whole numbers, constant over wide areas, and each of them is in few
    pieces: a mask or a map of phases has many pieces of one value and is grey (to be split). So is
    a map of few values with no 0, which has a number for what is between the grains, too; of more values
    with no 0, as in a scan without noise, the most frequent one is between the grains. Negative values are
    greys unless most values are 0; if they are labels, reading them is refused.

    ``slices``: a few slices of a volume, shape (k, ny, nx).
    """
    if slices.dtype.kind == "b" or (slices.dtype.kind == "f" and not _whole(slices)):
        return "grey"
    if not slices.any() or (slices.dtype.kind in "if" and slices.min() < 0 and not _mostly_zero(slices)):
        return "grey"
    if slices.all():
        values, counts = np.unique(slices, return_counts=True)
        if len(values) <= MAX_CLASSES:
            return "grey"
        slices = np.where(slices == values[counts.argmax()], slices.dtype.type(0), slices)
    left, right = slices[:, :, :-1], slices[:, :, 1:]
    inside = (left != 0) & (right != 0)
    if not inside.any() or (left == right)[inside].mean() < MIN_EQUAL_NEIGHBOURS:
        return "grey"
    return "labels" if _pieces_a_label(slices) <= MAX_PIECES else "grey"


def _mostly_zero(slices: NDArray[Any]) -> bool:
    return bool(2 * np.count_nonzero(slices) < slices.size)


def _whole(slices: NDArray[Any]) -> bool:
    return bool(np.isfinite(slices).all() and (slices == np.floor(slices)).all())


def _pieces_a_label(slices: NDArray[Any]) -> float:
    """How many pieces a value has in a slice, the mean over voxels."""
    from scipy import ndimage

    pieces = voxels = 0.0
    for each in slices:
        edges = np.zeros(each.shape, dtype=bool)
        edges[1:, 1:] = (each[1:, 1:] != each[:-1, 1:]) | (each[1:, 1:] != each[1:, :-1])
        parts, count = ndimage.label((each != 0) & ~edges)
        if not count:
            continue
        _, places, sizes = np.unique(parts, return_index=True, return_counts=True)
        inside = parts.ravel()[places] > 0
        _, whose = np.unique(each.ravel()[places[inside]], return_inverse=True)
        size_of_value = np.bincount(whose, sizes[inside])
        pieces += float((size_of_value * np.bincount(whose)).sum())
        voxels += float(size_of_value.sum())
    return pieces / voxels if voxels else 0.0
