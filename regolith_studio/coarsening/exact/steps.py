"""Steps of the exact method as Python functions: compiled kernels fill arrays, which are made here."""

import numpy as np

from regolith_studio.coarsening.core.box_follow import Watched
from regolith_studio.coarsening.core.box_search import Boxes
from regolith_studio.coarsening.core.planes import carried, gradient_of, levers_of, moved
from regolith_studio.coarsening.exact import descent, polish
from regolith_studio.coarsening.exact.conditions import Conditions
from regolith_studio.coarsening.exact.descent import State, descend, objective_at
from regolith_studio.coarsening.exact.memory import PointMemory, memory_for, point_in, store_point
from regolith_studio.coarsening.exact.polish import LEAST_LEVER, Polished
from regolith_studio.coarsening.exact.problem import Problem, Shape
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel

NOWHERE = Watched(np.empty((0, 3, 3)), np.empty((0, 13), dtype=np.int64), np.empty((0, 9, 3), dtype=np.int64))
_NO_BOXES = Boxes(np.empty(0), np.empty((0, 3, 3)), np.empty((0, 3)), np.empty((0, 13), dtype=np.int64))
_NO_METRIC = np.empty((0, 0))


def measured(
    problem: Problem, normals: FloatArray, offsets: FloatArray, frames: FloatArray, near: Watched
) -> Polished:
    """Shape and conditions of half-spaces; boxes are those of `near` if they are still there, else all."""
    n = len(offsets)
    nothing, no_edges = np.empty((0, 3)), np.empty((0, 4), dtype=np.int64)
    no_triples = np.empty((0, 3), dtype=np.int64)
    shape = Shape(
        0, normals, offsets, nothing, no_triples, no_edges, np.empty(n), normals, 0.0, 0.0, _NO_BOXES
    )
    conditions = Conditions(np.empty(0), np.empty((0, 0)), np.empty(0), np.empty((0, 0)), near, False)
    memory = memory_for(n)
    _solve(problem, Polished(np.inf, shape, conditions, frames), True, _NO_METRIC, 0, False, 0.0, 0.0, memory)
    return point_in(memory)


def polished(
    problem: Problem, point: Polished, metric: FloatArray, iterations: int, tolerance: float, cap: float
) -> Polished:
    """See :func:`regolith_studio.coarsening.exact.polish.polished`."""
    memory = memory_for(len(point.shape.offsets))
    _solve(problem, point, False, metric, iterations, False, tolerance, cap, memory)
    return point_in(memory)


def verified(
    problem: Problem, point: Polished, metric: FloatArray, iterations: int, tolerance: float, cap: float
) -> Polished:
    """See :func:`regolith_studio.coarsening.exact.polish.verified`."""
    memory = memory_for(len(point.shape.offsets))
    _solve(problem, point, False, metric, iterations, True, tolerance, cap, memory)
    return point_in(memory)


@kernel
def _solve(
    problem: Problem,
    point: Polished,
    afresh: bool,
    metric: FloatArray,
    iterations: int,
    check: bool,
    tolerance: float,
    cap: float,
    memory: PointMemory,
) -> None:
    """One kernel for three steps: numba would compile what they share once for each.

    Parameters
    ----------
    afresh
        Whether only to measure the half-spaces of `point`.
    check
        Whether to search for boxes everywhere at the end.
    """
    if afresh:
        shape, near = point.shape, point.conditions.watched
        point = polish.measured(problem, shape.normals, shape.offsets, point.frames, near)
    elif check:
        point = polish.verified(problem, point, metric, iterations, tolerance, cap)
    else:
        point = polish.polished(problem, point, metric, iterations, tolerance, cap)
    store_point(point, memory)


def started(problem: Problem, point: Polished, goal: int, radius: float) -> State:
    """A descent from a polyhedron on which all conditions hold."""
    gradient = objective_gradient(problem, point.shape, point.frames, goal)
    value = objective_at(problem, point.shape, goal)
    return State(point, value, gradient, first_metric(problem, point.shape), float(radius), False, 0)


