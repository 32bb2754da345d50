"""How the edges of a locally minimal box follow the vertices that it touches.

The box is an explicit function of the vertices and of one angle: its first side is flush with the edge e1,
its second with the flush edge of the piece, and the angle about e1 is fixed by a third condition: either
the volume is stationary, or a third pair of vertices lies in one side.
"""

import numpy as np

from regolith_studio.coarsening.core.box import log_slope, turned_frame
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel

STEP = 1e-5


@kernel
def contact_points(vertices: FloatArray, contact: IntArray) -> FloatArray:
    """Coordinates of the ten vertices that a row of contacts names, shape (10, 3)."""
    points = np.zeros((10, 3))
    for i in range(10):
        if contact[1 + i] >= 0:
            points[i] = vertices[contact[1 + i]]
    return points


@kernel
def box_of(
    points: FloatArray, slot: int, base: FloatArray, angle: float, frame: FloatArray, extents: FloatArray
) -> float:
    """Fill `frame` and `extents` of the box at `angle` from `base`; residual of the third condition."""
    e0, e1, e2 = points[1, 0] - points[0, 0], points[1, 1] - points[0, 1], points[1, 2] - points[0, 2]
    length = max(1e-300, np.sqrt(e0 * e0 + e1 * e1 + e2 * e2))
    e0, e1, e2 = e0 / length, e1 / length, e2 / length
    along = base[0] * e0 + base[1] * e1 + base[2] * e2
    u = np.array([base[0] - along * e0, base[1] - along * e1, base[2] - along * e2])
    u /= np.sqrt(np.sum(u * u))
    v = np.array([e1 * u[2] - e2 * u[1], e2 * u[0] - e0 * u[2], e0 * u[1] - e1 * u[0]])
    axis = np.cos(angle) * u + np.sin(angle) * v
    edge = points[5] - points[4]
    lever = turned_frame(axis, edge, frame)
    spans = np.empty((3, 3))
    spans[0] = points[2] - points[3]
    spans[1] = points[4] - points[6]
    spans[2] = points[7] - points[8]
    for c in range(3):
        extents[c] = frame[c, 0] * spans[c, 0] + frame[c, 1] * spans[c, 1] + frame[c, 2] * spans[c, 2]
    if slot < 0:
        turn = np.cos(angle) * v - np.sin(angle) * u
        return log_slope(turn, edge, lever, frame, spans, extents)
    c = 0 if slot <= 1 else (1 if slot == 4 else 2)
    return float(np.sum(frame[c] * (points[2 + slot] - points[9])))


@kernel
def settled_angle(points: FloatArray, slot: int, base: FloatArray) -> float:
    """Angle at which the third condition holds, by Newton's method from 0."""
    frame, extents = np.empty((3, 3)), np.empty(3)
    angle = 0.0
    for _ in range(4):
        residual = box_of(points, slot, base, angle, frame, extents)
        more = box_of(points, slot, base, angle + STEP, frame, extents)
        less = box_of(points, slot, base, angle - STEP, frame, extents)
        slope = (more - less) / (2.0 * STEP)
        if abs(slope) < 1e-9:
            return angle
        step = -residual / slope
        if abs(step) > 1e-3:
            return angle
        angle += step
        if abs(step) < 1e-13:
            break
    return angle


@kernel
def extent_forces(
    points: FloatArray, slot: int, base: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Box at rest, and the derivative of its log extents with each contact point.

    Returns
    -------
    frame, extents
        Axes as rows (3, 3), edge lengths along them (3,).
    forces
        d log(extent k) / d(point i), shape (3, 10, 3).
    """
    frame, extents = np.empty((3, 3)), np.empty(3)
    more, less = np.empty(3), np.empty(3)
    angle = settled_angle(points, slot, base)
    up = box_of(points, slot, base, angle + STEP, frame, more)
    down = box_of(points, slot, base, angle - STEP, frame, less)
    stiffness = (up - down) / (2.0 * STEP)
    with_angle = (np.log(more) - np.log(less)) / (2.0 * STEP)
    forces = np.zeros((3, 10, 3))
    for i in range(10):
        if i == 9 and slot < 0:
            continue
        for c in range(3):
            here = points[i, c]
            points[i, c] = here + STEP
            up = box_of(points, slot, base, angle, frame, more)
            points[i, c] = here - STEP
            down = box_of(points, slot, base, angle, frame, less)
            points[i, c] = here
            turn = 0.0
            if abs(stiffness) > 1e-9:
                turn = -(up - down) / (2.0 * STEP) / stiffness
            for k in range(3):
                forces[k, i, c] = (np.log(more[k]) - np.log(less[k])) / (2.0 * STEP) + with_angle[k] * turn
    box_of(points, slot, base, angle, frame, extents)
    return frame, extents, forces
