"""Protocols of shape models: fitting, drawing and storing."""

from collections.abc import Iterator, Mapping
from typing import Any, Protocol

from numpy.typing import NDArray

from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample

SizeRange = tuple[float, float]
"""Lowest and highest equivalent radius, in the unit of the sample."""


class FittedModel(Protocol):
    """A model with fitted parameters; immutable."""

    @property
    def key(self) -> str:
        """Of the model in ``MODELS``."""

    @property
    def l_max(self) -> int:
        """Degree of the particles it draws."""

    @property
    def unit(self) -> str:
        """Length unit of the sample."""

    def draw(self, n: int, seed: int, size_range: SizeRange | None = None) -> Realizations:
        """`n` particles; the first of them do not depend on `n`."""

    def draw_chunks(self, n: int, seed: int, size_range: SizeRange | None = None) -> Iterator[Realizations]:
        """The same particles in chunks of some hundreds."""

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON, and arrays by name for NPZ."""


class ShapeModel(Protocol):
    """A kind of model: an object called ``MODEL`` in a module of ``shape_models.models``."""

    key: str
    label: str
    summary: str
    Settings: type[Any]

    def fit(self, sample: Sample, settings: Any | None = None) -> FittedModel:
        """The model of a sample, with the settings or the default ones."""

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> FittedModel:
        """The fitted model from what it stored."""
