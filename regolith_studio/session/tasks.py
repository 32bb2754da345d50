"""The running tasks: numbered, listed, cancellable; each queue holds the newest one."""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from regolith_studio.jobs.events import Event, Failed, Finished, Job, Partial, Progress, Started, Stopped
from regolith_studio.jobs.runners import Handle, Pausable, Runner


@dataclass(frozen=True)
class Task:
    """One running job; `total` is 0 while its length is unknown.

    `pausable` says whether it can be paused between two of its steps, `paused` whether it is, `stopping`
    that it ends after its present step. `repeats` says that the same work starts by itself when its file or
    page is opened again, so that nothing is lost by stopping it.
    """

    id: int
    queue: str
    title: str
    done: int = 0
    total: int = 0
    message: str = ""
    pausable: bool = False
    paused: bool = False
    stopping: bool = False
    repeats: bool = False


@dataclass(frozen=True)
class Reactions:
    """Callbacks for the events of a task; called only while it is the newest of its queue."""

    finished: Callable[[Any], None]
    partial: Callable[[Any], None] = lambda _value: None
    failed: Callable[[Failed], None] = lambda _failure: None
    stopped: Callable[[], None] = lambda: None


class TaskBoard:
    """Submits jobs to a runner and drops the events of jobs that a newer one has replaced.

    ``changed``: called whenever :attr:`running` has changed. ``ending``: queue of the task whose end is
    reacted to at present, if there is one.
    """

    def __init__(self, runner: Runner, changed: Callable[[], None]) -> None:
        self._runner, self._changed = runner, changed
        self.ending = ""
        self._number = 0
        self._newest: dict[str, int] = {}
        self._tasks: dict[int, Task] = {}
        self._handles: dict[int, Handle] = {}
        self._waiting: dict[str, Callable[[], int]] = {}

    @property
    def running(self) -> tuple[Task, ...]:
        """The newest task of each queue that has not ended, oldest first."""
        return tuple(self._tasks.values())

    def is_running(self, queue: str) -> bool:
        """Whether `queue` has a task that has not ended."""
        return self._newest.get(queue, 0) in self._tasks

    def start(
        self,
        queue: str,
        title: str,
        job: Job,
        reactions: Reactions,
        *,
        repeats: bool = False,
        after_running: bool = False,
    ) -> int:
        """Run `job`; the previous job of `queue` is cancelled and its events dropped. Returns its id.

        - ``repeats``: see :class:`Task`.
        - ``after_running``: let the running job of `queue` end and be shown first, and drop one that waits:
          for a control that is dragged, where nothing would be seen if each new value stopped the job of the
          last.
        """
        if after_running and self.is_running(queue):
            self._waiting[queue] = partial(self.start, queue, title, job, reactions, repeats=repeats)
            return self._newest[queue]
        self.stop_queue(queue)
        self._number += 1
        number = self._newest[queue] = self._number
        self._tasks[number] = Task(number, queue, title, repeats=repeats)
        self._changed()
        handle = self._runner.submit(job, lambda event: self._on_event(number, event, reactions), queue)
        if number in self._tasks:
            self._handles[number] = handle
            if isinstance(handle, Pausable):
                self._update(number, pausable=True)
        return number

    def stop_queue(self, queue: str) -> None:
        """Cancel the job of `queue` silently: its reactions are not called any more."""
        self._waiting.pop(queue, None)
        number = self._newest.pop(queue, 0)
        if handle := self._handles.get(number):
            handle.cancel()
        if self._remove(number):
            self._changed()

    def cancel(self, number: int) -> None:
        """Cancel one task; its `stopped` reaction follows when it has stopped."""
        if handle := self._handles.get(number):
            handle.cancel()
        if number in self._tasks:
            self._update(number, stopping=True)

    def pause(self, number: int) -> None:
        """Pause one task after its current step, where its runner can do that."""
        handle = self._handles.get(number)
        if isinstance(handle, Pausable) and not self._tasks[number].paused:
            handle.pause()
            self._update(number, paused=True)

    def resume(self, number: int) -> None:
        """Resume a paused task."""
        handle = self._handles.get(number)
        if isinstance(handle, Pausable) and self._tasks[number].paused:
            handle.resume()
            self._update(number, paused=False)

    def _remove(self, number: int) -> bool:
        self._handles.pop(number, None)
        return self._tasks.pop(number, None) is not None

    def _on_event(self, number: int, event: Event, reactions: Reactions) -> None:
        if number not in self._tasks:
            return
        match event:
            case Started(title, total):
                self._update(number, title=title, done=0, total=total, message="")
            case Progress(done, total, message):
                self._update(number, done=done, total=total, message=message)
            case Partial(value):
                reactions.partial(value)
            case Finished() | Failed() | Stopped():
                self._end(number, event, reactions)

    def _update(self, number: int, **changes: Any) -> None:
        self._tasks[number] = dataclasses.replace(self._tasks[number], **changes)
        self._changed()

    def _end(self, number: int, event: Finished | Failed | Stopped, reactions: Reactions) -> None:
        queue = self._tasks[number].queue
        self._remove(number)
        outer, self.ending = self.ending, queue
        try:
            match event:
                case Finished(value):
                    reactions.finished(value)
                case Failed():
                    reactions.failed(event)
                case Stopped():
                    reactions.stopped()
        finally:
            self.ending = outer
            if start := self._waiting.pop(queue, None):
                start()
        self._changed()
