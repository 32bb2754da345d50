"""Runs a job in the thread that submits it; for tests and the command line."""

from dataclasses import dataclass

from regolith_studio.jobs.events import Job, Listener
from regolith_studio.jobs.runners.run_job import run_job


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
        result = run_job(job, listener, lambda: handle.cancelled)
        handle.done = True
        listener(result)
        return handle

    def close(self) -> None:
        """Nothing to do: no job outlives its submission."""
