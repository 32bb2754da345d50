"""What one iteration of the paper's annealing proposes and decides (section 2.4)."""

from dataclasses import dataclass

from regolith_studio.coarsening.evaluation import Evaluation
from regolith_studio.geometry.arrays import FloatArray


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
