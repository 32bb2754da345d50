"""How the edges of a locally minimal box follow the vertices that it touches."""

from regolith_studio.coarsening.core.box_contacts import pose_of, solved, tied_axis
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import Vector, cross, dot, mixed

FORCES = (3, 9, 3)
"""Shape of the forces: edge, vertex of the row of contacts, coordinate."""


@kernel_noalloc
def extent_forces(points: FloatArray, contact: IntArray, frame: FloatArray, forces: FloatArray) -> Vector:
    """Extents of a box at rest; `forces` takes d log(extent k) / d(vertex i), shape (3, 9, 3).

    The conditions keep holding while vertices move, which says how the box turns. Where they do not fix its
    orientation, it is held.

    Parameters
    ----------
    points
        Vertices of the row of contacts, shape (9, 3).
    frame
        Axes, one a row.
    """
    pose = pose_of(points, contact, frame)
    for k in range(3):
        for i in range(9):
            forces[k, i, 0] = forces[k, i, 1] = forces[k, i, 2] = 0.0
        pull(forces, k, 2 * k, 2 * k + 1, pose.axes[k], 1.0 / pose.extents[k])
    one, two, three = pose.conditions
    columns = ((one[0], two[0], three[0]), (one[1], two[1], three[1]), (one[2], two[2], three[2]))
    for k in range(3):
        sound, share = solved(columns, pose.slopes[k])
        if contact[0] < 2 or not sound:
            continue
        for t in range(contact[0]):
            pull(forces, k, 6 + t, contact[7 + 2 * t], tied_axis(contact, t, frame), -share[t])
        if contact[0] == 3:
            continue
        slope = mixed(mixed(pose.slopes[0], 1.0, pose.slopes[1], 1.0), 1.0, pose.slopes[2], 1.0)
        first = cross(cross(two, slope), tied_axis(contact, 0, frame))
        second = cross(cross(slope, one), tied_axis(contact, 1, frame))
        pull(forces, k, 6, contact[7], first, -share[2])
        pull(forces, k, 7, contact[9], second, -share[2])
        for axis in range(3):
            across = cross(pose.free, pose.axes[axis])
            across = mixed(across, 1.0, pose.axes[axis], -dot(pose.free, pose.slopes[axis]))
            pull(forces, k, 2 * axis, 2 * axis + 1, across, -share[2] / pose.extents[axis])
    return pose.extents


@kernel_noalloc
def pull(forces: FloatArray, k: int, far: int, near: int, direction: Vector, size: float) -> None:
    """Pull vertex `far` along a direction and `near` against it."""
    for c in range(3):
        forces[k, far, c] += size * direction[c]
        forces[k, near, c] -= size * direction[c]
