"""A recipe: inputs, choices and outputs as JSON; the window saves it, ``run`` runs it."""

from collections.abc import Sequence
from dataclasses import Field as DataclassField
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, create_model, model_validator

from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.dataset.parameters import DatasetSettings, ExportSettings
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.errors import FileError, InputError, format_validation_error
from regolith_studio.harmonics.fit_options import FIT_DEGREE, LEVEL_LIMITS, MAX_TABLE_DEGREE
from regolith_studio.io.own_files import parse_strict_json
from regolith_studio.readers.coefficient_tables import TableConvention
from regolith_studio.readers.sandbox.parent import read_bytes
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.resources import SAMPLE
from regolith_studio.session.choices import Choices, Scalar
from regolith_studio.settings import settings_in, settings_of_kind

FORMAT: Literal["regolith-studio recipe"] = "regolith-studio recipe"
VERSION: Literal[2] = 2
LARGEST = 16_000_000
"""Bytes of a recipe or project that are read: 100,000 inputs by name, and four seconds at the worst."""
MAX_ENTRIES = 100_000
"""Of a list of inputs or particles."""


Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Edges = Annotated[list[float], Field(min_length=3, max_length=3)]


class Strict(BaseModel):
    """Refuses what it does not know, and values of another type."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


def _entry(each: DataclassField[Any]) -> tuple[Any, Any]:
    """Type and description of the entry that holds a setting."""
    known = each.metadata
    kind = Literal[tuple(known["choices"])] if "choices" in known else type(each.default)
    limits = {"ge": known.get("minimum"), "le": known.get("maximum")}
    given = {name: value for name, value in limits.items() if value is not None}
    return kind, Field(default=each.default, title=known["label"], description=known["tip"], **given)


def _entries(kind: Any) -> dict[str, tuple[Any, Any]]:
    """An entry for each setting of a dataclass."""
    return {each.name: _entry(each) for each in settings_of_kind(kind)}


if TYPE_CHECKING:

    class _SettingsEntries(Strict):
        def __getattr__(self, name: str) -> Any: ...

    _ReadingEntries = _SettingsEntries
    _DatasetEntries = _SettingsEntries
    _ExportEntries = _SettingsEntries
else:
    _ReadingEntries = create_model("_ReadingEntries", __base__=Strict, **_entries(ReadingSettings))
    _DatasetEntries = create_model("_DatasetEntries", __base__=Strict, **_entries(DatasetSettings))
    _ExportEntries = create_model("_ExportEntries", __base__=Strict, **_entries(ExportSettings))


class Population(Strict):
    """Virtual particles among the inputs.

    - ``sources``: what they are drawn like: the name of a shipped material card; the file of a card, a fit
      or a fitted model; or meshes and tables of coefficients, files and folders, that are measured for it.
      Relative files are looked up beside the recipe.
    - ``model``, ``settings``: key of the model of shapes that is fitted to a fit or to meshes, and its
      settings; the default model where left out.
    - ``n``: particles to draw, with the seed of the recipe.
    - ``l_max``: degree of their surfaces; that of the source and at most 10 where left out.
    - ``size_range``: smallest and largest equivalent radius in micrometres.
    - ``seed``: of the draws; that of the recipe where left out.
    - ``level``: subdivisions of the icosahedron that their surfaces are drawn on; where left out that of the
      recipe, and at least 5 above l_max = 10.
    - ``name``: what they are called, and their group where the model has no parts; by default after the
      first source.
    """

    sources: list[str] = Field(min_length=1, max_length=MAX_ENTRIES)
    model: str = ""
    settings: dict[str, Scalar] = Field(default_factory=dict)
    n: int = Field(ge=1, le=1_000_000)
    l_max: int | None = Field(default=None, ge=1, le=FIT_DEGREE)
    size_range: Pair | None = None
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    level: int | None = Field(default=None, ge=LEVEL_LIMITS[0], le=LEVEL_LIMITS[1])
    name: str = ""

    @property
    def bounds(self) -> tuple[float, float] | None:
        """The size range as a pair."""
        return None if self.size_range is None else (self.size_range[0], self.size_range[1])


class FilesEntry(_ReadingEntries):
    """Files and folders that are read together, in a unit of their own; relative to the recipe.

    ``l_max``: degree above which coefficients of tables are left out; by default none are. ``convention``:
    of tables of coefficients: normalisation and phase.
    """

    files: list[str] = Field(min_length=1, max_length=MAX_ENTRIES)
    l_max: int | None = Field(default=None, ge=1, le=MAX_TABLE_DEGREE)
    convention: TableConvention = "auto"


class NamedParticle(Strict):
    """One particle of the inputs, under another name than theirs would be."""

    name: str
    called: str


class RawVolume(Strict):
    """What a raw file does not say about itself: voxels along x, y, z, their type, where they begin."""

    shape: Annotated[list[int], Field(min_length=3, max_length=3)]
    dtype: str = "uint8"
    byte_order: str = "little"
    offset: int = 0


class VolumeEntry(Strict):
    """A CT volume whose grains are among the inputs.

    - ``file``: file, or folder of slices, relative to the recipe; ``sample:grey``, ``sample:labels`` or
      ``sample:gradient`` for a scan that ships with the program.
    - ``voxel_size``, ``unit``, ``kind``, ``dataset``, ``axes``, ``allow_gaps``, ``raw``: as
      ``regolith-studio extract`` takes them; by default what the file says.
    - ``recipe``: an ``extraction.json`` with all settings, as ``extract`` and the window write it.
    - ``region``, ``segmentation``, ``extraction``: the settings themselves, in place of such a file.
    - ``classifier``: the file of a classifier of voxels, whose probabilities are thresholded.
    """

    file: str
    voxel_size: float | Edges | None = None
    unit: str | None = None
    kind: Literal["labels", "grey"] | None = None
    dataset: str | None = None
    axes: str | None = None
    allow_gaps: bool = False
    raw: RawVolume | None = None
    recipe: str | None = None
    region: dict[str, Any] = Field(default_factory=dict)
    segmentation: dict[str, Any] = Field(default_factory=dict)
    extraction: dict[str, Any] = Field(default_factory=dict)
    classifier: str | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if self.recipe is not None and (
            self.region or self.segmentation or self.extraction or self.classifier
        ):
            raise ValueError("give settings or the recipe that holds them, not both")
        return self


_ENTRIES = _entries(Choices)


class Representatives(_DatasetEntries):
    """As ``regolith-studio dataset build`` takes them; with a count of 0 each particle stands for itself.

    ``seed``: of the choice among very many particles; that of the recipe where left out.
    """

    seed: int | None = Field(default=None, ge=0, lt=2**63)


class Exports(_ExportEntries):
    """As ``regolith-studio dataset export`` takes them.

    - ``targets``: keys of the formats, or ``all``.
    - ``seed``: of the draw of particles; that of the recipe where left out.
    - ``settings``: of contact, cylinder, times or formats, by their names, in SI units.
    - ``lossy``: whether formats that change the shapes are allowed.
    """

    targets: list[str] = Field(min_length=1)
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    settings: dict[str, int | float] = Field(default_factory=dict)
    lossy: bool = False


@dataclass(frozen=True)
class DatasetRequest:
    """What the page of the dataset has chosen."""

    representatives: Representatives | None = None
    exports: Exports | None = None


class Outputs(Strict):
    """What is written below the output folder.

    ``chords``: whether the descriptors have width and thickness by chords, which take longer.
    ``dataset_by_group``: one dataset for each group, in folders of ``dataset``, with a manifest.
    """

    descriptors: bool = True
    chords: bool = False
    fits: bool = False
    meshes: bool = True
    dataset: bool = True
    dataset_by_group: bool = False
    lmax_study: bool = False
    coarsening_study: bool = False
    summary: bool = True


class RecipeInputs(Strict):
    """The particles of a recipe; relative files are looked up beside the recipe file.

    - ``inputs``: files and folders of meshes and tables of coefficients, or ``sample:all``; by default the
      sample, or nothing where there are volumes or a population. Those in another unit, with another answer
      to whether meshes are repaired, or cut at a degree, stand in entries of their own, and are read after
      the others.
    - ``volumes``: CT volumes whose grains are particles too.
    - ``population``: virtual particles, besides those.
    - ``particles``: names of those of all these particles that are worked on, in this order; all of them, in
      the order of the fields above, where left out.
    """

    format: Literal["regolith-studio recipe"] = FORMAT
    version: Literal[2] = VERSION
    inputs: list[str | FilesEntry] = Field(
        default_factory=lambda: list[str | FilesEntry]([SAMPLE]), max_length=MAX_ENTRIES
    )
    volumes: list[VolumeEntry] = Field(default_factory=list, max_length=MAX_ENTRIES)
    population: Population | None = None
    particles: list[str | NamedParticle] | None = Field(default=None, min_length=1, max_length=MAX_ENTRIES)


if TYPE_CHECKING:

    class _ChoiceEntries(RecipeInputs):
        def __getattr__(self, name: str) -> Any: ...

else:
    _ChoiceEntries = create_model("_ChoiceEntries", __base__=RecipeInputs, **_ENTRIES)


class Recipe(_ChoiceEntries):
    """Inputs, choices and outputs: an entry for each setting of ``Choices``, and those that follow.

    - ``settings``: settings of the method that differ from its defaults.
    - ``weights``: of the loss, in place of the preset's.
    - ``keep``: terms of the loss that are kept exactly; left to the weights where left out.
    - ``representatives``: which of the particles the dataset holds, and their sizes; all as they are where
      left out.
    - ``exports``: other programs that the dataset is written for, below ``exports``.
    """

    settings: dict[str, Scalar] = Field(default_factory=dict)
    weights: dict[str, float] | None = None
    keep: list[str] | None = Field(default=None, max_length=len(LOSS_KEYS))
    representatives: Representatives | None = None
    exports: Exports | None = None
    outputs: Outputs = Field(default_factory=Outputs)

    @model_validator(mode="before")
    @classmethod
    def _without_sample(cls, document: Any) -> Any:
        """Take no sample by default where there are volumes or a population."""
        if not isinstance(document, dict):
            return document
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
        if self.outputs.dataset_by_group and (self.representatives or self.exports):
            raise ValueError("representatives and exports are of one dataset, not of one for each group")
        return self

    @property
    def openings(self) -> tuple[FilesEntry, ...]:
        """Files and folders that are read together, those named alone first; without the sample."""
        plain = [entry for entry in self.inputs if isinstance(entry, str) and entry != SAMPLE]
        first = (FilesEntry(files=plain, **settings_in(ReadingSettings, self)),) if plain else ()
        return first + tuple(entry for entry in self.inputs if isinstance(entry, FilesEntry))

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
        chosen: dict[str, Any] = {name: getattr(choices, name) for name in _ENTRIES}
        chosen["settings"] = dict(choices.settings)
        chosen["weights"] = dict(choices.weights) if choices.preset_modified else None
        chosen["keep"] = None if choices.weights.keep is None else sorted(choices.weights.keep)
        return cls(inputs=list(inputs), outputs=outputs or Outputs(), **(chosen | others))

    def choices(self) -> Choices:
        """The choices that it holds."""
        changes: dict[str, Any] = {name: getattr(self, name) for name in _ENTRIES}
        changes["settings"] = tuple(self.settings.items())
        if self.weights is not None or self.keep is not None:
            named = self.weights
            weights = LossWeights.from_preset(self.preset) if named is None else LossWeights.of(**named)
            changes["weights"] = weights.keeping(self.keep)
        return Choices().replaced(**changes)

    def to_json(self) -> str:
        """As indented JSON, ending in a newline."""
        return self.model_dump_json(indent=2) + "\n"


def read_recipe(path: Path) -> Recipe:
    """Read a recipe file."""
    return read_document(path, Recipe, "recipe")


Document = TypeVar("Document", bound=BaseModel)


def read_document(path: Path, model: type[Document], kind: str) -> Document:
    """Read a JSON file that holds a model; `kind` is what the message of a refusal calls it."""
    content = read_bytes(path, LARGEST)
    try:
        document = model.model_validate_json(content)
    except ValidationError as error:
        reason = format_validation_error(error.errors(include_url=False))
        raise FileError(f"{path} is not a {kind} of this program: {reason}.") from error
    parse_strict_json(content.decode("utf-8"), str(path))
    return document


def recipe_schema() -> dict[str, Any]:
    """JSON Schema of recipes of this version, as it ships in ``resources/schema``."""
    title = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Regolith Studio recipe"}
    return title | {
        key: value for key, value in Recipe.model_json_schema().items() if key not in ("title", "$schema")
    }


def recipe_of(**entries: Any) -> Recipe:
    """A recipe from Python values."""
    try:
        return Recipe(**entries)
    except ValidationError as error:
        raise InputError(
            f"This is not a recipe: {format_validation_error(error.errors(include_url=False))}."
        ) from error
