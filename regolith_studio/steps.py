"""Steps of work that takes long: generators that yield how far it is, and return its result."""

from collections.abc import Callable, Generator, Iterable
from typing import Any, TypeVar

_Step = TypeVar("_Step")
_Event = TypeVar("_Event")
_Result = TypeVar("_Result")


def result_of(steps: Generator[Any, None, _Result]) -> _Result:
    """Do all steps of a job in this thread, and return its result.

    Parameters
    ----------
    steps
        A job that has been called: ``result_of(repose_steps(dataset, folder, request))``.

    Raises
    ------
    RegolithError
        Of the job.
    """
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: _Result = end.value
            return result


def as_events(
    steps: Generator[_Step, None, _Result], events_of: Callable[[_Step], Iterable[_Event]]
) -> Generator[_Event, None, _Result]:
    """Do steps of another kind, yield the events of each, and return the result."""
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            result: _Result = end.value
            return result
        yield from events_of(step)
