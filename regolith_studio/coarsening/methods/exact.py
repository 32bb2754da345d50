"""Descriptors kept to 1e-6, or a reason given; the rest of the freedom goes into the loss."""

from collections.abc import Generator
from dataclasses import dataclass, field

import numpy as np

from regolith_studio.coarsening.optimiser.search import EFFORTS, Search
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import InputError
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.messages import N_


@dataclass(frozen=True)
class ExactSettings:
    """Effort of the exact method.

    One start (``fast``), or ten more, the better half of which go on after 30 steps, and the best three to
    the end (``best``: better overlap). Where none keeps what is to be kept, so many further starts:
    `retries`.
    """

    level: str = field(default="fast", metadata={"label": N_("Level"), "choices": tuple(EFFORTS)})
    retries: int = field(default=8, metadata={"label": N_("Retries"), "minimum": 0, "maximum": 100})

    def __post_init__(self) -> None:
        if self.level not in EFFORTS:
            raise InputError(f"The level must be one of {', '.join(EFFORTS)}, got {self.level!r}.")
        if not 0 <= self.retries <= 100:
            raise InputError(f"The retries must lie between 0 and 100, got {self.retries}.")


class ExactMethod:
    """Sequential quadratic programming of Eq. 9, an exact penalty.

    Terms that are to be kept are met to 1e-6: volume, sphericity, shortest and longest edge of the exact
    minimum-volume box and aspect ratio by default. The others have their weight as a price, the Jaccard
    distance a small one even where its weight is 0: shapes that only meet descriptors drift away from the
    particle.
    """

    key = "exact"
    label = N_("Exact descriptors")
    keeps_terms = True
    Settings = ExactSettings

    def run(
        self,
        target: Target,
        n_facets: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,
        settings: ExactSettings,
        fewer: HalfSpaces | None = None,
    ) -> Generator[MethodStep, None, MethodResult]:
        """A step for each better polyhedron; the first is the start, the last what is reported.

        Facets are cut out of `fewer`, at unit volume, for one more start.
        """
        effort = EFFORTS[settings.level]
        search = Search(target, weights, weights.kept, n_facets, effort, settings.retries, seed, fewer)
        return (yield from search.steps())


METHOD = ExactMethod()
