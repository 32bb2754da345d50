"""Studies of the present choices: rows of loss weights, the jobs of the studies, the gallery of Fig. 7."""

import dataclasses
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle, CoarseningRequest, coarsen_particle
from regolith_studio.jobs.events import Job, Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, open_executor
from regolith_studio.jobs.study_checkpoint import StudyCheckpoint, hash_of_particles
from regolith_studio.jobs.study_jobs import study_coarsening, study_lmax
from regolith_studio.messages import N_
from regolith_studio.session.choices import L_MAX_LIMIT, Choices, Kind
from regolith_studio.studies.loss_variants import LossVariant, loss_variants, losses, paper_variants
from regolith_studio.studies.polyhedron_gallery import GalleryPolyhedron, GalleryStudy
from regolith_studio.studies.sweeps import SWEEPS, parse_values

CHOSEN = "chosen"
"""Name of the loss whose weights are the present ones."""


def present_row(choices: Choices) -> LossVariant:
    """What is chosen now, as a row."""
    return LossVariant(
        N_("Chosen weights"), choices.weights, choices.method, choices.facet_count, choices.settings
    )


def loss_names() -> dict[str, str]:
    """Every loss that can be a row, with its label; the chosen weights last."""
    return {name: loss.label for name, loss in losses().items()} | {CHOSEN: N_("Chosen weights")}


def chosen_rows(names: Sequence[str], choices: Choices) -> tuple[LossVariant, ...]:
    """A row for each name of :func:`loss_names`.

    Raises
    ------
    InputError
        If there is no such loss.
    """
    like = present_row(choices)
    return tuple(like if name == CHOSEN else loss_variants((name,), like)[0] for name in names)


def varied_rows(key: str, choices: Choices, values: str) -> tuple[LossVariant, ...]:
    """The rows of a variation of the present choices, from values with commas between them.

    Raises
    ------
    InputError
        If a value is wrong, or the choices leave nothing to vary.
    """
    rows = SWEEPS[key].rows(present_row(choices), parse_values(values))
    for row in rows:
        Choices(n_facets=row.n_facets)
    return rows


@dataclass(frozen=True)
class StudyJob:
    """A job and what it is called on screen."""

    title: str
    job: Job


def study_job(
    kind: Kind, particles: Sequence[Particle], choices: Choices, options: Mapping[str, Any]
) -> StudyJob:
    """The job of a study of `particles` with the present `choices`.

    Raises
    ------
    InputError
        If `kind` is no study.
    """
    match kind:
        case Kind.LMAX_STUDY:
            return StudyJob(
                N_("RMSRE against l_max"),
                Job(
                    study_lmax,
                    (tuple(particles),),
                    {
                        "seed": choices.seed,
                        "fit_options": choices.fit_options,
                        **options,
                    },
                ),
            )
        case Kind.COARSENING_STUDY:
            job = Job(study_coarsening, (tuple(particles), choices.order), options)
            return StudyJob(N_("RMSRE against loss weights"), job)
        case _:
            raise InputError(f"There is no study called {kind}.")


@dataclass(frozen=True)
class GalleryCell:
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


def coarsen_gallery(
    particles: Sequence[Particle], order: CoarseningRequest, rows: Sequence[LossVariant] | None = None
) -> Steps:
    """Coarsen each particle by the loss of each row; partial results and the result are ``list[Solid]``.

    Parameters
    ----------
    order
        Method, number of facets, settings, seed and target of all.
    rows
        Whose weights are taken; those of Fig. 8 by default.
    """
    chosen = paper_variants() if rows is None else tuple(rows)
    total = len(particles) * len(chosen)
    yield Started(N_("Coarsening for the gallery"), total)
    done: list[GalleryCell] = []
    for column, particle in enumerate(particles):
        fit = _fit_of(particle, order)
        for row, each in enumerate(chosen):
            now = Progress(len(done), total)
            outcome = yield from _outcome(particle, _by_row(order, each), column, fit, now)
            done.append(GalleryCell(row, column, outcome))
            yield Partial(list(done))
            yield Progress(len(done), total, particle.name)
    return done


