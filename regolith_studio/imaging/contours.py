"""Contours of voxels, and how deep each voxel lies in a mask."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from skimage import measure

from regolith_studio.geometry.arrays import BoolArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.connected_components import largest_component, pores_filled

_marching_cubes: Any = measure.marching_cubes
MAX_DEPTH = 4
"""Distance in voxels at which depths are cut off."""


def contour(values: NDArray[Any], level: float, spacing: Sequence[float]) -> Mesh:
    """Surface where `values`, higher inside, cross `level` (marching cubes, Lewiner's table).

    Parameters
    ----------
    values
        Samples on a grid, shape (nx, ny, nz), below `level` all over the border of the grid.
    spacing
        Distance of samples along each axis; the first sample lies at the origin.

    Raises
    ------
    ValueError
        If no value lies above `level` or none below, or the surface encloses no volume.
    """
    vertices, faces, _, _ = _marching_cubes(
        values, level, spacing=tuple(float(step) for step in spacing), gradient_direction="ascent"
    )
    mesh = Mesh(vertices, np.asarray(faces, dtype=np.int64))
    if not mesh.volume > 0.0:
        raise ValueError("the values must be higher inside, and lower all over the border of the grid")
    return mesh


def body_contour(share: NDArray[np.float32]) -> Mesh:
    """Contour at one half of the largest body, without what it encloses."""
    body, _ = largest_component(np.ascontiguousarray(share >= 0.5))
    body = pores_filled(body)
    one = np.where(body, np.maximum(share, 0.501), np.minimum(share, 0.499))
    mesh = contour(np.pad(one, 1).astype(np.float32), 0.5, (1.0, 1.0, 1.0))
    return mesh.moved(shift=np.full(3, -1.0))


def depth(mask: BoolArray) -> NDArray[np.float32]:
    """Distance of each voxel of a mask to the nearest one outside, at most :data:`MAX_DEPTH`; 0 outside.

    In voxels, between their centres, and exact below :data:`MAX_DEPTH`; beyond the array there is nothing.
    """
    squared = np.full(mask.shape, MAX_DEPTH * MAX_DEPTH, dtype=np.int32)
    _fill_squared(np.ascontiguousarray(mask), MAX_DEPTH, squared)
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
