"""Boxes that are followed while the planes of their polyhedron move."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box_contacts import MAX_TURN, VERTICES, pose_of, walk_to_minimum
from regolith_studio.coarsening.core.box_search import LocalBoxes, is_same_box
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import along, mixed, row

ALIKE = 0.985
"""Cosine of the largest angle between the axes of one box before and after a step."""


class TrackedBoxes(NamedTuple):
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


def select_boxes(boxes: LocalBoxes, chosen: IntArray, triples: IntArray) -> TrackedBoxes:
    """Some of the boxes, by index, of the polyhedron with these corners, shape (v, 3)."""
    contacts = boxes.contacts[chosen]
    return TrackedBoxes(boxes.frames[chosen], contacts, triples[contacts[:, VERTICES]])


def track_boxes(
    vertices: FloatArray, triples: IntArray, n_planes: int, tracked: TrackedBoxes
) -> tuple[LocalBoxes, BoolArray | None]:
    """The tracked boxes on the changed polyhedron, and which of them are lost, shape (k,); ``None`` for none.

    A box is lost if no local minimum is found near by. Where several end at one minimum, the first is kept.
    """
    k = len(tracked.frames)
    volumes, extents = np.empty(k), np.empty((k, 3))
    kept, lost = np.empty(k, dtype=np.bool_), np.empty(k, dtype=np.bool_)
    frames, contacts = tracked.frames.copy(), tracked.contacts.copy()
    owner, points = np.empty((n_planes, n_planes), dtype=np.int64), np.empty((9, 3))
    start = np.empty((3, 3))
    boxes = LocalBoxes(volumes, frames, extents, contacts)
    n_lost, n_kept = _track(vertices, triples, tracked.planes, owner, points, start, boxes, kept, lost)
    return boxes if n_kept == k else boxes.selected(kept), lost if n_lost else None


@kernel_noalloc
def _track(
    vertices: FloatArray,
    triples: IntArray,
    planes: IntArray,
    owner: IntArray,
    points: FloatArray,
    start: FloatArray,
    boxes: LocalBoxes,
    kept: BoolArray,
    lost: BoolArray,
) -> tuple[int, int]:
    """Numbers of lost and of kept boxes; fills the latter. Scratch: `owner` (n, n), `points`, `start`."""
    volumes, frames, extents, contacts = boxes
    owner[:] = -1
    for v in range(len(triples)):
        for k in range(3):
            owner[triples[v, k], triples[v, (k + 1) % 3]] = v
    n_lost, n_kept = 0, 0
    for k in range(len(frames)):
        contact, frame = contacts[k], frames[k]
        update_vertex_ids(vertices, contact, frame, planes[k], owner, triples)
        lost[k] = not walk_to_minimum(vertices, contact, frame, points, start, MAX_TURN)
        for axis in range(3):
            lost[k] = lost[k] or along(frame, axis, row(start, axis)) < ALIKE
        n_lost += lost[k]
        kept[k] = not lost[k]
        if not lost[k]:
            pose = pose_of(points, contact, frame)
            volumes[k] = pose.extents[0] * pose.extents[1] * pose.extents[2]
            extents[k, 0], extents[k, 1], extents[k, 2] = pose.extents
            for i in range(k):
                kept[k] = kept[k] and not (kept[i] and is_same_box(boxes, i, volumes[k], frame))
        n_kept += kept[k]
    return n_lost, n_kept


@kernel_noalloc
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
            v = owner[planes[i, k % 3], planes[i, (k + 1 + k // 3) % 3]]
            if v >= 0 and along(vertices, v, axis) > highest and not is_touched(contact, side, i, v):
                contact[place], highest = v, along(vertices, v, axis)
    for t in range(contact[0], 3):
        contact[8 + 2 * t] = 0


@kernel_noalloc
def is_touched(contact: IntArray, side: int, count: int, v: int) -> bool:
    """Whether a vertex is among the first vertices of a row of contacts in a side."""
    touched = count >= 6 and contact[1 + side] == v
    for t in range(count - 6):
        touched = touched or (contact[7 + 2 * t] == side and contact[8 + 2 * t] == v)
    return touched
