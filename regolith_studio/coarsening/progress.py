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

    Parameters
    ----------
    plane
        Index i of the point p_i that is moved.
    points
        The points with p_i', shape (n, 3).
    sigma
        Standard deviation of the step in each coordinate.
    before
        Errors and loss (Eq. 9) of the polyhedron as it was.
    proposed
        The same of the proposal; ``None`` where its half-spaces bound no polyhedron.
    probability
        T(k), with which a worse polyhedron is taken.
    drawn
        The uniform random number that was compared with T(k).
    accepted
        Whether the proposal is the polyhedron from now on.
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

    Parameters
    ----------
    step, steps
        Steps done, and how many there will be at most.
    loss
        Eq. 9 for `half_spaces`, as the method evaluates it.
    half_spaces
        The polyhedron, where it differs from that of the step before; else ``None``.
    move
        What was proposed and decided, where the method works by proposals.
    compound
        Makes the union of convex parts, in place of `half_spaces`, where the method makes one.
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

    Parameters
    ----------
    step, steps
        Steps done, and how many there will be at most.
    loss
        Eq. 9 for the present polyhedron.
    polyhedron
        About `centre`, where it differs from that of the step before; else ``None``.
    centre
        The particle's centroid in its own frame, shape (3,).
    recent
        The last steps with this one, for a listener that does not receive each.
    achieved, errors, jaccard_distance
        Descriptors of the polyhedron, their relative errors (Eq. 8) and Eq. 7 as it follows from the loss,
        NaN without weight; empty where the step was not measured.
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
