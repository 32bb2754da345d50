"""Runners execute jobs. Threads, locks and ``except Exception`` occur here and nowhere else.

This module is the interface of runners and of handles to submitted jobs.
"""

from typing import Protocol, runtime_checkable

from regolith_studio.jobs.events import Job, Listener


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

    def submit(self, job: Job, listener: Listener, lane: str = "") -> Handle:
        """Run `job`; `listener` receives its steps and, last, exactly one result.

        Parameters
        ----------
        lane
            Jobs of one lane replace each other where the runner says so: the newest wins.
        """
        ...

    def close(self) -> None:
        """Cancel what runs, wait for it, and leave no thread or process behind."""
        ...
