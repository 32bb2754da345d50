"""Where rays from the origin leave half-spaces that hold it."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel

BLOCK = 512
"""Rays compared with two planes at a time: their coordinates stay in the fastest cache, side by side, so
that the processor takes several rays at once."""


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
    n = len(offsets)
    dual = np.zeros((n + 1, 3))
    for i in range(n):
        for c in range(3):
            dual[i, c] = normals[i, c] / offsets[i]
    x, y, z = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
    most, place = np.empty(BLOCK), np.empty(BLOCK)
    for start in range(0, len(directions), BLOCK):
        rays = min(BLOCK, len(directions) - start)
        for j in range(rays):
            x[j], y[j], z[j] = directions[start + j, 0], directions[start + j, 1], directions[start + j, 2]
            most[j] = place[j] = 0.0
        for i in range(0, n, 2):
            a0, a1, a2, b0, b1, b2 = (
                dual[i, 0],
                dual[i, 1],
                dual[i, 2],
                dual[i + 1, 0],
                dual[i + 1, 1],
                dual[i + 1, 2],
            )
            one, two = float(i), float(i + 1)
            for j in range(rays):
                best, at = most[j], place[j]
                here = x[j] * a0 + y[j] * a1 + z[j] * a2
                at = one if here > best else at
                best = max(best, here)
                here = x[j] * b0 + y[j] * b1 + z[j] * b2
                place[j] = two if here > best else at
                most[j] = max(best, here)
        for j in range(rays):
            radius[start + j] = 1.0 / most[j] if most[j] > 0.0 else np.inf
            plane[start + j] = int(place[j])
