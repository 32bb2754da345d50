"""A recipe: everything that turns files into results, as JSON; the window saves it, ``run`` takes it."""

from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from regolith_studio.coarsening.coarsen import DEFAULT_METHOD, DEFAULT_PRESET
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import FileError, InputError
from regolith_studio.harmonics.expansion import USUAL
from regolith_studio.session.choices import L_MAX_LIMIT, Choices, Scalar

FORMAT: Literal["regolith-studio recipe"] = "regolith-studio recipe"
VERSION: Literal[2] = 2
"""Version 1 knew material cards as the only population and no volumes; it is still read."""
SAMPLE = "sample:all"
"""Stands among the inputs for the particles that ship with the program."""


Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Edges = Annotated[list[float], Field(min_length=3, max_length=3)]


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
    sources
        What they are drawn like: the name of a shipped material card; the file of a card, a fit or a fitted
        model; or meshes and tables of coefficients, files and folders, that are measured for it. Relative
        files are looked up beside the recipe.
    model, settings
        Key of the model of shapes that is fitted to a fit or to meshes, and its settings; the default
        model where left out.
    n
        Particles to draw, with the seed of the recipe.
    l_max
        Degree of their surfaces; that of the source and at most 10 where left out.
    size_range
        Smallest and largest equivalent radius in micrometres.
    """

    sources: list[str] = Field(min_length=1)
    model: str = ""
    settings: dict[str, Scalar] = Field(default_factory=dict)
    n: int = Field(ge=1, le=1_000_000)
    l_max: int | None = Field(default=None, ge=1, le=L_MAX_LIMIT)
    size_range: Pair | None = None

    @property
    def bounds(self) -> tuple[float, float] | None:
        """The size range as a pair."""
        return None if self.size_range is None else (self.size_range[0], self.size_range[1])

    @model_validator(mode="before")
    @classmethod
    def _from_card(cls, entry: Any) -> Any:
        """Version 1 knew cards only."""
        if not isinstance(entry, dict) or "card" not in entry or "sources" in entry:
            return entry
        return {**{key: value for key, value in entry.items() if key != "card"}, "sources": [entry["card"]]}


class RawVolume(_Strict):
    """What a raw file does not say about itself: voxels along x, y, z, their type, where they begin."""

    shape: Annotated[list[int], Field(min_length=3, max_length=3)]
    dtype: str = "uint8"
    byte_order: str = "little"
    offset: int = 0


class VolumeEntry(_Strict):
    """A CT volume whose grains are among the inputs.

    Parameters
    ----------
    file
        File, or folder of slices; relative to the recipe.
    voxel_size, unit, kind, dataset, axes, raw
        As ``regolith-studio extract`` takes them; by default what the file says.
    recipe
        An ``extraction.json`` with all settings, as ``extract`` and the window write it.
    segmentation, extraction
        The settings themselves, in place of such a file.
    """

    file: str
    voxel_size: float | Edges | None = None
    unit: str | None = None
    kind: Literal["labels", "grey"] | None = None
    dataset: str | None = None
    axes: str | None = None
    raw: RawVolume | None = None
    recipe: str | None = None
    segmentation: dict[str, Any] = Field(default_factory=dict)
    extraction: dict[str, Any] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if self.recipe is not None and (self.segmentation or self.extraction):
            raise ValueError("give settings or the recipe that holds them, not both")
        return self


class Recipe(_Strict):
    """Inputs, choices and outputs; relative inputs are looked up beside the recipe file.

    Parameters
    ----------
    inputs
        Files and folders of meshes and tables of coefficients, or ``sample:all``; by default the sample,
        or nothing where there are volumes or a population.
    volumes
        CT volumes whose grains are particles too.
    population
        Virtual particles, besides those.
    """

    format: Literal["regolith-studio recipe"] = FORMAT
    version: Literal[2] = VERSION
    inputs: list[str] = Field(default_factory=lambda: [SAMPLE])
    volumes: list[VolumeEntry] = Field(default_factory=list)
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

    @model_validator(mode="before")
    @classmethod
    def _upgraded(cls, document: Any) -> Any:
        """Version 1 as version 2; without inputs, what else there is is all."""
        if not isinstance(document, dict):
            return document
        if document.get("version") == 1:
            return {**document, "version": VERSION}
        others = document.get("volumes") or document.get("population")
        return {"inputs": [], **document} if others else document

    @model_validator(mode="after")
    def _has_particles(self) -> Self:
        if not self.inputs and not self.volumes and self.population is None:
            raise ValueError("inputs must name a file or folder, or there must be volumes or a population")
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


def recipe_schema() -> dict[str, Any]:
    """JSON Schema of recipes of this version, as it ships in ``resources/schema``."""
    title = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Regolith Studio recipe"}
    return title | {
        key: value for key, value in Recipe.model_json_schema().items() if key not in ("title", "$schema")
    }


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
