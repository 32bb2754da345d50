"""Progressive convex hull simplification (Jacobson 2026, arXiv 2604.14468): a baseline around the particle.

The package ``pchs`` is optional: MIT, with parts under MPL-2.0 (libigl, Eigen).
"""

from collections.abc import Generator
from dataclasses import dataclass, field
from importlib import import_module

import numpy as np

from regolith_studio.coarsening.loss import LossFunction
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.reasons import own_reason
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import InputError
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.messages import N_

COSTS = ("volume", "area")


@dataclass(frozen=True)
class PchsSettings:
    """What each removed facet of the hull is to add least of: ``volume`` or ``area``."""

    cost: str = field(default="volume", metadata={"label": N_("Cost"), "choices": COSTS})

    def __post_init__(self) -> None:
        if self.cost not in COSTS:
            raise InputError(f"The cost must be one of {', '.join(COSTS)}, got {self.cost!r}.")


class PchsMethod:
    """The convex hull without most of its facets, the cheapest removed first; weights do not matter.

    The polyhedron contains the particle, so its volume is larger.
    """

    key = "pchs"
    label = N_("Progressive convex hull")
    keeps_terms = False
    Settings = PchsSettings

    def run(
        self,
        target: Target,
        n_facets: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,  # noqa: ARG002
        settings: PchsSettings,
        fewer: HalfSpaces | None = None,  # noqa: ARG002
    ) -> Generator[MethodStep, None, MethodResult]:
        """One step, where the package ``pchs`` is installed."""
        try:
            pchs = import_module("pchs")
        except ImportError:
            raise InputError(
                "The method pchs needs the package pchs: install regolith-studio with the extra pchs, or take"
                " another method."
            ) from None
        hull = target.mesh.hull
        cost = getattr(pchs.CostFunction, settings.cost)
        faces = np.asfortranarray(hull.faces, dtype=np.int32)
        simplified = pchs.ConvexHullSimplification(
            np.asfortranarray(hull.vertices), faces, cost_function=cost
        )
        simplified.simplify_to(n_facets)
        poles, _ = simplified.get_dual_mesh()  # normals over their distances from a point inside the hull
        normals = np.ascontiguousarray(poles / np.linalg.norm(poles, axis=1, keepdims=True))
        # Where it lies is not reported, but every plane that is left still supports the hull.
        half_spaces = HalfSpaces(normals, (hull.vertices @ normals.T).max(axis=0))
        value = LossFunction(target, weights, everything=True).value(half_spaces.normals, half_spaces.offsets)
        yield MethodStep(1, 1, value, half_spaces)
        return MethodResult(half_spaces, (value,), own_reason(len(half_spaces), n_facets))


METHOD = PchsMethod()
