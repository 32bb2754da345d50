"""Boxes of voxels: what to cut out of a volume."""

from collections.abc import Sequence

import numpy as np

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
