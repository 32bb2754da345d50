"""Where open particles came from, in the terms of a recipe: files, the sample, a volume, a shape model."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.geometry.particle import Particle
from regolith_studio.readers.coefficient_tables import TABLE_SUFFIXES, TEXT_SUFFIXES
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.particles import find_files, sample_particles
from regolith_studio.session.recipe import Population, VolumeEntry

if TYPE_CHECKING:  # what draws shapes takes a third of a second to import: the window begins without it
    from regolith_studio.jobs.model_jobs import GenerationResult, ModelFitResult
    from regolith_studio.shape_models.protocol import FittedModel

Member = tuple[str, str, str]
"""A particle that an origin gives: what tells it from the others there, its name and its group."""


@dataclass(frozen=True)
class SampleSource:
    """The particles that ship with the program."""

    def members(self) -> tuple[Member, ...]:
        """All that it gives, in order."""
        return tuple((each.name, each.name, each.group) for each in sample_particles())


@dataclass(frozen=True)
class FileSource:
    """Files and folders that were read together.

    Parameters
    ----------
    paths
        As they were named, absolute.
    unit
        Of those without one.
    repair
        Whether what was wrong with meshes was mended.
    """

    paths: tuple[str, ...]
    unit: str
    repair: bool = True

    def members(self) -> tuple[Member, ...]:
        """All files that are there now, in order; also those that cannot be read."""
        found = find_files([Path(path) for path in self.paths], [])
        return tuple((str(file.path), file.path.stem, file.group) for file in found)


@dataclass(frozen=True, eq=False)
class VolumeSource:
    """Particles of a CT volume.

    Parameters
    ----------
    volume
        The file, and all settings.
    known
        Every grain that became a particle, in order.
    """

    volume: VolumeEntry
    known: tuple[Member, ...] = field(repr=False)

    @classmethod
    def of(cls, volume: VolumeEntry, particles: Sequence[Particle]) -> "VolumeSource":
        """The origin of all particles of an extraction."""
        return cls(volume, tuple((each.name, each.name, each.group) for each in particles))

    def members(self) -> tuple[Member, ...]:
        """All that it gives, in order."""
        return self.known


@dataclass(frozen=True, eq=False)
class VirtualSource:
    """Virtual particles.

    Parameters
    ----------
    population
        With a name and a seed; its source is a shipped card, or is to be the file of `model`.
    model
        What they were drawn from, where no card says it.
    """

    population: Population
    model: "FittedModel | None" = field(default=None, repr=False)

    @classmethod
    def of(cls, drawn: "GenerationResult", fitted: "ModelFitResult", level: int) -> "VirtualSource":
        """The origin of particles that were drawn from `fitted`, or from what was edited in it.

        Parameters
        ----------
        level
            Subdivisions of the icosahedron that their surfaces are drawn on.
        """
        from regolith_studio.shape_models.materials import materials

        name, wish = fitted.source.name, drawn.request
        shipped = drawn.model is fitted.model and fitted.source.content == materials().get(name)
        population = Population(
            sources=[name],
            n=len(drawn.draws),
            l_max=drawn.model.l_max if shipped else None,
            size_range=None if wish.size_range is None else list(wish.size_range),
            seed=wish.seed,
            level=level,
            name=name if shipped else _title(name),
        )
        return cls(population, None if shipped else drawn.model)

    def members(self) -> tuple[Member, ...]:
        """All that it gives, in order."""
        from regolith_studio.jobs.model_jobs import drawn_names

        names = drawn_names(self.population.name, self.population.n)
        return tuple((name, name, "") for name in names)


def _title(name: str) -> str:
    """A name for drawn particles that can stand in the names of files."""
    return re.sub(r"[^\w.+-]+", "_", name).strip("_.")[:40] or "virtual"


ParticleSource = SampleSource | FileSource | VolumeSource | VirtualSource


@dataclass(frozen=True)
class ParticleRef:
    """Which particle of an origin one is."""

    origin: ParticleSource
    key: str


def places_of(particles: Sequence[Particle], origin: ParticleSource) -> tuple[ParticleRef, ...]:
    """Where each of the particles stands that an origin has just given.

    Files are told apart by their paths, all others by their names before these were made unique.
    """
    if isinstance(origin, FileSource):
        return tuple(ParticleRef(origin, each.source.path if each.source else "") for each in particles)
    return tuple(ParticleRef(origin, each.name) for each in particles)


def place_by_source(particle: Particle) -> ParticleRef | None:
    """Where a particle stands of which only its file is known."""
    source = particle.source
    if source is None:
        return None
    kind, _, name = source.path.partition(":")
    if kind == "sample":
        return ParticleRef(SampleSource(), name)
    if Path(source.path).suffix.lower() not in {*mesh_suffixes(), *TABLE_SUFFIXES, *TEXT_SUFFIXES}:
        return None
    return ParticleRef(FileSource((source.path,), source.unit, source.repaired), source.path)
