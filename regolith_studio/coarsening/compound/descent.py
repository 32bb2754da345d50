"""Descent of the Jaccard distance of a union of convex parts along the conditions: projected BFGS steps."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.compound.conditions import (
    CLEARANCE,
    PUSHED_CLEARANCE,
    CompoundPoint,
    CompoundProblem,
    searched,
    stepped,
)
from regolith_studio.coarsening.compound.line_overlap import shared_with_lines
from regolith_studio.coarsening.core.overlap import jaccard
from regolith_studio.coarsening.optimiser.multipliers import solve_in_place
from regolith_studio.geometry.arrays import BoolArray, FloatArray

TOLERANCE, LOOSE = 2e-8, 1e-6
"""Largest residual of a compound that counts as exact, and on the way."""
MAX_PROJECTION_STEP = 0.1
PROJECTION_STEPS, LONG_PROJECTION = 8, 30
FIRST_RADIUS, MAX_RADIUS, RESTART_RADIUS = 0.06, 0.2, 0.02
SHRINK = 0.35
MAX_FAILURES = 7
"""The descent ends after so many steps in a row without gain; half-way it begins with a new metric."""
SOFTNESS = 0.05
"""Added to the second derivatives: hidden facets have none of their own."""
MEMORY = 2
"""A step is taken where the distance falls below the largest of so many steps before."""
MIN_GAIN = 2e-6
"""The descent ends where ten steps together bring less than ten times this."""


class Overlap(NamedTuple):
    """The Jaccard distance with its derivative (3 n,) and a metric, about its inverse second derivative."""

    distance: float
    gradient: FloatArray
    metric: FloatArray


def overlap_of(problem: CompoundProblem, point: CompoundPoint) -> Overlap:
    """Measured by lines; the union's volume is exact."""
    compound, n = point.compound, len(point.scales)
    shared, change, curvature = shared_with_lines(compound, problem.lines, point.tangents, point.scales)
    union = 1.0 + compound.volume - shared
    growth = np.zeros(3 * n)
    growth[::3] = compound.areas
    gradient = growth * (shared / union**2) - change * ((union + shared) / union**2)
    metric = np.zeros((n, 3, n, 3))
    blocks = np.arange(n)
    metric[blocks, :, blocks, :] = np.linalg.inv(curvature / union + SOFTNESS * np.eye(3))
    free = compound.planes.free
    metric_of_free = metric.reshape(3 * n, 3 * n) * free * free[:, None]
    return Overlap(jaccard(shared, 1.0, compound.volume), gradient * free, metric_of_free)


def project(
    problem: CompoundProblem,
    point: CompoundPoint,
    metric: FloatArray,
    steps: int,
    tolerance: float = TOLERANCE,
) -> CompoundPoint:
    """Towards the conditions by Gauss-Newton steps, boxes searched for everywhere.

    They hold where the largest residual of the result is not above `tolerance`.
    """
    for _ in range(3):
        point = _followed(problem, point, metric, steps, tolerance)
        if point.worst > tolerance:
            return point
        found = searched(problem, point)
        if found is None or found.worst <= tolerance:
            return found or point
        point = found
    return point


def _followed(
    problem: CompoundProblem, point: CompoundPoint, metric: FloatArray, steps: int, tolerance: float
) -> CompoundPoint:
    """At most so many Gauss-Newton steps; boxes are followed."""
    for _ in range(steps):
        if point.worst <= tolerance:
            break
        step = _correction(point, metric)
        share = min(1.0, MAX_PROJECTION_STEP / max(float(np.abs(step).max()), 1e-300))
        then = _not_worse(problem, point, share * step)
        if then is None:
            break
        point = then
    return point


def _correction(point: CompoundPoint, metric: FloatArray) -> FloatArray:
    """The step that removes the residuals to first order and keeps rivals off, least in the metric."""
    chosen = point.slack < CLEARANCE
    while True:
        rows, missing = _with_rivals(point, chosen)
        across = metric @ rows.T
        step = across @ solve_nearly_singular(rows @ across, missing)
        undercut = ~chosen & (point.slack + point.rival_rows @ step < CLEARANCE)
        if not undercut.any():
            return np.asarray(step)
        chosen = chosen | undercut


