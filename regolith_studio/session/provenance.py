"""The origin of open particles in the terms of a recipe, and how a recipe restores them."""

import tempfile
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.file_names import unique_name
from regolith_studio.jobs.events import Steps
from regolith_studio.readers.coefficient_tables import TABLE_SUFFIXES, TEXT_SUFFIXES, TableConvention
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.particles import LoadedParticles, find_files, sample_particles
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.session.recipe import Population, Recipe, VolumeEntry

if TYPE_CHECKING:
    from regolith_studio.jobs.model_jobs import GenerationResult, ModelFitResult
    from regolith_studio.session.batch.inputs import BatchInput
    from regolith_studio.session.batch.preprocessing import PreparedInputs
    from regolith_studio.shape_models.protocol import FittedModel


Member = tuple[str, str, str]
"""A particle of an origin: its key there, its name and its group."""


@dataclass(frozen=True)
class SampleSource:
    """The particles that ship with the program."""

    def members(self) -> tuple[Member, ...]:
        """All its particles, in order."""
        return tuple((each.name, each.name, each.group) for each in sample_particles())


@dataclass(frozen=True)
class FileSource:
    """Files and folders that were read together.

    - ``paths``: as they were named, absolute.
    - ``reading``: how meshes were read.
    - ``l_max``: degree above which coefficients of tables were left out.
    - ``convention``: of tables of coefficients: normalisation and phase.
    """

    paths: tuple[str, ...]
    reading: ReadingSettings
    l_max: int | None = None
    convention: TableConvention = "auto"

    def members(self) -> tuple[Member, ...]:
        """All files that are there now, in order; also those that cannot be read."""
        files = find_files([Path(path) for path in self.paths], [])
        return tuple((str(file.path), file.path.stem, file.group) for file in files)


@dataclass(frozen=True, eq=False)
class VolumeSource:
    """Particles of a CT volume.

    ``volume``: the file, and all settings. ``grains``: every grain that became a particle, in order.
    """

    volume: VolumeEntry
    grains: tuple[Member, ...] = field(repr=False)

    @classmethod
    def of(cls, volume: VolumeEntry, particles: Sequence[Particle]) -> "VolumeSource":
        """The origin of all particles of an extraction."""
        return cls(volume, tuple((each.name, each.name, each.group) for each in particles))

    def members(self) -> tuple[Member, ...]:
        """All its particles, in order."""
        return self.grains


@dataclass(frozen=True, eq=False)
class VirtualSource:
    """Virtual particles.

    ``population``: with a name and a seed; its source is a shipped card, or is to be the file of `model`.
    ``model``: model that they were drawn from, if it is not a shipped card.
    """

    population: Population
    model: "FittedModel | None" = field(default=None, repr=False)

    @classmethod
    def of(cls, generated: "GenerationResult", fitted: "ModelFitResult", level: int) -> "VirtualSource":
        """The origin of particles that were drawn from `fitted`, or from what was edited in it.

        ``level``: subdivisions of the icosahedron that their surfaces are drawn on.
        """
        from regolith_studio.shape_models.materials import materials

        name, request = fitted.source.name, generated.request
        shipped = generated.model is fitted.model and fitted.source.content == materials().get(name)
        population = Population(
            sources=[name],
            n=len(generated.draws),
            l_max=generated.model.l_max if shipped else None,
            size_range=None if request.size_range is None else list(request.size_range),
            seed=request.seed,
            level=level,
            name=name,
        )
        return cls(population, None if shipped else generated.model)

    def members(self) -> tuple[Member, ...]:
        """All its particles, in order."""
        from regolith_studio.jobs.model_jobs import drawn_names

        names = drawn_names(self.population.name, self.population.n)
        return tuple((name, name, "") for name in names)


ParticleSource = SampleSource | FileSource | VolumeSource | VirtualSource


@dataclass(frozen=True)
class ParticleRef:
    """Reference to one particle of an origin."""

    origin: ParticleSource
    key: str


def refs_of(particles: Sequence[Particle], origin: ParticleSource) -> tuple[ParticleRef, ...]:
    """References of particles that an origin has just given.

    Files are told apart by their paths, all others by their names before these were made unique.
    """
    if isinstance(origin, FileSource):
        return tuple(ParticleRef(origin, each.source.path if each.source else "") for each in particles)
    return tuple(ParticleRef(origin, each.name) for each in particles)


def ref_by_source(particle: Particle) -> ParticleRef | None:
    """Reference of a particle by its file; ``None`` if it has none that can be read again."""
    source = particle.source
    if source is None:
        return None
    kind, _, name = source.path.partition(":")
    if kind == "sample":
        return ParticleRef(SampleSource(), name)
    if Path(source.path).suffix.lower() not in {*mesh_suffixes(), *TABLE_SUFFIXES, *TEXT_SUFFIXES}:
        return None
    return ParticleRef(FileSource((source.path,), ReadingSettings(source.unit, source.repaired)), source.path)


