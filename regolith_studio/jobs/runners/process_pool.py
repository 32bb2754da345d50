"""Runs jobs in a few processes that stay warm between jobs; for batches."""

import contextlib
import logging
import math
import multiprocessing
import multiprocessing.util
import os
import pickle
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

from regolith_studio.io.machine_memory import machine_memory
from regolith_studio.jobs.events import Event, Failed, Finished, Job, JobResult, Listener, Progress, Stopped
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

    ``flags``: shared with the parent: slot n holds the number of a job that shall stop.
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


_log = logging.getLogger(__name__)
_THREAD_LIMITS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
_MIN_MEMORY, _MAX_MEMORY, _MEMORY_FRACTION = 768 * 1024**2, 2 * 1024**3, 0.6
_CLOSE_SECONDS = 1.0
"""Seconds after which a closing pool kills what has not ended: jobs between two steps, then processes."""

_GUARD = (
    "Worker processes import the script that starts them: what it does must stand below "
    '`if __name__ == "__main__":`.'
)


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def memory_limit(workers: int) -> int:
    """Bytes that a worker may hold on to between two jobs, so that all of them fit into the machine."""
    return int(min(max(_MEMORY_FRACTION * machine_memory() / workers, _MIN_MEMORY), _MAX_MEMORY))


@dataclass(eq=False)
class _PoolHandle:
    message: bytes
    number: int
    listener: Listener
    flags: Any
    wake: Callable[[], None]
    is_retry: bool = False
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def done(self) -> bool:
        return self.ended.is_set()

    @property
    def cancelled(self) -> bool:
        return bool(self.flags[self.number % SLOTS] == self.number)

    def cancel(self) -> None:
        self.flags[self.number % SLOTS] = self.number
        self.wake()

    def finish(self, result: JobResult) -> None:
        if self.cancelled and isinstance(result, Finished):
            result = Stopped()
        self.ended.set()
        self.tell(result)

    def tell(self, event: Event) -> None:
        try:
            self.listener(event)
        except Exception:  # noqa: BLE001  the pool must outlive its listeners
            _log.exception("A listener of the process pool raised an exception.")


@dataclass(eq=False)
class _Worker:
    """One process, the pipe to it, the job that it has, and whether that has taken its first step."""

    process: Any
    pipe: Connection
    handle: _PoolHandle | None = None
    started: bool = False

    def stop(self) -> None:
        """Let the process end by itself, once its current job is done."""
        with contextlib.suppress(OSError):
            self.pipe.send_bytes(b"")
        self.pipe.close()