def _not_worse(problem: CompoundProblem, point: CompoundPoint, step: FloatArray) -> CompoundPoint | None:
    for _ in range(5):
        then = stepped(problem, point, step) if np.isfinite(step).all() else None
        if then is not None and then.worst < max(1.5 * point.worst, 1e-6):
            return then
        step = 0.4 * step
    return None


def _with_rivals(point: CompoundPoint, chosen: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Rows of the conditions and of some rivals, and by how much each is to change."""
    return (
        np.vstack([point.rows, point.rival_rows[chosen]]),
        np.concatenate([-point.residual, PUSHED_CLEARANCE - point.slack[chosen]]),
    )


def descend(
    problem: CompoundProblem, point: CompoundPoint, steps: int
) -> Iterator[tuple[CompoundPoint, float]]:
    """Points that meet all conditions to :data:`LOOSE`, most with a smaller Jaccard distance than before.

    Parameters
    ----------
    point
        Meets all conditions.
    steps
        At most so many are tried.
    """
    here = overlap_of(problem, point)
    metric, radius, failures = here.metric, FIRST_RADIUS, 0
    history = [here.distance]
    for _ in range(steps):
        step = _tangent_step(point, here.gradient, metric)
        length = float(np.abs(step).max())
        share = min(1.0, radius / max(length, 1e-300))
        then = stepped(problem, point, share * step) if np.isfinite(length) else None
        then = None if then is None else project(problem, then, metric, PROJECTION_STEPS, LOOSE)
        there = overlap_of(problem, then) if then is not None and then.worst <= LOOSE else None
        if then is None or there is None or there.distance >= max(history[-MEMORY:]):
            failures += 1
            radius = SHRINK * min(radius, share * length) if np.isfinite(length) else radius
            if failures == MAX_FAILURES // 2:
                metric, radius = here.metric, RESTART_RADIUS
            if failures == MAX_FAILURES:
                return
            continue
        change = _lagrangian(then, there.gradient) - _lagrangian(point, here.gradient)
        metric, failures = bfgs_update(metric, share * step, change), 0
        radius = min(MAX_RADIUS, max(radius, 2.0 * share * length))
        point, here = then, there
        history.append(here.distance)
        yield point, here.distance
        if min(history[:-10], default=np.inf) - min(history[-10:]) < 10.0 * MIN_GAIN:
            return


def _tangent_step(point: CompoundPoint, gradient: FloatArray, metric: FloatArray) -> FloatArray:
    """Newton step along the conditions; rivals that it would bring below the wanted box are held off."""
    down = metric @ gradient
    step = -down
    chosen = np.zeros(len(point.slack), dtype=np.bool_)
    for _ in range(2):
        rows, missing = _with_rivals(point, chosen)
        across = metric @ rows.T
        step = across @ solve_nearly_singular(rows @ across, rows @ down + missing) - down
        chosen = point.slack + point.rival_rows @ step < PUSHED_CLEARANCE
        if not chosen.any():
            break
    return np.asarray(step)


def _lagrangian(point: CompoundPoint, gradient: FloatArray) -> FloatArray:
    """Gradient of the Lagrangian: what is left of the gradient across the conditions."""
    rows = point.rows
    return np.asarray(gradient - rows.T @ solve_nearly_singular(rows @ rows.T, rows @ gradient))


def solve_nearly_singular(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solution of a symmetric positive semidefinite system (m, m); NaN where it is none."""
    system = np.column_stack([matrix, right])
    return system[:, -1].copy() if solve_in_place(system) else np.full(len(right), np.nan)


def bfgs_update(metric: FloatArray, step: FloatArray, change: FloatArray) -> FloatArray:
    """BFGS update of the inverse second derivative; skipped where the curvature is not positive."""
    product = step @ change
    if product <= 1e-3 * np.sqrt((step @ step) * (change @ change)):
        return metric
    turned = metric @ change
    scale = (1.0 + change @ turned / product) / product
    mixed = np.outer(turned / product, step)
    return np.asarray(metric + scale * np.outer(step, step) - mixed - mixed.T)
