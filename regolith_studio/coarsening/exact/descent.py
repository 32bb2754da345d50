"""Descent of the Jaccard distance along the surface on which all conditions hold."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.measures import area_charge, volume_charge
from regolith_studio.coarsening.core.overlap import jaccard, shared_charge
from regolith_studio.coarsening.core.planes import carried, gradient_of, levers_of, moved
from regolith_studio.coarsening.exact.conditions import AIM, Conditions
from regolith_studio.coarsening.exact.memory import PointMemory, store_point
from regolith_studio.coarsening.exact.polish import (
    LEAST_LEVER,
    Polished,
    measured,
    polished,
    solved,
    verified,
)
from regolith_studio.coarsening.exact.problem import Problem, Shape, shared_with
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel

OVERLAP, SMOOTHER, ROUGHER = 0, 1, 2
"""Objectives: the Jaccard distance, less surface, more surface."""
TOLERANCE = 3e-8
"""Largest residual of a polyhedron that counts as exact."""
SHORTEST_STEP = 2e-4
CURVATURE = 0.1
UNCHECKED = 4
"""Steps between two searches for boxes everywhere."""
REACH = 0.4
"""Longest step of a polish times the square root of the number of planes: facets shrink as n grows."""


class State(NamedTuple):
    """Where a descent stands; it can go on from here.

    Parameters
    ----------
    point
        Polyhedron, conditions and tangents; all conditions hold.
    value
        Objective there.
    gradient
        Of the objective, shape (3 n,).
    metric
        Approximate inverse of the Lagrangian's second derivative, shape (3 n, 3 n).
    radius
        Largest step.
    done
        Whether no better polyhedron is near.
    iterations
        Spent so far.
    """

    point: Polished
    value: float
    gradient: FloatArray
    metric: FloatArray
    radius: float
    done: bool
    iterations: int


@kernel
def objective_at(problem: Problem, shape: Shape, goal: int) -> float:
    """Value of the objective."""
    if goal == OVERLAP:
        k = len(problem.directions)
        radius, plane = np.empty(k), np.empty(k, np.int64)
        shared = shared_with(problem, shape.normals, shape.offsets, radius, plane)
        return jaccard(shared, 1.0, shape.volume)
    return shape.surface if goal == SMOOTHER else -shape.surface


@kernel
def objective_gradient(problem: Problem, shape: Shape, frames: FloatArray, goal: int) -> FloatArray:
    """Its derivative with the coordinates of all planes, pivots in the facets' centroids, shape (3 n,)."""
    levers = levers_of(shape.area, LEAST_LEVER)
    if goal != OVERLAP:
        charge = area_charge(shape.normals, shape.vertices, shape.edges, shape.centroid)
        slope = gradient_of(charge, frames, levers)
        return slope if goal == SMOOTHER else -slope
    k = len(problem.directions)
    radius, plane = np.empty(k), np.empty(k, np.int64)
    shared = shared_with(problem, shape.normals, shape.offsets, radius, plane)
    charge = shared_charge(
        problem.directions,
        problem.first,
        problem.distance,
        problem.sign,
        problem.weight,
        shape.offsets,
        radius,
        plane,
        shape.centroid,
    )
    union = 1.0 + shape.volume - shared
    of_shared = -(union + shared) / union**2
    of_volume = shared / union**2
    whole = volume_charge(shape.area, shape.centroid, shape.centroid)
    return gradient_of(of_shared * charge + of_volume * whole, frames, levers)


@kernel
def first_metric(problem: Problem, shape: Shape) -> FloatArray:
    """A diagonal guess of the inverse second derivative: large facets resist."""
    metric = np.zeros((3 * len(shape.offsets), 3 * len(shape.offsets)))
    fill_first_metric(problem, shape, metric)
    return metric


@kernel
def fill_first_metric(problem: Problem, shape: Shape, metric: FloatArray) -> None:
    """Fill the diagonal of :func:`first_metric`."""
    n = len(shape.offsets)
    mean = shape.surface / n
    for i in range(problem.held, n):
        area = max(shape.area[i], 0.3 * mean)
        metric[3 * i, 3 * i] = CURVATURE / area
        metric[3 * i + 1, 3 * i + 1] = 3.0 * CURVATURE / area
        metric[3 * i + 2, 3 * i + 2] = 3.0 * CURVATURE / area


