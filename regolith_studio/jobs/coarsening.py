"""Coarsens one particle, with every better polyhedron on the way, or a whole sample."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.jobs.events import Partial, Progress, Started, Steps

if TYPE_CHECKING:
    from regolith_studio.coarsening.weights import LossWeights


@dataclass(frozen=True)
class CoarseningOrder:
    """What is asked of a coarsening; picklable.

    Parameters
    ----------
    weights
        Of the loss, Eq. 9.
    settings
        The method's settings that differ from its defaults, as (name, value) pairs.
    target
        ``fit``: the surface at degree `l_max` is imitated; ``particle``: the mesh itself.
    """

    weights: "LossWeights"
    n_faces: int = 20
    method: str = "annealing"
    settings: tuple[tuple[str, bool | int | float | str], ...] = ()
    seed: int = 0
    target: str = "fit"
    l_max: int = 10
    level: int = 4


def coarsen_one(mesh: Mesh, order: CoarseningOrder, particle_index: int = 0) -> Steps:
    """Coarsen `mesh` as ordered; partial results are ``CoarseningProgress``, the result ``Coarsened``."""
    from regolith_studio.coarsening.coarsen import coarsening_steps

    yield Started("Coarsening")
    steps = coarsening_steps(
        mesh,
        n_faces=order.n_faces,
        method=order.method,
        weights=order.weights,
        seed=order.seed,
        particle_index=particle_index,
        settings=dict(order.settings) or None,
    )
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            return end.value
        yield Partial(step)
        yield Progress(step.step, step.steps)
