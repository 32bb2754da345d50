"""What runs in a process of the pool: jobs one after the other, until told to stop."""

import os
import pickle
import signal
import sys
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from regolith_studio.jobs.events import Ending, Event, Failed, Job
from regolith_studio.jobs.runners.drive import drive

SLOTS = 4096
"""Jobs that can be told apart by the shared flags; more than are ever under way."""
BEGUN = b""
"""Sent back when a job and all modules that it needs are there, before its first step."""


def work(answers: Connection, flags: Any) -> None:
    """Run the jobs that come through `answers`, and send each one's ending back with the memory in use.

    Before the first step of each :data:`BEGUN` is sent: a process that has not said so has done nothing yet
    and can be ended at once. A job that shall stop by then takes no step.

    Parameters
    ----------
    flags
        Shared with the parent: slot n holds the number of a job that shall stop.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to handle
    while True:
        try:
            message = answers.recv_bytes()
            if not message:
                return
            number, job = pickle.loads(message)
            answers.send_bytes(BEGUN)
            answers.send_bytes(_packed(_ending(job, number, flags)))
        except (EOFError, OSError):
            return  # the parent is gone


def resident_memory() -> int:
    """Bytes of memory that this process holds; its peak where that is all the system tells; or 0."""
    statistics = Path("/proc/self/statm")
    if statistics.exists():
        return int(statistics.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    if sys.platform == "win32":
        return 0
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def _ending(job: Job, number: int, flags: Any) -> Ending:
    return drive(job, _silent, lambda: bool(flags[number % SLOTS] == number))


def _silent(_event: Event) -> None:
    """Steps are not sent across processes: what counts in a batch is each job's ending."""


def _packed(ending: Ending) -> bytes:
    try:
        return pickle.dumps((ending, resident_memory()))
    except Exception as error:  # noqa: BLE001  whatever a result's pickling raises
        failed = Failed(f"A worker process could not answer ({error}).", repr(error))
        return pickle.dumps((failed, resident_memory()))