@kernel
def tangent_step(
    conditions: Conditions, gradient: FloatArray, metric: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Newton step along the conditions, and the gradient of the Lagrangian.

    Other boxes that the step would bring below the wanted one are held where they are.
    """
    m, r = len(conditions.residual), len(conditions.slack)
    rows = np.empty((m + r, len(gradient)))
    rows[:m] = conditions.rows
    held = m
    step = projected(rows[:held], gradient, metric)
    for k in range(r):
        if conditions.slack[k] + np.sum(conditions.rival_rows[k] * step) < AIM:
            rows[held] = conditions.rival_rows[k]
            held += 1
    if held > m:
        step = projected(rows[:held], gradient, metric)
    across = rows[:held] @ rows[:held].T
    shadow = gradient - rows[:held].T @ solved(across, rows[:held] @ gradient)
    return step, shadow


@kernel
def projected(rows: FloatArray, gradient: FloatArray, metric: FloatArray) -> FloatArray:
    """-H g + H J' (J H J')^-1 J H g."""
    down = metric @ gradient
    if len(rows) == 0:
        return -down
    across = metric @ rows.T
    return across @ solved(rows @ across, rows @ down) - down


@kernel
def learned(metric: FloatArray, step: FloatArray, change: FloatArray) -> FloatArray:
    """BFGS update of the inverse second derivative; skipped where the curvature is not positive."""
    product = np.sum(step * change)
    if product <= 1e-3 * np.sqrt(np.sum(step * step) * np.sum(change * change)):
        return metric
    carriedover = metric @ change
    scale = (1.0 + np.sum(change * carriedover) / product) / product
    n = len(step)
    updated = metric.copy()
    for i in range(n):
        for j in range(n):
            updated[i, j] += (
                scale * step[i] * step[j] - (carriedover[i] * step[j] + step[i] * carriedover[j]) / product
            )
    return updated


@kernel
def checked(problem: Problem, state: State, goal: int, polish_steps: int, cap: float) -> State:
    """The state, searched for boxes everywhere and polished again where that found a smaller one."""
    point = verified(problem, state.point, state.metric, polish_steps, TOLERANCE, cap)
    if not point.worst < TOLERANCE:
        return State(point, np.inf, state.gradient, state.metric, state.radius, True, state.iterations)
    value = objective_at(problem, point.shape, goal)
    gradient = objective_gradient(problem, point.shape, point.frames, goal)
    return State(point, value, gradient, state.metric, state.radius, state.done, state.iterations)


@kernel
def descend(
    problem: Problem,
    state: State,
    goal: int,
    iterations: int,
    polish_steps: int,
    memory: PointMemory,
    numbers: FloatArray,
    gradient: FloatArray,
    metric: FloatArray,
) -> None:
    """At most `iterations` more steps of the descent; the polyhedron where it ends meets all conditions.

    Boxes are looked for everywhere after every few steps only. Where one has come in between that cannot be
    pushed away again without loss, these steps are taken back, and from then on each is checked.

    Parameters
    ----------
    memory, numbers, gradient, metric
        Filled with the new state: the point; value, radius, 1 if done, iterations; and the others, shapes
        (4,), (3 n,) and (3 n, 3 n).
    """
    cap = REACH / np.sqrt(len(state.point.shape.offsets))
    safe, unchecked, patience, failures = state, 0, UNCHECKED, 0
    for _ in range(iterations):
        if state.done:
            break
        better, state = stepped(problem, state, goal, polish_steps, cap)
        failures = 0 if better else failures + 1
        if not better and state.radius < SHORTEST_STEP:
            fresh = first_metric(problem, state.point.shape)
            done = failures > 3
            state = State(state.point, state.value, state.gradient, fresh, 0.02, done, state.iterations)
            failures += 2
        unchecked += better
        if unchecked >= patience or (unchecked > 0 and state.done):
            safe, state, patience = checked_or_back(problem, safe, state, goal, polish_steps, cap, patience)
            unchecked = 0
    if unchecked > 0:
        _, state, _ = checked_or_back(problem, safe, state, goal, polish_steps, cap, patience)
    store_point(state.point, memory)
    numbers[0], numbers[1] = state.value, state.radius
    numbers[2], numbers[3] = 1.0 if state.done else 0.0, state.iterations
    gradient[:], metric[:] = state.gradient, state.metric


@kernel
def checked_or_back(
    problem: Problem, safe: State, state: State, goal: int, polish_steps: int, cap: float, patience: int
) -> tuple[State, State, int]:
    """The last sound state, the one to go on from, and after how many steps to check again."""
    then = checked(problem, state, goal, polish_steps, cap)
    if then.value < safe.value:
        return then, then, patience
    back = State(
        safe.point,
        safe.value,
        safe.gradient,
        safe.metric,
        min(safe.radius, state.radius),
        patience == 1 and state.done,
        state.iterations,
    )
    return safe, back, 1


@kernel
def stepped(problem: Problem, state: State, goal: int, polish_steps: int, cap: float) -> tuple[bool, State]:
    """One step along the conditions and back to them; whether the objective fell."""
    point, value, gradient, metric, radius = (
        state.point,
        state.value,
        state.gradient,
        state.metric,
        state.radius,
    )
    spent = state.iterations + 1
    step, shadow = tangent_step(point.conditions, gradient, metric)
    length = np.abs(step).max()
    if not np.isfinite(length) or np.sum(step * gradient) >= 0.0:
        metric = first_metric(problem, point.shape)
        step, shadow = tangent_step(point.conditions, gradient, metric)
        length = np.abs(step).max()
    if not length > 1e-9:
        return False, State(point, value, gradient, metric, radius, True, spent)
    share = min(1.0, radius / length)
    shape = point.shape
    turned, shifted = moved(
        shape.normals,
        shape.centroid,
        shape.offsets,
        point.frames,
        levers_of(shape.area, LEAST_LEVER),
        share * step,
    )
    reached = np.inf
    if shifted.min() > 0.0:
        then = measured(problem, turned, shifted, carried(point.frames, turned), point.conditions.watched)
        then = polished(problem, then, metric, polish_steps, TOLERANCE, cap)
        if then.worst < TOLERANCE:
            reached = objective_at(problem, then.shape, goal)
            if reached < value:
                slope = objective_gradient(problem, then.shape, then.frames, goal)
                _, after = tangent_step(then.conditions, slope, metric)
                metric = learned(metric, share * step, after - shadow)
                radius = min(0.25, max(radius, 2.0 * share * length))
                done = value - reached < 1e-7 and goal == OVERLAP
                return True, State(then, reached, slope, metric, radius, done, spent)
    return False, State(point, value, gradient, metric, 0.35 * min(radius, share * length), False, spent)
