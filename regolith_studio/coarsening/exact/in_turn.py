"""Conditions that cannot be met together: one after the other, each as far as the ones before allow."""

import numpy as np

from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.planes import tangents_of
from regolith_studio.coarsening.exact.course import LONG_POLISH, reach
from regolith_studio.coarsening.exact.descent import TOLERANCE
from regolith_studio.coarsening.exact.polish import Polished
from regolith_studio.coarsening.exact.problem import LONGEST, RATIO, SHORTEST, VOLUME, Problem
from regolith_studio.coarsening.exact.steps import NOWHERE, first_metric, measured, verified
from regolith_studio.geometry.arrays import FloatArray

ORDER = (VOLUME, LONGEST, SHORTEST, RATIO)
"""The sphericity follows last, by a descent of its own."""
TRIALS = 8
"""Polishes a condition."""


def met_in_turn(rest: Problem, planes: tuple[FloatArray, FloatArray]) -> tuple[Problem, Polished] | None:
    """The problem that asks for what could be reached, and a polyhedron that meets it.

    Parameters
    ----------
    rest
        The conditions; the sphericity is none of them.
    planes
        To start from; they are scaled to the volume first.
    """
    point = measured(rest, *planes, tangents_of(planes[0]), NOWHERE)
    if point.shape.status != FINE:
        return None
    if rest.asked[VOLUME]:
        scale = float(np.exp((rest.wanted[VOLUME] - np.log(point.shape.volume)) / 3.0))
        planes = planes[0], planes[1] * scale
    problem = rest._replace(asked=np.zeros_like(rest.asked), wanted=rest.wanted.copy())
    point = measured(problem, *planes, tangents_of(planes[0]), NOWHERE)
    for key in ORDER:
        if rest.asked[key]:
            problem, point = towards(problem, point, key, float(rest.wanted[key]))
    return (problem, point) if point.worst < TOLERANCE else None


def towards(problem: Problem, point: Polished, key: int, goal: float) -> tuple[Problem, Polished]:
    """Take one more condition along, at `goal` or as near to it as polishing leads.

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
        shape = best.shape
        then = measured(tried, shape.normals, shape.offsets, best.frames, NOWHERE)
        then = verified(tried, then, first_metric(tried, shape), LONG_POLISH, TOLERANCE, reach(best))
        if then.worst < TOLERANCE:
            held, best, now = tried, then, value
            if value == goal:
                break
            share = min(1.0, 2.0 * share)
        else:
            share /= 2.0
    return held, best


def value_of(problem: Problem, point: Polished, key: int) -> float:
    """Logarithm of the descriptor that belongs to a condition."""
    shape = point.shape
    there = measured(problem, shape.normals, shape.offsets, point.frames, NOWHERE)
    at = int(np.count_nonzero(problem.asked[:key]))
    return float(there.conditions.residual[at] + problem.wanted[key])
