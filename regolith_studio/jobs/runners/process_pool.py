"""Runs jobs in a few warm processes; for batches."""

import multiprocessing
import os
import threading
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from typing import Any

from regolith_studio.jobs.events import Ending, Event, Failed, Finished, Job, Listener, Stopped
from regolith_studio.jobs.runners.drive import drive

_SLOTS = 4096
_THREAD_LIMITS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")

_flags: Any = None
"""In a worker: the numbers of the jobs that shall stop, shared with the parent."""


def _prepare_worker(flags: Any) -> None:
    global _flags
    _flags = flags
    _ignore_interrupts()


def _ignore_interrupts() -> None:
    """Ctrl-C is the parent's to handle; it reaches every process of the terminal."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _silent(_event: Event) -> None:
    """Steps are not sent across processes: what counts in a batch is each job's ending."""


def _run_whole(job: Job, number: int) -> Ending:
    return drive(job, _silent, lambda: _flags[number % _SLOTS] == number)


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@dataclass(eq=False)
class _PoolHandle:
    number: int
    flags: Any
    future: "Future[Ending] | None" = None
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def done(self) -> bool:
        return self.ended.is_set()

    def cancel(self) -> None:
        self.flags[self.number % _SLOTS] = self.number
        if self.future is not None:
            self.future.cancel()


class ProcessPoolRunner:
    """Each job runs whole in one process; listeners are called in a thread of the pool, endings only.

    The processes are spawned, not forked (no locks or OpenGL contexts come along), start with the
    first job, stay warm and keep to one thread each.

    Parameters
    ----------
    workers
        Number of processes; 0 for one a core.
    """

    def __init__(self, workers: int = 0) -> None:
        self.workers = workers or cores()
        self._context = multiprocessing.get_context("spawn")
        self._flags: Any = self._context.Array("q", _SLOTS, lock=False)
        self._number = 0
        self._pool = self._new_pool()

    def submit(self, job: Job, listener: Listener, lane: str = "") -> _PoolHandle:  # noqa: ARG002
        self._number += 1
        handle = _PoolHandle(self._number, self._flags)
        with _one_thread_each():
            try:
                handle.future = self._pool.submit(_run_whole, job, handle.number)
            except BrokenProcessPool:
                self._pool.shutdown(wait=False)
                self._pool = self._new_pool()
                handle.future = self._pool.submit(_run_whole, job, handle.number)
        handle.future.add_done_callback(lambda future: _conclude(handle, future, listener))
        return handle

    def close(self) -> None:
        """Stop the jobs between two of their steps and end the processes."""
        for number in range(max(1, self._number - _SLOTS + 1), self._number + 1):
            self._flags[number % _SLOTS] = number
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _new_pool(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            self.workers, mp_context=self._context, initializer=_prepare_worker, initargs=(self._flags,)
        )


def _conclude(handle: _PoolHandle, future: "Future[Ending]", listener: Listener) -> None:
    ending: Ending
    try:
        ending = future.result()
    except CancelledError:
        ending = Stopped()
    except BrokenProcessPool as error:
        ending = Failed("A worker process died; it may have run out of memory.", str(error))
    except Exception as error:  # noqa: BLE001  for example a result that cannot be pickled
        ending = Failed(f"A worker process could not answer ({error}).", repr(error))
    if handle.flags[handle.number % _SLOTS] == handle.number and isinstance(ending, Finished):
        ending = Stopped()
    handle.ended.set()
    listener(ending)


class _one_thread_each:  # noqa: N801  a context, read like a sentence
    """Lets the processes that start meanwhile keep to one thread for linear algebra."""

    def __enter__(self) -> None:
        self._before = {name: os.environ.get(name) for name in _THREAD_LIMITS}
        os.environ.update(dict.fromkeys(_THREAD_LIMITS, "1"))

    def __exit__(self, *_error: object) -> None:
        for name, value in self._before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
