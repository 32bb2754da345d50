"""Small facets become larger, as far as constraints and overlap allow: slivers are of no use to a solver."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from regolith_studio.coarsening.core.polyhedron_measures import add_force
from regolith_studio.coarsening.exact.constraint_projection import (
    TOLERANCE,
    after_step,
    max_step,
    project,
    project_and_verify,
)
from regolith_studio.coarsening.exact.constraints import ConstrainedPoint, Problem, measure
from regolith_studio.coarsening.exact.projected_bfgs import (
    MAX_RADIUS,
    PROJECTION_STEPS,
    SHRINK,
    UNVERIFIED,
    bfgs_update,
    first_metric,
    gradient_of,
    overlap_objective,
    tangent_step,
)
from regolith_studio.coarsening.exact.single_start import Candidate, candidate_of, count_facets
from regolith_studio.coarsening.polyhedra import facet_areas
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import dot, length, mixed, row

SMALL = 0.01
"""Facets below this share of the mean area are worth the work."""
MIN_SHARE = 0.05
"""Facets below this share of the mean area are pulled up."""
WEIGHT = 5e-3
"""Of the mean square of ln(:data:`MIN_SHARE` / share), beside the Jaccard distance."""
COST = 1e-3
"""By how much the Jaccard distance may rise."""
SHORTEST = 1e-5
"""Of a step, in units of the side of the cube of the particle's volume; shorter ones end the descent."""


@dataclass(frozen=True)
class _Evaluation:
    """A polyhedron on the way: its Jaccard distance, that with the penalty, and a derivative."""

    point: ConstrainedPoint
    jaccard: float
    value: float
    gradient: Callable[[], FloatArray]


def has_small_facets(normals: FloatArray, offsets: FloatArray) -> bool:
    """Whether a facet is below a hundredth of the mean."""
    areas = facet_areas(HalfSpaces(normals, offsets))
    return bool(areas.min() < SMALL * areas.mean())


def remove_slivers(problem: Problem, begun: Candidate, steps: int, cost: float = COST) -> Candidate:
    """A polyhedron that meets the same constraints with larger small facets; `begun` where there is none.

    A projected quasi-Newton descent of the Jaccard distance plus a penalty of small facets; it has the
    facets of `begun` and at most `cost` more Jaccard distance.

    Parameters
    ----------
    begun
        Meets all constraints.
    steps
        At most.
    """
    point = measure(problem, begun.normals, begun.offsets)
    if not point.worst < TOLERANCE:
        return begun
    min_area = MIN_SHARE * point.polyhedron.surface_area / len(point.offsets)
    now = verified = _evaluated(problem, point, min_area)
    limit, count = now.jaccard + cost, count_facets(point)

    def allowed(then: _Evaluation, before: _Evaluation) -> bool:
        return then.value < before.value and then.jaccard <= limit and count_facets(then.point) >= count

    metric, radius, unverified = first_metric(problem, point), max_step(point) / 4, 0
    for _ in range(steps):
        slope = now.gradient()
        step, lagrangian = tangent_step(now.point, slope, metric)
        size = float(np.abs(step).max())
        if not np.isfinite(size) or size < SHORTEST or step @ slope >= 0.0:
            break
        share = min(1.0, radius / size)
        then = _after_step(problem, now.point, share * step, metric, min_area)
        if then is None or not allowed(then, now):
            radius = SHRINK * min(radius, share * size)
            if radius < SHORTEST:
                break
            continue
        _, after = tangent_step(then.point, then.gradient(), metric)
        metric = bfgs_update(metric, share * step, after - lagrangian)
        radius = min(MAX_RADIUS, max(radius, 2.0 * share * size))
        now, unverified = then, unverified + 1
        if unverified == UNVERIFIED:
            now, unverified = _verified(problem, now, metric, min_area), 0
            if not allowed(now, verified):
                return candidate_of(problem, verified.point)
            verified = now
    end = _verified(problem, now, metric, min_area)
    return candidate_of(problem, (end if allowed(end, verified) else verified).point)


def _verified(problem: Problem, now: _Evaluation, metric: FloatArray, min_area: float) -> _Evaluation:
    """Searched for boxes everywhere; of infinite value where constraints are lost by that."""
    point = project_and_verify(problem, now.point, metric, PROJECTION_STEPS)
    if point.worst < TOLERANCE:
        return _evaluated(problem, point, min_area)
    return _Evaluation(point, np.inf, np.inf, now.gradient)


def _after_step(
    problem: Problem, point: ConstrainedPoint, step: FloatArray, metric: FloatArray, min_area: float
) -> _Evaluation | None:
    """One step and back to the constraints; ``None`` where that fails."""
    then = after_step(problem, point, step)
    if then is None:
        return None
    then = project(problem, then, metric, PROJECTION_STEPS)
    return _evaluated(problem, then, min_area) if then.worst < TOLERANCE else None


def _evaluated(problem: Problem, point: ConstrainedPoint, min_area: float) -> _Evaluation:
    """Jaccard distance and penalty."""
    polyhedron, n = point.polyhedron, len(point.offsets)
    areas = np.maximum(polyhedron.areas, 1e-12)
    short = np.maximum(0.0, np.log(min_area / areas))
    jaccard, slope = overlap_objective(problem, point)

    def gradient() -> FloatArray:
        charges, gains = np.zeros((n, 4)), -2.0 * WEIGHT * short / (n * areas)
        normals, vertices, edges = polyhedron.normals, polyhedron.vertices, polyhedron.edges
        add_area_charges(normals, vertices, edges, polyhedron.centroids, gains, charges)
        return slope() + gradient_of(point, charges)

    return _Evaluation(point, jaccard, jaccard + WEIGHT * float(np.mean(short**2)), gradient)


@kernel_noalloc
def add_area_charges(
    normals: FloatArray,
    vertices: FloatArray,
    edges: IntArray,
    pivots: FloatArray,
    gains: FloatArray,
    charges: FloatArray,
) -> None:
    """Add the derivative of the sum of gains x facet areas, shape (n, 4).

    The edge of facets a and b moves in the plane of a at the speed (w_b - w_a cos) / sin, where w are the
    speeds of the planes there and the angle is that between their normals.
    """
    for e in range(len(edges)):
        p, q = row(vertices, edges[e, 0]), row(vertices, edges[e, 1])
        a, b = edges[e, 2], edges[e, 3]
        cosine = dot(row(normals, a), row(normals, b))
        across = length(mixed(q, 1.0, p, -1.0)) / np.sqrt(max(1.0 - cosine * cosine, 1e-18))
        middle = mixed(p, 0.5, q, 0.5)
        add_force(charges, a, across * (gains[b] - gains[a] * cosine), middle, pivots)
        add_force(charges, b, across * (gains[a] - gains[b] * cosine), middle, pivots)
