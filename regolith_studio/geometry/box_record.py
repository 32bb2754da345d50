"""The least box so far, and a list of boxes that come near it."""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.compiled import kernel, leaf
from regolith_studio.geometry.vectors import Vector, along

TIE = 1e-8
SAME_BOX = 1e-4
"""Of boxes whose volumes differ by a share below TIE, the one with the lesser sum of edges is kept; where
that differs by less than SAME_BOX, it is one box, better placed."""
MOST = 64
"""Largest number of boxes on the list."""
SAME_FRAME = 1e-9
"""Boxes on the list are the same if the cosines of the angles between their axes are that near to 1."""
DEPTH = 256


class Found(NamedTuple):
    """Boxes found so far.

    Parameters
    ----------
    record
        The least volume, the sum of the edges of its box, and how many boxes are on the list, shape (3,).
    axes
        Of the best box, one a row, shape (3, 3).
    volumes, frames
        The list, shapes (MOST,) and (MOST, 3, 3).
    todo
        Scratch: ends of the pieces of a curve still to be searched, shape (DEPTH, 2).
    """

    record: FloatArray
    axes: FloatArray
    volumes: FloatArray
    frames: FloatArray
    todo: FloatArray


@kernel
def nothing_below(known: float) -> Found:
    """No box yet; only boxes smaller than `known` are to be kept."""
    return Found(
        np.array([known, np.inf, 0.0]),
        np.zeros((3, 3)),
        np.full(MOST, np.inf),
        np.empty((MOST, 3, 3)),
        np.empty((DEPTH, 2)),
    )


@leaf
def keep(long: float, wide: float, high: float, a: Vector, b: Vector, c: Vector, found: Found) -> float:
    """Volume of the box with these edges along these axes; it is kept if it is the best so far."""
    volume, total = long * wide * high, long + wide + high
    least, shorter = found.record[0], total / found.record[1] - 1.0
    if (
        volume < least * (1.0 - TIE)
        or (abs(shorter) < SAME_BOX and volume < least)
        or (shorter < -SAME_BOX and volume < least * (1.0 + TIE))
    ):
        found.record[0], found.record[1] = volume, total
        for k in range(3):
            found.axes[0, k], found.axes[1, k], found.axes[2, k] = a[k], b[k], c[k]
    return float(volume)


@leaf
def note(volume: float, a: Vector, b: Vector, c: Vector, margin: float, found: Found) -> None:
    """Put a box on the list if it is at most (1 + margin) times the least; of too many, the largest goes."""
    if not volume <= found.record[0] * (1.0 + margin):
        return
    at = int(found.record[2])
    for i in range(at):
        if abs(found.volumes[i] - volume) < 1e-6 * volume and _alike(found.frames[i], a, b, c):
            return
    if at == MOST:
        at = int(np.argmax(found.volumes))
        if found.volumes[at] <= volume:
            return
    else:
        found.record[2] += 1.0
    found.volumes[at] = volume
    for k in range(3):
        found.frames[at, 0, k], found.frames[at, 1, k], found.frames[at, 2, k] = a[k], b[k], c[k]


@leaf
def drop_far(margin: float, found: Found) -> None:
    """Take boxes off the list that are no longer within (1 + margin) times the least."""
    kept = 0
    for i in range(int(found.record[2])):
        if found.volumes[i] <= found.record[0] * (1.0 + margin):
            found.volumes[kept] = found.volumes[i]
            for j in range(3):
                for k in range(3):
                    found.frames[kept, j, k] = found.frames[i, j, k]
            kept += 1
    for i in range(kept, MOST):
        found.volumes[i] = np.inf
    found.record[2] = kept


@leaf
def _alike(frame: FloatArray, a: Vector, b: Vector, c: Vector) -> bool:
    """Whether three axes are those of a frame, in any order and direction."""
    for axis in (a, b, c):
        most = 0.0
        for k in range(3):
            most = max(most, abs(along(frame, k, axis)))
        if most < 1.0 - SAME_FRAME:
            return False
    return True
