"""Runners execute jobs. Threads, locks and ``except Exception`` occur here and nowhere else.

This module is the interface of runners and of handles to submitted jobs, and runs one job in this thread.
"""

import traceback
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from regolith_studio.errors import JobCancelled, RegolithError, format_os_error
from regolith_studio.jobs.events import Failed, Finished, Job, JobResult, Listener, Step, Stopped
from regolith_studio.messages import N_, Message


class Handle(Protocol):
    """One submitted job."""

    @property
    def done(self) -> bool:
        """Whether the job has ended, in whichever way."""
        ...

    def cancel(self) -> None:
        """Ask the job to stop between two of its steps; no effect when it has ended."""
        ...


@runtime_checkable
class Pausable(Handle, Protocol):
    """A handle of a job that can be paused between two of its steps."""

    def pause(self) -> None:
        """Let the job wait after its current step; no effect when it has ended."""
        ...

    def resume(self) -> None:
        """Resume the job."""
        ...


class Runner(Protocol):
    """Runs jobs and passes their events to a listener."""

    def submit(self, job: Job, listener: Listener, queue: str = "") -> Handle:
        """Run `job`; `listener` receives its steps and, last, exactly one result.

        ``queue``: jobs of one queue replace each other where the runner says so: the newest wins.
        """
        ...

    def close(self) -> None:
        """Cancel what runs, wait for it, and leave no thread or process behind."""
        ...


def run_job(job: Job, listener: Listener, stopped: Callable[[], bool]) -> JobResult:
    """Run `job` to its end, pass every step to `listener`, and return the result.

    ``stopped``: called before the first step and between any two; a true answer closes the generator.
    """
    if stopped():
        return Stopped()
    steps = iterate_job(job)
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            result: JobResult = end.value
            return result
        if stopped():
            # The last step is dropped: what it yielded would be shown after the user has stopped the job.
            steps.close()
            return Stopped()
        listener(step)


def iterate_job(job: Job) -> Generator[Step, None, JobResult]:
    """Iterate over the steps of `job`; the generator returns the result, whatever the job raised."""
    try:
        return Finished((yield from job.steps()))
    except JobCancelled:
        return Stopped()
    except Exception as error:  # noqa: BLE001  whatever a job raises must reach its listener
        return failure(error)


def failure(error: BaseException) -> Failed:
    """The event for an exception: its own message if it was meant for users, else a general one."""
    details = "".join(traceback.format_exception(error))
    if isinstance(error, RegolithError):
        return Failed(str(error), details)
    if isinstance(error, MemoryError):
        return Failed(N_("The work needs more memory than this machine has."), details)
    if isinstance(error, OSError) and error.errno is not None:
        return Failed(format_os_error(error), details)
    sentence = N_("The program made a mistake ({kind}: {error}).")
    return Failed(Message(sentence, kind=type(error).__name__, error=str(error)), details)


@dataclass
class _InlineHandle:
    cancelled: bool = False
    done: bool = False

    def cancel(self) -> None:
        self.cancelled = True


class InlineRunner:
    """Submitting returns when the job has ended."""

    def submit(self, job: Job, listener: Listener, queue: str = "") -> _InlineHandle:  # noqa: ARG002
        handle = _InlineHandle()
        result = run_job(job, listener, lambda: handle.cancelled)
        handle.done = True
        listener(result)
        return handle

    def close(self) -> None:
        """Nothing to do: no job outlives its submission."""
