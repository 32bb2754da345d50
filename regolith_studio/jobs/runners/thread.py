"""Runs jobs in threads, one a queue, for a program whose main thread must stay free; they can be paused."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, field

from regolith_studio.jobs.events import (
    Event,
    Finished,
    Job,
    JobResult,
    Listener,
    Partial,
    Progress,
    Stopped,
)
from regolith_studio.jobs.runners import run_job

Post = Callable[[Callable[[], None]], None]
"""Takes a function and calls it, soon and in order, in the thread that owns the listeners."""


class PauseToken:
    """Pauses, resumes or stops a job; the runner checks it between two steps, from any thread."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._paused = self._stopped = False

    @property
    def paused(self) -> bool:
        """Whether the job waits, or will as soon as its current step is done."""
        return self._paused

    @property
    def stopped(self) -> bool:
        """Whether the job shall go no further."""
        return self._stopped

    def pause(self) -> None:
        """Let the job wait after its current step; no effect when it has been stopped."""
        with self._changed:
            self._paused = not self._stopped

    def resume(self) -> None:
        """Resume the job."""
        with self._changed:
            self._paused = False
            self._changed.notify_all()

    def stop(self) -> None:
        """Let the job end, also if it waits."""
        with self._changed:
            self._paused, self._stopped = False, True
            self._changed.notify_all()

    def wait_while_paused(self) -> bool:
        """Block while paused; returns whether the job may continue."""
        with self._changed:
            self._changed.wait_for(lambda: not self._paused)
            return not self._stopped


class _Mailbox:
    """Carries events to the listener's thread; progress that has not been delivered is replaced by newer."""

    def __init__(self, listener: Listener, post: Post) -> None:
        self._listener, self._post = listener, post
        self._lock = threading.Lock()
        self._waiting: list[Event] = []

    def put(self, event: Event) -> None:
        with self._lock:
            idle = not self._waiting
            if isinstance(event, Progress | Partial):
                self._waiting = [old for old in self._waiting if type(old) is not type(event)]
            self._waiting.append(event)
        if idle:
            self._post(self._deliver)

    def _deliver(self) -> None:
        with self._lock:
            events, self._waiting = self._waiting, []
        for event in events:
            self._listener(event)


@dataclass(eq=False)
class _ThreadHandle:
    job: Job
    mailbox: _Mailbox
    token: PauseToken = field(default_factory=PauseToken)
    end: threading.Event = field(default_factory=threading.Event)

    @property
    def done(self) -> bool:
        return self.end.is_set()

    def cancel(self) -> None:
        self.token.stop()

    def pause(self) -> None:
        self.token.pause()

    def resume(self) -> None:
        self.token.resume()

    def run(self) -> None:
        self.finish(run_job(self.job, self.mailbox.put, lambda: not self.token.wait_while_paused()))

    def finish(self, ending: JobResult) -> None:
        # Stopped after its last step: whoever stopped it expects no result any more.
        if self.token.stopped and isinstance(ending, Finished):
            ending = Stopped()
        self.end.set()
        self.mailbox.put(ending)


class _Queue:
    """One thread and the newest job that waits for it."""

    def __init__(self, name: str) -> None:
        self._condition = threading.Condition()
        self._running: _ThreadHandle | None = None
        self._next: _ThreadHandle | None = None
        self._closing = False
        self.thread = threading.Thread(target=self._work, name=f"queue {name}", daemon=True)
        self.thread.start()

    def replace(self, handle: _ThreadHandle) -> None:
        with self._condition:
            if self._running:
                self._running.cancel()
            replaced, self._next = self._next, handle
            self._condition.notify()
        if replaced:
            replaced.finish(Stopped())

    def close(self) -> None:
        with self._condition:
            self._closing = True
            replaced, self._next = self._next, None
            if self._running:
                self._running.cancel()
            self._condition.notify()
        if replaced:
            replaced.finish(Stopped())

    def _work(self) -> None:
        while self._run_next():
            pass

    def _run_next(self) -> bool:
        """Wait for a job and run it; its objects are freed before the next one is waited for."""
        handle = self._take()
        if handle is None:
            return False
        handle.run()
        return True

    def _take(self) -> _ThreadHandle | None:
        with self._condition:
            self._running = None
            self._condition.wait_for(lambda: self._next or self._closing)
            self._running, self._next = self._next, None
            return self._running


class ThreadRunner:
    """One worker thread a queue; within a queue a new job stops the running one and takes its place.

    - ``post``: brings a call into the thread that owns the listeners (a queue in tests, the event loop of
      the window); events of one job arrive in order. Progress and partial results that have not been read
      when newer ones come are skipped, endings never.
    """

    def __init__(self, post: Post) -> None:
        self._post = post
        self._queues: dict[str, _Queue] = {}
        self._closed = False

    def submit(self, job: Job, listener: Listener, queue: str = "") -> _ThreadHandle:
        if self._closed:
            raise RuntimeError("the runner is closed")
        handle = _ThreadHandle(job, _Mailbox(listener, self._post))
        if queue not in self._queues:
            self._queues[queue] = _Queue(queue)
        self._queues[queue].replace(handle)
        return handle

    def close(self, timeout: float | None = 30.0) -> None:
        """Cancel everything and wait for the threads; a job that never yields is left behind."""
        self._closed = True
        for queue in self._queues.values():
            queue.close()
        for queue in self._queues.values():
            queue.thread.join(timeout)
        self._queues.clear()
