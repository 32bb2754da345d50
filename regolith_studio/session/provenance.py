"""Where open particles came from, in the terms of a recipe, and how a recipe brings them back."""

import re
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.errors import FileError, InputError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.messages import N_
from regolith_studio.readers.coefficient_tables import TABLE_SUFFIXES, TEXT_SUFFIXES
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.particles import FileProblem, LoadedParticles, find_files, sample_particles
from regolith_studio.session.recipe import Population, Recipe, VolumeEntry

if TYPE_CHECKING:
    from regolith_studio.jobs.model_jobs import GenerationResult, ModelFitResult
    from regolith_studio.session.batch.inputs import BatchInput
    from regolith_studio.session.batch.preprocessing import PreparedInputs
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


MOST = 2000
"""Virtual particles that are opened at most: each becomes a mesh in memory."""


@dataclass(frozen=True)
class RestoredParticles:
    """Particles with what a recipe names them by, one place a particle."""

    loaded: LoadedParticles
    places: tuple[ParticleRef, ...]


def restore_particles(recipe: Recipe, beside: Path) -> Steps:
    """Read, extract and draw what `recipe` names; returns :class:`RestoredParticles`.

    Parameters
    ----------
    beside
        Folder that relative files are looked up in.

    Raises
    ------
    FileError
        If nothing can be read.
    InputError
        If a setting is wrong, or the population is too large to be opened.
    """
    from regolith_studio.jobs.executor import Executor
    from regolith_studio.session.batch.inputs import BatchInputs
    from regolith_studio.session.batch.preprocessing import prepare_inputs

    if recipe.population is not None and recipe.population.n > MOST:
        raise InputError(
            f"{recipe.population.n:,} virtual particles are too many to open; at most {MOST:,}. "
            "Run the recipe as a batch."
        )
    with tempfile.TemporaryDirectory(prefix="regolith-") as scratch:
        prepared: PreparedInputs = yield from prepare_inputs(
            recipe, beside.absolute(), Path(scratch) / "work" / "prepared", Executor(1)
        )
        items = BatchInputs.of(recipe, beside.absolute(), prepared)
        places = _References(recipe, beside.absolute(), prepared)
        return (yield from _read(items.members, list(items.problems), places))


def _read(members: Sequence["BatchInput"], problems: list[FileProblem], places: "_References") -> Steps:
    yield Started(N_("Bringing particles back"), len(members))
    found: list[tuple[Particle, ParticleRef]] = []
    for number, item in enumerate(members, start=1):
        try:
            found.append((item.particle(), places.of(item)))
        except RegolithError as error:
            problems.append(FileProblem(item.name, str(error)))
        yield Progress(number, len(members), item.name)
    if not found:
        raise FileError(problems[0].sentence if problems else "There is no particle in the recipe.")
    particles, known = zip(*found, strict=True)
    return RestoredParticles(LoadedParticles(particles, tuple(problems)), known)


class _References:
    """Tells of each item which particle of which origin it is."""

    def __init__(self, recipe: Recipe, base: Path, prepared: "PreparedInputs") -> None:
        from regolith_studio.session.batch.preprocessing import read_index, resolved

        named = (
            FileSource(tuple(str(base / file) for file in files), unit, repair)
            for files, unit, repair in recipe.openings
        )
        self._files = {key: each for each in named for key, _, _ in each.members()}
        self._volumes = {
            folder: VolumeSource(
                resolved(entry, base), tuple((g["name"], g["name"], g["group"]) for g in read_index(folder))
            )
            for entry, folder in zip(recipe.volumes, prepared.volumes, strict=True)
        }
        self._drawn = _drawn(recipe, prepared)

    def of(self, item: "BatchInput") -> ParticleRef:
        """The place of an item."""
        from regolith_studio.session.batch.inputs import FileInput, GrainInput, SampleInput, VirtualInput

        match item:
            case FileInput(file=file):
                return ParticleRef(self._files[str(file.path)], str(file.path))
            case GrainInput(folder=folder, entry=entry):
                return ParticleRef(self._volumes[folder], str(entry["name"]))
            case VirtualInput(index=index) if self._drawn is not None:
                return ParticleRef(self._drawn, self._drawn.members()[index][0])
            case SampleInput(original=original):
                return ParticleRef(SampleSource(), original)
        raise ValueError(f"{item!r} is no item of a recipe")


def _drawn(recipe: Recipe, prepared: "PreparedInputs") -> VirtualSource | None:
    from regolith_studio.session.batch.inputs import model_of, title_of

    population = recipe.population
    if population is None:
        return None
    told = population.model_copy(
        update={
            "name": title_of(population),
            "seed": recipe.seed if population.seed is None else population.seed,
            "level": recipe.level if population.level is None else population.level,
        }
    )
    if prepared.model is None:
        return VirtualSource(told)
    fitted = told.model_copy(update={"model": "", "settings": {}, "l_max": None})
    return VirtualSource(fitted, model_of(population, prepared.model))
