"""Volume and surface area of a mesh in one compiled pass."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed, row


def volume_and_area(mesh: Mesh) -> tuple[float, float]:
    """Signed volume (divergence theorem, about the middle of the bounds) and surface area.

    The numbers are those of :attr:`Mesh.volume` and :attr:`Mesh.surface_area`, some twenty times sooner.
    """
    if len(mesh.faces) == 0:
        return 0.0, 0.0
    return _measured(mesh.vertices, mesh.faces)


@kernel
def _measured(points: FloatArray, faces: IntArray) -> tuple[float, float]:
    middle = _middle(points)
    volume = area = 0.0
    for f in range(len(faces)):
        a = mixed(row(points, faces[f, 0]), 1.0, middle, -1.0)
        b = mixed(row(points, faces[f, 1]), 1.0, middle, -1.0)
        c = mixed(row(points, faces[f, 2]), 1.0, middle, -1.0)
        normal = cross(mixed(b, 1.0, a, -1.0), mixed(c, 1.0, a, -1.0))
        volume += dot(a, normal)
        area += length(normal)
    return volume / 6.0, area / 2.0


@kernel
def _middle(points: FloatArray) -> Vector:
    """Middle of the bounds."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for i in range(len(points)):
        for k in range(3):
            low[k], high[k] = min(low[k], points[i, k]), max(high[k], points[i, k])
    return (low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, (low[2] + high[2]) / 2.0
