"""Descriptors as conditions: met to 1e-6, or a reason given; the rest of the freedom goes into overlap."""

from collections.abc import Generator
from dataclasses import dataclass, field

import numpy as np

from regolith_studio.coarsening.exact.multi_start import LEVELS, Search
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

    Parameters
    ----------
    level
        ``fast`` (one start) or ``best`` (that start, then six more, the best continued: better overlap).
    retries
        Further starts where no polyhedron meets all conditions.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    level: str = field(default="fast", metadata={"label": N_("Level"), "choices": tuple(LEVELS)})
    retries: int = field(default=8, metadata={"label": N_("Retries"), "minimum": 0, "maximum": 100})

    def __post_init__(self) -> None:
        if self.level not in LEVELS:
            raise InputError(f"The level must be one of {', '.join(LEVELS)}, got {self.level!r}.")
        if not 0 <= self.retries <= 100:
            raise InputError(f"The retries must lie between 0 and 100, got {self.retries}.")


class ExactMethod:
    """Constrained optimisation of the half-spaces.

    Weights above 0 make constraints: volume (or, if the weights of Eq. 9 prefer it, convex hull volume),
    sphericity, shortest and longest edge of the exact minimum-volume box, aspect ratio. On the surface where
    all hold, the Jaccard distance goes down; it is the tie-break even where its own weight is 0, since
    shapes that only meet descriptors drift away from the particle.
    """

    key = "exact"
    label = N_("Exact descriptors")
    Settings = ExactSettings

    def run(
        self,
        target: Target,
        n_facets: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,
        settings: ExactSettings,
    ) -> Generator[MethodStep, None, MethodResult]:
        """A step for each better polyhedron; the first is the start, the last what is reported."""
        return (yield from self.run_from_fewer(target, None, n_facets, weights, seed, settings))

    def run_from_fewer(
        self,
        target: Target,
        fewer: HalfSpaces | None,
        n_facets: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,
        settings: ExactSettings,
    ) -> Generator[MethodStep, None, MethodResult]:
        """As :meth:`run`, with one more start: facets are cut out of `fewer`, at unit volume."""
        levels = [LEVELS["fast"]] + [LEVELS["best"]] * (settings.level == "best")
        search = Search(target, weights, n_facets, levels, settings.retries, seed, fewer)
        yield from search.steps()
        return (yield from search.finish())


METHOD = ExactMethod()
