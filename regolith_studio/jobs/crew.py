"""Who works on a batch: this thread alone, or a pool of processes that stays warm between batches."""

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Self

from regolith_studio.jobs.batch import as_they_end, call, in_order, value_of
from regolith_studio.jobs.events import Ending, Job, Progress, Step
from regolith_studio.jobs.runners.drive import told
from regolith_studio.jobs.runners.process_pool import ProcessPoolRunner, cores
from regolith_studio.jobs.runners.protocol import Runner

if TYPE_CHECKING:
    from regolith_studio.jobs.runners.dask_cluster import TlsFiles


class Crew:
    """Runs jobs for a caller that wants their endings in order; results do not depend on its size.

    Parameters
    ----------
    workers
        Jobs at the same time: 1 for this thread alone, more for as many processes, 0 for one a core.
    runner
        That works in place of processes of this machine; closed with the crew.
    """

    def __init__(self, workers: int = 1, runner: Runner | None = None) -> None:
        self.workers = workers or cores()
        self._runner = runner
        self.dashboard = ""
        """Address of a cluster's page, if there is one."""

    @classmethod
    def on_cluster(cls, address: str = "", workers: int = 0, tls: "TlsFiles | None" = None) -> Self:
        """A crew on a Dask cluster; the parameters are those of :class:`DaskRunner`."""
        from regolith_studio.jobs.runners.dask_cluster import DaskRunner

        runner = DaskRunner(address, workers, tls)
        crew = cls(runner.workers, runner)
        crew.dashboard = runner.dashboard
        return crew

    def endings(self, jobs: Iterable[Job]) -> Generator[Ending | None, None, None]:
        """Endings of `jobs` in their order; ``None`` whenever the caller may want to stop."""
        if self._alone:
            return (None if answer is None else answer[1] for answer in _one_by_one(jobs))
        return in_order(self._hired(), jobs, window=2 * self.workers)

    def as_they_end(self, jobs: Iterable[Job]) -> Generator[tuple[int, Ending] | None, None, None]:
        """Number and ending of each of `jobs`, the quick ones first; ``None`` as for :meth:`endings`."""
        if self._alone:
            return _one_by_one(jobs)
        return as_they_end(self._hired(), jobs, window=2 * self.workers)

    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
        """As the built-in ``map``, in order and lazily, for a picklable function.

        An item whose call raises ends the mapping with a ``RegolithError`` of its sentence.
        """
        for ending in self.endings(Job(call, (function, item)) for item in items):
            if ending is not None:
                yield value_of(ending)

    def all(self, jobs: Sequence[Job], names: Sequence[str]) -> Generator[Step, None, list[Ending]]:
        """Endings of `jobs`, with a step of progress after each that names what is done."""
        endings: list[Ending] = []
        for ending in self.endings(jobs):
            if ending is not None:
                endings.append(ending)
            yield Progress(len(endings), len(jobs), names[len(endings) - 1] if endings else "")
        return endings

    @property
    def _alone(self) -> bool:
        return self.workers == 1 and self._runner is None

    def _hired(self) -> Runner:
        if self._runner is None:
            self._runner = ProcessPoolRunner(self.workers)
        return self._runner

    def close(self) -> None:
        """End the processes, if there are any."""
        if self._runner is not None:
            self._runner.close()
            self._runner = None


@contextmanager
def hired(workers: int | Crew) -> Iterator[Crew]:
    """The crew itself, or a new one of so many workers that is dismissed in the end."""
    if isinstance(workers, Crew):
        yield workers
        return
    crew = Crew(workers)
    try:
        yield crew
    finally:
        crew.close()


def _one_by_one(jobs: Iterable[Job]) -> Generator[tuple[int, Ending] | None, None, None]:
    for number, job in enumerate(jobs):
        story = told(job)
        while True:
            try:
                next(story)
            except StopIteration as end:
                yield number, end.value
                break
            yield None
