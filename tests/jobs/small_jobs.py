"""Small jobs that every runner is tested against; workers import them by the name of this module."""

import itertools
import os
import time
from pathlib import Path

from regolith_studio.errors import InputError, JobCancelled
from regolith_studio.imaging.extraction import ExtractedParticle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.jobs.particle_jobs import MeasuredParticle


def count_to(n: int) -> Steps:
    yield Started("Counting", n)
    for i in range(1, n + 1):
        yield Progress(i, n)
    return n


def square(x: int) -> Steps:
    yield Started("Squaring")
    return x * x


def refuse() -> Steps:
    yield Started("Refusing")
    raise InputError("The number is too green.")


def stumble() -> Steps:
    yield Started("Stumbling")
    raise KeyError("oops")


def give_up() -> Steps:
    yield Started("Giving up")
    raise JobCancelled("enough")


def die() -> Steps:
    yield Started("Dying")
    os._exit(3)


def process_id() -> Steps:
    yield Started("Asking")
    return os.getpid()


def wait_forever() -> Steps:
    yield Started("Waiting")
    while True:
        time.sleep(0.005)
        yield Progress(0, 0)


def with_a_lambda() -> Steps:
    yield Started("Hiding")
    return lambda: None


def hold(megabytes: int) -> Steps:
    yield Started("Holding")
    HELD.append(b"x" * (megabytes * 2**20))
    return os.getpid()


HELD: list[bytes] = []


def wait_for(path: str) -> Steps:
    yield Started("Waiting")
    while not os.path.exists(path):  # noqa: PTH110
        yield Progress(0, 0)
        time.sleep(0.005)
    return path


def count_until(path: str) -> Steps:
    yield Started("Counting")
    for number in itertools.count(1):
        yield Progress(number, 0, "counting")
        if os.path.exists(path):  # noqa: PTH110
            return number
        time.sleep(0.01)


def throttle(path: str) -> Steps:
    """A job without an end that writes to a file at each step."""
    yield Started("Beating")
    while True:
        Path(path).write_text(f"{time.time()}")
        time.sleep(0.05)
        yield Progress(0, 0)


def sleep_without_steps(path: str) -> Steps:
    """A job whose only step takes a minute; it says that it has begun by a file."""
    yield Started("Sleeping")
    Path(path).touch()
    time.sleep(60)


def name_and_numbers(extracted: ExtractedParticle, measured: MeasuredParticle) -> tuple[str, str, object]:
    """Name, hash of the mesh and descriptors of a particle."""
    return extracted.particle.name, extracted.particle.mesh.content_hash, measured.descriptors
