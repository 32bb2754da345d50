"""The particles of a recipe before they are read: small, picklable, in a fixed order."""

import tempfile
from collections import Counter
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol, Self

from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.synthesis import level_for
from regolith_studio.io.file_names import name_key, unique_name
from regolith_studio.jobs.events import Progress, Started, Step, Steps
from regolith_studio.jobs.executor import open_executor
from regolith_studio.jobs.model_jobs import PAPER_DEGREE, drawn_group, drawn_names, groups_of
from regolith_studio.jobs.scan_jobs import scratch_folder
from regolith_studio.messages import N_
from regolith_studio.readers.coefficient_tables import TableReading
from regolith_studio.readers.particles import (
    FileProblem,
    MeshFile,
    collect_particles,
    find_files,
    read_file,
    sample_particles,
)
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.readers.shape_files import read_shape_source
from regolith_studio.resources import SAMPLE
from regolith_studio.session.batch.preprocessing import (
    MODEL,
    PreparedInputs,
    prepare_inputs,
    read_grain,
    read_index,
)
from regolith_studio.session.recipe import NamedParticle, Population, Recipe
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.realizations import Realizations, virtual_mesh

NO_PREPARED_INPUTS = PreparedInputs()


class BatchInput(Protocol):
    """One particle that a recipe asks for."""

    @property
    def name(self) -> str:
        """Unique within the batch."""

    @property
    def fingerprint(self) -> str:
        """Changes when the input changes."""

    def particle(self) -> Particle:
        """Read or draw it."""

    def called(self, name: str) -> "BatchInput":
        """The same particle under another name."""


@dataclass(frozen=True)
class _NamedInput:
    """Fields of all inputs.

    ``name``: unique within the batch.
    """

    name: str

    def called(self, name: str) -> Self:
        """The same particle under another name."""
        return replace(self, name=name)


@dataclass(frozen=True)
class FileInput(_NamedInput):
    """A mesh file."""

    file: MeshFile
    reading: ReadingSettings

    @property
    def fingerprint(self) -> str:
        """Path, size and time of the file, or place and check sum in an archive; how its table is read."""
        member = self.file.member
        if member is not None:
            return f"{self.file.path} {member.chain[-1]}"
        try:
            state = self.file.path.stat()
        except (OSError, ValueError):  # no such file, or no name of one
            return f"{self.file.path} missing"
        return f"{self.file.path} {state.st_size} {state.st_mtime_ns} {self.file.tables}"

    def particle(self) -> Particle:
        """The particle in the file."""
        return replace(read_file(self.file, self.reading), name=self.name)


@dataclass(frozen=True)
class SampleInput(_NamedInput):
    """A particle that ships with the program."""

    original: str

    @property
    def fingerprint(self) -> str:
        """Its name."""
        return f"sample:{self.original}"

    def particle(self) -> Particle:
        """The particle."""
        shipped = next(each for each in sample_particles() if each.name == self.original)
        return replace(shipped, name=self.name)


@dataclass(frozen=True)
class GrainInput(_NamedInput):
    """A grain of a CT volume that has been extracted."""

    folder: Path
    entry: Mapping[str, Any]

    @property
    def fingerprint(self) -> str:
        """The folder, which is named by all that its grains depend on, and the grain."""
        return f"{self.folder.name} {self.entry['file']}"

    def particle(self) -> Particle:
        """The grain."""
        return replace(read_grain(self.folder, self.entry), name=self.name)


@dataclass(frozen=True)
class VirtualInput(_NamedInput):
    """A virtual particle.

    ``model``: folder of the fitted model; ``None`` where a shipped card is one.
    """

    population: Population
    seed: int
    index: int
    level: int
    model: Path | None = None

    @property
    def fingerprint(self) -> str:
        """Model, settings, seed and index."""
        fitted = self.model.name if self.model else ""
        return f"{self.population.model_dump_json()} {fitted} {self.seed} {self.index} {self.level}"

    def particle(self) -> Particle:
        """The particle's surface."""
        draws, parts = _cached_draws(self.population.model_dump_json(), self.model, self.seed)
        group = drawn_group(parts[self.index], title_of(self.population))
        return Particle(self.name, virtual_mesh(draws, self.index, self.level), group)


