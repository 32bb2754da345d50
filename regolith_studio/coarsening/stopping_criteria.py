"""The fewest facets whose largest error is small enough."""

import math
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from regolith_studio.coarsening.coarsen import coarsening_steps
from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.settings import DEFAULT_METHOD, DEFAULT_PRESET, FACETS_LIMITS
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.messages import N_, Message, Number
from regolith_studio.steps import result_of


@dataclass(frozen=True)
class Trial:
    """A coarsening with one number of facets, and its largest error."""

    n_facets: int
    largest_error: float
    result: CoarseningResult


def largest_error(
    result: CoarseningResult, weights: LossWeights, jaccard_limit: float | None = None
) -> float:
    """Largest relative error of the weighted descriptors, beyond what no polyhedron can avoid.

    V and CH cannot both be met; of the one that gives way only the excess over its bound counts. With
    `jaccard_limit` the Jaccard distance takes part, scaled so that the limit counts as no error.
    """
    errors = [
        max(0.0, error - result.bounds[key]) if key in ("volume", "convex_hull_volume") else error
        for key, error in result.errors.items()
        if weights[key]
    ]
    if jaccard_limit is not None:
        errors.append(max(0.0, result.jaccard_distance - jaccard_limit))
    return max(errors, default=0.0)


def fewest_facets(
    mesh: Mesh | Target,
    limit: float,
    jaccard_limit: float | None = None,
    method: str = DEFAULT_METHOD,
    weights: LossWeights | None = None,
    seed: int = 0,
    settings: Any = None,
) -> Generator[CoarseningProgress | Trial, None, CoarseningResult]:
    """The polyhedron with the fewest facets whose weighted descriptors are all off by at most `limit`.

    Doubles the number of facets from 5 until the limit is met, then halves the interval; each trial has one
    more start, from the result with the next smaller number tried. Yields the steps of each coarsening,
    counted through, and each :class:`Trial`. Where not even 500 facets meet the limit, the
    trial with the least error is the result, and its `reason` says so.

    Parameters
    ----------
    limit
        Relative error, for example 0.01.
    jaccard_limit
        The Jaccard distance must not exceed it either, where given.

    Raises
    ------
    InputError
        If the limit is not positive, or no descriptor has a weight.
    """
    check_limit(limit)
    weights = LossWeights.from_preset(DEFAULT_PRESET) if weights is None else weights
    if jaccard_limit is None and weights.replaced(**{JACCARD: 0.0}).all_zero:
        raise InputError("No descriptor has a weight, so there is no error to stop at.")
    target = mesh if isinstance(mesh, Target) else Target.of(mesh)
    done = 0
    results: dict[int, CoarseningResult] = {}

    def tried(n_facets: int) -> Generator[CoarseningProgress | Trial, None, Trial]:
        nonlocal done
        before = done
        fewer = max((number for number in results if number < n_facets), default=None)
        start = None if fewer is None else results[fewer].half_spaces
        steps = coarsening_steps(target, n_facets, method, weights, seed, settings, start)
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                results[n_facets] = end.value
                trial = Trial(n_facets, largest_error(end.value, weights, jaccard_limit), end.value)
                yield trial
                return trial
            done = before + step.step
            yield replace(step, step=done, steps=before + step.steps)

    low, high = FACETS_LIMITS
    failed: list[Trial] = []
    n_facets = low
    while (best := (yield from tried(n_facets))).largest_error > limit:
        failed.append(best)
        if n_facets == high:
            return _least(failed, limit)
        n_facets = min(2 * n_facets, high)
    # Below the lowest number there is nothing to halve.
    bottom = failed[-1].n_facets if failed else low - 1
    while best.n_facets - bottom > 1:
        trial = yield from tried((best.n_facets + bottom) // 2)
        if trial.largest_error <= limit:
            best = trial
        else:
            bottom = trial.n_facets
    return best.result


def coarsen_below(mesh: Mesh | Target, limit: float, **options: Any) -> CoarseningResult:
    """The result of :func:`fewest_facets`, whose `options` it takes."""
    return result_of(fewest_facets(mesh, limit, **options))


def check_limit(limit: float) -> None:
    """Refuse a largest error that is not a positive number."""
    if not 0.0 < limit < math.inf:
        raise InputError(f"The largest error must be above 0 per cent, got {100 * limit:g}.")


def _least(failed: Sequence[Trial], limit: float) -> CoarseningResult:
    """The best of the trials, with the reason why it is not good enough."""
    least = min(failed, key=lambda trial: trial.largest_error)
    reason = Message(
        N_(
            "No polyhedron was found whose errors are all below {limit} %, with up to {faces} facets: the"
            " least is {error} %, with {count} facets."
        ),
        faces=failed[-1].n_facets,
        limit=Number(100 * limit, "g"),
        error=Number(100 * least.largest_error, ".2g"),
        count=least.n_facets,
    )
    return replace(least.result, reason=reason)
