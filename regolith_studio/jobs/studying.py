"""The studies of sections 3.1 and 3.2 over a whole sample."""

from collections.abc import Generator, Sequence
from typing import Any

from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.batch import mapper
from regolith_studio.jobs.coarsening import CoarseningOrder
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.studies.lmax import lmax_study
from regolith_studio.studies.progress import StudyProgress


def study_lmax(particles: Sequence[Particle], workers: int = 1, seed: int = 0, **options: Any) -> Steps:
    """Fig. 3 for `particles`; partial results and the result are ``LmaxStudy``.

    Parameters
    ----------
    workers
        Processes at a time; 0 for one a core.
    options
        Further ones of :func:`~regolith_studio.studies.lmax.lmax_study`: degrees, level, keys ...
    """
    yield Started("RMSRE against l_max", len(particles))
    return (yield from _told(lmax_study(particles, mapper=mapper(workers), seed=seed, **options)))


def study_coarsening(
    particles: Sequence[Particle], order: CoarseningOrder, workers: int = 1, **options: Any
) -> Steps:
    """Fig. 8 for `particles`; partial results and the result are ``CoarseningStudy``."""
    from regolith_studio.studies.coarsening import coarsening_study

    yield Started("RMSRE against loss weights")
    return (yield from _told(coarsening_study(particles, mapper=mapper(workers), **options)))


def _told(steps: Generator[StudyProgress, None, Any]) -> Generator[Step, None, Any]:
    """The story of a study in the events of jobs."""
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            return end.value
        yield Progress(step.done, step.total, step.message)
        if step.partial is not None:
            yield Partial(step.partial)
