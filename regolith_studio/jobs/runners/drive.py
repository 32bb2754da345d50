"""Drives one job from its first step to its ending; the only place that catches everything."""

import traceback
from collections.abc import Callable

from regolith_studio.errors import Cancelled, RegolithError
from regolith_studio.jobs.events import Ending, Failed, Finished, Job, Listener, Stopped


def drive(job: Job, listener: Listener, stopped: Callable[[], bool]) -> Ending:
    """Run `job` to its end, telling `listener` every step, and return how it ended.

    Parameters
    ----------
    stopped
        Asked before the first step and between any two; a true answer closes the generator.
    """
    if stopped():
        return Stopped()
    try:
        steps = job.steps()
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                return Finished(end.value)
            if stopped():
                steps.close()
                return Stopped()
            listener(step)
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
    return Failed(f"The program made a mistake ({type(error).__name__}: {error}).", details)
