"""Conditions on the descriptors: residuals and their derivatives with the planes."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box_change import extent_forces
from regolith_studio.coarsening.core.box_contacts import fill_points
from regolith_studio.coarsening.core.box_follow import Watched, watch
from regolith_studio.coarsening.core.measures import area_charge, vertex_charge, volume_charge
from regolith_studio.coarsening.core.planes import gradient_of
from regolith_studio.coarsening.exact.problem import (
    LONGEST,
    RATIO,
    SHORTEST,
    SPHERICITY,
    VOLUME,
    Problem,
    Shape,
    log_sphericity,
)
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel

CLEARANCE = 1e-4
"""Other boxes must be larger than the wanted one by this share."""
AIM = 2e-4
"""Where they are not, they are pushed to this share."""
CLOSE = 2e-3
"""Other boxes within this share take part in the steps."""
WATCHED = 6e-3
"""Other boxes within this share are looked for at every step."""
MOST_RIVALS = 8
ALIKE = 0.985
"""Cosine of the largest angle between the axes of the wanted box before and after a step."""


class Conditions(NamedTuple):
    """Residuals of the asked descriptors in logarithms, and how far other boxes are from undercutting.

    Parameters
    ----------
    residual, rows
        Of the m equations, shapes (m,) and (m, 3 n).
    slack, rival_rows
        log(volume / volume of the wanted box) of each other box, and its derivative; (r,) and (r, 3 n).
    watched
        The wanted box and others that are to be looked for; none where no box is asked for.
    sound
        Whether everything could be measured.
    """

    residual: FloatArray
    rows: FloatArray
    slack: FloatArray
    rival_rows: FloatArray
    watched: Watched
    sound: bool


@kernel
def conditions_of(problem: Problem, shape: Shape, frames: FloatArray, levers: FloatArray) -> Conditions:
    """Evaluate all conditions; pivots are the facets' centroids."""
    n = len(shape.offsets)
    residual, rows = np.zeros(5), np.zeros((5, 3 * n))
    slack, rival_rows = np.zeros(MOST_RIVALS), np.zeros((MOST_RIVALS, 3 * n))
    chosen, n_watched = np.empty(1 + MOST_RIVALS, np.int64), 0
    rivals = 0
    sound = True
    if problem.asked[VOLUME] or problem.asked[SPHERICITY]:
        volume = gradient_of(volume_charge(shape.area, shape.centroid, shape.centroid), frames, levers)
        volume /= shape.volume
        residual[VOLUME], rows[VOLUME] = np.log(shape.volume) - problem.wanted[VOLUME], volume
        if problem.asked[SPHERICITY]:
            charge = area_charge(shape.normals, shape.vertices, shape.edges, shape.centroid)
            surface = gradient_of(charge, frames, levers) / shape.surface
            residual[SPHERICITY] = log_sphericity(shape.volume, shape.surface) - problem.wanted[SPHERICITY]
            rows[SPHERICITY] = volume * (2.0 / 3.0) - surface
    if problem.asked[SHORTEST] or problem.asked[LONGEST] or problem.asked[RATIO]:
        if len(shape.boxes.volumes) == 0:
            sound = False
        else:
            at = wanted_box(problem, shape)
            chosen[0], n_watched = at, 1
            own = box_rows(problem, shape, at, frames, levers, residual, rows)
            for b in range(len(shape.boxes.volumes)):
                if b == at or rivals == MOST_RIVALS:
                    continue
                apart = np.log(shape.boxes.volumes[b] / shape.boxes.volumes[at])
                if apart < WATCHED and n_watched <= MOST_RIVALS:
                    chosen[n_watched] = b
                    n_watched += 1
                if apart < CLOSE:
                    slack[rivals] = apart
                    rival_rows[rivals] = volume_row(shape, b, frames, levers) - own
                    rivals += 1
    asked = np.nonzero(problem.asked)[0]
    return Conditions(
        residual[asked],
        rows[asked],
        slack[:rivals].copy(),
        rival_rows[:rivals].copy(),
        watch(shape.boxes, chosen[:n_watched], shape.triples),
        sound,
    )


@kernel
def wanted_box(problem: Problem, shape: Shape) -> int:
    """Index of the box that is to become the least: near the wanted size and not far above the least."""
    least, at = np.inf, 0
    for b in range(len(shape.boxes.volumes)):
        low, high = np.log(shape.boxes.extents[b].min()), np.log(shape.boxes.extents[b].max())
        apart = np.log(shape.boxes.volumes[b] / shape.boxes.volumes[0])
        if problem.asked[SHORTEST]:
            apart += abs(low - problem.wanted[SHORTEST])
        if problem.asked[LONGEST]:
            apart += abs(high - problem.wanted[LONGEST])
        if problem.asked[RATIO]:
            apart += abs(high - low - problem.wanted[RATIO])
        if apart < least:
            at, least = b, apart
    return at


@kernel
def extent_rows(
    shape: Shape, b: int, frames: FloatArray, levers: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Logarithms of the three edges of box b, and their derivatives (3, 3 n)."""
    contact, points, forces = shape.boxes.contacts[b], np.empty((9, 3)), np.empty((3, 9, 3))
    fill_points(shape.vertices, contact, points)
    low, middle, high = extent_forces(points, contact, shape.boxes.frames[b], forces)
    rows = np.empty((3, 3 * len(shape.offsets)))
    for k in range(3):
        charge = np.zeros((len(shape.offsets), 4))
        for i in range(6 + contact[0]):
            v = contact[1 + i] if i < 6 else contact[8 + 2 * (i - 6)]
            vertex_charge(
                shape.normals, shape.triples[v], shape.vertices[v], forces[k, i], shape.centroid, charge
            )
        rows[k] = gradient_of(charge, frames, levers)
    return np.log(np.array([low, middle, high])), rows


@kernel
def box_rows(  # type: ignore[no-untyped-def]
    problem, shape, b, frames, levers, residual, rows
) -> FloatArray:
    """Fill the conditions on the box; the derivative of its log volume."""
    logs, change = extent_rows(shape, b, frames, levers)
    low, high = np.argmin(logs), np.argmax(logs)
    residual[SHORTEST], rows[SHORTEST] = logs[low] - problem.wanted[SHORTEST], change[low]
    residual[LONGEST], rows[LONGEST] = logs[high] - problem.wanted[LONGEST], change[high]
    residual[RATIO] = logs[high] - logs[low] - problem.wanted[RATIO]
    rows[RATIO] = change[high] - change[low]
    return change[0] + change[1] + change[2]  # type: ignore[no-any-return]


@kernel
def volume_row(shape: Shape, b: int, frames: FloatArray, levers: FloatArray) -> FloatArray:
    """Derivative of the log volume of box b."""
    _, change = extent_rows(shape, b, frames, levers)
    return np.asarray(change[0] + change[1] + change[2])
