"""Where constraints are hard to meet: the sphericity gives way first, and goes as far as it goes.

Constraints that cannot be met together even without it are met one after the other, each as far as the ones
before allow.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from regolith_studio.coarsening.core.box_search import FINE_ANGLE
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.exact.constraint_projection import (
    TOLERANCE,
    max_step,
    project_and_verify,
)
from regolith_studio.coarsening.exact.constraints import (
    LONGEST,
    RATIO,
    SHORTEST,
    SPHERICITY,
    VOLUME,
    ConstrainedPoint,
    Problem,
    log_sphericity,
    measure,
)
from regolith_studio.coarsening.exact.facet_growth import with_more_facets
from regolith_studio.coarsening.exact.projected_bfgs import (
    begin_descent,
    descend,
    first_metric,
    max_surface,
    min_surface,
)
from regolith_studio.coarsening.exact.single_start import (
    CHUNK,
    Candidate,
    candidate_of,
    descend_from,
    descend_in_chunks,
)
from regolith_studio.coarsening.loss import LossFunction
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray

STEPS = 64
PROJECTION_STEPS = 30
"""Gauss-Newton steps of one projection."""
STALLED = 0.02
"""Where a chunk of steps brings the sphericity nearer by less than this share, it ends."""
FACETS_COST = 0.1
"""By how much the loss may rise for facets that are put back."""
ORDER = (VOLUME, LONGEST, SHORTEST, RATIO)
"""The sphericity follows last, by a descent of its own."""
TRIALS = 8
"""Projections a constraint."""


def relax(
    target: Target,
    full: Problem,
    rest: Problem,
    planes: tuple[FloatArray, FloatArray],
    bound_steps: int,
    only_rounder: bool = False,
) -> Iterator[Candidate]:
    """Polyhedra that meet all constraints but the sphericity, ever nearer to it.

    Where it is reached, polyhedra that meet all constraints follow, with ever better overlap. Where it is
    not, the last ones overlap better at the sphericity that was reached. Where the other constraints are not
    met together either, they are met in turn.

    Parameters
    ----------
    full, rest
        The problem with and without the sphericity.
    planes
        To start from.
    bound_steps
        Of the descent of the Jaccard distance at the end.
    only_rounder
        Whether to do nothing where a rougher polyhedron is wanted.
    """
    rest, full = (each._replace(sample_angle=FINE_ANGLE) for each in (rest, full))
    point = measured_and_projected(rest, *planes)
    apart = 0.0
    if point.worst > TOLERANCE:
        nearest = None if only_rounder else relax_in_order(rest, planes)
        if nearest is None:
            return
        rest, point = nearest
        apart = float(np.abs(rest.wanted - full.wanted)[rest.asked].max())
        full = full._replace(wanted=rest.wanted, asked=rest.asked | (np.arange(5) == SPHERICITY))
    for found in nearer_sphericity(target, full, rest, point, bound_steps, only_rounder):
        yield replace(found, worst=max(found.worst, apart))


def nearer_sphericity(
    target: Target,
    full: Problem,
    rest: Problem,
    point: ConstrainedPoint,
    bound_steps: int,
    only_rounder: bool,
) -> Iterator[Candidate]:
    """From a polyhedron that meets the rest, ever nearer to the sphericity."""
    smoother = sphericity_residual(full, point) < 0.0
    if only_rounder and not smoother:
        return
    objective = min_surface if smoother else max_surface
    state = begin_descent(rest, point, objective, max_step(point) / 2)
    missing = np.inf
    for _ in range(0, STEPS, CHUNK):
        state = descend(rest, state, objective, CHUNK)
        residual = sphericity_residual(full, state.point)
        if (residual > 0.0) == smoother:
            yield from from_beyond(target, full, state.point, bound_steps)
            return
        yield missing_by(residual, candidate_of(rest, state.point))
        if state.done or missing - abs(residual) < STALLED * abs(residual):
            break
        missing = abs(residual)
    yield from with_sphericity_held(full, state.point, bound_steps)


def from_beyond(
    target: Target, full: Problem, beyond: ConstrainedPoint, bound_steps: int
) -> Iterator[Candidate]:
    """From a polyhedron that went past the wanted sphericity back to it."""
    point = measured_and_projected(full, beyond.normals, beyond.offsets)
    yield from descend_from(target, full, point, bound_steps, 0)


def with_sphericity_held(full: Problem, reached: ConstrainedPoint, bound_steps: int) -> Iterator[Candidate]:
    """Descent of the Jaccard distance at the sphericity of a polyhedron that misses the wanted one."""
    residual = sphericity_residual(full, reached)
    held, point = as_it_is(full, reached.normals, reached.offsets)
    if point.worst > TOLERANCE:
        return
    for later in descend_in_chunks(held, point, bound_steps, max_step(point) / 2):
        yield missing_by(residual, candidate_of(held, later))


def with_facets_back(
    target: Target, problems: tuple[Problem, ...], judge: LossFunction, found: Candidate, n_facets: int
) -> Candidate:
    """A polyhedron that misses a constraint with all its facets, at the descriptors that it has.

    Each of the problems is tried until all facets are back; their searches for boxes are ever finer, since
    one that is overlooked would change the descriptors. The sphericity goes free at last.
    """
    if found.exact or found.n_facets == n_facets:
        return found
    most = judge.value(found.normals, found.offsets) + FACETS_COST
    real, best = found.without_redundant(), found
    for problem in (*problems, without_sphericity(problems[-1])):
        held, point = as_it_is(problem, real.normals, real.offsets)
        if point.worst > TOLERANCE:
            continue
        for more in with_more_facets(target, held, candidate_of(held, point), n_facets, 0):
            worth = more.exact and more.n_facets > best.n_facets
            if worth and judge.value(more.normals, more.offsets) <= most:
                best = replace(more, worst=found.worst)
        if best.n_facets == n_facets:
            break
    return best


def without_sphericity(problem: Problem) -> Problem:
    """All constraints but that."""
    return problem._replace(asked=problem.asked & (np.arange(5) != SPHERICITY))


def as_it_is(full: Problem, normals: FloatArray, offsets: FloatArray) -> tuple[Problem, ConstrainedPoint]:
    """The problem that asks for the descriptors that a polyhedron has, and the polyhedron."""
    point = measure(full, normals, offsets)
    if not np.isfinite(point.worst):
        return full, point
    held = full._replace(wanted=values_of(full, point))
    return held, measure(held, normals, offsets)


def values_of(problem: Problem, point: ConstrainedPoint) -> FloatArray:
    """Logarithms of a polyhedron's descriptors, with the least of its boxes; shape (5,)."""
    values = problem.wanted.copy()
    volume, extents = point.polyhedron.volume, point.boxes.extents
    values[VOLUME], values[SPHERICITY] = np.log(volume), log_sphericity(volume, point.polyhedron.surface_area)
    if len(extents):
        low, high = np.log(extents[0].min()), np.log(extents[0].max())
        values[SHORTEST], values[LONGEST], values[RATIO] = low, high, high - low
    return values


