"""Protocols of shape models: fitting, drawing and storing, and the spectra that plots and sliders show.

A spectrum is shown as amplitudes: that of degree l is sqrt(A_l) / mu, as in publications. For fields in ln r
it is sqrt(A_l / 4 pi), which is the same to first order.
"""

from collections.abc import Iterator, Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample

N_MEASURED = 500
"""Draws by which the amplitudes of a model that states none are measured."""
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


@runtime_checkable
class SpectralModel(Protocol):
    """A fitted model that states its amplitudes; those of others are measured on draws."""

    def relative_amplitudes(self) -> FloatArray:
        """Of the degrees 1 .. l_max, mean over components or measured particles, shape (l_max,)."""


@runtime_checkable
class EditableModel(Protocol):
    """A fitted model with one spectrum, which may be changed by hand."""

    def with_amplitudes(self, amplitudes: ArrayLike) -> FittedModel:
        """The same model with other amplitudes (l_max,) for all its particles; the size stays.

        Raises InputError as :func:`checked_amplitudes`.
        """


def relative_amplitudes(model: FittedModel) -> FloatArray:
    """Amplitudes of the degrees 1 .. l_max, shape (l_max,): the model's own, or those of its draws.

    Raises InputError if the model states none and cannot draw.
    """
    if isinstance(model, SpectralModel):
        return model.relative_amplitudes()
    draws = model.draw(N_MEASURED, 0)
    return amplitudes_of(draws.coefficients, logarithmic=draws.scale == "log_radius")


def amplitudes_of(rows: FloatArray, logarithmic: bool = False) -> FloatArray:
    """Amplitudes of the degrees 1 .. l_max of particles with coefficients of shape (n, (l_max + 1)^2).

    ``logarithmic``: whether the coefficients are those of ln r.
    """
    shares = rows / (np.sqrt(4 * np.pi) if logarithmic else rows[:, :1])
    n_degrees = round(rows.shape[1] ** 0.5)
    powers = np.add.reduceat((shares**2).mean(axis=0), np.arange(n_degrees) ** 2)
    return np.asarray(np.sqrt(powers / (2 * np.arange(n_degrees) + 1))[1:])


def checked_amplitudes(amplitudes: ArrayLike, l_max: int) -> FloatArray:
    """The amplitudes as an array of shape (l_max,).

    Raises InputError if there are not as many, or one is negative or not finite.
    """
    values = np.asarray(amplitudes, dtype=np.float64)
    if values.shape != (l_max,) or not (np.isfinite(values).all() and (values >= 0).all()):
        raise InputError(f"{l_max} amplitudes are needed, none of them negative.")
    return values


class ShapeModel(Protocol):
    """A kind of model: an object called ``MODEL`` in a module of ``shape_models.models``."""

    key: str
    label: str
    summary: str
    Settings: type[Any]

    def fit(self, sample: Sample, settings: Any | None = None) -> FittedModel:
        """The model of a sample, with the settings or the default ones.

        Raises InputError if a setting is out of range, the sample is not expanded so far, or too few of its
        particles can be used.
        """

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> FittedModel:
        """The fitted model from what it stored."""
