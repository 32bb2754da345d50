"""Whether a closed mesh is star-shaped about a point, proved face by face."""

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel

CLEARANCE = 1e-12
"""Least share of the product of three corners' distances by which a triangle must look outwards."""


def is_star_shaped(vertices: FloatArray, faces: IntArray, point: ArrayLike) -> bool:
    """Whether every ray from `point` leaves the mesh exactly once; ``False`` where rounding leaves a doubt.

    The mesh must be closed and consistently wound. If every triangle then looks outwards as seen from the
    point, the central projection onto the sphere preserves orientation everywhere, so that each direction is
    covered by the same number of triangles, which is counted for one of them. If that number is 1, the
    projection is one to one: no two triangles can cross, and the point sees the whole surface.

    Parameters
    ----------
    vertices
        Shape (n, 3).
    faces
        Shape (m, 3).
    point
        Shape (3,).
    """
    if len(faces) < 4:
        return False
    corners = np.ascontiguousarray(vertices - np.asarray(point, dtype=np.float64))
    return bool(covers_once(corners, np.ascontiguousarray(faces)))


@kernel
def covers_once(corners: FloatArray, faces: IntArray) -> bool:
    """Whether all triangles look away from the origin, and one direction meets one of them only."""
    first = faces[0]
    ux, uy, uz = 0.0, 0.0, 0.0
    for k in range(3):
        x, y, z = corners[first[k], 0], corners[first[k], 1], corners[first[k], 2]
        length = np.sqrt(x * x + y * y + z * z)
        if not length > 0.0:
            return False
        ux, uy, uz = ux + x / length, uy + y / length, uz + z / length
    met = 0
    for f in range(len(faces)):
        a, b, c = corners[faces[f, 0]], corners[faces[f, 1]], corners[faces[f, 2]]
        px, py, pz = b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]
        qx, qy, qz = c[1] * a[2] - c[2] * a[1], c[2] * a[0] - c[0] * a[2], c[0] * a[1] - c[1] * a[0]
        rx, ry, rz = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
        la = np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
        lb = np.sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2])
        lc = np.sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2])
        if not a[0] * px + a[1] * py + a[2] * pz > CLEARANCE * la * lb * lc:
            return False
        if (
            ux * px + uy * py + uz * pz >= -CLEARANCE * lb * lc
            and ux * qx + uy * qy + uz * qz >= -CLEARANCE * lc * la
            and ux * rx + uy * ry + uz * rz >= -CLEARANCE * la * lb
        ):
            met += 1
    return met == 1
