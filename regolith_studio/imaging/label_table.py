"""The labels of a volume, found in one pass over its slabs: how large each is, where, and what it touches.

A :class:`ScanCircle` is the part of the slices that a scanner sees; it counts the places of a grain in it.
"""

from dataclasses import dataclass
from functools import partial
from typing import Any

import cc3d
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.imaging.volume import Box, Volume, box_between
from regolith_studio.imaging.volume_slabs import ParallelMap, SharedArray, slab_ranges

MAX_LABEL = 20_000_000
"""Beyond this the table alone would fill the memory."""

_statistics: Any = cc3d.statistics


@dataclass(frozen=True, eq=False)
class LabelTable:
    """Labels in ascending order, their voxels and boxes.

    ``labels``, ``counts``: shape (n,). ``low``, ``high``: first voxel of the box, and the one after its
    last, along x, y, z; shape (n, 3).
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

    - ``own``: the grain's voxels, shape (nx, ny, nz).
    - ``others``: voxels of other grains, same shape.
    - ``values``: grey values, same shape; the median of the background where a label below 0 says that there
      are none.
    """

    own: BoolArray
    others: BoolArray
    values: NDArray[Any]


def grain_crop(labels: SharedArray, grey: SharedArray, label: int, box: Box) -> GrainCrop:
    """What lies in a box about one grain."""
    here = np.asarray(labels.array[box])
    own, values = here == label, np.ascontiguousarray(grey.array[box])
    if (here < 0).any() and (here == 0).any():
        values = np.where(here < 0, np.median(values[here == 0]).astype(values.dtype), values)
    return GrainCrop(own, (here > 0) & ~own, values)


def label_table(source: Volume, run: ParallelMap = map) -> LabelTable:
    """The labels of a volume; 0 and less is no particle.

    ``run``: applies what is done to slabs.

    Raises InputError if the volume holds grey values, no label, or labels beyond :data:`MAX_LABEL`.
    """
    if source.kind != "labels":
        raise InputError(f"{source.name} holds grey values; segment it before particles can be extracted.")
    table_of = partial(_table_of, SharedArray(source.array), source.name)
    rows = [row for row in run(table_of, slab_ranges(source.shape)) if row is not None]
    if not rows:
        raise InputError(f"{source.name} holds no particle: every label is 0.")
    labels = np.concatenate([part.labels for part in rows])
    highest = int(labels.max()) + 1
    counts = np.zeros(highest, dtype=np.int64)
    low, high = np.full((highest, 3), np.iinfo(np.int64).max), np.zeros((highest, 3), dtype=np.int64)
    for part in rows:
        counts[part.labels] += part.counts
        low[part.labels] = np.minimum(low[part.labels], part.low)
        high[part.labels] = np.maximum(high[part.labels], part.high)
    present = np.flatnonzero(counts)
    return LabelTable(present, counts[present], low[present], high[present])


def voxel_inside(labels: NDArray[Any], label: int, box: Box) -> tuple[int, int, int]:
    """The voxel of a label in its box that is nearest to its centre."""
    places = np.argwhere(np.asarray(labels[box]) == label)
    nearest = places[np.linalg.norm(places - places.mean(axis=0), axis=1).argmin()]
    x, y, z = (int(at) + side.start for at, side in zip(nearest, box, strict=True))
    return x, y, z


def find_padding(source: Volume, run: ParallelMap = map) -> tuple[set[int], BoolArray]:
    """Labels that touch voxels of a label below 0, and columns of voxels along z most of which have one.

    Such a label marks what lies outside of a scanner's circle.
    """
    beside: set[int] = set()
    counts = np.zeros(source.shape[:2], dtype=np.int64)
    if source.dtype.kind == "i":
        find = partial(_padding_in_slab, SharedArray(source.array))
        for labels, padding in run(find, slab_ranges(source.shape)):
            beside |= labels
            counts += padding
    return beside, 2 * counts > source.shape[2]


def _padding_in_slab(labels: SharedArray, part: tuple[int, int]) -> tuple[set[int], IntArray]:
    first, stop = part
    # One slice more, for the faces between this slab and the next.
    slab = labels.slices(first, stop + 1)
    counts = (slab[:, :, : stop - first] < 0).sum(axis=2)
    beside: set[int] = set()
    if (slab < 0).any():
        for axis in range(3):
            low, high = (slab.take(range(k, slab.shape[axis] - 1 + k), axis=axis) for k in (0, 1))
            for one, other in ((low, high), (high, low)):
                beside.update(np.unique(one[(one > 0) & (other < 0)]).tolist())
    return beside, counts


