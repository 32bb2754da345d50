"""Drives one job from its first step to its ending; the only place that catches everything."""

import traceback
from collections.abc import Callable, Generator

from regolith_studio.errors import Cancelled, RegolithError, of_the_system
from regolith_studio.jobs.events import Ending, Failed, Finished, Job, Listener, Step, Stopped


def drive(job: Job, listener: Listener, stopped: Callable[[], bool]) -> Ending:
    """Run `job` to its end, telling `listener` every step, and return how it ended.

    Parameters
    ----------
    stopped
        Asked before the first step and between any two; a true answer closes the generator.
    """
    if stopped():
        return Stopped()
    story = told(job)
    while True:
        try:
            step = next(story)
        except StopIteration as end:
            ending: Ending = end.value
            return ending
        if stopped():
            story.close()
            return Stopped()
        listener(step)


def told(job: Job) -> Generator[Step, None, Ending]:
    """The steps of `job`; returns how it ended, whatever it raised."""
    try:
        return Finished((yield from job.steps()))
    except Cancelled:
        return Stopped()
    except Exception as error:  # noqa: BLE001  whatever a job raises must reach its listener
        return failure(error)


def failure(error: BaseException) -> Failed:
    """The event that tells `error`: its own sentence if it was meant for users, else a general one."""
    details = "".join(traceback.format_exception(error))
    if isinstance(error, RegolithError):
        return Failed(str(error), details)
    if isinstance(error, MemoryError):
        return Failed("The work needs more memory than this machine has.", details)
    if isinstance(error, OSError) and error.errno is not None:
        return Failed(of_the_system(error), details)
    return Failed(f"The program made a mistake ({type(error).__name__}: {error}).", details)
