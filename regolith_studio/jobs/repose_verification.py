"""Job that verifies an engine, a line at a time."""

from regolith_studio.dem.verification.certificate import MEASUREMENTS, QUICK, measure_lines, verifiable_engine
from regolith_studio.jobs.events import Partial, Progress, Started, Steps
from regolith_studio.messages import N_


def verify_engine(key: str, quick: bool = False) -> Steps:
    """Measure the lines of an engine, each a :class:`Partial` when it is done; returns a
    :class:`~regolith_studio.dem.verification.certificate.Certificate`.

    ``key``: of the engine. ``quick``: leave out what takes more than minutes: gravity and dice.
    """
    engine = verifiable_engine(key)
    keys = QUICK if quick else MEASUREMENTS
    yield Started(N_("Verifying the engine"), len(keys))
    steps, done = measure_lines(engine, keys), 0
    while True:
        try:
            name, line = next(steps)
        except StopIteration as end:
            return end.value
        if line is not None:
            done += 1
            yield Partial(line)
        yield Progress(done, len(keys), name)
