"""Extents of a convex solid: how far its vertices reach along directions."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inline_kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector

MIN_CELLS, MAX_CELLS = 12, 64
"""Directions are told apart by a grid of so many cells along the edge of a cube: as many as the square root
of the number of vertices."""
BLOCK = 256
"""Directions that are looked along together: they stay in the fastest cache."""


class SpanTable(NamedTuple):
    """A vector across the solid for each cell of directions.

    Parameters
    ----------
    spans
        Between the vertices farthest along and against the cell's middle, shape (3 cells^2, 3).
    cells
        Along the edge of a cube; those of one direction and of its opposite are the same.
    """

    spans: FloatArray
    cells: int


@kernel_noalloc
def extreme_vertices(points: FloatArray, direction: Vector) -> tuple[int, int]:
    """The vertices farthest along and against `direction`, the first of equal ones; points (3, n)."""
    x, y, z = direction
    low, high, bottom, top = np.inf, -np.inf, 0, 0
    for i in range(points.shape[1]):
        here = points[0, i] * x + points[1, i] * y + points[2, i] * z
        if here < low:
            low, bottom = here, i
        if here > high:
            high, top = here, i
    return top, bottom


@inline_kernel
def between(points: FloatArray, one: int, two: int) -> Vector:
    """Vector from vertex `two` to vertex `one`."""
    return points[0, one] - points[0, two], points[1, one] - points[1, two], points[2, one] - points[2, two]


def extreme_vertices_of_each(points: FloatArray, directions: FloatArray) -> IntArray:
    """:func:`extreme_vertices` for all directions, shape (3, m): shape (2, m), top and bottom."""
    ends = np.empty((2, directions.shape[1]), dtype=np.int64)
    fill_extreme_vertices(points, directions, np.empty((4, BLOCK)), ends)
    return ends


@kernel_noalloc
def fill_extreme_vertices(
    points: FloatArray, directions: FloatArray, block: FloatArray, ends: IntArray
) -> None:
    """Fill `ends` (2, m); `block` (4, BLOCK) is scratch."""
    low, high, bottom, top = block[0], block[1], block[2], block[3]
    for start in range(0, directions.shape[1], BLOCK):
        count = min(BLOCK, directions.shape[1] - start)
        for k in range(count):
            low[k], high[k], bottom[k], top[k] = np.inf, -np.inf, 0.0, 0.0
        for i in range(points.shape[1]):
            x, y, z, number = points[0, i], points[1, i], points[2, i], float(i)
            for k in range(count):  # compiled to vectors: no branch, and only floats
                at = start + k
                here = x * directions[0, at] + y * directions[1, at] + z * directions[2, at]
                bottom[k] = number if here < low[k] else bottom[k]
                low[k] = here if here < low[k] else low[k]  # noqa: FURB136
                top[k] = number if here > high[k] else top[k]
                high[k] = here if here > high[k] else high[k]  # noqa: FURB136
        for k in range(count):
            ends[0, start + k], ends[1, start + k] = int(top[k]), int(bottom[k])


def span_table(points: FloatArray) -> SpanTable:
    """Look along the middle of every cell; points of shape (3, n)."""
    cells = n_cells(points.shape[1])
    top, bottom = extreme_vertices_of_each(points, cell_directions(cells))
    return SpanTable(np.ascontiguousarray((points[:, top] - points[:, bottom]).T), cells)


def n_cells(n_points: int) -> int:
    """Cells along the edge of the cube for so many vertices."""
    return min(MAX_CELLS, max(MIN_CELLS, int(np.sqrt(n_points))))


@lru_cache(maxsize=8)
def cell_directions(cells: int) -> FloatArray:
    """Directions to the middles of all cells (k, i, j), number (k cells + i) cells + j; (3, 3 cells^2)."""
    middles = (2.0 * np.arange(cells) + 1.0) / cells - 1.0
    directions = np.empty((3, 3, cells, cells))
    for k in range(3):
        directions[k, k] = 1.0
        directions[(k + 1) % 3, k] = middles[:, None]
        directions[(k + 2) % 3, k] = middles
    return directions.reshape(3, -1)


@inline_kernel
def span_near(table: SpanTable, direction: Vector) -> Vector:
    """A vector between two vertices that is nearly as long along `direction` as the solid is wide."""
    x, y, z = direction
    if abs(x) >= abs(y) and abs(x) >= abs(z):
        k, u, v = 0, y / x, z / x
    elif abs(y) >= abs(z):
        k, u, v = 1, z / y, x / y
    else:
        k, u, v = 2, x / z, y / z
    spans, cells = table
    i = min(cells - 1, int((u + 1.0) * (0.5 * cells)))
    j = min(cells - 1, int((v + 1.0) * (0.5 * cells)))
    at = (k * cells + i) * cells + j
    return spans[at, 0], spans[at, 1], spans[at, 2]
