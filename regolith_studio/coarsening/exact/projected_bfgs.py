"""Descent of an objective along the surface on which all constraints hold: projected BFGS steps."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.overlap import add_shared_charges, jaccard, shared_volume
from regolith_studio.coarsening.core.plane_coordinates import fill_gradient
from regolith_studio.coarsening.core.polyhedron_measures import add_surface_charges, add_volume_charges
from regolith_studio.coarsening.exact.constraint_projection import (
    TOLERANCE,
    after_step,
    project,
    project_and_verify,
    solve_nearly_singular,
)
from regolith_studio.coarsening.exact.constraints import PUSHED_CLEARANCE, ConstrainedPoint, Problem
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.exits import exits

Objective = Callable[[Problem, ConstrainedPoint], tuple[float, Callable[[], FloatArray]]]
"""Value, and a function for its derivative with the coordinates of all planes, shape (3 n,)."""

PROJECTION_STEPS = 6
"""Gauss-Newton steps back to the constraints after each step."""
UNVERIFIED = 8
"""Steps between two searches for boxes everywhere."""
SHORTEST_STEP = 2e-4
MAX_RADIUS, RESTART_RADIUS = 0.25, 0.02
SHRINK = 0.35
GOOD = 0.5
"""Steps that bring this share of what the quadratic model predicts may be followed by longer ones."""
ON_THE_WAY = 1e-5
"""Residuals up to this are left during a descent; they are removed when boxes are searched for everywhere."""
MIN_GAIN = 1e-7
"""A descent of the Jaccard distance ends where a step brings less."""
CURVATURE = 0.03


def overlap_objective(problem: Problem, point: ConstrainedPoint) -> tuple[float, Callable[[], FloatArray]]:
    """The Jaccard distance to the particle of unit volume."""
    rays, polyhedron, k = problem.rays, point.polyhedron, len(problem.rays.directions)
    radius, plane = np.empty(k), np.empty(k, dtype=np.int64)
    exits(polyhedron.normals, polyhedron.offsets, rays.directions, radius, plane)
    shared = shared_volume(rays.first, rays.distance, rays.sign, rays.weight, radius)

    def gradient() -> FloatArray:
        union = 1.0 + polyhedron.volume - shared
        charges = np.zeros((len(polyhedron.offsets), 4))
        add_volume_charges(polyhedron.areas, shared / union**2, charges)
        add_shared_charges(
            rays.directions,
            rays.first,
            rays.distance,
            rays.sign,
            rays.weight,
            polyhedron.offsets,
            radius,
            plane,
            polyhedron.centroids,
            -(union + shared) / union**2,
            charges,
        )
        return gradient_of(point, charges)

    return jaccard(shared, 1.0, polyhedron.volume), gradient


def min_surface(_problem: Problem, point: ConstrainedPoint) -> tuple[float, Callable[[], FloatArray]]:
    """The surface area, for smoother polyhedra."""
    return _signed_surface(point, 1.0)


def max_surface(_problem: Problem, point: ConstrainedPoint) -> tuple[float, Callable[[], FloatArray]]:
    """The surface area with a minus, for rougher polyhedra."""
    return _signed_surface(point, -1.0)


def _signed_surface(point: ConstrainedPoint, sign: float) -> tuple[float, Callable[[], FloatArray]]:
    polyhedron = point.polyhedron

    def gradient() -> FloatArray:
        charges = np.zeros((len(polyhedron.offsets), 4))
        normals, vertices, edges = polyhedron.normals, polyhedron.vertices, polyhedron.edges
        add_surface_charges(normals, vertices, edges, polyhedron.centroids, sign, charges)
        return gradient_of(point, charges)

    return sign * polyhedron.surface_area, gradient


def gradient_of(point: ConstrainedPoint, charges: FloatArray) -> FloatArray:
    """Derivative with the coordinates of every plane, shape (3 n,), from charges (n, 4)."""
    gradient = np.empty(3 * len(charges))
    fill_gradient(charges, point.tangents, point.scales, gradient)
    return gradient


class DescentState(NamedTuple):
    """Where a descent is; it can go on from here.

    Parameters
    ----------
    point
        Polyhedron and constraints; all hold.
    value, gradient
        Of the objective there; shape (3 n,).
    metric
        Approximate inverse of the Lagrangian's second derivative, shape (3 n, 3 n).
    radius
        Largest step.
    done
        Whether no better polyhedron is near.
    """

    point: ConstrainedPoint
    value: float
    gradient: FloatArray
    metric: FloatArray
    radius: float
    done: bool


def begin_descent(
    problem: Problem, point: ConstrainedPoint, objective: Objective, radius: float
) -> DescentState:
    """A descent from a polyhedron on which all constraints hold."""
    value, gradient = objective(problem, point)
    return DescentState(point, value, gradient(), first_metric(problem, point), radius, False)


def descend(problem: Problem, state: DescentState, objective: Objective, steps: int) -> DescentState:
    """At most `steps` more steps of the descent; the polyhedron where it ends meets all constraints.

    Boxes are searched for everywhere after every few steps only. Where one has come in between that cannot
    be pushed away again without loss, these steps are taken back, and from then on each is verified.
    """
    verified, unverified, patience, failures = state, 0, UNVERIFIED, 0
    for _ in range(steps):
        if state.done:
            break
        better, state = _step(problem, state, objective)
        failures = 0 if better else failures + 1
        if not better and state.radius < SHORTEST_STEP:
            metric = first_metric(problem, state.point)
            state = state._replace(metric=metric, radius=RESTART_RADIUS, done=failures > 3)
            failures += 2
        unverified += better
        if unverified >= patience or (unverified > 0 and state.done):
            verified, state, patience = _verify_or_back(problem, verified, state, objective, patience)
            unverified = 0
    if unverified > 0:
        _, state, _ = _verify_or_back(problem, verified, state, objective, patience)
    return state


def _step(problem: Problem, state: DescentState, objective: Objective) -> tuple[bool, DescentState]:
    """One step along the constraints and back to them; whether the objective fell."""
    point, metric = state.point, state.metric
    step, lagrangian = tangent_step(point, state.gradient, metric)
    length = np.abs(step).max()
    if not np.isfinite(length) or step @ state.gradient >= 0.0:
        metric = first_metric(problem, point)
        step, lagrangian = tangent_step(point, state.gradient, metric)
        length = np.abs(step).max()
    if not length > 1e-9:
        return False, state._replace(metric=metric, done=True)
    share = min(1.0, state.radius / length)
    then = after_step(problem, point, share * step)
    if then is not None:
        then = project(problem, then, metric, PROJECTION_STEPS, ON_THE_WAY)
        if then.worst < ON_THE_WAY:
            value, slope = objective(problem, then)
            if value < state.value:
                gradient = slope()
                _, after = tangent_step(then, gradient, metric)
                metric = bfgs_update(metric, share * step, after - lagrangian)
                predicted = share * (0.5 * share - 1.0) * (step @ state.gradient)
                radius = state.radius
                if state.value - value > GOOD * predicted:
                    radius = min(MAX_RADIUS, max(radius, 2.0 * share * length))
                done = state.value - value < MIN_GAIN and objective not in (min_surface, max_surface)
                return True, DescentState(then, value, gradient, metric, radius, done)
    return False, state._replace(metric=metric, radius=SHRINK * min(state.radius, share * length))


def _verify_or_back(
    problem: Problem, verified: DescentState, state: DescentState, objective: Objective, patience: int
) -> tuple[DescentState, DescentState, int]:
    """The last verified state, the one to go on from, and after how many steps to verify again."""
    point = project_and_verify(problem, state.point, state.metric, PROJECTION_STEPS)
    if point.polyhedron is state.point.polyhedron and point.worst < TOLERANCE:
        then = state._replace(point=point)
        return then, then, patience
    if point.worst < TOLERANCE:
        value, gradient = objective(problem, point)
        if value < verified.value:
            then = state._replace(point=point, value=value, gradient=gradient())
            return then, then, patience
    radius, done = min(verified.radius, state.radius), patience == 1 and state.done
    return verified, verified._replace(radius=radius, done=done), 1


def tangent_step(
    point: ConstrainedPoint, gradient: FloatArray, metric: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Newton step along the constraints, and the gradient of the Lagrangian; shapes (3 n,).

    Other boxes that the step would bring below the wanted one are held where they are.
    """
    rows = point.rows
    step = _projected(rows, gradient, metric)
    if len(point.slack):
        undercuts = point.slack + point.rival_rows @ step < PUSHED_CLEARANCE
        if undercuts.any():
            rows = np.vstack([rows, point.rival_rows[undercuts]])
            step = _projected(rows, gradient, metric)
    return step, gradient - rows.T @ solve_nearly_singular(rows @ rows.T, rows @ gradient)


