"""The particles of a recipe before anybody has read them: small, picklable, in a fixed order."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Protocol, Self

from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.loading import Problem, files_in, free_name
from regolith_studio.model.draws import Draws, virtual_mesh
from regolith_studio.model.materials import materials
from regolith_studio.readers.registry import MeshFile, read_file
from regolith_studio.readers.sample import sample_particles
from regolith_studio.session.recipe import SAMPLE, Population, Recipe


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
class DrawnItem:
    """A virtual particle."""

    name: str
    population: Population
    seed: int
    index: int
    level: int

    @property
    def mark(self) -> str:
        """What it is drawn from, and its number."""
        return f"{self.population.model_dump_json()} {self.seed} {self.index} {self.level}"

    def particle(self) -> Particle:
        """The particle's surface."""
        draws = _draws(self.population, self.seed)
        return Particle(self.name, virtual_mesh(draws, self.index, self.level), self.population.card)


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
    def of(cls, recipe: Recipe, base: Path) -> Self:
        """What the inputs of `recipe` stand for; relative ones are looked up in `base`.

        Raises
        ------
        InputError
            If there is no such material card, or it does not reach the degree asked for.
        """
        problems: list[Problem] = []
        members: list[Item] = []
        taken: set[str] = set()
        if SAMPLE in recipe.inputs:
            for particle in sample_particles():
                members.append(SampleItem(free_name(particle.name, particle.group, taken), particle.name))
        files = [base / name for name in recipe.inputs if name != SAMPLE]
        for file in files_in(files, problems):
            members.append(FileItem(free_name(file.path.stem, file.group, taken), file, recipe.unit))
        if recipe.population is not None:
            members += _drawn(recipe, recipe.population, taken)
        return cls(tuple(members), tuple(problems))

    def marks(self) -> Iterable[str]:
        """Of all members."""
        return (member.mark for member in self.members)


def _drawn(recipe: Recipe, population: Population, taken: set[str]) -> Sequence[Item]:
    if population.card not in materials():
        raise InputError(
            f"There is no material card {population.card!r}; there are {', '.join(sorted(materials()))}."
        )
    materials()[population.card].model(population.l_max)
    digits = max(4, len(str(population.n - 1)))
    names = (f"{population.card}-{index:0{digits}d}" for index in range(population.n))
    return [
        DrawnItem(free_name(name, "", taken), population, recipe.seed, index, recipe.level)
        for index, name in enumerate(names)
    ]


@lru_cache(maxsize=1)
def _draws(population: Population, seed: int) -> Draws:
    """All draws of a population: a kilobyte each, made once in each process."""
    return materials()[population.card].model(population.l_max).draw(population.n, seed)
