"""Main loop of a worker process of the pool: runs one job after the other."""

import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

from regolith_studio.jobs.events import Event, Failed, Job, JobResult, Progress
from regolith_studio.jobs.runners import run_job

SLOTS = 4096
"""Length of the shared array of cancel flags; more than the jobs that are ever open at a time."""
PROGRESS_INTERVAL = 0.5
"""Seconds between two steps whose progress is sent back."""
STARTED = b""
"""Sent back when a job and all modules that it needs are loaded, before its first step."""


def run_jobs(pipe: Connection, flags: Any) -> None:
    """Run the jobs that come through `pipe`; send each one's progress back, and its result with the memory
    in use.

    Before the first step of each job :data:`STARTED` is sent: a process that has not sent it can be killed
    without loss. A job that is cancelled by then takes no step.

    Parameters
    ----------
    flags
        Shared with the parent: slot n holds the number of a job that shall stop.
    """
    end_with_parent()
    while True:
        try:
            message = pipe.recv_bytes()
            if not message:
                return
            number, job = pickle.loads(message)
            pipe.send_bytes(STARTED)
            pipe.send_bytes(_pickled(_run(job, number, flags, pipe)))
        except (EOFError, OSError):
            return  # the parent is gone


@contextmanager
def interrupts_blocked() -> Iterator[None]:
    """Processes that are started meanwhile see no Ctrl+C and no closing of the terminal.

    Terminals send those to all processes of a command; the parent acts on them.
    """
    if os.name == "nt":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGHUP})
    try:
        resource_tracker.ensure_running()  # a process of its own, whose start unblocks SIGINT
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def end_with_parent() -> None:
    """Let this process leave Ctrl+C to its parent, and end when that has ended, in whichever way."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if parent := multiprocessing.parent_process():
        threading.Thread(target=_exit_after, args=(parent,), name="parent", daemon=True).start()


def _exit_after(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)


def resident_memory() -> int:
    """Resident memory of this process in bytes; its peak where the system reports only that; 0 if unknown."""
    statistics = Path("/proc/self/statm")
    if statistics.exists():
        return int(statistics.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    if sys.platform == "win32":
        return 0
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def _run(job: Job, number: int, flags: Any, pipe: Connection) -> JobResult:
    return run_job(job, _SendProgress(pipe), lambda: bool(flags[number % SLOTS] == number))


class _SendProgress:
    """Sends progress across processes from time to time; partial results stay in the worker."""

    def __init__(self, pipe: Connection) -> None:
        self._pipe, self._sent = pipe, time.monotonic()

    def __call__(self, event: Event) -> None:
        now = time.monotonic()
        if isinstance(event, Progress) and now - self._sent >= PROGRESS_INTERVAL:
            self._pipe.send_bytes(pickle.dumps(event))
            self._sent = now


def _pickled(result: JobResult) -> bytes:
    try:
        return pickle.dumps((result, resident_memory()))
    except Exception as error:  # noqa: BLE001  whatever a result's pickling raises
        failed = Failed(f"A worker process could not answer ({error}).", repr(error))
        return pickle.dumps((failed, resident_memory()))
