"""Arrays that a compiled step of the exact method fills with the polyhedron where it ended."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box_contacts import ROW
from regolith_studio.coarsening.core.box_follow import Watched
from regolith_studio.coarsening.core.box_search import MOST, Boxes
from regolith_studio.coarsening.exact.conditions import MOST_RIVALS, Conditions
from regolith_studio.coarsening.exact.polish import Polished
from regolith_studio.coarsening.exact.problem import Shape
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel

STATUS, VERTICES, EDGES, BOXES, CONDITIONS, RIVALS, WATCHED, SOUND = range(8)
"""Places in the counts."""
WORST, VOLUME, SURFACE = range(3)
"""Places in the numbers."""
MOST_WATCHED = 1 + MOST_RIVALS


class PointMemory(NamedTuple):
    """Everything of a :class:`Polished` polyhedron with n half-spaces, in arrays of the largest size.

    Parameters
    ----------
    counts, numbers
        How much of the arrays is filled, with the status; and the single numbers: shapes (8,) and (3,).
    normals, offsets, vertices, triples, edges, area, centroid
        Of the shape, (n, 3), (n,), (2 n, 3), (2 n, 3), (3 n, 4), (n,) and (n, 3).
    boxes, residual, rows, slack, rival_rows, watched
        Its boxes, and what belongs to the conditions.
    frames
        Tangents, shape (n, 2, 3).
    """

    counts: IntArray
    numbers: FloatArray
    normals: FloatArray
    offsets: FloatArray
    vertices: FloatArray
    triples: IntArray
    edges: IntArray
    area: FloatArray
    centroid: FloatArray
    boxes: Boxes
    residual: FloatArray
    rows: FloatArray
    slack: FloatArray
    rival_rows: FloatArray
    watched: Watched
    frames: FloatArray


def memory_for(n: int) -> PointMemory:
    """Memory for n half-spaces."""
    most = MOST + MOST_WATCHED
    return PointMemory(
        np.zeros(8, dtype=np.int64),
        np.empty(3),
        np.empty((n, 3)),
        np.empty(n),
        np.empty((2 * n, 3)),
        np.empty((2 * n, 3), dtype=np.int64),
        np.empty((3 * n, 4), dtype=np.int64),
        np.empty(n),
        np.empty((n, 3)),
        Boxes(
            np.empty(most),
            np.empty((most, 3, 3)),
            np.empty((most, 3)),
            np.empty((most, ROW), dtype=np.int64),
        ),
        np.empty(5),
        np.empty((5, 3 * n)),
        np.empty(MOST_RIVALS),
        np.empty((MOST_RIVALS, 3 * n)),
        Watched(
            np.empty((MOST_WATCHED, 3, 3)),
            np.empty((MOST_WATCHED, ROW), dtype=np.int64),
            np.empty((MOST_WATCHED, 9, 3), dtype=np.int64),
        ),
        np.empty((n, 2, 3)),
    )


@kernel
def store_point(point: Polished, memory: PointMemory) -> None:
    """Fill the memory."""
    shape, conditions, counts = point.shape, point.conditions, memory.counts
    v, e, b = len(shape.vertices), len(shape.edges), len(shape.boxes.volumes)
    m, r, w = len(conditions.residual), len(conditions.slack), len(conditions.watched.frames)
    counts[STATUS], counts[SOUND] = shape.status, 1 if conditions.sound else 0
    counts[VERTICES], counts[EDGES], counts[BOXES] = v, e, b
    counts[CONDITIONS], counts[RIVALS], counts[WATCHED] = m, r, w
    memory.numbers[WORST] = point.worst
    memory.numbers[VOLUME], memory.numbers[SURFACE] = shape.volume, shape.surface
    memory.normals[:], memory.offsets[:] = shape.normals, shape.offsets
    memory.vertices[:v], memory.triples[:v], memory.edges[:e] = shape.vertices, shape.triples, shape.edges
    memory.area[:], memory.centroid[:], memory.frames[:] = shape.area, shape.centroid, point.frames
    memory.boxes.volumes[:b], memory.boxes.frames[:b] = shape.boxes.volumes, shape.boxes.frames
    memory.boxes.extents[:b], memory.boxes.contacts[:b] = shape.boxes.extents, shape.boxes.contacts
    memory.residual[:m], memory.slack[:r] = conditions.residual, conditions.slack
    if m > 0:
        memory.rows[:m] = conditions.rows
    if r > 0:
        memory.rival_rows[:r] = conditions.rival_rows
    memory.watched.frames[:w] = conditions.watched.frames
    memory.watched.contacts[:w] = conditions.watched.contacts
    memory.watched.planes[:w] = conditions.watched.planes


def point_in(memory: PointMemory) -> Polished:
    """What the memory holds, not copied."""
    status, v, e, b, m, r, w, sound = memory.counts.tolist()
    worst, volume, surface = memory.numbers.tolist()
    boxes, followed = memory.boxes, memory.watched
    shape = Shape(
        status,
        memory.normals,
        memory.offsets,
        memory.vertices[:v],
        memory.triples[:v],
        memory.edges[:e],
        memory.area,
        memory.centroid,
        volume,
        surface,
        Boxes(boxes.volumes[:b], boxes.frames[:b], boxes.extents[:b], boxes.contacts[:b]),
    )
    watched = Watched(followed.frames[:w], followed.contacts[:w], followed.planes[:w])
    conditions = Conditions(
        memory.residual[:m], memory.rows[:m], memory.slack[:r], memory.rival_rows[:r], watched, bool(sound)
    )
    return Polished(worst, shape, conditions, memory.frames)
