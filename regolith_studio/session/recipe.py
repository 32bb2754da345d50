"""A recipe: everything that turns files into results, as JSON; the window saves it, ``run`` takes it."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, ValidationError, model_validator

from regolith_studio.coarsening.coarsen import DEFAULT_METHOD, DEFAULT_PRESET
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import FileError, InputError, of_the_entry
from regolith_studio.harmonics.fit import DEFAULT_FIT_OPTIONS
from regolith_studio.readers.file_bytes import read_bytes
from regolith_studio.session.choices import Choices, Scalar
from regolith_studio.session.recipe_dataset import Exports, Representatives
from regolith_studio.session.recipe_inputs import Chosen, FilesEntry, Population, Strict, VolumeEntry

FORMAT: Literal["regolith-studio recipe"] = "regolith-studio recipe"
VERSION: Literal[2] = 2
"""Version 1 knew material cards as the only population and no volumes; it is still read."""
LARGEST = 16_000_000
"""Bytes of a recipe or project that are read: 100,000 inputs by name, and four seconds at the worst."""
SAMPLE = "sample:all"
"""Stands among the inputs for the particles that ship with the program."""


_CHOICES = (
    *("unit", "repair", "star_point", "rule", "reference", "l_max", "level", "target"),
    *("method", "preset", "stop_at", "n_facets", "n_triangles", "largest_error", "seed", "box_metric"),
)
Stop = Literal["facets", "triangles", "error"]
"""Which of the three numbers says how fine polyhedra are."""


class Outputs(Strict):
    """What is written below the output folder."""

    descriptors: bool = True
    fits: bool = False
    meshes: bool = True
    dataset: bool = True
    lmax_study: bool = False
    coarsening_study: bool = False
    summary: bool = True


class Recipe(Strict):
    """Inputs, choices and outputs; relative inputs are looked up beside the recipe file.

    Parameters
    ----------
    inputs
        Files and folders of meshes and tables of coefficients, or ``sample:all``; by default the sample,
        or nothing where there are volumes or a population. Those in another unit, or with another answer
        to whether meshes are repaired, stand in entries of their own, and are read after the others.
    volumes
        CT volumes whose grains are particles too.
    population
        Virtual particles, besides those.
    particles
        Names of those of all these particles that are worked on, in this order; all of them, in the order
        of the fields above, where left out.
    stop_at
        Whether `n_facets`, `n_triangles` (the most) or `largest_error` (a fraction, which the weighted errors
        of the fewest facets do not exceed) says how fine polyhedra are.
    representatives
        Which of them the dataset holds, and their sizes; all as they are where left out.
    exports
        Other programs that the dataset is written for, below ``exports``.
    """

    format: Literal["regolith-studio recipe"] = FORMAT
    version: Literal[2] = VERSION
    inputs: list[str | FilesEntry] = Field(default_factory=lambda: list[str | FilesEntry]([SAMPLE]))
    volumes: list[VolumeEntry] = Field(default_factory=list)
    population: Population | None = None
    particles: list[str | Chosen] | None = Field(default=None, min_length=1)
    unit: str = "um"
    repair: bool = True
    star_point: str = DEFAULT_FIT_OPTIONS.star_point
    rule: str = DEFAULT_FIT_OPTIONS.rule
    reference: str = DEFAULT_FIT_OPTIONS.reference
    l_max: int = 10
    level: int = 4
    target: str = "fit"
    method: str = DEFAULT_METHOD
    settings: dict[str, Scalar] = Field(default_factory=dict)
    preset: str = DEFAULT_PRESET
    weights: dict[str, float] | None = None
    stop_at: Stop = "facets"
    n_facets: int = 20
    n_triangles: int = 68
    largest_error: float = 0.01
    seed: int = 0
    box_metric: str = "exact"
    representatives: Representatives | None = None
    exports: Exports | None = None
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

    @model_validator(mode="after")
    def _has_dataset(self) -> Self:
        if not self.outputs.dataset and (self.representatives or self.exports):
            raise ValueError("representatives and exports need the dataset among the outputs")
        return self

    @property
    def openings(self) -> tuple[tuple[tuple[str, ...], str, bool], ...]:
        """Files and folders read together, their unit, whether they are repaired; without the sample."""
        plain = tuple(entry for entry in self.inputs if isinstance(entry, str) and entry != SAMPLE)
        others = (entry for entry in self.inputs if isinstance(entry, FilesEntry))
        first = ((plain, self.unit, self.repair),) if plain else ()
        return first + tuple((tuple(each.files), each.unit, each.repair) for each in others)

    @property
    def only_files(self) -> bool:
        """Whether all particles of files and of the sample are taken, and no others."""
        return not self.volumes and self.population is None and self.particles is None

    @property
    def named_inputs(self) -> tuple[str, ...]:
        """The sample, files and folders as they are written."""
        return tuple(
            name for entry in self.inputs for name in ([entry] if isinstance(entry, str) else entry.files)
        )

    @classmethod
    def from_choices(
        cls,
        choices: Choices,
        inputs: Sequence[str | FilesEntry],
        outputs: Outputs | None = None,
        **others: Any,
    ) -> Self:
        """The recipe that repeats what has been chosen; `others` are fields of the recipe."""
        chosen: dict[str, Any] = {name: getattr(choices, name) for name in _CHOICES}
        chosen["settings"] = dict(choices.settings)
        chosen["weights"] = dict(choices.weights) if choices.preset_modified else None
        return cls(inputs=list(inputs), outputs=outputs or Outputs(), **(chosen | others))

    def choices(self) -> Choices:
        """The choices that it holds.

        Raises
        ------
        InputError
            If a value is out of its range.
        """
        changes: dict[str, Any] = {name: getattr(self, name) for name in _CHOICES}
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
        return Recipe.model_validate_json(read_bytes(path, LARGEST))
    except ValidationError as error:
        raise FileError(
            f"{path} is not a recipe of this program: {of_the_entry(error.errors(include_url=False))}."
        ) from error


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
        raise InputError(f"This is not a recipe: {of_the_entry(error.errors(include_url=False))}.") from error
