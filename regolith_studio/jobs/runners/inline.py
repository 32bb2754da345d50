"""Runs a job where it is submitted; for tests and for the command line."""

from dataclasses import dataclass

from regolith_studio.jobs.events import Job, Listener
from regolith_studio.jobs.runners.drive import drive


@dataclass
class _InlineHandle:
    cancelled: bool = False
    done: bool = False

    def cancel(self) -> None:
        self.cancelled = True


class InlineRunner:
    """Submitting returns when the job has ended."""

    def submit(self, job: Job, listener: Listener, lane: str = "") -> _InlineHandle:  # noqa: ARG002
        handle = _InlineHandle()
        ending = drive(job, listener, lambda: handle.cancelled)
        handle.done = True
        listener(ending)
        return handle

    def close(self) -> None:
        """Nothing to do: no job outlives its submission."""
