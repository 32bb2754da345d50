"""Radius functions under linear maps of space: tables of measured radii, looked up where a map leads.

The image of the body r(u) under L has the radius r(v / |v|) / |v| along u, with v = L^-1 u. Tables are even
in colatitude and longitude; between their nodes Lagrange's cubic holds in both.
"""

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.harmonics.sphere_grid import ring_basis

Tables = NDArray[np.float32]

ROWS_PER_DEGREE = 2.4
MARGIN = 2
_BATCH = 500


def radius_tables(coefficients: FloatArray) -> Tables:
    """Radii on a grid of colatitudes and longitudes, wrapped, shape (n, rows + 4, 2 rows + 4)."""
    l_max = round(coefficients.shape[1] ** 0.5) - 1
    rows = max(16, int(np.ceil(ROWS_PER_DEGREE * l_max)))
    colatitude = (np.arange(rows) + 0.5) * np.pi / rows
    basis = ring_basis(np.cos(colatitude), 2 * rows, l_max)
    tables = np.empty((len(coefficients), rows + 2 * MARGIN, 2 * rows + 2 * MARGIN), dtype=np.float32)
    for first in range(0, len(coefficients), _BATCH):
        values = basis.values(coefficients[first : first + _BATCH]).astype(np.float32)
        tables[first : first + _BATCH] = _wrapped(values.reshape(-1, rows, 2 * rows))
    return tables


def _wrapped(grid: Tables) -> Tables:
    """With two more rows beyond each pole and two more columns on each side."""
    rows = grid.shape[1]
    opposite = np.roll(grid, rows, axis=2)
    tall = np.concatenate([opposite[:, MARGIN - 1 :: -1], grid, opposite[:, : -MARGIN - 1 : -1]], axis=1)
    return np.concatenate([tall[:, :, -MARGIN:], tall, tall[:, :, :MARGIN]], axis=2)


@kernel
def mapped_radii(
    tables: Tables, picks: IntArray, inverses: FloatArray, directions: FloatArray, radii: FloatArray
) -> None:
    """Fill `radii` of mapped particles, shape (n, k).

    Parameters
    ----------
    tables
        Of :func:`radius_tables`.
    picks
        Which table each particle has, shape (n,).
    inverses
        Inverse of each linear map, shape (n, 3, 3).
    directions
        Unit vectors, shape (k, 3).
    """
    step = np.pi / (tables.shape[1] - 4)
    for n in range(len(picks)):
        a = inverses[n]
        table = tables[picks[n]]
        for k in range(len(directions)):
            x, y, z = directions[k, 0], directions[k, 1], directions[k, 2]
            p = a[0, 0] * x + a[0, 1] * y + a[0, 2] * z
            q = a[1, 0] * x + a[1, 1] * y + a[1, 2] * z
            r = a[2, 0] * x + a[2, 1] * y + a[2, 2] * z
            length = np.sqrt(p * p + q * q + r * r)
            row = np.arctan2(np.sqrt(p * p + q * q), r) / step - 0.5
            column = np.arctan2(q, p) / step
            if column < 0.0:
                column += tables.shape[2] - 4
            i, j = int(np.floor(row)), int(np.floor(column))
            radii[n, k] = _cubic(table, i, j, row - i, column - j) / length


@kernel
def _cubic(table: Tables, i: int, j: int, s: float, t: float) -> float:
    """Value at (i + s, j + t) of a table with a margin of two, 0 <= s, t <= 1."""
    total = 0.0
    c0 = -t * (t - 1.0) * (t - 2.0) / 6.0
    c1 = (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0
    c2 = -(t + 1.0) * t * (t - 2.0) / 2.0
    c3 = (t + 1.0) * t * (t - 1.0) / 6.0
    for d in range(4):
        if d == 0:
            weight = -s * (s - 1.0) * (s - 2.0) / 6.0
        elif d == 1:
            weight = (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0
        elif d == 2:
            weight = -(s + 1.0) * s * (s - 2.0) / 2.0
        else:
            weight = (s + 1.0) * s * (s - 1.0) / 6.0
        line = table[i + 1 + d]
        total += weight * (c0 * line[j + 1] + c1 * line[j + 2] + c2 * line[j + 3] + c3 * line[j + 4])
    return total
