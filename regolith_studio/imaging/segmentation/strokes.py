"""Brush strokes in the slices of a volume, as voxels."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_integers

ERASER = -1
"""The label of a stroke that takes paint away."""


@dataclass(frozen=True, eq=False)
class Stroke(LockedRecord):
    """Voxels that were painted at a time.

    ``positions``: along x, y, z, shape (n, 3). ``label``: their class, from 0, or :data:`ERASER`.
    """

    positions: IntArray
    label: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", locked_integers(self.positions, (None, 3), "positions"))


def draw_stroke(
    axis: int, number: int, points: FloatArray, radius: float, shape: Sequence[int], label: int
) -> Stroke:
    """The voxels of a slice whose centres lie within `radius` of a line.

    - ``axis``, ``number``: the slice.
    - ``points``: corners of the line across the slice, in voxels, voxel 0 reaching from 0 to 1; shape (n,
      2).
    - ``radius``: in voxels.
    - ``shape``: of the volume.
    """
    across, down = (each for each in range(3) if each != axis)
    low = np.maximum(np.floor(points.min(axis=0) - radius), 0).astype(int)
    high = np.minimum(np.ceil(points.max(axis=0) + radius), (shape[across], shape[down])).astype(int)
    corners = np.stack(np.meshgrid(*map(np.arange, low, high), indexing="ij"), axis=-1).reshape(-1, 2)
    centres = np.asarray(corners + 0.5, dtype=np.float64)
    starts, ends = (points, points) if len(points) == 1 else (points[:-1], points[1:])
    near = np.zeros(len(corners), dtype=bool)
    for start, end in zip(starts, ends, strict=True):
        near |= _distance(centres, start, end) <= radius
    positions = np.full((int(near.sum()), 3), number, dtype=np.int64)
    positions[:, [across, down]] = corners[near]
    return Stroke(positions, label)


def _distance(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """From each point to the nearest of a line from `start` to `end`."""
    along = end - start
    length = float(along @ along)
    share = np.clip((points - start) @ along / length, 0.0, 1.0) if length else np.zeros(len(points))
    return np.asarray(np.linalg.norm(points - start - share[:, None] * along, axis=1))


def painted_rows(strokes: Sequence[Stroke]) -> tuple[IntArray, IntArray, IntArray]:
    """Positions, labels and rows of the voxels that are painted at the end.

    Later strokes cover earlier ones. Rows are those of all strokes' voxels one after the other.
    """
    if not strokes:
        return np.zeros((0, 3), np.int64), np.zeros(0, np.int64), np.zeros(0, np.int64)
    positions = np.concatenate([each.positions for each in strokes])
    labels = np.concatenate([np.full(len(each.positions), each.label) for each in strokes])
    _, last = np.unique(positions[::-1], axis=0, return_index=True)
    rows = np.sort(len(positions) - 1 - last)
    rows = rows[labels[rows] != ERASER]
    return positions[rows], labels[rows], rows
