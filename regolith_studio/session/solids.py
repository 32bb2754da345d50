"""The polyhedra of Fig. 7: some particles, coarsened once for each row of loss weights."""

import dataclasses
from collections.abc import Generator, Sequence
from dataclasses import dataclass

from regolith_studio.errors import RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.jobs.answers import Answers
from regolith_studio.jobs.coarsening import CoarsenedParticle, CoarseningOrder, coarsen_particle
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.session.choices import L_MAX_LIMIT
from regolith_studio.studies.loss_rows import StudyRow, paper_rows
from regolith_studio.studies.solid_study import SolidStudy


@dataclass(frozen=True)
class Solid:
    """One picture of the gallery.

    Parameters
    ----------
    row, column
        Which loss and which particle, from 0.
    outcome
        The polyhedron, or why there is none.
    """

    row: int
    column: int
    outcome: CoarsenedParticle


def draw_solids(
    particles: Sequence[Particle], order: CoarseningOrder, rows: Sequence[StudyRow] | None = None
) -> Steps:
    """Coarsen each particle by the loss of each row; partial results and the result are ``list[Solid]``.

    Parameters
    ----------
    order
        Method, number of faces, settings, seed and target of all.
    rows
        Whose weights are taken; those of Fig. 8 by default.
    """
    chosen = paper_rows() if rows is None else tuple(rows)
    total = len(particles) * len(chosen)
    yield Started("Coarsening for the gallery", total)
    done: list[Solid] = []
    for column, particle in enumerate(particles):
        fit = order.expansion.fit(particle.mesh, L_MAX_LIMIT) if order.target == "fit" else None
        for row, each in enumerate(chosen):
            outcome = yield from _outcome(
                particle, _by_row(order, each), column, fit, Progress(len(done), total)
            )
            done.append(Solid(row, column, outcome))
            yield Partial(list(done))
            yield Progress(len(done), total, particle.name)
    return done


def study_solids(
    particles: Sequence[Particle],
    order: CoarseningOrder,
    rows: Sequence[StudyRow] | None = None,
    answers: Answers | None = None,
) -> Steps:
    """As :func:`draw_solids`; the result is the study that can be written. No `answers` are kept of it."""
    del answers
    chosen = paper_rows() if rows is None else tuple(rows)
    solids = yield from draw_solids(particles, order, chosen)
    return solid_study(solids, [row.label for row in chosen], [particle.name for particle in particles])


def solid_study(solids: Sequence[Solid], labels: Sequence[str], names: Sequence[str]) -> SolidStudy:
    """What has been drawn, as a study that can be written."""
    cells = {(each.row, each.column): each.outcome.coarsened or each.outcome.problem for each in solids}
    return SolidStudy(tuple(labels), tuple(names), cells)


def _by_row(order: CoarseningOrder, row: StudyRow) -> CoarseningOrder:
    plain = dataclasses.replace(order, weights=row.weights, largest_error=None)
    if row.weights.all_zero:  # the quadric start itself
        return dataclasses.replace(plain, method="quadric", settings=())
    return plain


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
