"""Where conditions are hard to meet: the sphericity gives way first, and goes as far as it goes."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from regolith_studio.coarsening.core.box_search import FINE_ANGLE
from regolith_studio.coarsening.core.planes import tangents_of
from regolith_studio.coarsening.exact.course import (
    CHUNK,
    LONG_POLISH,
    POLISH_STEPS,
    Attempt,
    attempt,
    mended,
    reach,
    steps_down,
)
from regolith_studio.coarsening.exact.descent import OVERLAP, ROUGHER, SMOOTHER, TOLERANCE, State
from regolith_studio.coarsening.exact.growth import with_more_facets
from regolith_studio.coarsening.exact.in_turn import met_in_turn
from regolith_studio.coarsening.exact.polish import Polished
from regolith_studio.coarsening.exact.problem import (
    LONGEST,
    RATIO,
    SHORTEST,
    SPHERICITY,
    VOLUME,
    Problem,
    Shape,
    log_sphericity,
)
from regolith_studio.coarsening.exact.steps import (
    NOWHERE,
    descended,
    first_metric,
    measured,
    started,
    verified,
)
from regolith_studio.coarsening.loss import LossFunction
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray

STEPS = 64
STALLED = 0.02
"""Where a chunk of steps brings the sphericity nearer by less than this share, it ends."""
FACETS_COST = 0.1
"""By how much the loss may rise for facets that are put back."""


def compromise(
    target: Target,
    full: Problem,
    rest: Problem,
    planes: tuple[FloatArray, FloatArray],
    bound_steps: int,
    only_rounder: bool = False,
) -> Iterator[Attempt]:
    """Polyhedra that meet all conditions but the sphericity, ever nearer to it.

    Where it is reached, polyhedra that meet all conditions follow, with ever better overlap. Where it is not,
    the last ones overlap better at the sphericity that was reached. Where the other conditions are not met
    together either, they are met in turn.

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
    point = measured(rest, planes[0], planes[1], tangents_of(planes[0]), NOWHERE)
    point = verified(rest, point, first_metric(rest, point.shape), LONG_POLISH, TOLERANCE, reach(point))
    apart = 0.0
    if point.worst > TOLERANCE:
        nearest = None if only_rounder else met_in_turn(rest, planes)
        if nearest is None:
            return
        rest, point = nearest
        apart = float(np.abs(rest.wanted - full.wanted)[rest.asked].max())
        full = full._replace(wanted=rest.wanted, asked=rest.asked | (np.arange(5) == SPHERICITY))
    for found in nearer_sphericity(target, full, rest, point, bound_steps, only_rounder):
        yield replace(found, worst=max(found.worst, apart))


def nearer_sphericity(
    target: Target, full: Problem, rest: Problem, point: Polished, bound_steps: int, only_rounder: bool
) -> Iterator[Attempt]:
    """From a polyhedron that meets the rest, ever nearer to the sphericity."""
    goal = SMOOTHER if sphericity_residual(full, point) < 0.0 else ROUGHER
    if only_rounder and goal == ROUGHER:
        return
    state = started(rest, point, goal, reach(point) / 2)
    missing = np.inf
    for _ in range(0, STEPS, CHUNK):
        state = descended(rest, state, goal, CHUNK, POLISH_STEPS)
        residual = sphericity_residual(full, state.point)
        if (residual > 0.0) == (goal == SMOOTHER):
            yield from from_beyond(target, full, state, bound_steps)
            return
        yield missing_by(residual, attempt(rest, state.point))
        if state.done or missing - abs(residual) < STALLED * abs(residual):
            break
        missing = abs(residual)
    yield from with_sphericity_held(full, state, bound_steps)


def from_beyond(target: Target, full: Problem, state: State, bound_steps: int) -> Iterator[Attempt]:
    """From a polyhedron that went past the wanted sphericity back to it."""
    point = measured(full, state.point.shape.normals, state.point.shape.offsets, state.point.frames, NOWHERE)
    point = verified(full, point, first_metric(full, point.shape), LONG_POLISH, TOLERANCE, reach(point))
    yield attempt(full, point)
    if point.worst > TOLERANCE:
        return
    for later in steps_down(full, started(full, point, OVERLAP, reach(point) / 2), bound_steps):
        point = later.point
        yield attempt(full, point)
    yield from mended(target, full, point, 0)


def with_sphericity_held(full: Problem, state: State, bound_steps: int) -> Iterator[Attempt]:
    """Descent of the Jaccard distance at the sphericity of a polyhedron that misses the wanted one."""
    residual = sphericity_residual(full, state.point)
    held, point = as_it_is(full, state.point.shape.normals, state.point.shape.offsets)
    if point.worst > TOLERANCE:
        return
    for later in steps_down(held, started(held, point, OVERLAP, reach(point) / 2), bound_steps):
        yield missing_by(residual, attempt(held, later.point))


def with_facets_back(
    target: Target, problems: tuple[Problem, ...], judge: LossFunction, found: Attempt, n_facets: int
) -> Attempt:
    """A polyhedron that misses a condition with all its facets, at the descriptors that it has.

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
        for more in with_more_facets(target, held, attempt(held, point), n_facets, 0):
            worth = more.exact and more.n_facets > best.n_facets
            if worth and judge.value(more.normals, more.offsets) <= most:
                best = replace(more, worst=found.worst)
        if best.n_facets == n_facets:
            break
    return best


def without_sphericity(problem: Problem) -> Problem:
    """All conditions but that."""
    return problem._replace(asked=problem.asked & (np.arange(5) != SPHERICITY))


def as_it_is(full: Problem, normals: FloatArray, offsets: FloatArray) -> tuple[Problem, Polished]:
    """The problem that asks for the descriptors that a polyhedron has, and the polyhedron."""
    frames = tangents_of(normals)
    point = measured(full, normals, offsets, frames, NOWHERE)
    if not np.isfinite(point.worst):
        return full, point
    held = full._replace(wanted=values_of(full, point.shape))
    return held, measured(held, normals, offsets, frames, NOWHERE)


def values_of(problem: Problem, shape: Shape) -> FloatArray:
    """Logarithms of a polyhedron's descriptors, with the least of its boxes; shape (5,)."""
    values = problem.wanted.copy()
    values[VOLUME], values[SPHERICITY] = np.log(shape.volume), log_sphericity(shape.volume, shape.surface)
    if len(shape.boxes.extents):
        low, high = np.log(shape.boxes.extents[0].min()), np.log(shape.boxes.extents[0].max())
        values[SHORTEST], values[LONGEST], values[RATIO] = low, high, high - low
    return values


def missing_by(residual: float, found: Attempt) -> Attempt:
    """The polyhedron, as far from the conditions as its sphericity."""
    return replace(found, worst=abs(residual))


def sphericity_residual(problem: Problem, point: Polished) -> float:
    """Logarithm of the sphericity over the wanted one."""
    return log_sphericity(point.shape.volume, point.shape.surface) - float(problem.wanted[SPHERICITY])
