"""A recipe: everything that turns files into results, as JSON; the window saves it, ``run`` takes it."""

from pathlib import Path
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from regolith_studio.coarsening.coarsen import DEFAULT_METHOD, DEFAULT_PRESET
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import FileError, InputError
from regolith_studio.harmonics.expansion import USUAL
from regolith_studio.session.choices import L_MAX_LIMIT, Choices, Scalar

FORMAT: Literal["regolith-studio recipe"] = "regolith-studio recipe"
VERSION: Literal[1] = 1
SAMPLE = "sample:all"
"""Stands among the inputs for the particles that ship with the program."""


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class Outputs(_Strict):
    """What is written below the output folder."""

    descriptors: bool = True
    fits: bool = False
    meshes: bool = True
    dataset: bool = True
    lmax_study: bool = False
    coarsening_study: bool = False
    summary: bool = True


class Population(_Strict):
    """Virtual particles among the inputs.

    Parameters
    ----------
    card
        Name of a shipped material card.
    n
        Particles to draw, with the seed of the recipe.
    l_max
        Degree of their surfaces.
    """

    card: str
    n: int = Field(ge=1, le=1_000_000)
    l_max: int = Field(default=10, ge=1, le=L_MAX_LIMIT)


class Recipe(_Strict):
    """Inputs, choices and outputs; relative inputs are looked up beside the recipe file.

    Parameters
    ----------
    inputs
        Files and folders of meshes, or ``sample:all``; may be empty where there is a population.
    population
        Virtual particles, besides the inputs.
    """

    format: Literal["regolith-studio recipe"] = FORMAT
    version: Literal[1] = VERSION
    inputs: list[str] = Field(default_factory=lambda: [SAMPLE])
    population: Population | None = None
    unit: str = "um"
    star_point: str = USUAL.star_point
    rule: str = USUAL.rule
    reference: str = USUAL.reference
    l_max: int = 10
    level: int = 4
    target: str = "fit"
    method: str = DEFAULT_METHOD
    settings: dict[str, Scalar] = Field(default_factory=dict)
    preset: str = DEFAULT_PRESET
    weights: dict[str, float] | None = None
    n_faces: int = 20
    seed: int = 0
    box_metric: str = "exact"
    outputs: Outputs = Field(default_factory=Outputs)

    @model_validator(mode="after")
    def _has_particles(self) -> Self:
        if not self.inputs and self.population is None:
            raise ValueError("inputs must name a file or folder, or there must be a population")
        return self

    @classmethod
    def from_choices(cls, choices: Choices, inputs: list[str], outputs: Outputs | None = None) -> Self:
        """The recipe that repeats what has been chosen."""
        return cls(
            inputs=inputs,
            unit=choices.unit,
            star_point=choices.star_point,
            rule=choices.rule,
            reference=choices.reference,
            l_max=choices.l_max,
            level=choices.level,
            target=choices.target,
            method=choices.method,
            settings=dict(choices.settings),
            preset=choices.preset,
            weights=dict(choices.weights) if choices.preset_modified else None,
            n_faces=choices.n_faces,
            seed=choices.seed,
            box_metric=choices.box_metric,
            outputs=outputs or Outputs(),
        )

    def choices(self) -> Choices:
        """The choices that it holds.

        Raises
        ------
        InputError
            If a value is out of its range.
        """
        names = (
            *("unit", "star_point", "rule", "reference", "l_max", "level", "target"),
            *("method", "preset", "n_faces", "seed", "box_metric"),
        )
        changes: dict[str, Any] = {name: getattr(self, name) for name in names}
        changes["settings"] = tuple(self.settings.items())
        if self.weights is not None:
            changes["weights"] = LossWeights.of(**self.weights)
        return Choices().replaced(**changes)

    def to_json(self) -> str:
        """As indented JSON, ending in a newline."""
        return self.model_dump_json(indent=2) + "\n"


def read_recipe(path: Path) -> Recipe:
    """Read a recipe file.

    Raises
    ------
    FileError
        If it cannot be read or is no recipe; the sentence names the first entry that is wrong.
    """
    try:
        return Recipe.model_validate_json(path.read_bytes())
    except OSError as error:
        raise FileError(f"The recipe {path} cannot be read ({error.strerror}).") from error
    except ValidationError as error:
        raise FileError(f"{path} is not a recipe of this program: {_first_problem(error)}.") from error


def recipe_of(**entries: Any) -> Recipe:
    """A recipe from Python values.

    Raises
    ------
    InputError
        If an entry is wrong.
    """
    try:
        return Recipe(**entries)
    except ValidationError as error:
        raise InputError(f"This is not a recipe: {_first_problem(error)}.") from error


def _first_problem(error: ValidationError) -> str:
    first = error.errors(include_url=False)[0]
    where = ".".join(str(part) for part in first["loc"]) or "the file"
    said = first["msg"].removeprefix("Value error, ")
    return f"{where}: {said[:1].lower()}{said[1:]}"
