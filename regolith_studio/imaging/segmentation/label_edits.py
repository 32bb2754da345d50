"""Corrections of labels by hand: merge, delete, split, fill and paint grains, in the order they were made.

Edits name grains by voxels in them, not by numbers, so that a list of edits means the same on the labels that
the same settings give again.
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.segmentation import watershed

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.imaging.label_table import label_table
from regolith_studio.imaging.segmentation.splitting import distance_map
from regolith_studio.imaging.volume import Box, Volume, box_between

EditKind = Literal["merge", "delete", "seeds", "cut", "fill", "paint", "erase"]
EDIT_KINDS: tuple[EditKind, ...] = get_args(EditKind)
_MIN_POINTS: dict[EditKind, int] = {"merge": 2, "seeds": 2, "cut": 2}
_IN_SLICES, _BRUSHED = ("cut", "fill"), ("paint", "erase")
MAX_RADIUS = 100.0
Voxel = tuple[int, int, int]
_watershed: Any = watershed


@dataclass(frozen=True)
class LabelEdit:
    """One correction.

    - ``kind``: ``merge`` gives all grains at the points the label of the first; ``delete`` removes those at
      the points; ``seeds`` splits the grain that holds all points into one a point, by a watershed of the
      distance to its surface; ``cut`` splits the grain that the line between two points crosses longest, by
      the plane through the line and along `axis`; ``fill`` gives the grains at the points the free voxels
      that they enclose in a slice across `axis`; ``paint`` gives all voxels within `radius` of the line
      through the points the label at its first point, or a new one where no grain is there; ``erase`` frees
      them.
    - ``points``: voxels along x, y, z.
    - ``axis``: direction across the slice that was looked at.
    - ``radius``: of a brush, in voxels.

    Raises InputError if the kind is another, there are too few points, or the radius is out of its range.
    """

    kind: EditKind
    points: tuple[Voxel, ...]
    axis: int = 2
    radius: float = 0.5

    def __post_init__(self) -> None:
        if self.kind not in EDIT_KINDS:
            raise InputError(f"An edit of labels is one of {', '.join(EDIT_KINDS)}, not {self.kind!r}.")
        least = _MIN_POINTS.get(self.kind, 1)
        if len(set(self.points)) < least or (self.kind == "cut" and len(self.points) != 2):
            raise InputError(f"The edit {self.kind!r} of labels needs {least} different voxels.")
        if self.axis not in (0, 1, 2):
            raise InputError(f"The axis of an edit is 0, 1 or 2, got {self.axis!r}.")
        if not 0.5 <= self.radius <= MAX_RADIUS:
            raise InputError(f"The radius of a brush is 0.5 to {MAX_RADIUS:g} voxels, got {self.radius!r}.")


def apply_edits(
    numbers: NDArray[np.int32], edits: Sequence[LabelEdit], edges: FloatArray
) -> Generator[tuple[int, int], None, None]:
    """Change labels in place, one edit after the other; tells how many are done, of how many.

    The first part of a split grain keeps its label, further ones get new labels above the highest; labels of
    grains that are merged or deleted are left out.

    ``numbers``: labels, 0 between grains, shape (nx, ny, nz). ``edges``: of a voxel along x, y and z, in any
    unit, shape (3,).

    Raises InputError if an edit does not find its grains: it was made on another scan or with other
    settings.
    """
    if not edits:
        return
    boxes = label_table(Volume(numbers, edges, "labels", "the segmentation")).boxes()
    editor = _LabelEditor(numbers, edges, boxes)
    for number, edit in enumerate(edits, start=1):
        try:
            editor.apply(edit)
        except InputError as error:
            raise InputError(f"Edit {number} of the labels ({edit.kind}) cannot be made: {error}") from None
        yield number, len(edits)


class _LabelEditor:
    """Labels with a box about each, which may be wider than the grain."""

    def __init__(self, numbers: NDArray[np.int32], edges: FloatArray, boxes: dict[int, Box]) -> None:
        self._numbers, self._edges, self._boxes = numbers, edges, boxes
        self._highest = max(boxes)

    def apply(self, edit: LabelEdit) -> None:
        match edit.kind:
            case "merge":
                self._merge([self._label_at(point) for point in edit.points])
            case "delete":
                for label in {self._label_at(point) for point in edit.points}:
                    self._relabel(label, 0)
            case "seeds":
                self._split_by_seeds(edit.points)
            case "cut":
                self._cut(edit)
            case "fill":
                self._fill({self._label_at(point) for point in edit.points}, edit.axis)
            case "paint" | "erase":
                self._paint(edit)

    def _label_at(self, point: Voxel) -> int:
        if not all(0 <= at < n for at, n in zip(point, self._numbers.shape, strict=True)):
            raise InputError(f"voxel {point} lies outside of the volume.")
        label = int(self._numbers[point])
        if label <= 0:
            raise InputError(
                f"there is no grain at voxel {point}; use the scan and the settings that it was made with."
            )
        return label

    def _merge(self, labels: list[int]) -> None:
        first, *others = dict.fromkeys(labels)
        if not others:
            raise InputError("all its voxels lie in one grain.")
        for label in others:
            own, other = self._boxes[first], self._boxes[label]
            self._relabel(label, first)
            self._boxes[first] = _about_both(own, other)

    def _relabel(self, label: int, new: int) -> None:
        region = self._numbers[self._boxes.pop(label)]
        region[region == label] = new

    def _split_by_seeds(self, points: Sequence[Voxel]) -> None:
        labels = {self._label_at(point) for point in points}
        if len(labels) > 1:
            raise InputError("its voxels lie in different grains.")
        (label,) = labels
        box = self._boxes[label]
        own = np.ascontiguousarray(self._numbers[box] == label)
        seeds = np.zeros(own.shape, dtype=np.int32)
        for number, point in enumerate(dict.fromkeys(points), start=1):
            seeds[tuple(at - side.start for at, side in zip(point, box, strict=True))] = number
        parts = _watershed(-distance_map(own, self._edges), seeds, mask=own)
        self._write_parts(label, [parts == number for number in range(2, int(seeds.max()) + 1)])

    def _cut(self, edit: LabelEdit) -> None:
        start, end = (np.array(point, dtype=np.float64) for point in edit.points)
        label = self._crossed(start, end)
        across, down = (axis for axis in range(3) if axis != edit.axis)
        box = self._boxes[label]
        x, y = np.ogrid[box[across], box[down]]
        side = (end[across] - start[across]) * (y - start[down]) - (end[down] - start[down]) * (
            x - start[across]
        )
        beyond = np.expand_dims(side > 0, edit.axis) & (self._numbers[box] == label)
        rest = (self._numbers[box] == label) & ~beyond
        if not beyond.any() or not rest.any():
            raise InputError("the line does not divide the grain.")
        self._write_parts(label, [beyond])

    def _crossed(self, start: FloatArray, end: FloatArray) -> int:
        """The label that a line crosses over the greatest length."""
        count = 2 * int(np.abs(end - start).max()) + 1
        places = np.rint(np.linspace(start, end, count)).astype(int)
        inside = ((places >= 0) & (places < self._numbers.shape)).all(axis=1)
        labels: IntArray = self._numbers[tuple(places[inside].T)].astype(np.int64)
        if not (labels > 0).any():
            raise InputError(
                "its line crosses no grain; use the scan and the settings that it was made with."
            )
        return int(np.bincount(labels[labels > 0]).argmax())

    def _fill(self, labels: set[int], axis: int) -> None:
        filled = 0
        for label in sorted(labels):
            region = np.moveaxis(self._numbers[self._boxes[label]], axis, 0)
            for picture in region:
                enclosed = ndimage.binary_fill_holes(picture == label) & (picture <= 0)
                picture[enclosed] = label
                filled += int(enclosed.sum())
        if not filled:
            raise InputError("the grain encloses no free voxel in these slices.")

    def _paint(self, edit: LabelEdit) -> None:
        shape = np.array(self._numbers.shape)
        corners = np.array(edit.points, dtype=np.float64)
        if not ((corners >= 0) & (corners < shape)).all():
            raise InputError("its line leaves the volume.")
        low = np.maximum(corners.min(axis=0) - edit.radius, 0).astype(int)
        high = np.minimum(np.ceil(corners.max(axis=0) + edit.radius).astype(int) + 1, shape)
        box = box_between(low.tolist(), high.tolist())
        near = _near_line([n.stop - n.start for n in box], corners - low, edit.radius)
        label = max(int(self._numbers[edit.points[0]]), 0)
        if edit.kind == "erase":
            label = 0
        elif not label:
            label = self._highest = self._highest + 1
        self._numbers[box][near] = label
        if label:
            self._boxes[label] = _about_both(self._boxes.get(label, box), box)

    def _write_parts(self, label: int, parts: Sequence[BoolArray]) -> None:
        region = self._numbers[self._boxes[label]]
        for part in parts:
            self._highest += 1
            region[part] = self._highest
            self._boxes[self._highest] = self._boxes[label]


def _near_line(shape: Sequence[int], corners: FloatArray, radius: float) -> BoolArray:
    """Voxels of a box whose centres lie within `radius` of the line through the corners, shape (n, 3).

    The line is walked in steps of half a voxel at most.
    """
    free = np.ones(tuple(shape), dtype=bool)
    for start, end in pairwise(np.concatenate([corners, corners[-1:]])):
        count = 2 * int(np.ceil(np.abs(end - start).max())) + 1
        places = np.rint(np.linspace(start, end, count)).astype(int)
        free[tuple(places.T)] = False
    distance: Any = ndimage.distance_transform_edt(free)
    return np.asarray(distance <= radius)


def _about_both(one: Box, other: Box) -> Box:
    low = [min(a.start, b.start) for a, b in zip(one, other, strict=True)]
    high = [max(a.stop, b.stop) for a, b in zip(one, other, strict=True)]
    return box_between(low, high)


def edits_document(edits: Sequence[LabelEdit]) -> list[dict[str, Any]]:
    """Plain JSON of edits."""
    return [
        {"kind": each.kind, "points": [list(point) for point in each.points]}
        | ({"axis": each.axis} if each.kind in _IN_SLICES else {})
        | ({"radius": each.radius} if each.kind in _BRUSHED else {})
        for each in edits
    ]


def edits_from(document: Any) -> tuple[LabelEdit, ...]:
    """The edits that :func:`edits_document` has written.

    Raises InputError if it is no list of edits.
    """
    try:
        return tuple(
            LabelEdit(
                each["kind"],
                tuple(_voxel(point) for point in each["points"]),
                each.get("axis", 2),
                float(each.get("radius", 0.5)),
            )
            for each in document
        )
    except (KeyError, TypeError, ValueError, AttributeError):
        raise InputError(
            "“edits” in a recipe is a list of edits of labels, each with a kind and points of three whole "
            "numbers."
        ) from None


def _voxel(point: Any) -> Voxel:
    x, y, z = point
    if not all(type(each) is int for each in (x, y, z)):
        raise ValueError(f"a voxel has whole numbers, got {point!r}")
    return x, y, z
