"""Unions of few convex parts that keep all descriptors, the convex hull volume among them."""

from collections.abc import Generator
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from regolith_studio.coarsening.core.line_overlap import compound_distance
from regolith_studio.coarsening.loss import loss
from regolith_studio.coarsening.optimiser.compound_search import (
    MIN_FACETS,
    CompoundCandidate,
    asked_terms,
    compound_of,
    search_compound,
)
from regolith_studio.coarsening.optimiser.search import EFFORTS as CONVEX_EFFORTS
from regolith_studio.coarsening.optimiser.search import TERMS, Search, SearchEffort
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.reasons import missed_terms, named_errors
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.describe import Descriptors, describe, relative_errors
from regolith_studio.errors import InputError
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.messages import N_, Message, join_messages
from regolith_studio.settings import is_whole
from regolith_studio.steps import result_of

PARTS_LIMITS = (2, 8)
CONVEX = 1e-6
"""Particles whose volume is less below that of their hull, as a share, are convex."""
RETRIES = 8
JOINTS = ("overlap", "touch")
EFFORTS = {"fast": SearchEffort(8, 3), "best": SearchEffort(16, 5)}
"""By level."""


@dataclass(frozen=True)
class CompoundSettings:
    """At most 2 to 8 convex parts, and the effort.

    Parts ``overlap``, so that a solver sees a welded body, or ``touch`` in planes between them, so that their
    volumes and masses add up. The level is ``fast`` (8 starts, the best 3 of which descend further) or
    ``best`` (16 and 5: better overlap).
    """

    parts: int = field(
        default=4,
        metadata={"label": N_("Convex parts"), "minimum": PARTS_LIMITS[0], "maximum": PARTS_LIMITS[1]},
    )
    joint: str = field(default="overlap", metadata={"label": N_("Parts overlap or touch"), "choices": JOINTS})
    level: str = field(default="fast", metadata={"label": N_("Level"), "choices": tuple(EFFORTS)})

    def __post_init__(self) -> None:
        low, high = PARTS_LIMITS
        if not is_whole(self.parts) or not low <= self.parts <= high:
            raise InputError(
                f"The number of parts must be a whole number from {low} to {high}, got {self.parts}."
            )
        if self.joint not in JOINTS:
            raise InputError(f"The parts either overlap or touch, got {self.joint!r}.")
        if self.level not in EFFORTS:
            raise InputError(f"The level must be one of {', '.join(EFFORTS)}, got {self.level!r}.")


class CompoundMethod:
    """Constrained optimisation of the planes of several convex parts.

    Terms that are to be kept, or else weights above 0, make conditions on the union: volume, sphericity,
    shortest and longest edge of its exact minimum-volume box, aspect ratio, convex hull volume. On the
    surface where all hold, the Jaccard distance goes down. There are at most `parts` parts with 5 facets or
    more each, which overlap or touch. The result is the polyhedron of the exact method where that is better,
    or the particle is convex, or there are fewer than 10 facets, which do not suffice for two parts.
    """

    key = "compound"
    label = N_("Compound of convex parts")
    keeps_terms = True
    Settings = CompoundSettings

    def run(
        self,
        target: Target,
        n_facets: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,
        settings: CompoundSettings,
        fewer: HalfSpaces | None = None,  # noqa: ARG002
    ) -> Generator[MethodStep, None, MethodResult]:
        """A step for each start and each better compound of the last descents."""
        parts = min(settings.parts, n_facets // MIN_FACETS)
        convex = CONVEX_EFFORTS[settings.level]
        search = Search(target, weights, weights.kept, n_facets, convex, RETRIES, seed)
        if target.solidity > 1.0 - CONVEX or parts < PARTS_LIMITS[0]:
            result = yield from search.steps()
            return replace(result, makes_compounds=True, reason=_reason_of_one(target, weights, result))
        effort, touching = EFFORTS[settings.level], settings.joint == "touch"
        run = search_compound(target, weights, parts, n_facets, effort, seed, touching)
        result = yield from _compound(target, n_facets, weights, parts, effort, run)
        one = result_of(search.steps())
        if _rank(target, weights, one) < _rank(target, weights, result):
            missing = one.achieved and _reason(target, weights, one.achieved, parts, n_facets)
            return replace(one, makes_compounds=True, reason=missing or one.reason)
        return result


def _rank(target: Target, weights: LossWeights, result: MethodResult) -> tuple[bool, float]:
    """Sorting key, the best first: whether all that is asked for is met, then Eq. 9."""
    solid, achieved = result.solid, result.achieved
    assert achieved is not None, "both searches measure what they return"
    if isinstance(solid, ConvexCompound):
        overlap = compound_distance(target.mesh, solid)
    else:
        overlap = target.jaccard_distance(solid)
    errors = relative_errors(target.descriptors, achieved)
    return bool(_missed(target, weights, achieved)), loss(weights, errors, overlap)


def _compound(
    target: Target,
    n_facets: int,
    weights: LossWeights,
    parts: int,
    effort: SearchEffort,
    run: Generator[CompoundCandidate, None, CompoundCandidate],
) -> Generator[MethodStep, None, MethodResult]:
    history: list[float] = []
    while True:
        try:
            found = next(run)
        except StopIteration as end:
            best: CompoundCandidate = end.value
            break
        history.append(_loss(weights, found))
        step = min(len(history), effort.starts)
        yield MethodStep(step, effort.starts, history[-1], compound=partial(compound_of, found.planes))
    solid = compound_of(best.planes)
    achieved = describe(solid)
    steps = {"starts": float(min(len(history), effort.starts)), "better": float(len(history))}
    return MethodResult(
        solid,
        loss_history=tuple(history),
        reason=_reason(target, weights, achieved, parts, n_facets),
        steps=steps,
        achieved=achieved,
    )


def _loss(weights: LossWeights, found: CompoundCandidate) -> float:
    """Eq. 9 by what the search has measured; descriptors that no condition is about count as met."""
    missed = dict(zip(TERMS, np.abs(found.residuals).tolist(), strict=True))
    return loss(weights, missed, found.distance)


def _reason(
    target: Target, weights: LossWeights, achieved: Descriptors, parts: int, n_facets: int
) -> str | None:
    """One sentence that names every descriptor that is missed; ``None`` where all asked for are met."""
    if not (missed := _missed(target, weights, achieved)):
        return None
    return Message(
        N_(
            "No compound of {parts} parts with {faces} facets was found that meets all descriptors; this one"
            " misses {missed}. More parts or facets, or a weight of 0 for a descriptor, may help."
        ),
        parts=parts,
        faces=n_facets,
        missed=missed,
    )


def _reason_of_one(target: Target, weights: LossWeights, result: MethodResult) -> str | None:
    """Why a polyhedron stands for a particle that is not convex, before the reason of the exact method."""
    if target.solidity > 1.0 - CONVEX or result.achieved is None:
        return result.reason
    if not (missed := _missed(target, weights, result.achieved)):
        return result.reason
    few = Message(
        N_(
            "Two parts need {faces} facets; with fewer the result is one convex polyhedron, which misses"
            " {missed}."
        ),
        faces=PARTS_LIMITS[0] * MIN_FACETS,
        missed=missed,
    )
    return few if result.reason is None else join_messages((few, result.reason), " ")


def _missed(target: Target, weights: LossWeights, achieved: Descriptors) -> str:
    """The weighted descriptors that are missed and by how much, the largest error first; may be empty."""
    missed = missed_terms(target.descriptors, achieved, asked_terms(weights))
    return named_errors(missed) if missed else ""


METHOD = CompoundMethod()
