"""Where rays from the origin leave half-spaces that hold it."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector

BLOCK = 512
"""Rays that are worked out together: they stay in the fastest cache."""


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
    coordinates, largest, place = np.empty((3, BLOCK)), np.empty(BLOCK), np.empty(BLOCK)
    for start in range(0, len(directions), BLOCK):
        count = min(BLOCK, len(directions) - start)
        for j in range(count):
            largest[j] = place[j] = 0.0
            for c in range(3):
                coordinates[c, j] = directions[start + j, c]
        for i in range(len(offsets)):
            a, b, c = normals[i, 0] / offsets[i], normals[i, 1] / offsets[i], normals[i, 2] / offsets[i]
            _compare(coordinates, (a, b, c), float(i), count, largest, place)
        for j in range(count):
            radius[start + j] = 1.0 / largest[j] if largest[j] > 0.0 else np.inf
            plane[start + j] = int(place[j])


@kernel_noalloc
def _compare(
    coordinates: FloatArray, dual: Vector, number: float, count: int, largest: FloatArray, place: FloatArray
) -> None:
    """Keep the product of each ray with a plane, and the plane's number, where it is larger than before."""
    a, b, c = dual
    for j in range(count):  # compiled to vectors: no branch, and only floats
        here = coordinates[0, j] * a + coordinates[1, j] * b + coordinates[2, j] * c
        place[j] = number if here > largest[j] else place[j]
        largest[j] = here if here > largest[j] else largest[j]  # noqa: FURB136
