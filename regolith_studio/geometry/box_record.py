"""The least box so far."""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector

TIE = 1e-8
SAME_BOX = 1e-4
"""Of boxes whose volumes differ by a share below TIE, the one with the lesser sum of edges is kept; where
that differs by less than SAME_BOX, it is one box, better placed."""
DEPTH = 256


class Found(NamedTuple):
    """The best box so far.

    Parameters
    ----------
    record
        The least volume, and the sum of the edges of its box, shape (2,).
    axes
        One a row, shape (3, 3).
    todo
        Scratch: ends of the pieces of a curve still to be searched, shape (DEPTH, 2).
    """

    record: FloatArray
    axes: FloatArray
    todo: FloatArray


@kernel
def nothing_below(known: float) -> Found:
    """No box yet; only boxes smaller than `known` are to be kept."""
    return Found(np.array([known, np.inf]), np.zeros((3, 3)), np.empty((DEPTH, 2)))


@kernel_noalloc
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
