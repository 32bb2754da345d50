"""Progress of a coarsening: the steps of a method, and the proposals of simulated annealing."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from regolith_studio.coarsening.loss import Evaluation
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Move:
    """One proposal, for a particle of unit volume with its centroid at the origin.

    Point number `plane` of the points (n, 3) was moved by a step of standard deviation `sigma` in each
    coordinate. `proposed` is ``None`` where the half-spaces bound no polyhedron. A worse one is taken where
    the random number `drawn` is below `probability`, T(k).
    """

    plane: int
    points: FloatArray
    sigma: float
    before: Evaluation
    proposed: Evaluation | None
    probability: float
    drawn: float
    accepted: bool

    @property
    def better(self) -> bool:
        """Whether the proposal has the smaller loss."""
        return self.proposed is not None and self.proposed.loss < self.before.loss


@dataclass(frozen=True)
class MethodStep:
    """One step of a method, for a particle of unit volume with its centroid at the origin.

    `steps` is how many there will be at most, `loss` Eq. 9 as the method evaluates it. The polyhedron is
    ``None`` where it is that of the step before; `compound` makes the union of a method that makes one.
    """

    step: int
    steps: int
    loss: float
    half_spaces: HalfSpaces | None = None
    move: Move | None = None
    compound: Callable[[], ConvexCompound] | None = None


@dataclass(frozen=True)
class CoarseningProgress:
    """One step of a coarsening, in the unit of the particle.

    The polyhedron is about `centre`, the particle's centroid in its own frame, and ``None`` where it is that
    of the step before. `recent` has the last steps with this one, for a listener that does not receive each.
    Descriptors, their relative errors (Eq. 8) and Eq. 7 as it follows from the loss (NaN without weight) are
    empty where the step was not measured.
    """

    step: int
    steps: int
    loss: float
    polyhedron: Polyhedron | None
    centre: FloatArray
    recent: "tuple[CoarseningProgress, ...]" = ()
    achieved: Mapping[str, float] = field(default_factory=dict)
    errors: Mapping[str, float] = field(default_factory=dict)
    jaccard_distance: float = math.nan

    @property
    def mesh(self) -> Mesh | None:
        """Triangles of the polyhedron in the particle's own frame."""
        return None if self.polyhedron is None else placed(self.polyhedron, self.centre)


def placed(polyhedron: Polyhedron, centre: FloatArray) -> Mesh:
    """Triangles of a polyhedron whose origin lies at `centre`."""
    return Mesh(polyhedron.mesh.vertices + np.asarray(centre), polyhedron.mesh.faces)
