"""How squarely the surface stands to the rays from a point: the mean of |cos| of the angle between them."""

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.vectors import cross, dot, length, mixed, row


def mean_incidence(mesh: Mesh, centre: ArrayLike) -> float:
    """Mean over the surface of |n . x| / |x|, x from `centre` and n the unit normal; 1 for a sphere.

    Exact for triangles: the distance of a triangle's plane times the integral of 1 / |x| over it, which
    has a closed form (Wilton et al. 1984), so that cutting a facet in triangles changes nothing.
    """
    origin = locked_floats(centre, (3,), "centre")
    size = float(np.ptp(mesh.bounds, axis=0).max())
    return _incidence((mesh.vertices - origin) / size, mesh.faces) * size**2 / mesh.surface_area


@kernel
def _incidence(points: FloatArray, faces: IntArray) -> float:
    """Integral of |n . x| / |x| over the triangles."""
    total = 0.0
    for f in range(len(faces)):
        corners = row(points, faces[f, 0]), row(points, faces[f, 1]), row(points, faces[f, 2])
        normal = cross(mixed(corners[1], 1.0, corners[0], -1.0), mixed(corners[2], 1.0, corners[0], -1.0))
        doubled = length(normal)
        if doubled == 0.0:
            continue
        normal = mixed(normal, 1.0 / doubled, normal, 0.0)
        height = dot(normal, corners[0])
        total += abs(height) * _potential(corners[0], corners[1], corners[2], normal, height)
    return total


@kernel
def _potential(
    a: tuple[float, float, float],
    b: tuple[float, float, float],
    c: tuple[float, float, float],
    normal: tuple[float, float, float],
    height: float,
) -> float:
    """Integral of 1 / |x| over a triangle with unit `normal` at the signed distance `height` of its plane."""
    total = 0.0
    for k in range(3):
        start, end = (a, b) if k == 0 else ((b, c) if k == 1 else (c, a))
        edge = mixed(end, 1.0, start, -1.0)
        size = length(edge)
        if size == 0.0:
            continue
        edge = mixed(edge, 1.0 / size, edge, 0.0)
        outward = dot(start, cross(edge, normal))
        before, behind = dot(start, edge), dot(end, edge)
        far, near = length(end) + behind, length(start) + before
        if before < 0.0 and behind < 0.0:
            far, near = length(start) - before, length(end) - behind
        if outward != 0.0 and near > 0.0 and far > 0.0:
            total += outward * np.log(far / near)
    volume = dot(a, cross(b, c))
    la, lb, lc = length(a), length(b), length(c)
    angle = 2.0 * np.arctan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    return float(total - height * angle)
