"""Work over a whole sample: many particles through one runner, results in their order."""

from collections.abc import Generator, Sequence

from regolith_studio.errors import Cancelled
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.batch import batch_runner, in_order, value_of, window_for
from regolith_studio.jobs.coarsening import CoarsenedParticle, CoarseningOrder, coarsen_particle
from regolith_studio.jobs.events import Ending, Failed, Finished, Job, Progress, Started, Step, Steps
from regolith_studio.jobs.fitting import FIT_DEGREE, examine_one, fit_one


def coarsen_sample(particles: Sequence[Particle], order: CoarseningOrder, workers: int = 1) -> Steps:
    """Fit and coarsen every particle; returns a tuple of :class:`CoarsenedParticle`.

    A particle that fails is told with its sentence and does not stop the others. The results do not
    depend on `workers` (0: one process a core).
    """
    yield Started("Coarsening", len(particles))
    jobs = [Job(coarsen_particle, (particle, order, at)) for at, particle in enumerate(particles)]
    endings = yield from _all(particles, jobs, workers)
    return tuple(_outcome(at, p, endings[at]) for at, p in enumerate(particles))


def examine_sample(particles: Sequence[Particle], box_metric: str = "exact", workers: int = 1) -> Steps:
    """Health and descriptors of every particle; returns a tuple of ``Examined``."""
    yield Started("Measuring", len(particles))
    jobs = [Job(examine_one, (particle, box_metric)) for particle in particles]
    endings = yield from _all(particles, jobs, workers)
    return tuple(value_of(ending) for ending in endings)


def fit_sample(particles: Sequence[Particle], l_max: int = FIT_DEGREE, workers: int = 1) -> Steps:
    """Fit every particle; returns a tuple of ``HarmonicFit``, or the sentence where that is impossible."""
    yield Started("Fitting spherical harmonics", len(particles))
    jobs = [Job(fit_one, (particle.mesh, l_max)) for particle in particles]
    endings = yield from _all(particles, jobs, workers)
    return tuple(e.sentence if isinstance(e, Failed) else value_of(e) for e in endings)


def _all(
    particles: Sequence[Particle], jobs: Sequence[Job], workers: int
) -> Generator[Step, None, list[Ending]]:
    """Endings of `jobs`, one a particle, with a step of progress after each."""
    runner = batch_runner(workers)
    endings: list[Ending] = []
    try:
        for ending in in_order(runner, jobs, window=window_for(workers)):
            if ending is not None:
                endings.append(ending)
            yield Progress(len(endings), len(jobs), particles[max(len(endings) - 1, 0)].name)
    finally:
        runner.close()
    return endings


def _outcome(at: int, particle: Particle, ending: Ending) -> CoarsenedParticle:
    match ending:
        case Finished(value) if isinstance(value, CoarsenedParticle):
            return value
        case Failed(sentence):
            return CoarsenedParticle(particle.name, at, None, sentence, notes=particle.notes)
        case _:
            raise Cancelled("The coarsening was stopped.")