def study_gallery(
    particles: Sequence[Particle],
    order: CoarseningRequest,
    rows: Sequence[LossVariant] | None = None,
    workers: int | Executor = 1,
    answers: StudyCheckpoint | None = None,
) -> Steps:
    """As :func:`coarsen_gallery`, particle by particle; the result is the study that can be written.

    Parameters
    ----------
    workers
        Processes at a time; 0 for one a core.
    answers
        Keeps what is known of each particle, so that the study can be taken up again.
    """
    chosen = paper_variants() if rows is None else tuple(rows)
    yield Started(N_("Coarsening for the gallery"), len(particles))
    if answers is not None:
        answers.open("solids", (order, chosen), hash_of_particles(particles))
    labels, names = [row.label for row in chosen], [particle.name for particle in particles]
    cells: dict[tuple[int, int], GalleryPolyhedron | str] = {}
    with open_executor(workers) as executor:
        mapper = executor.map if answers is None else answers.wrap(executor.map)
        found = mapper(partial(coarsen_column, order=order, rows=chosen), list(enumerate(particles)))
        for column, (name, answer) in enumerate(zip(names, found, strict=True)):
            for row, cell in enumerate(answer["rows"]):
                cells[row, column] = cell if isinstance(cell, str) else GalleryPolyhedron.from_document(cell)
            yield Progress(column + 1, len(names), name)
    return GalleryStudy(tuple(labels), tuple(names), cells)


def coarsen_column(
    numbered: tuple[int, Particle], order: CoarseningRequest, rows: Sequence[LossVariant]
) -> dict[str, Any]:
    """The polyhedra of one particle, by row, as a document; a sentence where there is none.

    Pure and picklable: for process pools.
    """
    column, particle = numbered
    fit = _fit_of(particle, order)
    cells: list[dict[str, Any] | str] = []
    for row in rows:
        outcome = _ended(_outcome(particle, _by_row(order, row), column, fit, Progress(0, 0)))
        solid = outcome.coarsened
        cells.append(outcome.problem if solid is None else GalleryPolyhedron.of(solid).document())
    return {"rows": cells}


def solid_study(solids: Sequence[GalleryCell], labels: Sequence[str], names: Sequence[str]) -> GalleryStudy:
    """What has been drawn, as a study that can be written."""
    cells: dict[tuple[int, int], GalleryPolyhedron | str] = {}
    for each in solids:
        found = each.outcome.coarsened
        cells[each.row, each.column] = each.outcome.problem if found is None else GalleryPolyhedron.of(found)
    return GalleryStudy(tuple(labels), tuple(names), cells)


def _fit_of(particle: Particle, order: CoarseningRequest) -> HarmonicFit | str | None:
    """The fit that is imitated, where one is; the sentence that says why there is none."""
    if order.target != "fit":
        return None
    try:
        return order.fit_options.fit(particle.mesh, L_MAX_LIMIT)
    except RegolithError as error:
        return str(error)


def _by_row(order: CoarseningRequest, row: LossVariant) -> CoarseningRequest:
    plain = dataclasses.replace(order, weights=row.weights, largest_error=None)
    if row.weights.all_zero:  # the quadric start itself
        return dataclasses.replace(plain, method="quadric", settings=())
    return plain


def _outcome(
    particle: Particle,
    order: CoarseningRequest,
    index: int,
    fit: HarmonicFit | str | None,
    now: Progress,
) -> Generator[Step, None, CoarsenedParticle]:
    """What became of one coarsening; its own steps are not told, but it can be stopped between them."""
    if isinstance(fit, str):
        return CoarsenedParticle(particle.name, index, None, fit)
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


def _ended(story: Generator[Step, None, CoarsenedParticle]) -> CoarsenedParticle:
    while True:
        try:
            next(story)
        except StopIteration as end:
            outcome: CoarsenedParticle = end.value
            return outcome
