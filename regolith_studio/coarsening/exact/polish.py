"""Return to the conditions by Gauss-Newton steps."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box_follow import Watched, nothing_watched
from regolith_studio.coarsening.core.box_search import likeness
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.planes import carried, levers_of, moved
from regolith_studio.coarsening.exact.conditions import AIM, ALIKE, CLEARANCE, Conditions, conditions_of
from regolith_studio.coarsening.exact.problem import Problem, Shape, needs_box, shape_of
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel

LEAST_LEVER = 0.08
"""Smallest lever of a tilt, in units of the particle's size (the cube root of its volume)."""


class Polished(NamedTuple):
    """Where the Gauss-Newton steps ended.

    Parameters
    ----------
    worst
        Largest residual; infinite where the polyhedron broke.
    shape, conditions
        There.
    frames
        Tangents of the planes, carried along.
    """

    worst: float
    shape: Shape
    conditions: Conditions
    frames: FloatArray


@kernel
def worst_of(conditions: Conditions) -> float:
    """Largest absolute residual, counting boxes that undercut the wanted one."""
    if not conditions.sound:
        return np.inf
    worst = 0.0
    for value in conditions.residual:
        worst = max(worst, abs(value))
    for value in conditions.slack:
        worst = max(worst, CLEARANCE - value)
    return worst


@kernel
def correction(conditions: Conditions, metric: FloatArray) -> FloatArray:
    """The step that removes the residuals to first order, least in the inverse of `metric` (3 n, 3 n)."""
    m = len(conditions.residual)
    active = np.nonzero(conditions.slack < CLEARANCE)[0]
    rows = np.empty((m + len(active), conditions.rows.shape[1]))
    right = np.empty(m + len(active))
    rows[:m], right[:m] = conditions.rows, -conditions.residual
    for k in range(len(active)):
        rows[m + k] = conditions.rival_rows[active[k]]
        right[m + k] = AIM - conditions.slack[active[k]]
    across = metric @ rows.T
    return across @ solved(rows @ across, right)


@kernel
def solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solution of a symmetric system that may be nearly singular; NaN where it is broken."""
    k = len(right)
    if k == 0:
        return right.copy()
    if not (np.isfinite(matrix).all() and np.isfinite(right).all()):
        return np.full(k, np.nan)
    lift = 1e-13 * np.trace(matrix) / k
    lifted = matrix.copy()
    for i in range(k):
        lifted[i, i] += lift + 1e-300
    return np.asarray(np.linalg.solve(lifted, right), dtype=np.float64)


@kernel
def measured(
    problem: Problem, normals: FloatArray, offsets: FloatArray, frames: FloatArray, near: Watched
) -> Polished:
    """Shape and conditions of half-spaces; boxes are those of `near` if they are still there, else all."""
    shape = shape_of(problem, normals, offsets, near)
    if shape.status != FINE:
        nothing = np.zeros((0, 0))
        void = Conditions(np.zeros(0), nothing, np.zeros(0), nothing, near, False)
        return Polished(np.inf, shape, void, frames)
    if len(near.frames) > 0 and needs_box(problem):
        like = 0.0
        for b in range(len(shape.boxes.volumes)):
            like = max(like, likeness(near.frames[0], shape.boxes.frames[b]))
        if like < ALIKE:
            shape = shape_of(problem, normals, offsets, nothing_watched())
    conditions = conditions_of(problem, shape, frames, levers_of(shape.area, LEAST_LEVER))
    return Polished(worst_of(conditions), shape, conditions, frames)


@kernel
def everywhere(problem: Problem, point: Polished) -> Polished:
    """The same polyhedron with boxes looked for everywhere."""
    if not needs_box(problem) or point.shape.status != FINE:
        return point
    shape = shape_of(problem, point.shape.normals, point.shape.offsets, nothing_watched())
    levers = levers_of(shape.area, LEAST_LEVER)
    conditions = conditions_of(problem, shape, point.frames, levers)
    return Polished(worst_of(conditions), shape, conditions, point.frames)


@kernel
def nearer(problem: Problem, point: Polished, metric: FloatArray, cap: float) -> tuple[bool, Polished]:
    """One Gauss-Newton step no longer than `cap`, shortened until the residuals do not grow much."""
    step = correction(point.conditions, metric)
    length = np.abs(step).max()
    if not np.isfinite(length):
        return False, point
    shape = point.shape
    levers = levers_of(shape.area, LEAST_LEVER)
    share = min(1.0, cap / length) if length > 0.0 else 1.0
    for _ in range(5):
        normals, offsets = moved(
            shape.normals, shape.centroid, shape.offsets, point.frames, levers, share * step
        )
        if offsets.min() > 0.0:
            then = measured(
                problem, normals, offsets, carried(point.frames, normals), point.conditions.watched
            )
            if then.worst < max(1.5 * point.worst, 1e-6):
                return True, then
        share *= 0.4
    return False, point


@kernel
def polished(
    problem: Problem, point: Polished, metric: FloatArray, iterations: int, tolerance: float, cap: float
) -> Polished:
    """At most `iterations` Gauss-Newton steps until all residuals are below `tolerance`.

    Parameters
    ----------
    metric
        Shape (3 n, 3 n): steps are least in its inverse.
    cap
        Longest step.
    """
    for _ in range(iterations):
        if point.worst < tolerance or point.worst == np.inf:
            break
        fine, then = nearer(problem, point, metric, cap)
        if not fine:
            break
        point = then
    return point


@kernel
def verified(
    problem: Problem, point: Polished, metric: FloatArray, iterations: int, tolerance: float, cap: float
) -> Polished:
    """As :func:`polished`, but the result has been searched for boxes everywhere."""
    point = everywhere(problem, polished(problem, point, metric, iterations, tolerance, cap))
    for _ in range(4):
        if point.worst < tolerance or point.worst == np.inf:
            break
        then = polished(problem, point, metric, iterations, tolerance, cap)
        if then.worst > tolerance:
            return then
        point = everywhere(problem, then)
    return point
