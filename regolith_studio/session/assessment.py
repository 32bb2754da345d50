"""The errors of a polyhedron in three numbers and a sentence."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.coarsening.lower_bounds import bounds_in_force
from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.jobs.coarsening_jobs import ParticleComparison
from regolith_studio.messages import N_, Message, Number, join_messages

CLOSE = 1e-3
"""Relative error up to which a descriptor counts as met."""


@dataclass(frozen=True)
class PolyhedronAssessment:
    """How well a polyhedron stands for what it imitates.

    - ``loss``: eq. 9.
    - ``rmsre``: root of the mean squared relative error (Eq. 10) over the weighted descriptors; NaN if there
      are none.
    - ``jaccard_distance``: eq. 7.
    - ``sentence``: which descriptors are met, and how far the polyhedron is from the particle itself.
    """

    loss: float
    rmsre: float
    jaccard_distance: float
    sentence: str


def assess_polyhedron(
    coarsened: CoarseningResult,
    weights: LossWeights,
    against_particle: ParticleComparison | None = None,
    fewer: tuple[int, float] | None = None,
) -> PolyhedronAssessment:
    """The assessment on a finished coarsening.

    - ``weights``: those of its loss.
    - ``against_particle``: the polyhedron of a fit against the particle itself.
    - ``fewer``: number of facets and loss of a polyhedron with fewer facets and no larger loss.
    """
    chosen = [key for key in LOSS_KEYS if weights[key]]
    errors = np.array([coarsened.errors[key] for key in chosen])
    parts = [_met(coarsened, chosen)]
    if fewer is not None:
        template = N_("More facets do not help here: {count} facets had a loss of {loss}.")
        parts.append(Message(template, count=fewer[0], loss=Number(fewer[1], "#.4g")))
    if against_particle is not None:
        parts.append(cost_of_imitating_the_fit(against_particle))
    return PolyhedronAssessment(
        coarsened.loss,
        float(np.sqrt(np.mean(errors**2))) if chosen else float("nan"),
        coarsened.jaccard_distance,
        join_messages(parts),
    )


def assess_step(step: CoarseningProgress, weights: LossWeights) -> PolyhedronAssessment | None:
    """The assessment on a step of a coarsening that runs; ``None`` where its polyhedron was not measured."""
    if not step.errors:
        return None
    errors = np.array([step.errors[key] for key in LOSS_KEYS if weights[key]])
    error = float(np.sqrt(np.mean(errors**2))) if len(errors) else float("nan")
    return PolyhedronAssessment(step.loss, error, step.jaccard_distance, N_("Best so far."))


def redundant_planes(coarsened: CoarseningResult) -> str | None:
    """How many of the planes bound a facet, where some do not; else ``None``."""
    if coarsened.n_facets >= coarsened.n_facets_asked:
        return None
    template = N_("The result has {real} facets instead of {faces}: the other planes bound none.")
    return Message(template, real=coarsened.n_facets, faces=coarsened.n_facets_asked)


def cost_of_imitating_the_fit(comparison: ParticleComparison) -> str:
    """The largest error of a fit's polyhedron against the particle itself, as a sentence."""
    worst = max(LOSS_KEYS, key=lambda key: comparison.errors[key])
    template = N_("Vs. particle: {symbol} {error}, Jaccard distance {distance}.")
    distance = _percent(comparison.jaccard_distance)
    return Message(
        template, symbol=CATALOGUE[worst].symbol, error=_percent(comparison.errors[worst]), distance=distance
    )


def _met(coarsened: CoarseningResult, chosen: list[str]) -> str:
    if not chosen:
        return N_("Only the overlap has a weight.")
    held = bounds_in_force(coarsened.bounds, coarsened.errors)
    excess = {key: coarsened.errors[key] - held[key] for key in chosen}
    if max(excess.values()) > CLOSE:
        worst = max(chosen, key=lambda key: coarsened.errors[key])
        template = N_("The largest error of a weighted descriptor is {error}, of {symbol}.")
        return Message(template, symbol=CATALOGUE[worst].symbol, error=_percent(coarsened.errors[worst]))
    bound = max(chosen, key=lambda key: held[key])
    if held[bound] > CLOSE:
        template = N_("Exact except {symbol} ({error}, the least possible).")
        return Message(template, symbol=CATALOGUE[bound].symbol, error=_percent(held[bound]))
    return N_("All weighted descriptors are met within 0.1 %.")


def _percent(share: float) -> str:
    return Number(100 * share, ".3g", " %")
