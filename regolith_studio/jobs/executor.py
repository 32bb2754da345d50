"""Runs many jobs at the same time: in this thread, in processes of this machine or on a Dask cluster."""

import queue
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from regolith_studio.errors import InputError, JobCancelled, MissingRequirement, RegolithError
from regolith_studio.jobs.events import (
    Event,
    Failed,
    Finished,
    Job,
    JobResult,
    Progress,
    Started,
    Step,
    Steps,
    Stopped,
)
from regolith_studio.jobs.runners import Handle, Runner, iterate_job
from regolith_studio.jobs.runners.process_pool import ProcessPoolRunner, cores

if TYPE_CHECKING:
    from regolith_studio.jobs.runners.dask_cluster import TlsFiles

RUNNERS = {"processes": "processes of this machine", "dask": "a Dask cluster"}
"""Where jobs can run: key and description."""
TLS_NAMES = ("ca.pem", "cert.pem", "key.pem")
_POLL_SECONDS = 0.1
"""Seconds without a result after which the caller gets a turn, so that it can be cancelled."""


class Executor:
    """Runs jobs for a caller that wants their results in order; results do not depend on its size.

    ``workers``: jobs at the same time: 1 for this thread alone, more for as many processes, 0 for one a
    core. ``runner``: used in place of processes of this machine; closed with the executor.
    """

    def __init__(self, workers: int = 1, runner: Runner | None = None) -> None:
        self.workers = workers or cores()
        self._runner = runner
        self._check_shared: Callable[[Path, Path | None], None] | None = None
        self.dashboard = ""
        """Address of a cluster's status page, if there is one."""

    @classmethod
    def on_cluster(cls, address: str = "", workers: int = 0, tls: "TlsFiles | None" = None) -> Self:
        """An executor on a Dask cluster; the parameters are those of :class:`DaskRunner`."""
        from regolith_studio.jobs.runners.dask_cluster import DaskRunner

        runner = DaskRunner(address, workers, tls)
        executor = cls(runner.workers, runner)
        executor.dashboard = runner.dashboard
        executor._check_shared = runner.check_shared
        return executor

    def results(
        self, jobs: Iterable[Job], follow: Callable[[int, Progress], None] | None = None
    ) -> Generator[JobResult | None, None, None]:
        """Results of `jobs` in their order; ``None`` whenever the caller may want to stop.

        ``follow``: as for :meth:`as_completed`.
        """
        if self.in_this_thread:
            return (None if answer is None else answer[1] for answer in _run_one_by_one(jobs, follow))
        return in_order(self._open_runner(), jobs, window=2 * self.workers, follow=follow)

    def as_completed(
        self, jobs: Iterable[Job], follow: Callable[[int, Progress], None] | None = None
    ) -> Generator[tuple[int, JobResult] | None, None, None]:
        """Number and result of each of `jobs`, the quick ones first; ``None`` as for :meth:`results`.

        ``follow``: called with the number of a job and its progress, of jobs on this machine.
        """
        if self.in_this_thread:
            return _run_one_by_one(jobs, follow)
        return as_completed(self._open_runner(), jobs, window=2 * self.workers, follow=follow)

    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
        """As the built-in ``map``, in order and lazily, for a picklable function."""
        for result in self.results(Job(call, (function, item)) for item in items):
            if result is not None:
                yield value_of(result)

    def run_all(self, jobs: Sequence[Job], names: Sequence[str]) -> Generator[Step, None, list[JobResult]]:
        """Results of `jobs`, with progress events that name what has ended last, or the part of a job that
        reports its own progress."""
        results: dict[int, JobResult] = {}
        current = ""

        def follow(number: int, step: Progress) -> None:
            nonlocal current
            if step.message:
                current = f"{names[number]} ({step.done + 1}/{step.total}: {step.message})"

        for answer in self.as_completed(jobs, follow):
            if answer is not None:
                number, result = answer
                results[number] = result
                current = names[number]
            yield Progress(len(results), len(jobs), current)
        return [results[number] for number in range(len(jobs))]

    @property
    def in_this_thread(self) -> bool:
        """Whether there are no other processes."""
        return self.workers == 1 and self._runner is None

    def threads_for(self, n_jobs: int) -> int | None:
        """Threads that each of so many jobs may use without more threads than workers; ``None`` for jobs in
        this thread, which may use what they like."""
        if self.in_this_thread:
            return None
        return 1 if self._check_shared else max(1, self.workers // max(1, n_jobs))

    def check_shared(self, path: Path, folder: Path | None = None) -> None:
        """Check that all workers find a file or folder, and `folder`, which is made, under these paths."""
        if self._check_shared is not None:
            if folder is not None:
                folder.mkdir(parents=True, exist_ok=True)
            self._check_shared(path.absolute(), folder)

    def _open_runner(self) -> Runner:
        if self._runner is None:
            self._runner = ProcessPoolRunner(self.workers)
        return self._runner

    def close(self) -> None:
        """End the processes, if there are any."""
        if self._runner is not None:
            self._runner.close()
            self._runner = None


@contextmanager
def open_executor(workers: int | Executor) -> Iterator[Executor]:
    """The executor itself, or a new one of so many workers that is closed at the end."""
    if isinstance(workers, Executor):
        yield workers
        return
    executor = Executor(workers)
    try:
        yield executor
    finally:
        executor.close()


@dataclass(frozen=True)
class ExecutorSettings:
    """Where jobs shall run, as the command line and the window ask for it; picklable.

    - ``runner``: key of :data:`RUNNERS`.
    - ``workers``: processes of this machine, also of a cluster that is started on it; 0 for one a core.
    - ``address``: of the cluster's scheduler; without it a cluster is started on this machine.
    - ``tls``: folder with :data:`TLS_NAMES` for a ``tls://`` address.
    """

    runner: str = "processes"
    workers: int = 1
    address: str = ""
    tls: Path | None = None

    def __post_init__(self) -> None:
        if self.runner not in RUNNERS:
            raise InputError(f"There is no runner {self.runner!r}; there are {' and '.join(RUNNERS)}.")
        if self.workers < 0:
            raise InputError(f"The number of workers must not be negative, got {self.workers}.")
        if self.runner == "processes" and (self.address or self.tls):
            raise InputError("An address and TLS files go with the runner dask.")

    def open(self) -> Executor:
        """A new executor, to be closed by the caller."""
        if self.runner == "processes":
            return Executor(self.workers)
        from regolith_studio.jobs.runners.dask_cluster import TlsFiles

        files = TlsFiles(*[self.tls / name for name in TLS_NAMES]) if self.tls else None
        return Executor.on_cluster(self.address, self.workers, files)


def in_order(
    runner: Runner,
    jobs: Iterable[Job],
    window: int = 2,
    follow: Callable[[int, Progress], None] | None = None,
) -> Generator[JobResult | None, None, None]:
    """Results of `jobs` in their order; ``None`` while the next one is being waited for.

    ``window``: jobs that are submitted and whose results have not been handed on: bounds the memory.
    """
    early: dict[int, JobResult] = {}
    expected = 0
    for answer in as_completed(runner, jobs, window, lambda: len(early), follow):
        if answer is None:
            yield None
            continue
        number, result = answer
        early[number] = result
        while expected in early:
            yield early.pop(expected)
            expected += 1


def as_completed(
    runner: Runner,
    jobs: Iterable[Job],
    window: int = 2,
    n_buffered: Callable[[], int] = lambda: 0,
    follow: Callable[[int, Progress], None] | None = None,
) -> Generator[tuple[int, JobResult] | None, None, None]:
    """Number and result of each of `jobs` as they end; ``None`` while the next one is being waited for.

    - ``window``: jobs that are submitted at the same time.
    - ``n_buffered``: number of results that the caller keeps back; they count as if they were still running.
    - ``follow``: called, in this thread, with the number of a job and its progress, where the runner sends
      that.
    """
    answers: queue.SimpleQueue[tuple[int, JobResult | Progress]] = queue.SimpleQueue()
    waiting = enumerate(jobs)
    open_handles: dict[int, Handle] = {}
    try:
        while True:
            while len(open_handles) + n_buffered() < window and (entry := next(waiting, None)):
                number, job = entry
                open_handles[number] = runner.submit(job, _put_answer(answers, number))
            if not open_handles:
                return
            try:
                number, result = answers.get(timeout=_POLL_SECONDS)
            except queue.Empty:
                yield None
                continue
            if isinstance(result, Progress):
                if follow is not None:
                    follow(number, result)
                yield None
                continue
            del open_handles[number]
            yield number, result
    finally:
        for handle in open_handles.values():
            handle.cancel()


def call(function: Callable[[Any], Any], item: Any) -> Steps:
    """A job of a single step: `function` of `item`."""
    yield Started("Working")
    return function(item)


def value_of(result: JobResult) -> Any:
    """What a job returned."""
    match result:
        case Finished(value):
            return value
        case Failed(sentence):
            raise RegolithError(sentence)
        case Stopped(reason) if reason:
            raise MissingRequirement(reason)
        case _:
            raise JobCancelled("The work was stopped.")


def _put_answer(
    answers: "queue.SimpleQueue[tuple[int, JobResult | Progress]]", number: int
) -> Callable[[Event], None]:
    def listen(event: Event) -> None:
        if isinstance(event, Finished | Failed | Stopped | Progress):
            answers.put((number, event))

    return listen


def _run_one_by_one(
    jobs: Iterable[Job], follow: Callable[[int, Progress], None] | None = None
) -> Generator[tuple[int, JobResult] | None, None, None]:
    for number, job in enumerate(jobs):
        steps = iterate_job(job)
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                yield number, end.value
                break
            if follow is not None and isinstance(step, Progress):
                follow(number, step)
            yield None
