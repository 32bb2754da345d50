"""The particles of a recipe before anybody has read them: small, picklable, in a fixed order."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol, Self

from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.generating import PAPER_DEGREE, groups_of
from regolith_studio.jobs.loading import Problem, files_in, free_name
from regolith_studio.model.draws import Draws, virtual_mesh
from regolith_studio.model.materials import materials
from regolith_studio.model.protocol import FittedModel
from regolith_studio.readers.registry import MeshFile, read_file
from regolith_studio.readers.sample import sample_particles
from regolith_studio.readers.shape_files import read_shape_source
from regolith_studio.session.batch.prepared import MODEL, Prepared, read_grain, read_index
from regolith_studio.session.recipe import SAMPLE, Population, Recipe

NOTHING = Prepared()


class Item(Protocol):
    """One particle that a recipe asks for."""

    @property
    def name(self) -> str:
        """Unique within the batch."""

    @property
    def mark(self) -> str:
        """Changes when the input changes."""

    def particle(self) -> Particle:
        """Read or draw it.

        Raises
        ------
        RegolithError
            If that is impossible.
        """


@dataclass(frozen=True)
class FileItem:
    """A mesh file."""

    name: str
    file: MeshFile
    unit: str

    @property
    def mark(self) -> str:
        """Path, size and time of the file."""
        try:
            state = self.file.path.stat()
        except OSError:
            return f"{self.file.path} missing"
        return f"{self.file.path} {state.st_size} {state.st_mtime_ns}"

    def particle(self) -> Particle:
        """The particle in the file."""
        return replace(read_file(self.file, self.unit), name=self.name)


@dataclass(frozen=True)
class SampleItem:
    """A particle that ships with the program."""

    name: str
    original: str

    @property
    def mark(self) -> str:
        """Its name."""
        return f"sample:{self.original}"

    def particle(self) -> Particle:
        """The particle."""
        found = next(each for each in sample_particles() if each.name == self.original)
        return replace(found, name=self.name)


@dataclass(frozen=True)
class GrainItem:
    """A grain of a CT volume that has been extracted."""

    name: str
    folder: Path
    entry: Mapping[str, Any]

    @property
    def mark(self) -> str:
        """The folder, which is named by all that its grains depend on, and the grain."""
        return f"{self.folder.name} {self.entry['file']}"

    def particle(self) -> Particle:
        """The grain."""
        return replace(read_grain(self.folder, self.entry), name=self.name)


@dataclass(frozen=True)
class DrawnItem:
    """A virtual particle.

    Parameters
    ----------
    model
        Folder of the fitted model; ``None`` where a shipped card is one.
    """

    name: str
    population: Population
    seed: int
    index: int
    level: int
    model: Path | None = None

    @property
    def mark(self) -> str:
        """What it is drawn from, and its number."""
        known = self.model.name if self.model else ""
        return f"{self.population.model_dump_json()} {known} {self.seed} {self.index} {self.level}"

    def particle(self) -> Particle:
        """The particle's surface."""
        draws, groups = _draws(self.population, self.model, self.seed)
        group = groups[self.index] or title_of(self.population)
        return Particle(self.name, virtual_mesh(draws, self.index, self.level), group)


@dataclass(frozen=True)
class Items:
    """All particles of a recipe.

    Parameters
    ----------
    problems
        Inputs that hold none.
    """

    members: tuple[Item, ...]
    problems: tuple[Problem, ...] = ()

    @classmethod
    def of(cls, recipe: Recipe, base: Path, prepared: Prepared = NOTHING) -> Self:
        """What the inputs of `recipe` stand for; relative ones are looked up in `base`.

        Raises
        ------
        InputError
            If the material card does not reach the degree asked for.
        """
        problems: list[Problem] = list(prepared.problems)
        members: list[Item] = []
        taken: set[str] = set()
        if SAMPLE in recipe.inputs:
            for particle in sample_particles():
                members.append(SampleItem(free_name(particle.name, particle.group, taken), particle.name))
        files = [base / name for name in recipe.inputs if name != SAMPLE]
        for file in files_in(files, problems):
            members.append(FileItem(free_name(file.path.stem, file.group, taken), file, recipe.unit))
        for folder in prepared.volumes:
            for entry in read_index(folder):
                members.append(GrainItem(free_name(entry["name"], entry["group"], taken), folder, entry))
        if recipe.population is not None:
            members += _drawn(recipe, recipe.population, prepared.model, taken)
        return cls(tuple(members), tuple(problems))

    def marks(self) -> Iterable[str]:
        """Of all members."""
        return (member.mark for member in self.members)


def title_of(population: Population) -> str:
    """What its particles are called: the card, or the first source."""
    (first, *_) = population.sources
    return first if first in materials() else Path(first).stem or "virtual"


def _drawn(recipe: Recipe, population: Population, model: Path | None, taken: set[str]) -> Sequence[Item]:
    if model is None:
        _model(population, None)
    digits = max(4, len(str(population.n - 1)))
    names = (f"{title_of(population)}-{index:0{digits}d}" for index in range(population.n))
    return [
        DrawnItem(free_name(name, "", taken), population, recipe.seed, index, recipe.level, model)
        for index, name in enumerate(names)
    ]


def _model(population: Population, folder: Path | None) -> FittedModel:
    """The model that particles are drawn from."""
    if folder is None:
        card = materials()[population.sources[0]]
        return card.model(population.l_max or min(PAPER_DEGREE, card.l_max))
    fitted: FittedModel = read_shape_source(str(folder / MODEL)).content  # type: ignore[assignment]
    return fitted


def _draws(population: Population, folder: Path | None, seed: int) -> tuple[Draws, tuple[str, ...]]:
    """All draws of a population and their groups: a kilobyte each, made once in each process."""
    return _remembered_draws(population.model_dump_json(), folder, seed)


@lru_cache(maxsize=1)
def _remembered_draws(population: str, folder: Path | None, seed: int) -> tuple[Draws, tuple[str, ...]]:
    wish = Population.model_validate_json(population)
    model = _model(wish, folder)
    draws = model.draw(wish.n, seed, wish.bounds)
    return draws, groups_of(draws, model)
