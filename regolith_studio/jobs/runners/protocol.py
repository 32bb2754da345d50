"""What every runner offers."""

from typing import Protocol, runtime_checkable

from regolith_studio.jobs.events import Job, Listener


class Handle(Protocol):
    """One submitted job."""

    @property
    def done(self) -> bool:
        """Whether the job has ended, in whichever way."""
        ...

    def cancel(self) -> None:
        """Ask the job to stop between two of its steps; harmless when it has ended."""
        ...


@runtime_checkable
class Pausable(Handle, Protocol):
    """A handle of a runner that can hold a job back between two of its steps."""

    def pause(self) -> None:
        """Let the job wait after the step that it is at; harmless when it has ended."""
        ...

    def resume(self) -> None:
        """Let it go on."""
        ...


class Runner(Protocol):
    """Drives jobs and tells a listener what they say."""

    def submit(self, job: Job, listener: Listener, lane: str = "") -> Handle:
        """Run `job`; `listener` hears its steps and, last, exactly one ending.

        Parameters
        ----------
        lane
            Jobs of one lane replace each other where the runner says so: the newest wins.
        """
        ...

    def close(self) -> None:
        """Cancel what runs, wait for it, and leave no thread or process behind."""
        ...
