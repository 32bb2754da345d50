"""How the edges of a locally minimal box follow the vertices that it touches, and those the planes."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box_contacts import fill_points, pose_of, solved, tied_axis
from regolith_studio.coarsening.core.plane_coordinates import fill_gradient
from regolith_studio.coarsening.core.polyhedron_measures import MeasuredPolyhedron, add_vertex_charges
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kept_in_thread, kernel_noalloc
from regolith_studio.geometry.vectors import Vector, cross, dot, mixed, row


class GradientWorkspace(NamedTuple):
    """Memory: nine vertices (9, 3) of a box, forces (3, 9, 3) on them, charges (n, 4) of the planes.

    Then logarithms (3,) of the box's edges, and their derivatives (3, 3 n).
    """

    points: FloatArray
    forces: FloatArray
    charges: FloatArray
    logs: FloatArray
    gradients: FloatArray


@kept_in_thread
def gradient_workspace(n: int) -> GradientWorkspace:
    """Memory for n planes."""
    return GradientWorkspace(
        np.empty((9, 3)), np.empty((3, 9, 3)), np.empty((n, 4)), np.empty(3), np.empty((3, 3 * n))
    )


@kernel_noalloc
def fill_extent_gradients(
    polyhedron: MeasuredPolyhedron,
    frame: FloatArray,
    contact: IntArray,
    tangents: FloatArray,
    scales: FloatArray,
    work: GradientWorkspace,
) -> None:
    """Fill logarithms of the edges of a box at rest, and derivatives with the planes' coordinates, in `work`.

    Parameters
    ----------
    frame, contact
        Axes (3, 3), and contacts as in :mod:`regolith_studio.coarsening.core.box_contacts`, (13,).
    tangents, scales
        As in :mod:`regolith_studio.coarsening.core.plane_coordinates`; pivots are the facets' centroids.
    """
    _, normals, _, vertices, triples, _, _, pivots, _, _ = polyhedron
    points, forces, charges, logs, gradients = work
    fill_points(vertices, contact, points)
    extents = extent_forces(points, contact, frame, forces)
    for k in range(3):
        logs[k] = np.log(extents[k])
        charges[:] = 0.0
        for i in range(6 + contact[0]):
            v = contact[1 + i] if i < 6 else contact[8 + 2 * (i - 6)]
            add_vertex_charges(normals, triples, vertices, v, row(forces[k], i), pivots, charges)
        fill_gradient(charges, tangents, scales, gradients[k])


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
        _add_pair_force(forces, k, 2 * k, 2 * k + 1, pose.axes[k], 1.0 / pose.extents[k])
    one, two, three = pose.conditions
    columns = ((one[0], two[0], three[0]), (one[1], two[1], three[1]), (one[2], two[2], three[2]))
    for k in range(3):
        sound, share = solved(columns, pose.slopes[k])
        if contact[0] < 2 or not sound:
            continue
        for t in range(contact[0]):
            _add_pair_force(forces, k, 6 + t, contact[7 + 2 * t], tied_axis(contact, t, frame), -share[t])
        if contact[0] == 3:
            continue
        slope = mixed(mixed(pose.slopes[0], 1.0, pose.slopes[1], 1.0), 1.0, pose.slopes[2], 1.0)
        first = cross(cross(two, slope), tied_axis(contact, 0, frame))
        second = cross(cross(slope, one), tied_axis(contact, 1, frame))
        _add_pair_force(forces, k, 6, contact[7], first, -share[2])
        _add_pair_force(forces, k, 7, contact[9], second, -share[2])
        for axis in range(3):
            across = cross(pose.free, pose.axes[axis])
            across = mixed(across, 1.0, pose.axes[axis], -dot(pose.free, pose.slopes[axis]))
            _add_pair_force(forces, k, 2 * axis, 2 * axis + 1, across, -share[2] / pose.extents[axis])
    return pose.extents


@kernel_noalloc
def _add_pair_force(forces: FloatArray, k: int, far: int, near: int, direction: Vector, size: float) -> None:
    """Pull vertex `far` along a direction and `near` against it."""
    for c in range(3):
        forces[k, far, c] += size * direction[c]
        forces[k, near, c] -= size * direction[c]
