"""How the edges of a locally minimal box follow the vertices that it touches.

The box is an explicit function of the vertices and of one angle: its first side is flush with the edge e1,
its second with the flush edge of the piece, and the angle about e1 is fixed by a third condition: either
the volume is stationary, or a third pair of vertices lies in one side.
"""

import numpy as np

from regolith_studio.coarsening.core.box import from_to, log_slope, turned_frame
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel, leaf
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed

STEP = 1e-5


@kernel
def contact_points(vertices: FloatArray, contact: IntArray) -> FloatArray:
    """Coordinates of the ten vertices that a row of contacts names, shape (10, 3)."""
    points = np.zeros((10, 3))
    for i in range(10):
        if contact[1 + i] >= 0:
            points[i] = vertices[contact[1 + i]]
    return points


@leaf
def basis(points: FloatArray, base: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors across the edge of the first side, the first near `base`."""
    edge = from_to(points, 0, 1)
    edge = mixed(edge, 1.0 / max(1e-300, length(edge)), edge, 0.0)
    first = mixed(base, 1.0, edge, -dot(base, edge))
    first = mixed(first, 1.0 / length(first), first, 0.0)
    return first, cross(edge, first)


@leaf
def box_of(points: FloatArray, slot: int, base: Vector, angle: float) -> tuple[float, Vector]:
    """Residual of the third condition and extents of the box at `angle` from `base`."""
    first, across = basis(points, base)
    axis = mixed(first, np.cos(angle), across, np.sin(angle))
    edge = from_to(points, 4, 5)
    lever, second, third = turned_frame(axis, edge)
    spans = (from_to(points, 3, 2), from_to(points, 6, 4), from_to(points, 8, 7))
    extents = (dot(axis, spans[0]), dot(second, spans[1]), dot(third, spans[2]))
    if slot < 0:
        turn = mixed(across, np.cos(angle), first, -np.sin(angle))
        return log_slope(turn, edge, lever, axis, second, spans, extents), extents
    apart = from_to(points, 9, 2 + slot)
    residual = dot(axis, apart) if slot <= 1 else (dot(second, apart) if slot == 4 else dot(third, apart))
    return residual, extents


@leaf
def settled_angle(points: FloatArray, slot: int, base: Vector) -> float:
    """Angle at which the third condition holds, by Newton's method from 0."""
    angle = 0.0
    for _ in range(4):
        residual, _ = box_of(points, slot, base, angle)
        more, _ = box_of(points, slot, base, angle + STEP)
        less, _ = box_of(points, slot, base, angle - STEP)
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


@leaf
def extent_forces(points: FloatArray, slot: int, base: Vector, forces: FloatArray) -> Vector:
    """Extents of the box at rest; `forces` takes d log(extent k) / d(point i), shape (3, 10, 3).

    `points` is restored to rounding.
    """
    angle = settled_angle(points, slot, base)
    up, more = box_of(points, slot, base, angle + STEP)
    down, less = box_of(points, slot, base, angle - STEP)
    stiffness = (up - down) / (2.0 * STEP)
    with_angle = log_change(more, less)
    for i in range(10):
        for c in range(3):
            if i == 9 and slot < 0:
                forces[0, i, c] = forces[1, i, c] = forces[2, i, c] = 0.0
                continue
            here = points[i, c]
            points[i, c] = here + STEP
            up, more = box_of(points, slot, base, angle)
            points[i, c] = here - STEP
            down, less = box_of(points, slot, base, angle)
            points[i, c] = here
            turn = 0.0
            if abs(stiffness) > 1e-9:
                turn = -(up - down) / (2.0 * STEP) / stiffness
            change = log_change(more, less)
            for k in range(3):
                forces[k, i, c] = change[k] + with_angle[k] * turn
    _, extents = box_of(points, slot, base, angle)
    return extents


@leaf
def log_change(more: Vector, less: Vector) -> Vector:
    """Derivative of the logarithms of three extents from a step to either side.

    2 (m - l) / (m + l) is the difference of the logarithms to the order of the cube of their difference.
    """
    return (
        (more[0] - less[0]) / (more[0] + less[0]) / STEP,
        (more[1] - less[1]) / (more[1] + less[1]) / STEP,
        (more[2] - less[2]) / (more[2] + less[2]) / STEP,
    )
