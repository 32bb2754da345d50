"""Reads particles from files, one after the other, and tells what is wrong with each."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.errors import RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Progress, Started, Steps

if TYPE_CHECKING:
    pass


@dataclass(frozen=True)
class Loaded:
    """Particles that could be read, and one sentence for each file or body that could not."""

    particles: tuple[Particle, ...]
    problems: tuple[str, ...]


def load_particles(paths: Sequence[Path], unit: str = "um", repair: bool = True) -> Steps:
    """Read the meshes in `paths` (files and folders); returns :class:`Loaded`."""
    from regolith_studio.readers.registry import read_particles

    yield Started("Reading particles", len(paths))
    particles: list[Particle] = []
    problems: list[str] = []
    for done, path in enumerate(paths, start=1):
        try:
            particles += read_particles([path], unit=unit, repair=repair, on_problem=problems.append)
        except RegolithError as error:
            problems.append(str(error))
        yield Progress(done, len(paths), path.name)
    return Loaded(tuple(particles), tuple(problems))


def load_sample() -> Steps:
    """The particles that ship with the program; returns :class:`Loaded`."""
    from regolith_studio.readers.sample import sample_particles

    yield Started("Reading the sample")
    return Loaded(tuple(sample_particles()), ())
