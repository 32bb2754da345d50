"""Rays from one origin sorted into bins of the unit sphere.

Rows are bands of equal height in z, and so of equal area; columns are equal steps of longitude.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel

RAYS_PER_BIN = 2
MARGIN = 1e-9
"""Added to the radius of every cap, in radians."""


class DirectionBins(NamedTuple):
    """Rays by bin.

    Parameters
    ----------
    rays
        Indices of the rays, row by row and column by column, shape (n,).
    first
        Position in `rays` of the first ray of each bin, shape (rows * columns + 1,).
    rows, columns
        Size of the grid.
    """

    rays: IntArray
    first: IntArray
    rows: int
    columns: int


@kernel
def direction_bins(directions: FloatArray) -> DirectionBins:
    """Sort rays along unit `directions`, shape (n, 3)."""
    n = len(directions)
    rows = max(1, int(np.sqrt(n / (2.0 * RAYS_PER_BIN))))
    columns = 2 * rows
    bins = np.empty(n, np.int64)
    first = np.zeros(rows * columns + 1, np.int64)
    for k in range(n):
        x, y, z = directions[k, 0], directions[k, 1], directions[k, 2]
        bins[k] = row_of(z, rows) * columns + column_of(np.arctan2(y, x), columns) % columns
        first[bins[k] + 1] += 1
    for i in range(rows * columns):
        first[i + 1] += first[i]
    rays, filled = np.empty(n, np.int64), first.copy()
    for k in range(n):
        rays[filled[bins[k]]] = k
        filled[bins[k]] += 1
    return DirectionBins(rays, first, rows, columns)


@kernel
def row_of(z: float, rows: int) -> int:
    """Row of height `z`, which may lie outside -1..1."""
    return min(rows - 1, max(0, int((z + 1.0) * 0.5 * rows)))


@kernel
def column_of(longitude: float, columns: int) -> int:
    """Column of a longitude between -pi and pi; outside them, columns count on."""
    return int(np.floor((longitude / (2.0 * np.pi) + 0.5) * columns))


@kernel
def bins_around(
    a: FloatArray, b: FloatArray, c: FloatArray, rows: int, columns: int
) -> tuple[int, int, int, int]:
    """First and last row and column of the bins that a triangle, seen from the origin, may touch.

    Found from the cap around its three directions. The last column may be `columns` or more: count on
    from column 0.
    """
    everything = (0, rows - 1, 0, columns - 1)
    x = y = z = 0.0
    for p in (a, b, c):
        length = np.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
        if length == 0.0:
            return everything
        x, y, z = x + p[0] / length, y + p[1] / length, z + p[2] / length
    length = np.sqrt(x * x + y * y + z * z)
    if length < 0.1:
        return everything
    x, y, z = x / length, y / length, z / length
    chord = 0.0
    for p in (a, b, c):
        length = np.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
        far = (p[0] / length - x) ** 2 + (p[1] / length - y) ** 2 + (p[2] / length - z) ** 2
        chord = max(chord, far)
    chord = np.sqrt(chord) + MARGIN
    if chord > 1.4:
        return everything
    cosine, sine = 1.0 - chord**2 / 2.0, chord * np.sqrt(1.0 - chord**2 / 4.0)
    across = np.sqrt(x * x + y * y)
    low = row_of(-1.0 if -z >= cosine else z * cosine - across * sine - MARGIN, rows)
    high = row_of(1.0 if z >= cosine else z * cosine + across * sine + MARGIN, rows)
    if abs(z) >= cosine or sine >= across:
        return low, high, 0, columns - 1
    half = np.arcsin(sine / across) + MARGIN
    middle = np.arctan2(y, x)
    left, right = column_of(middle - half, columns), column_of(middle + half, columns)
    if right - left >= columns:
        return low, high, 0, columns - 1
    return (low, high, left, right) if left >= 0 else (low, high, left + columns, right + columns)
