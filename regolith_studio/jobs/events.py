"""Events of a job: small frozen records, the same for the window, the command line and the tests.

A job is a generator function with picklable arguments. It yields :class:`Started`,
:class:`Progress` and :class:`Partial`, and returns its result. The runner reports how it ended with exactly
one :class:`Finished`, :class:`Failed` or :class:`Stopped`, which always comes last.
"""

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Started:
    """The job has begun; `total` is its number of steps, 0 where that is not known."""

    title: str
    total: int = 0


@dataclass(frozen=True)
class Progress:
    """`done` of `total` steps are done; the message names the last one."""

    done: int
    total: int
    message: str = ""


@dataclass(frozen=True)
class Partial:
    """An intermediate result, such as the best polyhedron so far; a runner may leave out all but the last."""

    value: Any


@dataclass(frozen=True)
class Finished:
    """The job returned `value`."""

    value: Any


@dataclass(frozen=True)
class Failed:
    """The job raised: a message for the user, and the traceback."""

    sentence: str
    details: str = ""


@dataclass(frozen=True)
class Stopped:
    """The job was cancelled, or replaced by a newer one of its lane; `reason` if not by the user."""

    reason: str = ""


Step = Started | Progress | Partial
JobResult = Finished | Failed | Stopped
Event = Step | JobResult
Listener = Callable[[Event], None]
Steps = Generator[Step, None, Any]


@dataclass(frozen=True)
class Job:
    """A generator function with the arguments that it will be called with.

    Parameters
    ----------
    function
        Module-level generator function; yields :data:`Step`, returns the result.
    arguments, options
        Positional and keyword arguments; picklable, so that any runner can take the job.
    """

    function: Callable[..., Steps]
    arguments: tuple[Any, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)

    def steps(self) -> Steps:
        """A fresh run of the job."""
        return self.function(*self.arguments, **self.options)


def result_of(steps: Steps) -> Any:
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
            return end.value
