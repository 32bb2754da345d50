"""Where the particles of a recipe come from, besides plain names of files."""

from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from regolith_studio.session.choices import L_MAX_LIMIT, LEVEL_LIMITS, Scalar

Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Edges = Annotated[list[float], Field(min_length=3, max_length=3)]


class Strict(BaseModel):
    """Refuses what it does not know, and values of another type."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class Population(Strict):
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
    seed
        Of the draws; that of the recipe where left out.
    level
        Subdivisions of the icosahedron that their surfaces are drawn on; that of the recipe where left out.
    name
        What they are called, and their group where the model has no parts; by default after the first source.
    """

    sources: list[str] = Field(min_length=1)
    model: str = ""
    settings: dict[str, Scalar] = Field(default_factory=dict)
    n: int = Field(ge=1, le=1_000_000)
    l_max: int | None = Field(default=None, ge=1, le=L_MAX_LIMIT)
    size_range: Pair | None = None
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    level: int | None = Field(default=None, ge=LEVEL_LIMITS[0], le=LEVEL_LIMITS[1])
    name: str = ""

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


class FilesEntry(Strict):
    """Files and folders that are read together, in a unit of their own; relative to the recipe."""

    files: list[str] = Field(min_length=1)
    unit: str
    repair: bool = True


class Chosen(Strict):
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

    Parameters
    ----------
    file
        File, or folder of slices, relative to the recipe; ``sample:grey`` or ``sample:labels`` for the
        scan that ships with the program.
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