def missing_by(residual: float, found: Candidate) -> Candidate:
    """The polyhedron, as far from the constraints as its sphericity."""
    return replace(found, worst=abs(residual))


def sphericity_residual(problem: Problem, point: ConstrainedPoint) -> float:
    """Logarithm of the sphericity over the wanted one."""
    volume, surface = point.polyhedron.volume, point.polyhedron.surface_area
    return log_sphericity(volume, surface) - float(problem.wanted[SPHERICITY])


def measured_and_projected(problem: Problem, normals: FloatArray, offsets: FloatArray) -> ConstrainedPoint:
    point = measure(problem, normals, offsets)
    return project_and_verify(problem, point, first_metric(problem, point), PROJECTION_STEPS)


def relax_in_order(
    rest: Problem, planes: tuple[FloatArray, FloatArray]
) -> tuple[Problem, ConstrainedPoint] | None:
    """The problem that asks for what could be reached, and a polyhedron that meets it.

    Parameters
    ----------
    rest
        The constraints; the sphericity is none of them.
    planes
        To start from; they are scaled to the volume first.
    """
    problem = rest._replace(asked=np.zeros_like(rest.asked), wanted=rest.wanted.copy())
    point = measure(problem, *planes)
    if point.polyhedron.status != FINE:
        return None
    if rest.asked[VOLUME]:
        scale = float(np.exp((rest.wanted[VOLUME] - np.log(point.polyhedron.volume)) / 3.0))
        planes = planes[0], planes[1] * scale
    point = measure(problem, *planes)
    for key in ORDER:
        if rest.asked[key]:
            problem, point = towards(problem, point, key, float(rest.wanted[key]))
    return (problem, point) if point.worst < TOLERANCE else None


def towards(
    problem: Problem, point: ConstrainedPoint, key: int, goal: float
) -> tuple[Problem, ConstrainedPoint]:
    """Take one more constraint along, at `goal` or as near to it as projections lead.

    It stays out where not even the value that the polyhedron has can be held.
    """
    asked = problem.asked.copy()
    asked[key] = True
    now = value_of(problem._replace(asked=asked), point, key)
    held, best, share = problem, point, 1.0
    for _ in range(TRIALS):
        value = goal if share == 1.0 else now + share * (goal - now)
        wanted = problem.wanted.copy()
        wanted[key] = value
        tried = problem._replace(asked=asked, wanted=wanted)
        then = measured_and_projected(tried, best.normals, best.offsets)
        if then.worst < TOLERANCE:
            held, best, now = tried, then, value
            if value == goal:
                break
            share = min(1.0, 2.0 * share)
        else:
            share /= 2.0
    return held, best


def value_of(problem: Problem, point: ConstrainedPoint, key: int) -> float:
    """Logarithm of the descriptor that belongs to a constraint."""
    there = measure(problem, point.normals, point.offsets)
    at = int(np.count_nonzero(problem.asked[:key]))
    return float(there.residual[at] + problem.wanted[key])
