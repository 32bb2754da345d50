"""Small facets become larger, as far as constraints and overlap allow: slivers are of no use to a solver."""

from collections.abc import Callable

import numpy as np

from regolith_studio.coarsening.core.polyhedron_measures import add_force
from regolith_studio.coarsening.exact.constraint_projection import TOLERANCE, max_step
from regolith_studio.coarsening.exact.constraints import ConstrainedPoint, Problem, measure
from regolith_studio.coarsening.exact.projected_bfgs import (
    Objective,
    begin_descent,
    descend,
    gradient_of,
    overlap_objective,
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
    objective = _overlap_and_penalty(point, begun.jaccard_distance + cost)
    state = begin_descent(problem, point, objective, max_step(point) / 4)
    return candidate_of(problem, descend(problem, state, objective, steps).point)


def _overlap_and_penalty(begun: ConstrainedPoint, limit: float) -> Objective:
    """Jaccard distance and penalty; infinite where that distance is above `limit` or facets are lost."""
    n = len(begun.offsets)
    min_area, count = MIN_SHARE * begun.polyhedron.surface_area / n, count_facets(begun)

    def objective(problem: Problem, point: ConstrainedPoint) -> tuple[float, Callable[[], FloatArray]]:
        polyhedron = point.polyhedron
        areas = np.maximum(polyhedron.areas, 1e-12)
        short = np.maximum(0.0, np.log(min_area / areas))
        jaccard, slope = overlap_objective(problem, point)

        def gradient() -> FloatArray:
            charges, gains = np.zeros((n, 4)), -2.0 * WEIGHT * short / (n * areas)
            normals, vertices, edges = polyhedron.normals, polyhedron.vertices, polyhedron.edges
            add_area_charges(normals, vertices, edges, polyhedron.centroids, gains, charges)
            return slope() + gradient_of(point, charges)

        allowed = jaccard <= limit and count_facets(point) >= count
        return jaccard + WEIGHT * float(np.mean(short**2)) if allowed else np.inf, gradient

    return objective


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
