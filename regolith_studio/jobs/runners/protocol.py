"""What every runner offers."""

from typing import Protocol

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
