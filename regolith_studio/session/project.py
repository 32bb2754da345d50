"""A session on disk: the recipe that repeats it, and the project file that reopens it."""

import dataclasses
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from regolith_studio.errors import FileError, format_validation_error
from regolith_studio.io.atomic import write_bytes
from regolith_studio.readers.file_bytes import read_bytes
from regolith_studio.readers.particles import unique_name
from regolith_studio.session.choices import Choices
from regolith_studio.session.provenance import (
    FileSource,
    ParticleRef,
    ParticleSource,
    SampleSource,
    VirtualSource,
    VolumeSource,
)
from regolith_studio.session.recipe import (
    LARGEST,
    SAMPLE,
    DatasetRequest,
    FilesEntry,
    NamedParticle,
    Outputs,
    Recipe,
)
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.session import Session
from regolith_studio.shape_models.io import write_model
from regolith_studio.shape_models.protocol import FittedModel


@dataclass(frozen=True)
class SessionRecipe:
    """A recipe, and what it cannot hold by itself.

    Parameters
    ----------
    recipe
        Of all particles that have an origin; with models beside it, it must be written by :meth:`beside`.
    model
        What its population is drawn from, if no shipped card is.
    lost
        Ids of the particles that it cannot bring back.
    """

    recipe: Recipe
    model: FittedModel | None = field(default=None, repr=False)
    lost: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        entries: Sequence[ParticleEntry],
        choices: Choices,
        outputs: Outputs | None = None,
        standing: DatasetRequest | None = None,
    ) -> "SessionRecipe":
        """Of particles and choices, and of the wish for a dataset; without any particle, of the sample."""
        wish = standing if standing and (outputs is None or outputs.dataset) else DatasetRequest()
        placed = [(entry.id, entry.place) for entry in entries]
        origins = _in_order([place.origin for _, place in placed if place is not None])
        named = dict(_names(origins))
        pairs = [(named.get(place), name) for name, place in placed]
        files = [each for each in origins if isinstance(each, FileSource)]
        drawn = next((each for each in origins if isinstance(each, VirtualSource)), None)
        first = files[0] if files else None
        recipe = Recipe.from_choices(
            choices,
            _inputs(origins),
            outputs,
            unit=first.unit if first else choices.unit,
            repair=first.repair if first else choices.repair,
            volumes=[each.volume for each in origins if isinstance(each, VolumeSource)],
            population=drawn.population if drawn else None,
            particles=_selection(pairs, list(named.values())),
            representatives=wish.representatives,
            exports=wish.exports,
        )
        lost = tuple(name for known, name in pairs if known is None)
        return cls(recipe, drawn.model if drawn else None, lost)

    def beside(self, path: Path, whole_path: bool = False) -> Recipe:
        """The recipe as it can be written to `path`; a model is written beside it.

        Parameters
        ----------
        whole_path
            Name the model by its whole path: the recipe will lie elsewhere.

        Raises
        ------
        FileError
            If the model cannot be written.
        """
        population = self.recipe.population
        if self.model is None or population is None:
            return self.recipe
        model = path.with_name(f"{path.stem}-model.json")
        write_model(model, self.model, {"source": population.name, "notes": []})
        told = population.model_copy(update={"sources": [str(model) if whole_path else model.name]})
        return self.recipe.model_copy(update={"population": told})


def _in_order(origins: Sequence[ParticleSource]) -> list[ParticleSource]:
    """As a recipe takes them: the sample, files, volumes, one population."""
    kinds = (SampleSource, FileSource, VolumeSource, VirtualSource)
    found = [each for kind in kinds for each in dict.fromkeys(o for o in origins if isinstance(o, kind))]
    populations = [each for each in found if isinstance(each, VirtualSource)]
    return [each for each in found if each not in populations[1:]]


def _inputs(origins: Sequence[ParticleSource]) -> list[str | FilesEntry]:
    files = [each for each in origins if isinstance(each, FileSource)]
    named: list[str | FilesEntry] = [SAMPLE] if not origins or SampleSource() in origins else []
    for number, each in enumerate(files):
        entry = FilesEntry(files=list(each.paths), unit=each.unit, repair=each.repair)
        named += [entry] if number else each.paths
    return named


