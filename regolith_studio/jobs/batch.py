"""Many jobs through one runner: few at a time, answers in the order of the questions."""

import queue
from collections.abc import Callable, Generator, Iterable
from typing import Any

from regolith_studio.errors import Cancelled, EnvironmentProblem, RegolithError
from regolith_studio.jobs.events import Ending, Event, Failed, Finished, Job, Started, Steps, Stopped
from regolith_studio.jobs.runners.protocol import Handle, Runner

_PATIENCE = 0.1
"""Seconds without an answer after which the caller gets a turn, so that it can be cancelled."""


def in_order(runner: Runner, jobs: Iterable[Job], window: int = 2) -> Generator[Ending | None, None, None]:
    """Endings of `jobs` in their order; ``None`` while the next one is being waited for.

    Parameters
    ----------
    window
        Jobs that are submitted but not yet answered for: bounds the memory.
    """
    early: dict[int, Ending] = {}
    expected = 0
    for answer in as_they_end(runner, jobs, window, held=lambda: len(early)):
        if answer is None:
            yield None
            continue
        number, ending = answer
        early[number] = ending
        while expected in early:
            yield early.pop(expected)
            expected += 1


def as_they_end(
    runner: Runner, jobs: Iterable[Job], window: int = 2, held: Callable[[], int] = lambda: 0
) -> Generator[tuple[int, Ending] | None, None, None]:
    """Number and ending of each of `jobs` as they end; ``None`` while the next one is being waited for.

    Parameters
    ----------
    window
        Jobs that are submitted at the same time.
    held
        Endings that the caller keeps back; they count as if they were still under way.
    """
    answers: queue.SimpleQueue[tuple[int, Ending]] = queue.SimpleQueue()
    waiting = enumerate(jobs)
    open_handles: dict[int, Handle] = {}
    try:
        while True:
            while len(open_handles) + held() < window and (entry := next(waiting, None)):
                number, job = entry
                open_handles[number] = runner.submit(job, _noting(answers, number))
            if not open_handles:
                return
            try:
                number, ending = answers.get(timeout=_PATIENCE)
            except queue.Empty:
                yield None
                continue
            del open_handles[number]
            yield number, ending
    finally:
        for handle in open_handles.values():
            handle.cancel()


def call(function: Callable[[Any], Any], item: Any) -> Steps:
    """A job of a single step: `function` of `item`."""
    yield Started("Working")
    return function(item)


def value_of(ending: Ending) -> Any:
    """What a job returned.

    Raises
    ------
    RegolithError
        If it failed.
    Cancelled
        If it was stopped.
    """
    match ending:
        case Finished(value):
            return value
        case Failed(sentence):
            raise RegolithError(sentence)
        case Stopped(reason) if reason:
            raise EnvironmentProblem(reason)
        case _:
            raise Cancelled("The work was stopped.")


def _noting(answers: "queue.SimpleQueue[tuple[int, Ending]]", number: int) -> Callable[[Event], None]:
    def note(event: Event) -> None:
        if isinstance(event, Finished | Failed | Stopped):
            answers.put((number, event))

    return note
