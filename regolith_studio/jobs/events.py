"""The story of a job: small frozen events, the same for the window, the command line and the tests.

A job is a generator function with picklable arguments. It yields :class:`Started`,
:class:`Progress` and :class:`Partial`, and returns its result. How it ended is said by the runner:
:class:`Finished`, :class:`Failed` or :class:`Stopped`, exactly one of them and always last.
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
    """`done` of `total` steps are done; the message says what was done last."""

    done: int
    total: int
    message: str = ""


@dataclass(frozen=True)
class Partial:
    """A result that is already of use: the best polyhedron so far, one row of a table."""

    value: Any


@dataclass(frozen=True)
class Finished:
    """The job returned `value`."""

    value: Any


@dataclass(frozen=True)
class Failed:
    """The job raised: one sentence for the user, the traceback for a report."""

    sentence: str
    details: str = ""


@dataclass(frozen=True)
class Stopped:
    """The job was cancelled, or replaced by a newer one of its lane; `reason` where nobody asked for it."""

    reason: str = ""


Step = Started | Progress | Partial
Ending = Finished | Failed | Stopped
Event = Step | Ending
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