def _selection(
    pairs: Sequence[tuple[str | None, str]], all_names: Sequence[str]
) -> list[str | NamedParticle] | None:
    """Names of the particles among all that a run finds; ``None`` where it is all of them in their order."""
    found = [(known, name) for known, name in pairs if known is not None]
    if not found or found == [(name, name) for name in all_names]:
        return None
    return [known if known == name else NamedParticle(name=known, called=name) for known, name in found]


def _names(origins: Sequence[ParticleSource]) -> Iterator[tuple[ParticleRef | None, str]]:
    """The name that each particle of the origins gets in a run."""
    taken: set[str] = set()
    for origin in origins:
        for key, name, group in origin.members():
            yield ParticleRef(origin, key), unique_name(name, group, taken)


FORMAT: Literal["regolith-studio project"] = "regolith-studio project"
SUFFIX = ".regolith"
"""Of project files."""


class Project(BaseModel):
    """The recipe that repeats the work, and what a sitting adds to it.

    Parameters
    ----------
    recipe
        Inputs and choices, as ``regolith-studio run`` takes them.
    selected
        Id of the particle on screen.
    page
        Key of the page that was seen.
    pages
        What each page keeps, by its key.
    """

    model_config = ConfigDict(extra="ignore", frozen=True)

    format: Literal["regolith-studio project"] = FORMAT
    version: Literal[1] = 1
    recipe: Recipe = Field(default_factory=Recipe)
    selected: str = ""
    page: str = ""
    pages: dict[str, dict[str, Any]] = Field(default_factory=dict)

    @classmethod
    def of(cls, session: Session, page: str = "", pages: dict[str, dict[str, Any]] | None = None) -> Self:
        """The present state of a session."""
        recipe = SessionRecipe.of(session.particles, session.choices).recipe
        return cls(recipe=recipe, selected=session.choices.selected, page=page, pages=pages or {})

    def save(self, path: Path, model: FittedModel | None = None) -> None:
        """Write it in one step.

        Parameters
        ----------
        model
            What the virtual particles were drawn from; it is written beside.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        recipe = SessionRecipe(self.recipe, model).beside(path)
        whole = self.model_copy(update={"recipe": recipe})
        write_bytes(path, whole.model_dump_json(indent=2).encode("utf-8") + b"\n")

    def open_in(self, session: Session, beside: Path) -> int:
        """Choose what was chosen and read what was open; returns the task's id.

        Parameters
        ----------
        beside
            Folder that relative inputs are looked up in.
        """
        chosen = self.recipe.choices()
        names = {each.name for each in dataclasses.fields(chosen)} - {"selected"}
        session.choose(**{name: getattr(chosen, name) for name in names})
        return session.open_recipe(self.recipe, beside)


def read_project(path: Path) -> Project:
    """Read a project file.

    Raises
    ------
    FileError
        If it cannot be read or is none.
    """
    try:
        return Project.model_validate_json(read_bytes(path, LARGEST))
    except ValidationError as error:
        reason = format_validation_error(error.errors(include_url=False))
        raise FileError(f"{path} is not a project of this program: {reason}.") from error


def inputs_of(session: Session) -> list[str]:
    """The files that the open particles came from, the sample by its name; the sample if there are none."""
    sources = [entry.particle.source for entry in session.particles]
    paths = [source.path for source in sources if source]
    return list(dict.fromkeys(SAMPLE if path.startswith("sample:") else path for path in paths)) or [SAMPLE]


def input_shown(session: Session) -> str:
    """Where the particle on screen came from; the sample if it came from no file."""
    source = session.selected.particle.source if session.selected else None
    return source.path if source else SAMPLE


def without_file(session: Session) -> Sequence[str]:
    """Ids of open particles that neither a recipe nor a project can bring back."""
    return list(SessionRecipe.of(session.particles, session.choices).lost)