def _projected(rows: FloatArray, gradient: FloatArray, metric: FloatArray) -> FloatArray:
    """-H g + H J' (J H J')^-1 J H g."""
    down = metric @ gradient
    across = metric @ rows.T
    return np.asarray(across @ solve_nearly_singular(rows @ across, rows @ down) - down)


def bfgs_update(metric: FloatArray, step: FloatArray, change: FloatArray) -> FloatArray:
    """BFGS update of the inverse second derivative; skipped where the curvature is not positive."""
    product = step @ change
    if product <= 1e-3 * np.sqrt((step @ step) * (change @ change)):
        return metric
    turned = metric @ change
    scale = (1.0 + change @ turned / product) / product
    mixed = np.outer(turned / product, step)
    return np.asarray(metric + scale * np.outer(step, step) - mixed - mixed.T)


def first_metric(problem: Problem, point: ConstrainedPoint) -> FloatArray:
    """A diagonal guess of the inverse second derivative: large facets resist."""
    areas = point.polyhedron.areas
    shifts = CURVATURE / np.maximum(areas, max(0.3 * point.polyhedron.surface_area / len(areas), 1e-12))
    shifts[: problem.held] = 0.0
    return np.diag(np.column_stack([shifts, 3.0 * shifts, 3.0 * shifts]).reshape(-1))


def steady_metric(problem: Problem, point: ConstrainedPoint) -> FloatArray:
    """A diagonal metric in which small facets hold still."""
    areas = point.polyhedron.areas
    mean = max(point.polyhedron.surface_area / len(areas), 1e-12)
    diagonal = np.repeat(np.maximum(areas / mean, 1e-3), 3)
    diagonal[: 3 * problem.held] = 0.0
    return np.diag(diagonal)
