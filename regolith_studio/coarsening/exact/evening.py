"""Small facets become larger, as far as conditions and overlap allow: slivers are of no use to a solver."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.coarsening.core.planes import tangents_of
from regolith_studio.coarsening.exact.course import POLISH_STEPS, Attempt, attempt, n_facets, reach
from regolith_studio.coarsening.exact.descent import OVERLAP, TOLERANCE, UNCHECKED, objective_at
from regolith_studio.coarsening.exact.polish import Polished
from regolith_studio.coarsening.exact.problem import Problem
from regolith_studio.coarsening.exact.steps import (
    NOWHERE,
    after_step,
    first_metric,
    learned,
    measured,
    objective_gradient,
    polished,
    slope_of_charge,
    tangent_step,
    verified,
)
from regolith_studio.coarsening.polyhedra import facet_areas
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.kernels import kernel

SMALL = 0.01
"""Facets below this share of the mean area are worth the work."""
LEAST = 0.05
"""Facets below this share of the mean area are pulled up."""
WEIGHT = 5e-3
"""Of the mean square of ln(:data:`LEAST` / share), beside the Jaccard distance."""
COST = 1e-3
"""By how much the Jaccard distance may rise."""
SHORTEST = 1e-5
"""Of a step, in units of the side of the cube of the particle's volume; shorter ones end the descent."""


@dataclass(frozen=True)
class _Stand:
    """A polyhedron on the way, what is to fall, and its slope."""

    point: Polished
    jaccard: float
    value: float
    slope: FloatArray


def has_small_facets(normals: FloatArray, offsets: FloatArray) -> bool:
    """Whether a facet is below a hundredth of the mean."""
    areas = facet_areas(HalfSpaces(normals, offsets))
    return bool(areas.min() < SMALL * areas.mean())


def evened(problem: Problem, begun: Attempt, steps: int) -> Attempt:
    """A polyhedron that meets the same conditions with larger small facets; `begun` where there is none.

    A projected quasi-Newton descent of the Jaccard distance plus a penalty of small facets; it has the
    facets of `begun` and at most :data:`COST` more Jaccard distance.

    Parameters
    ----------
    begun
        Meets all conditions.
    steps
        At most.
    """
    point = measured(problem, begun.normals, begun.offsets, tangents_of(begun.normals), NOWHERE)
    if not point.worst < TOLERANCE:
        return begun
    least = LEAST * point.shape.surface / len(point.shape.offsets)
    stand = safe = _stand(problem, point, least)
    limit, count = stand.jaccard + COST, n_facets(point)
    metric, radius, unchecked = first_metric(problem, point.shape), reach(point) / 4, 0
    for _ in range(steps):
        step, shadow = tangent_step(stand.point.conditions, stand.slope, metric)
        length = float(np.abs(step).max())
        if not np.isfinite(length) or length < SHORTEST or np.sum(step * stand.slope) >= 0.0:
            break
        share = min(1.0, radius / length)
        then = _stepped(problem, stand.point, share * step, metric, least)
        if then is None or then.value >= stand.value or then.jaccard > limit or n_facets(then.point) < count:
            radius = 0.35 * min(radius, share * length)
            if radius < SHORTEST:
                break
            continue
        _, after = tangent_step(then.point.conditions, then.slope, metric)
        metric = learned(metric, share * step, after - shadow)
        radius = min(0.25, max(radius, 2.0 * share * length))
        stand, unchecked = then, unchecked + 1
        if unchecked == UNCHECKED:
            stand, unchecked = _checked(problem, stand, metric, least), 0
            if stand.value >= safe.value or stand.jaccard > limit or n_facets(stand.point) < count:
                return attempt(problem, safe.point)
            safe = stand
    end = _checked(problem, stand, metric, least)
    fine = end.value < safe.value and end.jaccard <= limit and n_facets(end.point) >= count
    return attempt(problem, (end if fine else safe).point)


def _checked(problem: Problem, stand: _Stand, metric: FloatArray, least: float) -> _Stand:
    """Searched for boxes everywhere; of infinite value where conditions are lost by that."""
    cap = reach(stand.point)
    point = verified(problem, stand.point, metric, POLISH_STEPS, TOLERANCE, cap)
    if point.worst < TOLERANCE:
        return _stand(problem, point, least)
    return _Stand(point, np.inf, np.inf, stand.slope)


def _stepped(
    problem: Problem, point: Polished, step: FloatArray, metric: FloatArray, least: float
) -> _Stand | None:
    """One step and back to the conditions; ``None`` where that fails."""
    normals, offsets, frames = after_step(point, step)
    if not offsets.min() > 0.0:
        return None
    then = measured(problem, normals, offsets, frames, point.conditions.watched)
    then = polished(problem, then, metric, POLISH_STEPS, TOLERANCE, reach(point))
    return _stand(problem, then, least) if then.worst < TOLERANCE else None


def _stand(problem: Problem, point: Polished, least: float) -> _Stand:
    """Jaccard distance, penalty and slope."""
    shape, n = point.shape, len(point.shape.offsets)
    areas = np.maximum(shape.area, 1e-12)
    short = np.maximum(0.0, np.log(least / areas))
    charge, slope, gains = np.zeros((n, 4)), np.empty(3 * n), -2.0 * WEIGHT * short / (n * areas)
    add_facet_charge(shape.normals, shape.vertices, shape.edges, shape.centroid, gains, charge)
    slope_of_charge(shape, point.frames, charge, slope)
    jaccard = objective_at(problem, shape, OVERLAP)
    slope = slope + objective_gradient(problem, shape, point.frames, OVERLAP)
    return _Stand(point, jaccard, jaccard + WEIGHT * float(np.mean(short**2)), slope)


@kernel
def add_facet_charge(
    normals: FloatArray,
    vertices: FloatArray,
    edges: IntArray,
    pivots: FloatArray,
    gains: FloatArray,
    charge: FloatArray,
) -> None:
    """Add the derivative of the sum of gains x facet areas as charges, shape (n, 4), as in `core.measures`.

    The edge of facets a and b moves in the plane of a at the speed (w_b - w_a cos) / sin, where w are the
    speeds of the planes there and the angle is that between their normals.
    """
    for e in range(len(edges)):
        p, q, a, b = edges[e]
        square, cosine = 0.0, 0.0
        for c in range(3):
            square += (vertices[q, c] - vertices[p, c]) ** 2
            cosine += normals[a, c] * normals[b, c]
        across = np.sqrt(square / max(1.0 - cosine * cosine, 1e-18))
        of_a = across * (gains[b] - gains[a] * cosine)
        of_b = across * (gains[a] - gains[b] * cosine)
        charge[a, 0] += of_a
        charge[b, 0] += of_b
        for c in range(3):
            middle = 0.5 * (vertices[p, c] + vertices[q, c])
            charge[a, 1 + c] += of_a * (middle - pivots[a, c])
            charge[b, 1 + c] += of_b * (middle - pivots[b, c])
