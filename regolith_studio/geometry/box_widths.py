"""Widths of a convex solid: how far its vertices reach along directions."""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.eights import (
    WIDTH,
    Eight,
    count_up,
    least,
    load,
    most,
    pick,
    smallest,
    splat,
    store,
    tagged,
    tags,
)
from regolith_studio.geometry.kernels import inline_kernel, kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector

FEWEST_CELLS, MOST_CELLS = 20, 64
"""Directions are told apart by a grid of so many cells along the edge of a cube: as many as the square root
of the number of vertices."""


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


@inline_kernel
def _ends(points: FloatArray, direction: Vector) -> tuple[int, int]:
    """See :func:`ends_along`."""
    x, y, z = direction
    low, high, bottom, top, n = np.inf, -np.inf, 0, 0, points.shape[1]
    if n >= WIDTH:
        u, v, w = splat(x), splat(y), splat(z)
        lows, highs, numbers = splat(np.inf), splat(-np.inf), count_up()
        bottoms, tops = numbers, numbers
        for first in range(0, n, WIDTH):
            at = min(first, n - WIDTH)
            here = load(points, at) * u + load(points, n + at) * v + load(points, 2 * n + at) * w
            now = numbers + splat(float(at))
            bottoms, tops = pick(here, lows, now, bottoms), pick(highs, here, now, tops)
            lows, highs = least(here, lows), most(here, highs)
        lowest, highest = splat(smallest(lows)), splat(-smallest(splat(0.0) - highs))
        nobody = splat(np.inf)
        top = int(smallest(pick(highs, highest, nobody, tops)))
        bottom = int(smallest(pick(lowest, lows, nobody, bottoms)))
    else:
        for i in range(n):
            here = points[0, i] * x + points[1, i] * y + points[2, i] * z
            if here < low:
                low, bottom = here, i
            if here > high:
                high, top = here, i
    return top, bottom


@kernel_noalloc
def ends_along(points: FloatArray, direction: Vector) -> tuple[int, int]:
    """The vertices farthest along and against `direction`, of equal ones the first; points of shape (3, n).

    Where there are eight, the last eight may overlap those before: they bring no other ends.
    """
    return _ends(points, direction)


@kernel_noalloc
def ends_along_axes(
    points: FloatArray, a: Vector, b: Vector, c: Vector
) -> tuple[tuple[int, int], tuple[int, int], tuple[int, int]]:
    """:func:`ends_along` for three directions: one call costs as much as a look along one."""
    return _ends(points, a), _ends(points, b), _ends(points, c)


@inline_kernel
def between(points: FloatArray, one: int, two: int) -> Vector:
    """Vector from vertex `two` to vertex `one`."""
    return points[0, one] - points[0, two], points[1, one] - points[1, two], points[2, one] - points[2, two]


@kernel
def ends_along_each(points: FloatArray, directions: FloatArray) -> IntArray:
    """:func:`ends_along` for all directions, shape (3, m), several at once: shape (2, m), top and bottom."""
    m = directions.shape[1]
    ends, found = np.empty((2, m), np.int64), np.empty((2, WIDTH))
    if m < WIDTH:
        for k in range(m):
            ends[0, k], ends[1, k] = ends_along(
                points, (directions[0, k], directions[1, k], directions[2, k])
            )
        return ends
    for first in range(0, m, WIDTH):
        at = min(first, m - WIDTH)
        x, y, z = load(directions, at), load(directions, m + at), load(directions, 2 * m + at)
        farthest(points, x, y, z, found)
        for k in range(WIDTH):
            ends[0, at + k], ends[1, at + k] = int(found[0, k]), int(found[1, k])
    return ends


@kernel_noalloc
def farthest(points: FloatArray, x: Eight, y: Eight, z: Eight, found: FloatArray) -> None:
    """:func:`ends_along` for eight directions: numbers of the vertices, tops and bottoms, shape (2, 8)."""
    lows, highs = splat(np.inf), splat(-np.inf)
    bottoms = tops = splat(0.0)
    for i in range(points.shape[1]):
        here, now = (
            splat(points[0, i]) * x + splat(points[1, i]) * y + splat(points[2, i]) * z,
            splat(float(i)),
        )
        bottoms, tops = pick(here, lows, now, bottoms), pick(highs, here, now, tops)
        lows, highs = least(here, lows), most(here, highs)
    store(found, 0, tops)
    store(found, WIDTH, bottoms)


@kernel
def span_table(points: FloatArray) -> SpanTable:
    """Look along the middle of every cell; points of shape (3, n).

    Numbers of vertices go with their reach in its last places: of vertices that reach about as far, any is
    taken.
    """
    cells = min(MOST_CELLS, max(FEWEST_CELLS, int(np.sqrt(points.shape[1]))))
    middles, spans = np.empty(cells), np.empty(9 * cells * cells + WIDTH)
    corners = np.empty((points.shape[1], WIDTH))
    for v in range(len(corners)):
        for c in range(WIDTH):
            corners[v, c] = points[c, v] if c < 3 else 0.0
    for j in range(cells):
        middles[j] = (2.0 * j + 1.0) / cells - 1.0
    look_along_rows(points, corners, middles, np.empty(points.shape[1]), np.empty((2, WIDTH)), spans)
    return SpanTable(spans[: 9 * cells * cells].reshape(-1, 3), cells)


@kernel_noalloc
def look_along_rows(
    points: FloatArray,
    corners: FloatArray,
    middles: FloatArray,
    begin: FloatArray,
    ends: FloatArray,
    spans: FloatArray,
) -> None:
    """Fill the table, eight cells of a row at once; scratch for the vertices, and of shape (2, 8)."""
    n, cells = points.shape[1], len(middles)
    for k in range(3):
        second, third = (k + 1) % 3, (k + 2) % 3
        for i in range(cells):
            for v in range(n):
                begin[v] = points[k, v] + middles[i] * points[second, v]
            for first in range(0, cells, WIDTH):
                at = min(first, cells - WIDTH)
                across, low, high = load(middles, at), splat(np.inf), splat(-np.inf)
                for v in range(n):
                    here = tagged(splat(begin[v]) + splat(points[third, v]) * across, v)
                    low, high = least(here, low), most(here, high)
                store(ends, 0, tags(high))
                store(ends, WIDTH, tags(low))
                for j in range(WIDTH):
                    top, bottom = WIDTH * int(ends[0, j]), WIDTH * int(ends[1, j])
                    cell = (k * cells + i) * cells + at + j
                    store(spans, 3 * cell, load(corners, top) - load(corners, bottom))


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
