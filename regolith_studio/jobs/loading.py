"""Jobs that read particles: from files, and those that ship with the program."""

from collections.abc import Sequence
from pathlib import Path

from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.readers.particles import (
    FileProblem,
    LoadedParticles,
    collect_particles,
    find_files,
    read_each,
    sample_particles,
)


def load_particles(paths: Sequence[Path], unit: str = "um", repair: bool = True) -> Steps:
    """Read the meshes in `paths` (files and folders); returns :class:`LoadedParticles`.

    Raises
    ------
    FileError
        If nothing could be read: the first file's message.
    """
    problems: list[FileProblem] = []
    results: list[Particle | FileProblem] = []
    files = find_files(paths, problems)
    yield Started("Reading particles", len(files))
    for done, (file, result) in enumerate(read_each(files, unit, repair), start=1):
        results.append(result)
        yield Progress(done, len(files), file.path.name)
    return collect_particles(results, problems)


def load_sample() -> Steps:
    """Read the particles that ship with the program; returns :class:`LoadedParticles`."""
    yield Started("Reading the sample")
    return LoadedParticles(tuple(sample_particles()))
