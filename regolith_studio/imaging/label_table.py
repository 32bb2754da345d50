"""The labels of a volume, found in one pass over its slabs: how large each is, and where.

A second pass, :func:`label_masks` or :func:`grain_crops`, cuts each label out as soon as its last
slab has been seen, so that only labels that lie across two slabs are kept in the meantime.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import cc3d
import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, IntArray
from regolith_studio.imaging.bounding_boxes import Box, box_between
from regolith_studio.imaging.volume_slabs import SliceSource, slab_ranges

MAX_LABEL = 20_000_000
"""Beyond this the table alone would fill the memory."""

_statistics: Any = cc3d.statistics
_Parts = tuple[NDArray[Any], ...]


@dataclass(frozen=True, eq=False)
class LabelTable:
    """Labels in ascending order, their voxels and boxes.

    Parameters
    ----------
    labels, counts
        Shape (n,).
    low, high
        First voxel of the box, and the one after its last, along x, y, z; shape (n, 3).
    """

    labels: IntArray
    counts: IntArray
    low: IntArray
    high: IntArray

    def boxes(self) -> dict[int, Box]:
        """Box of each label."""
        rows = zip(self.labels.tolist(), self.low.tolist(), self.high.tolist(), strict=True)
        return {label: box_between(low, high) for label, low, high in rows}

    def sizes(self) -> dict[int, int]:
        """Voxels of each label."""
        return dict(zip(self.labels.tolist(), self.counts.tolist(), strict=True))


@dataclass(frozen=True, eq=False)
class GrainCrop:
    """What lies in a box about one grain.

    Parameters
    ----------
    own
        The grain's voxels, shape (nx, ny, nz).
    others
        Voxels of other grains, same shape.
    values
        Grey values, same shape.
    """

    own: BoolArray
    others: BoolArray
    values: NDArray[Any]


def label_table(source: SliceSource) -> LabelTable:
    """The labels of a volume; 0 and less is no particle.

    Raises
    ------
    InputError
        If the volume holds grey values, no label, or labels beyond :data:`MAX_LABEL`.
    """
    if source.kind != "labels":
        raise InputError(f"{source.name} holds grey values; segment it before particles can be extracted.")
    found = [
        row
        for first, stop in slab_ranges(source.shape)
        if (row := _table_of(source.read(first, stop), first, source.name)) is not None
    ]
    if not found:
        raise InputError(f"{source.name} holds no particle: every label is 0.")
    labels = np.concatenate([part.labels for part in found])
    highest = int(labels.max()) + 1
    counts = np.zeros(highest, dtype=np.int64)
    low, high = np.full((highest, 3), np.iinfo(np.int64).max), np.zeros((highest, 3), dtype=np.int64)
    for part in found:
        counts[part.labels] += part.counts
        low[part.labels] = np.minimum(low[part.labels], part.low)
        high[part.labels] = np.maximum(high[part.labels], part.high)
    present = np.flatnonzero(counts)
    return LabelTable(present, counts[present], low[present], high[present])


def contact_areas(source: SliceSource) -> dict[tuple[int, int], float]:
    """Area, in faces of a voxel, over which each two labels touch, the lower label first.

    Counts of faces along the three axes are the components of a flat contact's area vector.
    """
    faces: dict[tuple[int, int], IntArray] = {}
    for first, stop in slab_ranges(source.shape):
        slab = source.read(first, min(stop + 1, source.shape[2]))
        for axis in range(3):
            own = slab if axis == 2 else slab[:, :, : stop - first]
            low, high = (own.take(range(k, own.shape[axis] - 1 + k), axis=axis) for k in (0, 1))
            meet = (low != high) & (low > 0) & (high > 0)
            pairs = np.sort(np.stack([low[meet], high[meet]], axis=1).astype(np.int64), axis=1)
            for pair, count in zip(*np.unique(pairs, axis=0, return_counts=True), strict=True):
                faces.setdefault((int(pair[0]), int(pair[1])), np.zeros(3, dtype=np.int64))[axis] += count
    return {pair: float(np.linalg.norm(counts)) for pair, counts in faces.items()}


def label_masks(source: SliceSource, boxes: Mapping[int, Box]) -> Iterator[tuple[int, BoolArray]]:
    """Each label with its mask in its box, in the order in which the slabs complete them."""
    for label, (mask,) in _cuts((source,), boxes, lambda label, parts: (parts[0] == label,)):
        yield label, mask


def grain_crops(
    labels: SliceSource, grey: SliceSource, boxes: Mapping[int, Box]
) -> Iterator[tuple[int, GrainCrop]]:
    """Each label with what lies in its box, in the order in which the slabs complete them.

    Raises
    ------
    ValueError
        If the two volumes have not the same shape.
    """
    if labels.shape != grey.shape:
        raise ValueError(f"labels of shape {labels.shape} do not fit grey values of shape {grey.shape}")
    for label, (own, others, values) in _cuts(
        (labels, grey),
        boxes,
        lambda label, parts: (parts[0] == label, (parts[0] > 0) & (parts[0] != label), parts[1]),
    ):
        yield label, GrainCrop(own, others, values)


def _cuts(
    sources: Sequence[SliceSource], boxes: Mapping[int, Box], taken: Callable[[int, _Parts], _Parts]
) -> Iterator[tuple[int, _Parts]]:
    """What `taken` makes of each box of all sources, put together slab by slab."""
    waiting = sorted(boxes.items(), key=lambda entry: entry[1][2].start)
    begun: dict[int, _Parts] = {}
    for first, stop in slab_ranges(sources[0].shape):
        count = sum(1 for _, box in _until(waiting, stop))
        active, waiting = [*begun, *(label for label, _ in waiting[:count])], waiting[count:]
        if not active:
            continue
        slabs = [source.read(first, stop) for source in sources]
        for label in active:
            x, y, z = boxes[label]
            here = slice(max(z.start, first), min(z.stop, stop))
            parts = taken(label, tuple(s[x, y, here.start - first : here.stop - first] for s in slabs))
            if z.start >= first and z.stop <= stop:
                yield label, tuple(np.ascontiguousarray(part) for part in parts)
                continue
            if label not in begun:
                shape = [side.stop - side.start for side in (x, y, z)]
                begun[label] = tuple(np.zeros(shape, dtype=part.dtype) for part in parts)
            for whole, part in zip(begun[label], parts, strict=True):
                whole[:, :, here.start - z.start : here.stop - z.start] = part
            if z.stop <= stop:
                yield label, begun.pop(label)


def _until(waiting: list[tuple[int, Box]], stop: int) -> Iterator[tuple[int, Box]]:
    """The labels that begin before the slice `stop`."""
    for entry in waiting:
        if entry[1][2].start >= stop:
            return
        yield entry


def _table_of(slab: NDArray[Any], first: int, name: str) -> LabelTable | None:
    highest = int(slab.max())
    if highest > MAX_LABEL:
        raise InputError(f"The labels of {name} go up to {highest}; number them from 1 without gaps.")
    if highest <= 0:
        return None
    seen = _statistics(_unsigned(slab), no_slice_conversion=True)
    counts = np.asarray(seen["voxel_counts"], dtype=np.int64)
    counts[0] = 0
    labels = np.flatnonzero(counts)
    box = np.asarray(seen["bounding_boxes"], dtype=np.int64)[labels]
    shift = np.array([0, 0, first])
    return LabelTable(labels, counts[labels], box[:, 0::2] + shift, box[:, 1::2] + 1 + shift)


def _unsigned(slab: NDArray[Any]) -> NDArray[Any]:
    if slab.dtype.kind == "b":
        return slab.view(np.uint8)
    if slab.dtype.kind == "u":
        return slab
    return np.asarray(np.maximum(slab, 0), dtype=np.uint32)