@dataclass(frozen=True)
class UnreadParticle:
    """A particle that a project or recipe names and that could not be read, as its file is not there.

    - ``id``: its name among those of the project.
    - ``after``: id of the particle that it stands behind; empty for the first.
    """

    id: str
    ref: ParticleRef
    after: str


def unread_members(origin: ParticleSource, loaded: LoadedParticles) -> tuple[UnreadParticle, ...]:
    """The members of an origin that are among the problems of its reading."""
    paths = {problem.path for problem in loaded.problems}
    taken: dict[str, int] = {}
    unread, before = [], ""
    for key, name, group in origin.members() if paths else ():
        unique = unique_name(name, group, taken)
        if key in paths:
            unread.append(UnreadParticle(unique, ParticleRef(origin, key), before))
        else:
            before = unique
    return tuple(unread)


MAX_RESTORED = 2000
"""Maximum number of virtual particles that are opened: each becomes a mesh in memory."""


@dataclass(frozen=True)
class RestoredParticles:
    """Particles of a recipe, each with its reference, and those that could not be read."""

    loaded: LoadedParticles
    refs: tuple[ParticleRef, ...]
    unread: tuple[UnreadParticle, ...] = ()


def restore_particles(recipe: Recipe, base: Path) -> Steps:
    """Read, extract and draw what `recipe` names; returns :class:`RestoredParticles`.

    ``base``: folder that relative files are looked up in.
    """
    from regolith_studio.jobs.executor import Executor
    from regolith_studio.session.batch.inputs import BatchInputs, read_members
    from regolith_studio.session.batch.preprocessing import prepare_inputs

    if recipe.population is not None and recipe.population.n > MAX_RESTORED:
        raise InputError(
            f"{recipe.population.n:,} virtual particles are too many to open; at most {MAX_RESTORED:,}. "
            "Run the recipe as a batch."
        )
    with tempfile.TemporaryDirectory(prefix="regolith-") as scratch:
        prepared: PreparedInputs = yield from prepare_inputs(
            recipe, base.absolute(), Path(scratch) / "work" / "prepared", Executor(1)
        )
        items = BatchInputs.of(recipe, base.absolute(), prepared)
        refs = _References(recipe, base.absolute(), prepared)
        problems = list(items.problems)
        read = yield from read_members(items.members, problems)
    if not read:
        raise FileError(problems[0].sentence if problems else "There is no particle in the recipe.")
    particles = tuple(particle for _, particle in read)
    return RestoredParticles(
        LoadedParticles(particles, tuple(problems)),
        tuple(refs.of(item) for item, _ in read),
        tuple(_unread(items.members, {item.name for item, _ in read}, refs)),
    )


def _unread(
    members: Sequence["BatchInput"], read: Collection[str], refs: "_References"
) -> Iterator[UnreadParticle]:
    before = ""
    for item in members:
        if item.name in read:
            before = item.name
        else:
            yield UnreadParticle(item.name, refs.of(item), before)


class _References:
    """The :class:`ParticleRef` of each input of a recipe."""

    def __init__(self, recipe: Recipe, base: Path, prepared: "PreparedInputs") -> None:
        from regolith_studio.session.batch.preprocessing import read_index, resolved

        named = (
            FileSource(
                tuple(str(base / file) for file in each.files),
                ReadingSettings.of(each),
                each.l_max,
                each.convention,
            )
            for each in recipe.openings
        )
        self._files = {key: each for each in named for key, _, _ in each.members()}
        self._volumes = {
            folder: VolumeSource(
                resolved(entry, base), tuple((g["name"], g["name"], g["group"]) for g in read_index(folder))
            )
            for entry, folder in zip(recipe.volumes, prepared.volumes, strict=True)
        }
        self._virtual = _virtual_source(recipe, prepared)

    def of(self, item: "BatchInput") -> ParticleRef:
        """The reference of an input."""
        from regolith_studio.session.batch.inputs import FileInput, GrainInput, SampleInput, VirtualInput

        match item:
            case FileInput(file=file):
                return ParticleRef(self._files[str(file.path)], str(file.path))
            case GrainInput(folder=folder, entry=entry):
                return ParticleRef(self._volumes[folder], str(entry["name"]))
            case VirtualInput(index=index) if self._virtual is not None:
                return ParticleRef(self._virtual, self._virtual.members()[index][0])
            case SampleInput(original=original):
                return ParticleRef(SampleSource(), original)
        raise ValueError(f"{item!r} is no item of a recipe")


def _virtual_source(recipe: Recipe, prepared: "PreparedInputs") -> VirtualSource | None:
    from regolith_studio.session.batch.inputs import model_of, title_of

    population = recipe.population
    if population is None:
        return None
    named = population.model_copy(
        update={
            "name": title_of(population),
            "seed": recipe.seed if population.seed is None else population.seed,
            "level": recipe.level if population.level is None else population.level,
        }
    )
    if prepared.model is None:
        return VirtualSource(named)
    fitted = named.model_copy(update={"model": "", "settings": {}, "l_max": None})
    return VirtualSource(fitted, model_of(population, prepared.model))
