"""Where rays from the origin leave half-spaces that hold it."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.eights import WIDTH, load, most, pick, splat, store
from regolith_studio.geometry.kernels import kernel, kernel_noalloc
from regolith_studio.geometry.vectors import row

BLOCK = 512
"""Rays whose coordinates are laid side by side at a time: they stay in the fastest cache."""
MOST, PLACE = 3, 4
"""Rows of a block, after those for the coordinates."""


@kernel
def exits(
    normals: FloatArray, offsets: FloatArray, directions: FloatArray, radius: FloatArray, plane: IntArray
) -> None:
    """Fill `radius` (k,), infinite where no plane is met, and `plane` (k,), the first of several that tie.

    Parameters
    ----------
    normals, offsets
        Half-spaces <n_i, x> <= h_i with h_i > 0, shapes (n, 3) and (n,).
    directions
        Unit vectors, shape (k, 3).
    """
    dual = np.empty((len(offsets), 3))
    for i in range(len(offsets)):
        for c in range(3):
            dual[i, c] = normals[i, c] / offsets[i]
    rows = np.zeros((5, BLOCK))
    for start in range(0, len(directions), BLOCK):
        rays = min(BLOCK, len(directions) - start)
        for j in range(rays):
            rows[0, j], rows[1, j], rows[2, j] = row(directions, start + j)
        farthest_planes(dual, rows, rays)
        for j in range(rays):
            radius[start + j] = 1.0 / rows[MOST, j] if rows[MOST, j] > 0.0 else np.inf
            plane[start + j] = int(rows[PLACE, j])


@kernel_noalloc
def farthest_planes(dual: FloatArray, rows: FloatArray, rays: int) -> None:
    """Fill the rows MOST and PLACE: the largest product of each ray with a plane, from 0, and with which."""
    x_row, y_row, z_row, nothing = 0, BLOCK, 2 * BLOCK, splat(0.0)
    for at in range(0, rays, 2 * WIDTH):
        also = at + WIDTH
        x, y, z = load(rows, x_row + at), load(rows, y_row + at), load(rows, z_row + at)
        u, v, w = load(rows, x_row + also), load(rows, y_row + also), load(rows, z_row + also)
        best, at_best, top, at_top = nothing, nothing, nothing, nothing
        for i in range(len(dual)):
            a, b, c, number = splat(dual[i, 0]), splat(dual[i, 1]), splat(dual[i, 2]), splat(float(i))
            here, there = x * a + y * b + z * c, u * a + v * b + w * c
            at_best, at_top = pick(best, here, number, at_best), pick(top, there, number, at_top)
            best, top = most(here, best), most(there, top)
        store(rows, MOST * BLOCK + at, best)
        store(rows, MOST * BLOCK + also, top)
        store(rows, PLACE * BLOCK + at, at_best)
        store(rows, PLACE * BLOCK + also, at_top)
