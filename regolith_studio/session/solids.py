"""The polyhedra of Fig. 7: some particles, coarsened once for each row of loss weights."""

import dataclasses
from collections.abc import Generator, Sequence
from dataclasses import dataclass

from regolith_studio.coarsening.weights import presets
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.jobs.coarsening import CoarsenedParticle, CoarseningOrder, coarsen_particle
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.session.choices import L_MAX_LIMIT
from regolith_studio.studies.loss_rows import PAPER_ROWS


@dataclass(frozen=True)
class Solid:
    """One picture of the gallery.

    Parameters
    ----------
    row, column
        Which preset and which particle, from 0.
    outcome
        The polyhedron, or why there is none.
    """

    row: int
    column: int
    outcome: CoarsenedParticle


def row_labels() -> tuple[str, ...]:
    """What the rows are called: the presets of Fig. 8."""
    return tuple(presets()[name].label for name in PAPER_ROWS)


def draw_solids(particles: Sequence[Particle], order: CoarseningOrder) -> Steps:
    """Coarsen each particle by each row of the paper; partial results and the result are ``list[Solid]``."""
    total = len(particles) * len(PAPER_ROWS)
    yield Started("Coarsening for the gallery", total)
    done: list[Solid] = []
    for column, particle in enumerate(particles):
        fit = order.expansion.fit(particle.mesh, L_MAX_LIMIT) if order.target == "fit" else None
        for row, name in enumerate(PAPER_ROWS):
            outcome = yield from _outcome(
                particle, _by_row(order, name), column, fit, Progress(len(done), total)
            )
            done.append(Solid(row, column, outcome))
            yield Partial(list(done))
            yield Progress(len(done), total, particle.name)
    return done


def _by_row(order: CoarseningOrder, preset: str) -> CoarseningOrder:
    weights = presets()[preset].weights
    if weights.all_zero:  # the quadric start itself
        return dataclasses.replace(order, weights=weights, method="quadric", settings=())
    return dataclasses.replace(order, weights=weights)


def _outcome(
    particle: Particle, order: CoarseningOrder, index: int, fit: HarmonicFit | None, now: Progress
) -> Generator[Step, None, CoarsenedParticle]:
    """What became of one coarsening; its own steps are not told, but it can be stopped between them."""
    story = coarsen_particle(particle, order, index, fit)
    try:
        while True:
            next(story)
            yield now
    except StopIteration as end:
        outcome: CoarsenedParticle = end.value
        return outcome
    except RegolithError as error:
        return CoarsenedParticle(particle.name, index, None, str(error))
