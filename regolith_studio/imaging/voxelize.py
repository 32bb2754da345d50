"""Share of each voxel that lies inside a closed mesh: what a perfect scanner would see of it."""

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh

_ASIDE = np.array([1.23e-7, 2.17e-7, 0.0])
"""Keeps columns off edges that run along the grid."""


def coverage(mesh: Mesh, shape: tuple[int, int, int], fine: int = 3) -> NDArray[np.float32]:
    """Share of each voxel inside the mesh, whose corners are given in voxels; shape `shape`.

    Each voxel is cut into `fine` x `fine` columns along z, and along their middles the share is exact. What
    lies outside the grid is cut off.
    """
    share = np.empty(shape, dtype=np.float32)
    _fill_coverage(mesh.vertices + _ASIDE, mesh.faces, fine, share)
    return share


@kernel
def _fill_coverage(vertices: FloatArray, faces: IntArray, fine: int, share: NDArray[np.float32]) -> None:
    """Sum of what each crossing adds to its own voxel and to those above it, column by column."""
    nx, ny, nz = share.shape
    added = np.zeros((nx, ny, nz + 1))
    weight = 1.0 / (fine * fine)
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        ax, ay = (a[0] + 0.5) * fine - 0.5, (a[1] + 0.5) * fine - 0.5
        bx, by = (b[0] + 0.5) * fine - 0.5, (b[1] + 0.5) * fine - 0.5
        cx, cy = (c[0] + 0.5) * fine - 0.5, (c[1] + 0.5) * fine - 0.5
        twice = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if twice == 0.0:
            continue
        sign = -weight if twice > 0.0 else weight
        first, last = int(np.ceil(min(ax, bx, cx))), int(np.floor(max(ax, bx, cx)))
        front, back = int(np.ceil(min(ay, by, cy))), int(np.floor(max(ay, by, cy)))
        for i in range(max(first, 0), min(last, nx * fine - 1) + 1):
            for j in range(max(front, 0), min(back, ny * fine - 1) + 1):
                u = ((i - ax) * (cy - ay) - (cx - ax) * (j - ay)) / twice
                v = ((bx - ax) * (j - ay) - (i - ax) * (by - ay)) / twice
                if u < 0.0 or v < 0.0 or u + v > 1.0:
                    continue
                height = max(a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]) + 0.5, 0.0)
                k = int(np.floor(height))
                if k < nz:
                    above = 1.0 - (height - k)
                    added[i // fine, j // fine, k] += sign * above
                    added[i // fine, j // fine, k + 1] += sign * (1.0 - above)
    for i in range(nx):
        for j in range(ny):
            total = 0.0
            for k in range(nz):
                total += added[i, j, k]
                share[i, j, k] = total
