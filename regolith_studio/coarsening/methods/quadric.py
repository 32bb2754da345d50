"""Quadric decimation of the convex hull: the paper's baseline, and the start of its annealing."""

from collections.abc import Generator, Mapping
from dataclasses import dataclass, field

import numpy as np

from regolith_studio.coarsening.decimated_hull import decimated_hull, quadric_half_spaces
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


def variants(target: Target, n_facets: int) -> dict[str, dict[str, float]]:
    """Errors of the three readings of the baseline: ``mesh``, ``half_spaces``, ``volume_restored``."""
    half_spaces = quadric_half_spaces(target, n_facets)
    polyhedron = ConvexPolyhedron.from_half_spaces(half_spaces)
    restored = ConvexPolyhedron.from_half_spaces(restored_volume(half_spaces))
    solids: Mapping[str, Mesh | ConvexPolyhedron] = {
        "mesh": decimated_hull(target, n_facets),
        "half_spaces": polyhedron,
        "volume_restored": restored,
    }
    table = {name: dict(relative_errors(target.descriptors, describe(s))) for name, s in solids.items()}
    table["half_spaces"][JACCARD] = target.jaccard_distance(polyhedron.half_spaces)
    table["volume_restored"][JACCARD] = target.jaccard_distance(restored.half_spaces)
    return table


def restored_volume(half_spaces: HalfSpaces) -> HalfSpaces:
    """The same polyhedron scaled to unit volume."""
    return half_spaces.scaled(ConvexPolyhedron.from_half_spaces(half_spaces).volume ** (-1 / 3))


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
        half_spaces = quadric_half_spaces(target, n_facets)
        if settings.restore_volume:
            half_spaces = restored_volume(half_spaces)
        others = variants(target, n_facets)
        chosen = others["volume_restored" if settings.restore_volume else "half_spaces"]
        value = loss(weights, chosen, chosen[JACCARD])
        yield MethodStep(1, 1, value, half_spaces)
        return MethodResult(half_spaces, loss_history=(value,), variants=others)


METHOD = QuadricMethod()
