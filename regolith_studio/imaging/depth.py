"""How deep voxels lie in a mask, as far as it matters near a surface."""

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import BoolArray
from regolith_studio.geometry.kernels import kernel

DEEPEST = 4
"""Voxels beyond which depths are not told apart."""


def depth(mask: BoolArray) -> NDArray[np.float32]:
    """Distance of each voxel of a mask to the nearest one outside, at most :data:`DEEPEST`; 0 outside.

    In voxels, between their centres, and exact below :data:`DEEPEST`; beyond the array there is nothing.
    """
    squared = np.full(mask.shape, DEEPEST * DEEPEST, dtype=np.int32)
    _fill_squared(np.ascontiguousarray(mask), DEEPEST, squared)
    return np.asarray(np.sqrt(squared), dtype=np.float32)


@kernel
def _fill_squared(mask: BoolArray, deepest: int, found: NDArray[np.int32]) -> None:
    """Squared distances: along z, then the least over y, then over x; `found` begins at the largest."""
    nx, ny, nz = mask.shape
    most = np.int32(deepest * deepest)
    along = np.empty((nx, ny, nz), dtype=np.int32)
    for i in range(nx):
        for j in range(ny):
            run = deepest
            for k in range(nz):
                run = min(run + 1, deepest) if mask[i, j, k] else 0
                along[i, j, k] = run
            run = deepest
            for k in range(nz - 1, -1, -1):
                run = min(run + 1, deepest) if mask[i, j, k] else 0
                nearest = min(run, along[i, j, k])
                along[i, j, k] = nearest * nearest
    across = np.full((nx, ny, nz), most, dtype=np.int32)
    for i in range(nx):
        for j in range(ny):
            for other in range(max(j - deepest + 1, 0), min(j + deepest, ny)):
                added = np.int32((other - j) ** 2)
                for k in range(nz):
                    across[i, j, k] = min(across[i, j, k], along[i, other, k] + added)
    for i in range(nx):
        for other in range(max(i - deepest + 1, 0), min(i + deepest, nx)):
            added = np.int32((other - i) ** 2)
            for j in range(ny):
                for k in range(nz):
                    found[i, j, k] = min(found[i, j, k], across[other, j, k] + added)