class ProcessPoolRunner:
    """Each job runs whole in one process; listeners are called in a thread of the pool, with progress about
    twice a second, and the result.

    The processes are spawned, not forked (no locks or OpenGL contexts come along), start when there is
    work for them, stay warm and keep to one thread each. One that holds more memory than it may is
    replaced after its job. One that dies is replaced too, and its job is run again while nothing else
    runs; only a job that dies alone has failed.

    ``workers``: number of processes; 0 for one a core. ``memory``: bytes that a process may hold on to
    between two jobs; by default :func:`memory_limit`.
    """

    def __init__(self, workers: int = 0, memory: int | None = None) -> None:
        self.workers = workers or cores()
        self.memory = memory or memory_limit(self.workers)
        self._context = multiprocessing.get_context("spawn")
        # Without a lock: a flag is one aligned word, and a late look at it costs one more step.
        self._flags: Any = self._context.Array("q", SLOTS, lock=False)
        self._number = 0
        self._closed, self._deadline = False, math.inf
        self._lock = threading.Lock()
        self._waiting: deque[_PoolHandle] = deque()
        self._workers: list[_Worker] = []
        self._retired: list[Any] = []
        self._wakeup_recv, self._wakeup_send = self._context.Pipe(duplex=False)
        self._manager: threading.Thread | None = None
        self._at_exit: Any = None

    def submit(self, job: Job, listener: Listener, queue: str = "") -> _PoolHandle:  # noqa: ARG002
        if self._closed:
            raise RuntimeError("the runner is closed")
        self._number += 1
        handle = _PoolHandle(b"", self._number, listener, self._flags, self._wake)
        try:
            handle.message = pickle.dumps((self._number, job))
        except Exception as error:  # noqa: BLE001  whatever an argument's pickling raises
            handle.finish(Failed(f"The work cannot be sent to a process ({error}).", repr(error)))
            return handle
        with self._lock:
            self._waiting.append(handle)
            if self._manager is None:
                # Before multiprocessing's own exit function, which joins the processes and would wait for
                # ever.
                self._at_exit = multiprocessing.util.Finalize(self, self.close, exitpriority=100)
                self._manager = threading.Thread(target=self._manage, name="process pool", daemon=True)
                self._manager.start()
        self._wake()
        return handle

    def close(self) -> None:
        """Stop the jobs between two of their steps and end the processes, within little over a second.

        A process that is still importing what its job needs is not waited for.
        """
        if self._closed:
            return
        self._deadline, self._closed = time.monotonic() + _CLOSE_SECONDS, True
        for number in range(max(1, self._number - SLOTS + 1), self._number + 1):
            self._flags[number % SLOTS] = number
        if self._manager is not None:
            self._at_exit.cancel()
            self._wake()
            self._manager.join()
        self._wakeup_recv.close()
        self._wakeup_send.close()

    def _wake(self) -> None:
        with contextlib.suppress(OSError):
            self._wakeup_send.send_bytes(b"!")

    def _manage(self) -> None:
        """In a thread: dispatch jobs and receive results until closed and all have ended."""
        while True:
            self._drop_cancelled()
            if self._closed:
                self._kill_not_started()
                if not self._busy:
                    break
            self._dispatch()
            ready = wait([self._wakeup_recv, *[worker.pipe for worker in self._workers]], self._timeout)
            if time.monotonic() >= self._deadline:
                for worker in self._busy:
                    worker.process.kill()
            while self._wakeup_recv.poll():
                self._wakeup_recv.recv_bytes()
            for worker in [each for each in self._workers if each.pipe in ready]:
                self._receive(worker)
        for worker in self._workers:
            worker.stop()
        for process in [*self._retired, *[worker.process for worker in self._workers]]:
            _end(process, self._deadline)
        self._workers.clear()

    @property
    def _busy(self) -> list[_Worker]:
        return [worker for worker in self._workers if worker.handle]

    @property
    def _timeout(self) -> float | None:
        return max(0.02, self._deadline - time.monotonic()) if self._closed else None

    def _drop_cancelled(self) -> None:
        with self._lock:
            dropped = [each for each in self._waiting if each.cancelled]
            for handle in dropped:
                self._waiting.remove(handle)
        for handle in dropped:
            handle.finish(Stopped())

    def _kill_not_started(self) -> None:
        """End the processes whose jobs have not taken a step yet; they may still be importing."""
        for worker in [each for each in self._busy if not (each.started or each.pipe.poll())]:
            handle, worker.handle = worker.handle, None
            worker.process.kill()
            self._remove(worker)
            if handle:
                handle.finish(Stopped())

    def _dispatch(self) -> None:
        """Give waiting jobs to idle processes; a retry only while no other job runs."""
        while len(self._busy) < self.workers and (handle := self._next()):
            try:
                idle = self._idle_worker() or self._start_worker()
            except OSError as error:
                handle.finish(
                    Failed(f"A worker process could not be started ({error.strerror}).", repr(error))
                )
                continue
            except RuntimeError as error:  # multiprocessing's, in a process that is itself being started
                handle.finish(Failed(_GUARD, repr(error)))
                continue
            idle.handle, idle.started = handle, False
            with contextlib.suppress(OSError):  # it died while idle, which its pipe reports next
                idle.pipe.send_bytes(handle.message)

    def _next(self) -> _PoolHandle | None:
        """The job to be started next, if there is one."""
        with self._lock:
            if not self._waiting:
                return None
            alone = self._waiting[0].is_retry or any(w.handle and w.handle.is_retry for w in self._workers)
            return None if alone and self._busy else self._waiting.popleft()

    def _idle_worker(self) -> _Worker | None:
        return next((worker for worker in self._workers if not worker.handle), None)

    def _start_worker(self) -> _Worker:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=run_jobs, args=(theirs, self._flags), name="worker")
        # Libraries read the number of threads when they are loaded, and a spawned process inherits what is
        # blocked.
        with _SingleThreadedBlas(), interrupts_blocked():
            process.start()
        # The child has its own copy: only without this one its death ends the pipe.
        theirs.close()
        worker = _Worker(process, ours)
        self._workers.append(worker)
        return worker

    def _receive(self, worker: _Worker) -> None:
        """Receive a result, or find that the process is dead."""
        try:
            answer = worker.pipe.recv_bytes()
        except (EOFError, OSError):
            self._handle_death(worker)
            return
        if answer == STARTED:
            worker.started = True
            return
        try:
            message = pickle.loads(answer)
            if isinstance(message, Progress):
                if worker.handle:
                    worker.handle.tell(message)
                return
            result, memory = message
        except Exception as error:  # noqa: BLE001  whatever an answer's unpickling raises
            result, memory = Failed(f"A worker process could not answer ({error}).", repr(error)), 0
        handle, worker.handle = worker.handle, None
        if memory > self.memory:
            self._remove(worker)
        if handle:
            handle.finish(result)

    def _handle_death(self, worker: _Worker) -> None:
        """Remove a dead process; its job is tried once more, alone."""
        handle = worker.handle
        self._remove(worker)
        if handle is None:
            return
        if handle.is_retry:
            died = "A worker process died of it; it may have run out of memory."
            handle.finish(Failed(died if worker.started else f"A worker process died at its start. {_GUARD}"))
            return
        handle.is_retry = True
        with self._lock:
            self._waiting.appendleft(handle)

    def _remove(self, worker: _Worker) -> None:
        self._workers.remove(worker)
        worker.stop()
        self._retired = [process for process in [*self._retired, worker.process] if process.is_alive()]


def _end(process: Any, deadline: float) -> None:
    process.join(max(0.0, deadline - time.monotonic()))
    if process.is_alive():
        process.kill()
        process.join()


class _SingleThreadedBlas:
    """Processes that are started meanwhile use one thread for linear algebra."""

    def __enter__(self) -> None:
        self._before = {name: os.environ.get(name) for name in _THREAD_LIMITS}
        os.environ.update(dict.fromkeys(_THREAD_LIMITS, "1"))

    def __exit__(self, *_error: object) -> None:
        for name, value in self._before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