def descended(problem: Problem, state: State, goal: int, iterations: int, polish_steps: int) -> State:
    """At most `iterations` more steps of the descent; the polyhedron returned meets all conditions."""
    memory, numbers = memory_for(len(state.point.shape.offsets)), np.empty(4)
    gradient, metric = np.empty_like(state.gradient), np.empty_like(state.metric)
    descend(problem, state, goal, iterations, polish_steps, memory, numbers, gradient, metric)
    value, radius, done, spent = numbers.tolist()
    return State(point_in(memory), value, gradient, metric, radius, bool(done), int(spent))


def first_metric(problem: Problem, shape: Shape) -> FloatArray:
    """A diagonal guess of the inverse second derivative: large facets resist."""
    metric = np.zeros((3 * len(shape.offsets), 3 * len(shape.offsets)))
    descent.fill_first_metric(problem, shape, metric)
    return metric


def steady_metric(problem: Problem, shape: Shape) -> FloatArray:
    """A diagonal metric in which small facets hold still."""
    diagonal = np.repeat(np.maximum(shape.area / (shape.surface / len(shape.area)), 1e-3), 3)
    diagonal[: 3 * problem.held] = 0.0
    return np.diag(diagonal)


def objective_gradient(problem: Problem, shape: Shape, frames: FloatArray, goal: int) -> FloatArray:
    """Derivative of the objective with the coordinates of all planes, shape (3 n,)."""
    gradient = np.empty(3 * len(shape.offsets))
    _fill_gradient(problem, shape, frames, goal, gradient)
    return gradient


@kernel
def _fill_gradient(
    problem: Problem, shape: Shape, frames: FloatArray, goal: int, gradient: FloatArray
) -> None:
    gradient[:] = descent.objective_gradient(problem, shape, frames, goal)


def tangent_step(
    conditions: Conditions, gradient: FloatArray, metric: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """See :func:`regolith_studio.coarsening.exact.descent.tangent_step`."""
    step, shadow = np.empty_like(gradient), np.empty_like(gradient)
    _fill_step(conditions, gradient, metric, step, shadow)
    return step, shadow


@kernel
def _fill_step(
    conditions: Conditions, gradient: FloatArray, metric: FloatArray, step: FloatArray, shadow: FloatArray
) -> None:
    along, across = descent.tangent_step(conditions, gradient, metric)
    step[:], shadow[:] = along, across


def learned(metric: FloatArray, step: FloatArray, change: FloatArray) -> FloatArray:
    """See :func:`regolith_studio.coarsening.exact.descent.learned`."""
    updated = np.empty_like(metric)
    _fill_learned(metric, step, change, updated)
    return updated


@kernel
def _fill_learned(metric: FloatArray, step: FloatArray, change: FloatArray, updated: FloatArray) -> None:
    updated[:] = descent.learned(metric, step, change)


def after_step(point: Polished, step: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Normals, offsets and tangents after a step in the coordinates of every plane, shape (3 n,)."""
    n = len(point.shape.offsets)
    normals, offsets, frames = np.empty((n, 3)), np.empty(n), np.empty((n, 2, 3))
    _fill_after_step(point.shape, point.frames, step, normals, offsets, frames)
    return normals, offsets, frames


@kernel
def _fill_after_step(
    shape: Shape,
    tangents: FloatArray,
    step: FloatArray,
    normals: FloatArray,
    offsets: FloatArray,
    frames: FloatArray,
) -> None:
    levers = levers_of(shape.area, LEAST_LEVER)
    turned, shifted = moved(shape.normals, shape.centroid, shape.offsets, tangents, levers, step)
    normals[:], offsets[:], frames[:] = turned, shifted, carried(tangents, turned)


@kernel
def slope_of_charge(shape: Shape, frames: FloatArray, charge: FloatArray, slope: FloatArray) -> None:
    """Fill the derivative with the coordinates of every plane, shape (3 n,), from charges (n, 4)."""
    slope[:] = gradient_of(charge, frames, levers_of(shape.area, LEAST_LEVER))
