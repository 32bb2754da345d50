"""Runs jobs in a few warm processes; for batches."""

import multiprocessing
import os
import queue
import signal
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
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to handle


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
    job: Job
    number: int
    listener: Listener
    flags: Any
    future: "Future[Ending] | None" = None
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def done(self) -> bool:
        return self.ended.is_set()

    @property
    def cancelled(self) -> bool:
        return bool(self.flags[self.number % _SLOTS] == self.number)

    def cancel(self) -> None:
        self.flags[self.number % _SLOTS] = self.number
        if self.future is not None:
            self.future.cancel()

    def finish(self, ending: Ending) -> None:
        if self.cancelled and isinstance(ending, Finished):
            ending = Stopped()
        self.ended.set()
        self.listener(ending)


class ProcessPoolRunner:
    """Each job runs whole in one process; listeners are called in a thread of the pool, endings only.

    The processes are spawned, not forked (no locks or OpenGL contexts come along), start with the
    first job, stay warm and keep to one thread each. When one dies, the jobs that were under way
    are run again, one at a time; only the job that dies alone has failed.

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
        self._closed = False
        self._lock = threading.Lock()
        self._pool = self._new_pool(self.workers)
        self._suspects: queue.SimpleQueue[_PoolHandle | None] = queue.SimpleQueue()
        self._judge: threading.Thread | None = None

    def submit(self, job: Job, listener: Listener, lane: str = "") -> _PoolHandle:  # noqa: ARG002
        if self._closed:
            raise RuntimeError("the runner is closed")
        self._number += 1
        handle = _PoolHandle(job, self._number, listener, self._flags)
        try:
            handle.future = self._send(self._pool, handle)
        except BrokenProcessPool:
            self._pool.shutdown(wait=False)
            self._pool = self._new_pool(self.workers)
            handle.future = self._send(self._pool, handle)
        handle.future.add_done_callback(lambda future: self._conclude(handle, future))
        return handle

    def close(self) -> None:
        """Stop the jobs between two of their steps and end the processes."""
        self._closed = True
        for number in range(max(1, self._number - _SLOTS + 1), self._number + 1):
            self._flags[number % _SLOTS] = number
        self._pool.shutdown(wait=True, cancel_futures=True)
        if self._judge:
            self._suspects.put(None)
            self._judge.join()

    def _new_pool(self, workers: int) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            workers, mp_context=self._context, initializer=_prepare_worker, initargs=(self._flags,)
        )

    def _send(self, pool: ProcessPoolExecutor, handle: _PoolHandle) -> "Future[Ending]":
        with _one_thread_each():
            return pool.submit(_run_whole, handle.job, handle.number)

    def _conclude(self, handle: _PoolHandle, future: "Future[Ending]") -> None:
        ending = _ending_of(future)
        if ending is None:
            self._suspect(handle)
        else:
            handle.finish(ending)

    def _suspect(self, handle: _PoolHandle) -> None:
        with self._lock:
            if not self._judge:
                self._judge = threading.Thread(target=self._try_suspects, name="suspects", daemon=True)
                self._judge.start()
        self._suspects.put(handle)

    def _try_suspects(self) -> None:
        while handle := self._suspects.get():
            if handle.cancelled:
                handle.finish(Stopped())
                continue
            with self._new_pool(1) as alone:
                ending = _ending_of(self._send(alone, handle))
            handle.finish(ending or Failed("A worker process died of it; it may have run out of memory."))


def _ending_of(future: "Future[Ending]") -> Ending | None:
    """How a job ended; ``None`` if a process died, this job's or another's."""
    try:
        return future.result()
    except CancelledError:
        return Stopped()
    except BrokenProcessPool:
        return None
    except Exception as error:  # noqa: BLE001  for example a result that cannot be pickled
        return Failed(f"A worker process could not answer ({error}).", repr(error))


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
