"""Projection onto the constraints by Gauss-Newton steps."""

import numpy as np
from scipy.linalg.lapack import dgesv

from regolith_studio.coarsening.core.plane_coordinates import moved_planes
from regolith_studio.coarsening.exact.constraints import (
    CLEARANCE,
    PUSHED_CLEARANCE,
    ConstrainedPoint,
    Problem,
    constrained,
    search_everywhere,
)
from regolith_studio.geometry.arrays import FloatArray

TOLERANCE = 3e-8
"""Largest residual of a polyhedron that counts as exact."""
MAX_STEP = 0.4
"""Longest step times the square root of the number of planes: facets shrink as n grows."""


def max_step(point: ConstrainedPoint) -> float:
    """Longest step of a plane."""
    return float(MAX_STEP / np.sqrt(len(point.offsets)))


def project(
    problem: Problem,
    point: ConstrainedPoint,
    metric: FloatArray,
    iterations: int,
    tolerance: float = TOLERANCE,
) -> ConstrainedPoint:
    """At most `iterations` Gauss-Newton steps until all residuals are below `tolerance`.

    Parameters
    ----------
    metric
        Shape (3 n, 3 n): steps are least in its inverse.
    """
    for _ in range(iterations):
        if point.worst < tolerance or point.worst == np.inf:
            break
        then = _gauss_newton_step(problem, point, metric)
        if then is None:
            break
        point = then
    return point


def project_and_verify(
    problem: Problem, point: ConstrainedPoint, metric: FloatArray, iterations: int
) -> ConstrainedPoint:
    """As :func:`project`, but the result has been searched for boxes everywhere."""
    point = search_everywhere(problem, project(problem, point, metric, iterations))
    for _ in range(4):
        if point.worst < TOLERANCE or point.worst == np.inf:
            break
        then = project(problem, point, metric, iterations)
        if then.worst > TOLERANCE:
            return then
        point = search_everywhere(problem, then)
    return point


def after_step(problem: Problem, point: ConstrainedPoint, step: FloatArray) -> ConstrainedPoint | None:
    """The polyhedron after a step in the coordinates of every plane, (3 n,); boxes are followed.

    ``None`` where a half-space would not hold the origin inside.
    """
    shape = point.polyhedron
    normals, offsets, tangents = moved_planes(
        shape.normals, shape.centroids, shape.offsets, point.tangents, point.scales, step
    )
    return constrained(problem, normals, offsets, tangents, point.tracked) if offsets.min() > 0.0 else None


def _gauss_newton_step(
    problem: Problem, point: ConstrainedPoint, metric: FloatArray
) -> ConstrainedPoint | None:
    """One step, shortened until the residuals do not grow much; ``None`` where that leads nowhere."""
    step = _correction(point, metric)
    length = np.abs(step).max()
    if not np.isfinite(length):
        return None
    share = min(1.0, max_step(point) / length) if length > 0.0 else 1.0
    for _ in range(5):
        then = after_step(problem, point, share * step)
        if then is not None and then.worst < max(1.5 * point.worst, 1e-6):
            return then
        share *= 0.4
    return None


def _correction(point: ConstrainedPoint, metric: FloatArray) -> FloatArray:
    """The step that removes the residuals to first order, least in the inverse of `metric` (3 n, 3 n)."""
    rows, right = point.rows, -point.residual
    active = point.slack < CLEARANCE
    if active.any():
        rows = np.vstack([rows, point.rival_rows[active]])
        right = np.append(right, PUSHED_CLEARANCE - point.slack[active])
    across = metric @ rows.T
    return np.asarray(across @ solve_nearly_singular(rows @ across, right))


def solve_nearly_singular(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solution of a symmetric system that may be nearly singular; NaN where it is broken."""
    k = len(right)
    if k == 0:
        return right
    lifted = matrix.copy()
    diagonal = lifted.reshape(-1)[:: k + 1]
    diagonal += 1e-13 * diagonal.sum() / k + 1e-300
    solution, broken = dgesv(lifted, right)[2:]
    return np.full(k, np.nan) if broken else np.asarray(solution)
