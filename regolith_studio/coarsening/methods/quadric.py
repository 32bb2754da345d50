"""Quadric decimation of the convex hull: the paper's baseline, and the start of its annealing."""

from collections.abc import Generator, Mapping
from dataclasses import dataclass, field

import numpy as np

from regolith_studio.coarsening.decimated_hull import decimated_hull
from regolith_studio.coarsening.loss import loss
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.describe import describe, relative_errors
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.messages import N_


@dataclass(frozen=True)
class QuadricSettings:
    """Whether the half-spaces' polyhedron is scaled to the volume of the particle."""

    restore_volume: bool = field(default=False, metadata={"label": N_("Restore the volume")})


class QuadricMethod:
    """Fast quadric mesh simplification of the convex hull (section 2.4); weights do not matter."""

    key = "quadric"
    label = N_("Quadric decimation")
    keeps_terms = False
    Settings = QuadricSettings

    def run(
        self,
        target: Target,
        n_facets: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,  # noqa: ARG002
        settings: QuadricSettings,
        fewer: HalfSpaces | None = None,  # noqa: ARG002
    ) -> Generator[MethodStep, None, MethodResult]:
        """One step; the loss is that of the half-spaces."""
        decimated = decimated_hull(target, n_facets)
        polyhedron = decimated.polyhedron
        planes = decimated.half_spaces.scaled(polyhedron.volume ** (-1 / 3))
        restored = ConvexPolyhedron.from_half_spaces(planes)
        solids: Mapping[str, Mesh | ConvexPolyhedron] = {
            "mesh": decimated.mesh,
            "half_spaces": polyhedron,
            "volume_restored": restored,
        }
        achieved = {name: describe(solid) for name, solid in solids.items()}
        variants = {
            name: dict(relative_errors(target.descriptors, found)) for name, found in achieved.items()
        }
        variants["half_spaces"][JACCARD] = target.jaccard_distance(polyhedron.half_spaces)
        variants["volume_restored"][JACCARD] = target.jaccard_distance(restored.half_spaces)
        chosen, solid = "half_spaces", polyhedron
        if settings.restore_volume:
            chosen, solid = "volume_restored", restored
        distance = variants[chosen][JACCARD]
        value = loss(weights, variants[chosen], distance)
        yield MethodStep(1, 1, value, solid.half_spaces)
        return MethodResult(
            solid.half_spaces,
            loss_history=(value,),
            variants=variants,
            polyhedron=solid,
            achieved=achieved[chosen],
            jaccard_distance=distance,
        )


METHOD = QuadricMethod()
