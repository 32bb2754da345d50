"""How a locally minimal box follows the vertices that it touches, and those their planes."""

import numpy as np

from regolith_studio.coarsening.core.box_contacts import pose_of, solved, tied_axis
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel
from regolith_studio.geometry.vectors import Vector, along, cross, dot, mixed, row

ALIKE = 0.985
"""Cosine of the largest angle between the axes of one box before and after a step."""


@inner_kernel
def extent_forces(points: FloatArray, contact: IntArray, frame: FloatArray, forces: FloatArray) -> Vector:
    """Extents of a box at rest; `forces` takes d log(extent k) / d(vertex i), shape (3, 9, 3).

    The conditions keep holding while vertices move, which says how the box turns. Where they do not fix its
    orientation, it is held. Points (9, 3) are the vertices of the row of contacts, axes the rows of `frame`.
    """
    pose = pose_of(points, contact, frame)
    for k in range(3):
        for i in range(9):
            forces[k, i, 0] = forces[k, i, 1] = forces[k, i, 2] = 0.0
        _add_pair_force(forces, k, 2 * k, 2 * k + 1, pose.axes[k], 1.0 / pose.extents[k])
    one, two, three = pose.conditions
    # Transposed (adjoint): one solution for each extent instead of one for each coordinate of each vertex.
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


@inner_kernel
def _add_pair_force(forces: FloatArray, k: int, far: int, near: int, direction: Vector, size: float) -> None:
    """Pull vertex `far` along a direction and `near` against it."""
    for c in range(3):
        forces[k, far, c] += size * direction[c]
        forces[k, near, c] -= size * direction[c]


@inner_kernel
def update_vertex_ids(
    vertices: FloatArray,
    contact: IntArray,
    frame: FloatArray,
    planes: IntArray,
    owner: IntArray,
    triples: IntArray,
) -> None:
    """Put the corners of the changed polyhedron into a row of contacts.

    In place of one that is gone comes the corner on one of its edges that lies farthest beyond its side.
    """
    for i in range(6 + contact[0]):
        place, side = (1 + i, i) if i < 6 else (8 + 2 * (i - 6), contact[7 + 2 * (i - 6)])
        a, b, c = planes[i, 0], planes[i, 1], planes[i, 2]
        v = owner[a, b]
        found = v >= 0 and (triples[v, 0] == c or triples[v, 1] == c or triples[v, 2] == c)
        if found and not is_touched(contact, side, i, v):
            contact[place] = v
            continue
        axis, highest = row(frame, side // 2), -np.inf
        axis = mixed(axis, 1.0 if side % 2 == 0 else -1.0, axis, 0.0)
        contact[place] = 0
        for k in range(6):
            # Each pair of its planes both ways round: the two ends of the line in which they meet.
            v = owner[planes[i, k % 3], planes[i, (k + 1 + k // 3) % 3]]
            if v >= 0 and along(vertices, v, axis) > highest and not is_touched(contact, side, i, v):
                contact[place], highest = v, along(vertices, v, axis)
    for t in range(contact[0], 3):
        contact[8 + 2 * t] = 0


@inner_kernel
def is_touched(contact: IntArray, side: int, count: int, v: int) -> bool:
    """Whether a vertex is among the first vertices of a row of contacts in a side."""
    touched = count >= 6 and contact[1 + side] == v
    for t in range(count - 6):
        touched = touched or (contact[7 + 2 * t] == side and contact[8 + 2 * t] == v)
    return touched


@inner_kernel
def likeness_of(one: FloatArray, two: FloatArray) -> float:
    """Cosine of the largest angle between the axes of two frames (3, 3), in any order and direction."""
    least = 1.0
    for a in range(3):
        most = 0.0
        for b in range(3):
            dot = one[a, 0] * two[b, 0] + one[a, 1] * two[b, 1] + one[a, 2] * two[b, 2]
            most = max(most, abs(dot))
        least = min(least, most)
    return float(least)
