"""Reads particles from files, one after the other, and tells what is wrong with each."""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.readers.registry import MeshFile, mesh_files, read_file
from regolith_studio.readers.sample import sample_particles
from regolith_studio.readers.sentences import counted, shown_name


@dataclass(frozen=True)
class Problem:
    """A file that could not be read, and why, in one sentence."""

    path: str
    sentence: str

    @property
    def with_path(self) -> str:
        """The sentence with the whole path in it, where the file's name alone may not tell which it is."""
        name = shown_name(Path(self.path))
        if self.sentence.startswith(f"{name} "):
            return self.path + self.sentence.removeprefix(name)
        return f"{self.path}: {self.sentence}"


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
    problems: list[Problem] = []
    particles: list[Particle] = []
    files = files_in(paths, problems)
    yield Started("Reading particles", len(files))
    for done, file in enumerate(files, start=1):
        try:
            particles.append(read_file(file, unit, repair))
        except (FileError, GeometryError) as error:
            problems.append(Problem(str(file.path), str(error)))
        yield Progress(done, len(files), file.path.name)
    if not particles:
        raise FileError(_nothing_read(problems))
    return Loaded(uniquely_named(particles), tuple(problems))


def _nothing_read(problems: Sequence[Problem]) -> str:
    """The first file's sentence, and how many more there are."""
    if not problems:
        return "There is no file to read."
    more = f" ({counted(len(problems) - 1, 'more file')} could not be read either.)" if problems[1:] else ""
    return problems[0].sentence + more


def files_in(paths: Sequence[Path], problems: list[Problem]) -> list[MeshFile]:
    """The files behind `paths`; a folder without meshes becomes one of the `problems`."""
    if not paths:
        return []
    try:
        return mesh_files(paths)
    except FileError as error:
        if len(paths) == 1:
            problems.append(Problem(str(paths[0]), str(error)))
            return []
    return [file for path in paths for file in files_in([path], problems)]


def load_sample() -> Steps:
    """The particles that ship with the program; returns :class:`Loaded`."""
    yield Started("Reading the sample")
    return Loaded(tuple(sample_particles()))


def uniquely_named(particles: Sequence[Particle], taken: Sequence[str] = ()) -> tuple[Particle, ...]:
    """The particles; a name that has been `taken`, or came before, gets the group, then a number."""
    used = set(taken)
    return tuple(
        dataclasses.replace(particle, name=free_name(particle.name, particle.group, used))
        for particle in particles
    )


def free_name(name: str, group: str, used: set[str]) -> str:
    """The name, or if it is `used` the name with its group, then with a number; is used afterwards."""
    if name in used and group:
        name = f"{group.replace('/', '_')}_{name}"
    base, number = name, 1
    while name in used:
        number += 1
        name = f"{base}_{number}"
    used.add(name)
    return name
