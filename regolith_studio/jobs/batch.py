"""Many jobs through one runner: few at a time, answers in the order of the questions."""

import queue
from collections.abc import Callable, Generator, Iterable, Iterator
from itertools import count
from typing import Any

from regolith_studio.errors import Cancelled, RegolithError
from regolith_studio.jobs.events import Ending, Event, Failed, Finished, Job, Started, Steps, Stopped
from regolith_studio.jobs.runners.inline import InlineRunner
from regolith_studio.jobs.runners.process_pool import ProcessPoolRunner, cores
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
    answers: queue.SimpleQueue[tuple[int, Ending]] = queue.SimpleQueue()
    waiting = enumerate(jobs)
    open_handles: dict[int, Handle] = {}
    early: dict[int, Ending] = {}
    try:
        for expected in count():
            while len(open_handles) + len(early) < window and (entry := next(waiting, None)):
                number, job = entry
                open_handles[number] = runner.submit(job, _noting(answers, number))
            if expected not in open_handles and expected not in early:
                return
            while expected not in early:
                try:
                    number, ending = answers.get(timeout=_PATIENCE)
                except queue.Empty:
                    yield None
                    continue
                del open_handles[number]
                early[number] = ending
            yield early.pop(expected)
    finally:
        for handle in open_handles.values():
            handle.cancel()


def mapper(workers: int) -> Callable[[Callable[[Any], Any], Iterable[Any]], Iterator[Any]]:
    """As ``map``, for `workers` processes (0: one a core): in order, lazily, few at a time.

    An item whose call raises ends the mapping with a ``RegolithError`` of its sentence.
    """

    def mapped(function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
        runner = batch_runner(workers)
        try:
            for ending in in_order(
                runner, (Job(call, (function, item)) for item in items), window_for(workers)
            ):
                if ending is not None:
                    yield value_of(ending)
        finally:
            runner.close()

    return mapped


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
        case _:
            raise Cancelled("The work was stopped.")


def window_for(workers: int) -> int:
    """How many jobs to have under way so that `workers` processes never wait (0: one a core)."""
    return 1 if workers == 1 else 2 * (workers or cores())


def _noting(answers: "queue.SimpleQueue[tuple[int, Ending]]", number: int) -> Callable[[Event], None]:
    def note(event: Event) -> None:
        if isinstance(event, Finished | Failed | Stopped):
            answers.put((number, event))

    return note


def batch_runner(workers: int) -> Runner:
    """The runner for `workers` jobs at a time: inline for one, processes for more (0: all cores)."""
    workers = workers or cores()
    return InlineRunner() if workers == 1 else ProcessPoolRunner(workers)
