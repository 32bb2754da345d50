"""Jobs for the studies of sections 3.1 and 3.2 over a whole sample."""

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from functools import partial
from typing import Any

from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.compile_kernels import compile_first, compile_first_for
from regolith_studio.jobs.events import Job, Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, call, open_executor, value_of
from regolith_studio.jobs.study_checkpoint import Mapper, StudyCheckpoint, hash_of_particles, hash_of_rows
from regolith_studio.messages import N_
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.coarsening import TargetChoice, coarsening_study
from regolith_studio.studies.lmax import lmax_study
from regolith_studio.studies.population import population_study
from regolith_studio.studies.progress import StudyProgress


def study_lmax(
    particles: Sequence[Particle],
    workers: int | Executor = 1,
    seed: int = 0,
    answers: StudyCheckpoint | None = None,
    **options: Any,
) -> Steps:
    """Fig. 3 for `particles`; partial results and the result are ``LmaxStudy``.

    Parameters
    ----------
    workers
        Processes at a time; 0 for one a core.
    answers
        Keeps what is known of each particle, so that the study can be taken up again.
    options
        Further ones of :func:`~regolith_studio.studies.lmax.lmax_study`: degrees, level, keys ...
    """
    yield from compile_first("fit", "describe")
    yield Started(N_("RMSRE against l_max"), len(particles))
    if answers is not None:
        answers.open("lmax", (seed, sorted(options.items())), hash_of_particles(particles))
    with open_executor(workers) as executor:
        mapper = _with_answers(executor.map, answers)
        return (yield from as_job_steps(lmax_study(particles, mapper=mapper, seed=seed, **options)))


def study_population(
    sample: Sample,
    models: Sequence[str] | None = None,
    workers: int | Executor = 1,
    answers: StudyCheckpoint | None = None,
    **options: Any,
) -> Steps:
    """Figs. 4 to 6 for `sample`; partial results and the result are ``PopulationStudy``.

    Parameters
    ----------
    models
        Keys of ``MODELS``; all by default.
    workers
        Processes at a time; 0 for one a core.
    answers
        Keeps what is known of particles and draws, so that the study can be taken up again.
    options
        Further ones of :func:`~regolith_studio.studies.population.population_study`.
    """
    yield Started(N_("Judging models"), 0)
    if answers is not None:
        inputs = hash_of_rows(sample.coefficients, (*sample.names, sample.unit))
        answers.open("population", (models, sorted(options.items())), inputs)
    with open_executor(workers) as executor:
        mapper = _with_answers(partial(_map_with_pauses, executor), answers)
        return (yield from as_job_steps(population_study(sample, models, mapper=mapper, **options)))


def _map_with_pauses(
    executor: Executor, function: Callable[[Any], Any], items: Iterable[Any]
) -> Iterator[Any]:
    """As :meth:`Executor.map`, with ``None`` while waiting, so that the study can be stopped."""
    for result in executor.results(Job(call, (function, item)) for item in items):
        yield None if result is None else value_of(result)


def study_coarsening(
    particles: Sequence[Particle],
    request: CoarseningRequest,
    workers: int | Executor = 1,
    answers: StudyCheckpoint | None = None,
    title: str = "RMSRE against loss weights",
    **options: Any,
) -> Steps:
    """Fig. 8 for `particles`; partial results and the result are ``CoarseningStudy``.

    Parameters
    ----------
    request
        Method, face count, settings, seed and target; its weights do not matter, the rows bring theirs.
    workers
        Processes at a time; 0 for one a core.
    answers
        Keeps what is known of each particle, so that the study can be taken up again.
    title
        In lists of tasks: studies of other rows have other names.
    options
        Further ones of :func:`~regolith_studio.studies.coarsening.coarsening_study`: rows, box_metric.
    """
    yield from compile_first_for(request.method)
    yield Started(title, len(particles))
    if answers is not None:
        answers.open("coarsening", (request, sorted(options.items())), hash_of_particles(particles))
    with open_executor(workers) as executor:
        study = coarsening_study(
            particles,
            n_facets=request.n_facets,
            method=request.method,
            seed=request.seed,
            settings=dict(request.settings),
            target=TargetChoice(request.target, request.l_max, request.level, request.fit_options),
            mapper=_with_answers(executor.map, answers),
            **options,
        )
        return (yield from as_job_steps(study))


def _with_answers(mapper: Mapper, answers: StudyCheckpoint | None) -> Mapper:
    return mapper if answers is None else answers.wrap(mapper)


def as_job_steps(steps: Generator[StudyProgress, None, Any]) -> Generator[Step, None, Any]:
    """The steps of a study as events of a job."""
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            return end.value
        yield Progress(step.done, step.total, step.message)
        if step.partial is not None:
            yield Partial(step.partial)
