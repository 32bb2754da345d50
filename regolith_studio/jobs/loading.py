"""Reads particles from files, one after the other, and tells what is wrong with each."""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.errors import FileError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.readers.registry import read_particles
from regolith_studio.readers.sample import sample_particles


@dataclass(frozen=True)
class Problem:
    """A file that could not be read, and why, in one sentence."""

    path: str
    sentence: str


@dataclass(frozen=True)
class Loaded:
    """Particles that could be read, with names that all differ, and the files that could not."""

    particles: tuple[Particle, ...]
    problems: tuple[Problem, ...] = ()


def load_particles(paths: Sequence[Path], unit: str = "um", repair: bool = True) -> Steps:
    """Read the meshes in `paths` (files and folders); returns :class:`Loaded`.

    Raises
    ------
    FileError
        If nothing could be read: the first sentence.
    """
    yield Started("Reading particles", len(paths))
    particles: list[Particle] = []
    problems: list[Problem] = []

    def note(path: Path, sentence: str) -> None:
        problems.append(Problem(str(path), sentence))

    for done, path in enumerate(paths, start=1):
        noted = len(problems)
        try:
            particles += read_particles([path], unit=unit, repair=repair, on_problem=note)
        except RegolithError as error:
            if len(problems) == noted:
                note(path, str(error))
        yield Progress(done, len(paths), path.name)
    if not particles:
        raise FileError(problems[0].sentence if problems else "There is no file to read.")
    return Loaded(uniquely_named(particles), tuple(problems))


def load_sample() -> Steps:
    """The particles that ship with the program; returns :class:`Loaded`."""
    yield Started("Reading the sample")
    return Loaded(tuple(sample_particles()))


def uniquely_named(particles: Sequence[Particle], taken: Sequence[str] = ()) -> tuple[Particle, ...]:
    """The particles, those whose name has been `taken` or came before with a number behind it."""
    used, renamed = set(taken), []
    for particle in particles:
        name, number = particle.name, 1
        while name in used:
            number += 1
            name = f"{particle.name}_{number}"
        used.add(name)
        renamed.append(dataclasses.replace(particle, name=name))
    return tuple(renamed)
