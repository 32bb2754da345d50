"""A project file: what was open, what was chosen, and how the window stood; it reopens to the same state."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from regolith_studio.errors import FileError, format_validation_error
from regolith_studio.io.atomic import write_bytes
from regolith_studio.readers.file_bytes import read_bytes
from regolith_studio.session.recipe import LARGEST, SAMPLE, Recipe
from regolith_studio.session.session import Session
from regolith_studio.session.session_recipe import SessionRecipe
from regolith_studio.shape_models.protocol import FittedModel

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
