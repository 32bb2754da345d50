"""Surfaces that cross themselves, and how they are kept from it.

Smoothing does not know how near the other side of a plate or of a tunnel is. Two sides that cross lie close
together: at corners there, one or two voxels inward is outside again, or outward is inside. Only the faces
about such corners, and about those that are turned over, are looked at, which are few or none.
"""

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.self_intersection import crossing_pairs
from regolith_studio.imaging.coverage import coverage

LIGHTLY = 4.0
"""Times the usual pass band: a contour smoothed with so wide a one does not cross itself."""
_LOOKED_AT, _TAKEN_BACK, _ATTEMPTS = 2, 3, 4
"""Rings of faces about doubtful ones that are looked at, rings of corners about crossing faces that go back
to where they were, and how often that is tried."""
_UPRIGHT = 0.2
"""Cosine of the angle to a corner's normal beyond which a face counts as turned over."""


def uncrossed(mesh: Mesh, safe: Mesh) -> Mesh:
    """The mesh with the corners of the safe one, of the same faces, where its faces cross each other.

    Both in voxels. If crossings do not end, or are too many to look through, the safe mesh.
    """
    low, high = np.floor(safe.bounds[0]) - 1.0, np.ceil(safe.bounds[1]) + 1.0
    nx, ny, nz = (int(n) for n in high - low + 1.0)
    inside = coverage(safe.moved(shift=-low), (nx, ny, nz), 1) > 0.5
    for _ in range(_ATTEMPTS):
        normals = corner_normals(mesh.vertices, mesh.faces)
        doubtful = np.zeros(len(mesh.faces), dtype=np.bool_)
        _mark_doubtful(mesh.vertices - low, mesh.faces, normals, inside, doubtful)
        looked_at = _about(mesh.faces, np.flatnonzero(doubtful), len(normals), _LOOKED_AT)
        faces = np.ascontiguousarray(mesh.faces[looked_at[mesh.faces].any(axis=1)])
        found = crossing_pairs(mesh.vertices, faces)
        if found is None:
            break
        if found[0] == 0:
            return mesh
        near = _about(faces, np.flatnonzero(found[1]), len(normals), _TAKEN_BACK)
        mesh = Mesh(np.where(near[:, None], safe.vertices, mesh.vertices), mesh.faces)
    return safe


def _about(faces: IntArray, chosen: IntArray, n_vertices: int, rings: int) -> BoolArray:
    """Corners of the chosen faces, and of the faces about these; shape (n_vertices,)."""
    near = np.zeros(n_vertices, dtype=np.bool_)
    near[faces[chosen]] = True
    for _ in range(rings - 1):
        near[faces[near[faces].any(axis=1)]] = True
    return near


def corner_normals(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Unit normals of the corners: sums of those of the faces about them, weighted by area."""
    total = np.zeros(vertices.shape)
    _add_corner_normals(vertices, faces, total)
    return total


@kernel
def _add_corner_normals(vertices: FloatArray, faces: IntArray, total: FloatArray) -> None:
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for corner in range(3):
            total[faces[face, corner], 0] += x
            total[faces[face, corner], 1] += y
            total[faces[face, corner], 2] += z
    for corner in range(len(vertices)):
        x, y, z = total[corner]
        length = max(np.sqrt(x * x + y * y + z * z), 1e-300)
        total[corner, 0], total[corner, 1], total[corner, 2] = x / length, y / length, z / length


@kernel
def _mark_doubtful(
    vertices: FloatArray, faces: IntArray, normals: FloatArray, inside: BoolArray, doubtful: BoolArray
) -> None:
    """Mark faces with another side of the surface within two voxels of a corner, or turned over, (m,)."""
    nx, ny, nz = inside.shape
    thin = np.zeros(len(vertices), dtype=np.bool_)
    for corner in range(len(vertices)):
        for away in (-2.0, -1.0, 1.0, 2.0):
            i = int(np.rint(vertices[corner, 0] + away * normals[corner, 0]))
            j = int(np.rint(vertices[corner, 1] + away * normals[corner, 1]))
            k = int(np.rint(vertices[corner, 2] + away * normals[corner, 2]))
            deep = 0 <= i < nx and 0 <= j < ny and 0 <= k < nz and inside[i, j, k]
            thin[corner] = thin[corner] or deep != (away < 0.0)
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        least = _UPRIGHT * np.sqrt(x * x + y * y + z * z)
        for side in range(3):
            corner = faces[face, side]
            along = x * normals[corner, 0] + y * normals[corner, 1] + z * normals[corner, 2]
            doubtful[face] = doubtful[face] or thin[corner] or along < least