@dataclass(frozen=True)
class BatchInputs:
    """All particles of a recipe.

    ``problems``: inputs that hold none.
    """

    members: tuple[BatchInput, ...]
    problems: tuple[FileProblem, ...] = ()

    @classmethod
    def of(cls, recipe: Recipe, base: Path, prepared: PreparedInputs = NO_PREPARED_INPUTS) -> Self:
        """The particles of `recipe`; relative paths are relative to `base`."""
        problems: list[FileProblem] = list(prepared.problems)
        members: list[BatchInput] = []
        taken: dict[str, int] = {}
        if SAMPLE in recipe.inputs:
            for particle in sample_particles():
                members.append(SampleInput(unique_name(particle.name, particle.group, taken), particle.name))
        for each in recipe.openings:
            tables, reading = TableReading(each.l_max, each.convention), ReadingSettings.of(each)
            for file in find_files([base / name for name in each.files], problems, tables):
                name = unique_name(file.path.stem, file.group, taken)
                members.append(FileInput(name, file, reading))
        for folder in prepared.volumes:
            for entry in read_index(folder):
                members.append(GrainInput(unique_name(entry["name"], entry["group"], taken), folder, entry))
        if recipe.population is not None:
            members += _virtual_inputs(recipe, recipe.population, prepared.model, taken)
        if recipe.particles is not None:
            members = _select(members, recipe.particles)
        return cls(tuple(members), tuple(problems))

    @property
    def largest_group(self) -> int:
        """Members of the largest group of files; other inputs count as one group."""
        groups = Counter(each.file.group if isinstance(each, FileInput) else "" for each in self.members)
        return max(groups.values(), default=0)


def title_of(population: Population) -> str:
    """What its particles are called: by its name, or the card's or the first source's."""
    if population.name:
        return population.name
    (first, *_) = population.sources
    return first if first in materials() else Path(first).stem or "virtual"


def _virtual_inputs(
    recipe: Recipe, population: Population, model: Path | None, taken: dict[str, int]
) -> list[BatchInput]:
    fitted = model_of(population, model)
    seed = recipe.seed if population.seed is None else population.seed
    level = population.level
    if level is None:
        level = recipe.level if fitted.l_max <= PAPER_DEGREE else max(recipe.level, level_for(fitted.l_max))
    return [
        VirtualInput(unique_name(name, "", taken), population, seed, index, level, model)
        for index, name in enumerate(drawn_names(title_of(population), population.n))
    ]


def _select(members: Sequence[BatchInput], selection: Sequence[str | NamedParticle]) -> list[BatchInput]:
    by_name = {member.name: member for member in members}
    pairs = [(each, each) if isinstance(each, str) else (each.name, each.called) for each in selection]
    if missing := next((name for name, _ in pairs if name not in by_name), None):
        raise InputError(f"The recipe asks for a particle {missing!r}, which its inputs do not hold.")
    ((key, count),) = Counter(name_key(new) for _, new in pairs).most_common(1)
    if count > 1:
        name = next(new for _, new in pairs if name_key(new) == key)
        raise InputError(f"The recipe asks for {count} particles of the name {name!r}.")
    taken: dict[str, int] = {}
    return [by_name[name].called(unique_name(new, "", taken)) for name, new in pairs]


def model_of(population: Population, folder: Path | None) -> FittedModel:
    """The model that particles are drawn from."""
    if folder is None:
        return materials()[population.sources[0]].model(population.l_max or None)
    fitted: FittedModel = read_shape_source(str(folder / MODEL)).content  # type: ignore[assignment]
    return fitted


@lru_cache(maxsize=1)
def _cached_draws(population: str, folder: Path | None, seed: int) -> tuple[Realizations, tuple[str, ...]]:
    """All draws of a population, as JSON, and their groups: a kilobyte each, made once in each process."""
    selection = Population.model_validate_json(population)
    model = model_of(selection, folder)
    draws = model.draw(selection.n, seed, selection.bounds)
    return draws, groups_of(draws, model)


def read_members(
    members: Sequence[BatchInput], problems: list[FileProblem]
) -> Generator[Step, None, list[tuple[BatchInput, Particle]]]:
    """The inputs that can be read, with their particles; the others are added to `problems`."""
    yield Started(N_("Reading particles"), len(members))
    read: list[tuple[BatchInput, Particle]] = []
    for number, item in enumerate(members, start=1):
        try:
            read.append((item, item.particle()))
        except RegolithError as error:
            problems.append(FileProblem(item.name, str(error)))
        yield Progress(number, len(members), item.name)
    return read


def load_recipe_particles(recipe: Recipe, base: Path, workers: int = 1) -> Steps:
    """Read or make all particles of a recipe; returns :class:`LoadedParticles`.

    ``base``: folder that relative inputs are relative to.
    """
    with tempfile.TemporaryDirectory(dir=scratch_folder()) as folder, open_executor(workers) as executor:
        prepared = yield from prepare_inputs(recipe, base, Path(folder) / "prepared", executor)
        inputs = BatchInputs.of(recipe, base, prepared)
        problems = list(inputs.problems)
        read = yield from read_members(inputs.members, problems)
        return collect_particles([particle for _, particle in read], problems)