def contact_areas(source: Volume, run: ParallelMap = map) -> dict[tuple[int, int], float]:
    """Area, in faces of a voxel, over which each two labels touch, the lower label first.

    Counts of faces along the three axes are the components of a flat contact's area vector.
    """
    faces: dict[tuple[int, int], IntArray] = {}
    for contacts in run(partial(_faces_in_slab, SharedArray(source.array)), slab_ranges(source.shape)):
        for pair, counts in contacts.items():
            faces[pair] = faces.get(pair, 0) + counts
    return {pair: float(np.linalg.norm(counts)) for pair, counts in faces.items()}


def _faces_in_slab(labels: SharedArray, part: tuple[int, int]) -> dict[tuple[int, int], IntArray]:
    """Faces along the three axes between each two labels, of voxels in a slab and those above it."""
    first, stop = part
    slab = labels.slices(first, stop + 1)
    faces: dict[tuple[int, int], IntArray] = {}
    for axis in range(3):
        own = slab if axis == 2 else slab[:, :, : stop - first]
        low, high = (own.take(range(k, own.shape[axis] - 1 + k), axis=axis) for k in (0, 1))
        meet = (low != high) & (low > 0) & (high > 0)
        pairs = np.sort(np.stack([low[meet], high[meet]], axis=1).astype(np.int64), axis=1)
        for pair, count in zip(*np.unique(pairs, axis=0, return_counts=True), strict=True):
            faces.setdefault((int(pair[0]), int(pair[1])), np.zeros(3, dtype=np.int64))[axis] += count
    return faces


def _table_of(source: SharedArray, name: str, part: tuple[int, int]) -> LabelTable | None:
    slab, first = source.slices(*part), part[0]
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
    # cc3d refuses labels below 0, which mark what lies outside.
    return np.asarray(np.maximum(slab, 0), dtype=np.uint32)


_PLACES = 256
"""Places along an edge at which the shares of areas are taken."""


@dataclass(frozen=True, eq=False)
class ScanCircle:
    """The convex hull of the pixels that a scanner sees, by its half-planes ``normals @ p <= offsets``.

    ``normals``, ``offsets``: shapes (n, 2) and (n,), in pixels. ``places``: points spread evenly over the
    hull, shape (m, 2).
    """

    normals: FloatArray
    offsets: FloatArray
    places: FloatArray

    @classmethod
    def of(cls, seen: BoolArray) -> "ScanCircle":
        """The circle of the pixels that are seen, shape (nx, ny)."""
        hull = ConvexHull(_corners(seen, 0.5))
        low, high = hull.min_bound, hull.max_bound
        steps = (np.arange(_PLACES) + 0.5) / _PLACES
        x, y = (low[k] + steps * (high[k] - low[k]) for k in (0, 1))
        grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        normals, offsets = hull.equations[:, :2], -hull.equations[:, 2]
        return cls(normals, offsets, grid[(grid @ normals.T <= offsets).all(axis=1)])

    def share_inside(self, footprint: BoolArray) -> float:
        """Of the places of a grain in the circle, the share where it keeps clear of the edge.

        The grain lies clear of the edge if it does in each half-plane, moved inwards by its extent along the
        normal: the erosion of the circle, of area pi R^2 - R P + A for a convex grain of perimeter P and area
        A (Miles 1974).

        ``footprint``: pixels that have a voxel of the grain, shape (bx, by).
        """
        # Half a pixel of the grain and half of the free one beside it: b pixels then need b + 1, as in
        # border_weight.
        points = _corners(footprint, 1.0) - (np.array(footprint.shape) - 1.0) / 2.0
        extent = (points @ self.normals.T).max(axis=0)
        clear = (self.places @ self.normals.T <= self.offsets - extent).all(axis=1)
        # No finer than the places tell: a grain that fits nowhere would have an infinite weight.
        return max(float(clear.mean()), 1.0 / len(self.places))


def _corners(pixels: BoolArray, reach: float) -> FloatArray:
    """Corners of squares of half edge `reach` about the first and last pixel of each row, shape (n, 2)."""
    rows = np.flatnonzero(pixels.any(axis=1))
    first = pixels[rows].argmax(axis=1)
    last = pixels.shape[1] - 1 - pixels[rows, ::-1].argmax(axis=1)
    centres = np.concatenate([np.stack([rows, first], axis=1), np.stack([rows, last], axis=1)])
    signs = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    return np.asarray((centres[:, None] + reach * signs).reshape(-1, 2), dtype=np.float64)
