"""Boxes that keep touching the same corners of a polyhedron while its planes move."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box import Solid
from regolith_studio.coarsening.core.box_contacts import at_minimum, pose_of, rested
from regolith_studio.coarsening.core.box_search import Boxes, likeness
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel, kernel_noalloc

FARTHEST = 0.12
"""Boxes that turn by more, in radians, are looked for anew."""
SAME_VOLUME, SAME_FRAME = 1e-6, 1.0 - 1e-9
"""Boxes that differ by less, as shares and by the cosine of the angle between their axes, are one."""


class Watched(NamedTuple):
    """Boxes to be looked for on a polyhedron that has changed, the wanted one first.

    Parameters
    ----------
    frames
        Axes, shape (k, 3, 3).
    contacts
        As in :mod:`regolith_studio.coarsening.core.box_contacts`, shape (k, 13).
    planes
        The three planes that meet in each of the nine vertices of the contacts, shape (k, 9, 3).
    """

    frames: FloatArray
    contacts: IntArray
    planes: IntArray


@kernel
def nothing_watched() -> Watched:
    """No box at all: look everywhere."""
    return Watched(np.empty((0, 3, 3)), np.empty((0, 13), np.int64), np.empty((0, 9, 3), np.int64))


@kernel
def watch(boxes: Boxes, chosen: IntArray, triples: IntArray) -> Watched:
    """Some of the boxes, by index, of the polyhedron with these corners."""
    planes = np.zeros((len(chosen), 9, 3), np.int64)
    for k in range(len(chosen)):
        contact = boxes.contacts[chosen[k]]
        for i in range(6 + contact[0]):
            planes[k, i] = triples[contact[1 + i] if i < 6 else contact[8 + 2 * (i - 6)]]
    return Watched(boxes.frames[chosen], boxes.contacts[chosen], planes)


@kernel
def followed(solid: Solid, triples: IntArray, watched: Watched) -> tuple[Boxes, BoolArray]:
    """The watched boxes on the changed polyhedron, and which of them are lost, shape (k,).

    A box is lost if a corner that it touched is gone, if it cannot rest near by on others, or if a small turn
    would make it smaller.
    """
    total, n = len(watched.frames), len(solid.normals)
    owner = np.full((n, n), -1, np.int64)
    for v in range(len(triples)):
        for k in range(3):
            owner[triples[v, k], triples[v, (k + 1) % 3]] = v
    volumes, extents = np.empty(total), np.empty((total, 3))
    frames, contacts = watched.frames.copy(), watched.contacts.copy()
    points, lost = np.empty((9, 3)), np.full(total, True)
    for k in range(total):
        contact, frame = contacts[k], frames[k]
        if not renamed(contact, watched.planes[k], owner, triples):
            continue
        if not rested(solid.vertices, contact, frame, points, FARTHEST):
            continue
        pose = pose_of(points, contact, frame)
        if not at_minimum(pose, contact):
            continue
        lost[k] = False
        volumes[k] = pose.extents[0] * pose.extents[1] * pose.extents[2]
        for axis in range(3):
            extents[k, axis] = pose.extents[axis]
    found = ~lost
    return Boxes(volumes[found], frames[found], extents[found], contacts[found]), lost


@kernel
def lost_axes(watched: Watched, lost: BoolArray) -> FloatArray:
    """Of each lost box the axis whose sides had the most ties, shape (k, 3), to look near it."""
    at, axes = np.nonzero(lost)[0], np.empty((len(np.nonzero(lost)[0]), 3))
    for i in range(len(at)):
        contact, most, ties = watched.contacts[at[i]], 0, np.zeros(3, np.int64)
        for t in range(contact[0]):
            ties[contact[7 + 2 * t] // 2] += 1
        for axis in range(3):
            most = axis if ties[axis] > ties[most] else most
        axes[i] = watched.frames[at[i], most]
    return axes


@kernel_noalloc
def renamed(contact: IntArray, planes: IntArray, owner: IntArray, triples: IntArray) -> bool:
    """Put the corners of the changed polyhedron into a row of contacts; False where one is gone."""
    for i in range(6 + contact[0]):
        a, b, c = planes[i, 0], planes[i, 1], planes[i, 2]
        v = owner[a, b]
        if v < 0 or (triples[v, 0] != c and triples[v, 1] != c and triples[v, 2] != c):
            return False
        contact[1 + i if i < 6 else 8 + 2 * (i - 6)] = v
    return True


@kernel
def together(some: Boxes, others: Boxes) -> Boxes:
    """Boxes of two lists, each once, the least first."""
    fresh = np.full(len(others.volumes), True)
    for i in range(len(others.volumes)):
        for k in range(len(some.volumes)):
            if abs(some.volumes[k] / others.volumes[i] - 1.0) < SAME_VOLUME:
                fresh[i] = fresh[i] and likeness(some.frames[k], others.frames[i]) < SAME_FRAME
    volumes = np.concatenate((some.volumes, others.volumes[fresh]))
    order = np.argsort(volumes)
    return Boxes(
        volumes[order],
        np.concatenate((some.frames, others.frames[fresh]))[order],
        np.concatenate((some.extents, others.extents[fresh]))[order],
        np.concatenate((some.contacts, others.contacts[fresh]))[order],
    )
