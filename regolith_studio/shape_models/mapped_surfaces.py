"""Measured surfaces under linear maps, expanded again: what models that reuse measured particles share.

The share of its convex hull that a body fills does not change under linear maps. Particles are mapped with
all degrees that the sample has, up to twice that of the draws, and cut afterwards, as measured ones are: so
both lose the same by the cut.
"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cached_property
from math import isqrt
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.harmonics.sphere_grid import sphere_grid
from regolith_studio.messages import N_
from regolith_studio.shape_models.chunked_sampling import SizedSampler
from regolith_studio.shape_models.inertia_ellipsoid import PrincipalAxes, principal_axes
from regolith_studio.shape_models.linear_maps import Tables, mapped_radii, radius_tables
from regolith_studio.shape_models.protocol import amplitudes_of
from regolith_studio.shape_models.realizations import Scale, positive_rows
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.size_law import LogNormalSizes

OVERSAMPLING = 2
"""Measured particles are mapped with degrees up to so many times that of the draws."""
MIN_MATCHED_DEGREE = 3
"""Degrees below belong to the ellipsoid, and their power is left alone."""
LIMITS = (0.8, 1.5)
"""Of the factor of a degree."""


@dataclass(frozen=True, eq=False)
class MappedSurfaces:
    """Measured particles, to be mapped and expanded to a degree.

    Parameters
    ----------
    coefficients
        Of the radii, shape (n, (base + 1)^2), positive everywhere, also where they are cut at `l_max`.
    l_max
        Degree of the mapped particles, at most `base`.
    """

    coefficients: FloatArray
    l_max: int

    def __post_init__(self) -> None:
        rows = locked_floats(self.coefficients, (None, None), "coefficients")
        if rows.shape[1] < (self.l_max + 1) ** 2:
            raise ValueError(f"{rows.shape[1]} coefficients do not reach l_max = {self.l_max}")
        object.__setattr__(self, "coefficients", rows)

    def __reduce__(self) -> tuple[Callable[..., "MappedSurfaces"], tuple[Any, ...]]:
        return MappedSurfaces, (self.coefficients, self.l_max)

    def __len__(self) -> int:
        return len(self.coefficients)

    @classmethod
    def of(cls, sample: Sample, l_max: int) -> "MappedSurfaces":
        """The particles of a sample whose radius is positive, with degrees up to twice `l_max`.

        Raises
        ------
        InputError
            If the sample is not expanded to `l_max`, or fewer than two particles have a positive radius.
        """
        sample.truncated(l_max)  # refuses what the sample lacks
        usable = sample.truncated(min(sample.l_max, OVERSAMPLING * l_max)).star_shaped()
        if usable.l_max > l_max:
            keep = np.flatnonzero(positive_rows(usable.truncated(l_max).coefficients))
            if len(keep) < len(usable):
                usable = usable.chosen(keep)
        return cls(usable.coefficients, l_max)

    @property
    def loses_by_mapping(self) -> bool:
        """Whether too few degrees above those of the draws are known to come down under a map."""
        return self._base < OVERSAMPLING * self.l_max

    @property
    def _base(self) -> int:
        return isqrt(self.coefficients.shape[1]) - 1

    @property
    def cut(self) -> FloatArray:
        """The measured particles at the degree of the draws."""
        return self.coefficients[:, : (self.l_max + 1) ** 2]

    @cached_property
    def axes(self) -> PrincipalAxes:
        """Of the measured particles."""
        return principal_axes(self.coefficients)

    @cached_property
    def equivalent_radii(self) -> FloatArray:
        """Of the measured particles, shape (n,)."""
        return np.asarray(np.cbrt(3 * self.axes.volumes / (4 * np.pi)))

    @cached_property
    def _tables(self) -> Tables:
        return radius_tables(self.coefficients)

    def mapped(self, picks: IntArray, inverses: FloatArray) -> FloatArray:
        """Coefficients (k, (l_max + 1)^2) of the particles `picks` (k,) under maps with these inverses
        (k, 3, 3)."""
        grid = sphere_grid((5 * self.l_max + 6 * self._base) // 10 + 1, self.l_max)
        radii = np.empty((len(picks), len(grid.directions)))
        mapped_radii(self._tables, picks, np.ascontiguousarray(inverses), grid.directions, radii)
        return np.asarray(grid.expanded(radii), dtype=np.float64)


def roughness_gain(mapped: FloatArray, measured: FloatArray) -> FloatArray:
    """A factor for each degree with which mapped particles have the mean power of the measured ones.

    Parameters
    ----------
    mapped, measured
        Coefficients of the radii of the same particles, shapes (n, (l_max + 1)^2).

    Returns
    -------
    Shape (l_max + 1,); ones for the lowest degrees.
    """
    ratio = np.sqrt(_power(measured) / np.maximum(_power(mapped), 1e-300))
    ratio[:MIN_MATCHED_DEGREE] = 1.0
    return np.asarray(np.clip(ratio, *LIMITS))


def _power(rows: FloatArray) -> FloatArray:
    """Mean over the particles of the sum of squares at each degree, sizes divided out."""
    starts = np.arange(round(rows.shape[1] ** 0.5)) ** 2
    return np.asarray(np.add.reduceat(((rows / rows[:, :1]) ** 2).mean(axis=0), starts))


@dataclass(frozen=True)
class SurfaceSettings:
    """Parameters
    ----------
    l_max
        Degree of the particles drawn; by default all that the sample has.
    size_jitter
        Standard deviation of ln r_eq about the measured one.
    """

    l_max: int = 30
    size_jitter: float = field(
        default=0.02,
        metadata={
            "label": N_("Size jitter"),
            "maximum": 1.0,
            "decimals": 3,
            "tip": N_("Deviation in ln r_eq."),
        },
    )


@dataclass(frozen=True, eq=False)
class SurfaceSampler(SizedSampler):
    """Base of fitted models that keep the measured particles and map them linearly.

    Parameters
    ----------
    coefficients
        Of the measured radii, shape (n, (base l_max + 1)^2), positive everywhere.
    settings
        Of the fit.
    unit
        Length unit of the sample.
    gain
        Factor of each degree of mapped particles, shape (l_max + 1,); ones if ``None``.
    """

    coefficients: FloatArray
    settings: Any
    unit: str = "um"
    gain: FloatArray | None = None
    scale: ClassVar[Scale] = "radius"

    def __post_init__(self) -> None:
        gain = np.ones(self.l_max + 1) if self.gain is None else self.gain
        object.__setattr__(self, "gain", locked_floats(gain, (self.l_max + 1,), "gain"))
        object.__setattr__(self, "coefficients", self.surfaces.coefficients)

    def __reduce__(self) -> tuple[type[Self], tuple[Any, ...]]:
        return type(self), tuple(getattr(self, each.name) for each in fields(self))

    @property
    def l_max(self) -> int:
        """Degree of the particles it draws."""
        return int(self.settings.l_max)

    @cached_property
    def surfaces(self) -> MappedSurfaces:
        """The measured particles."""
        return MappedSurfaces(self.coefficients, self.l_max)

    @cached_property
    def sizes(self) -> LogNormalSizes:
        """Law of equivalent radii: the measured ones, each blurred a little; component i is particle i."""
        return LogNormalSizes.kernel(self.surfaces.equivalent_radii, self.settings.size_jitter)

    def relative_amplitudes(self) -> FloatArray:
        """Of the measured particles at the degree of the draws, shape (l_max,)."""
        return amplitudes_of(self.surfaces.cut)

    def mapped(self, picks: IntArray, inverses: FloatArray) -> FloatArray:
        """Coefficients of the particles `picks` under maps with these inverses (k, 3, 3), times the gain."""
        rows = self.surfaces.mapped(picks, inverses)
        return np.asarray(rows * np.asarray(self.gain)[degrees(rows.shape[1])])

    def calibrated(self, **changes: Any) -> Self:
        """A copy with another calibration, which shares what has been found of the measured particles."""
        better = replace(self, **changes)
        names = {each.name for each in fields(self)}
        better.__dict__.update({name: found for name, found in self.__dict__.items() if name not in names})
        return better

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Settings and calibration for JSON; the measured coefficients."""
        calibration = [each.name for each in fields(self)[3:]]
        values = {name: np.asarray(getattr(self, name)).tolist() for name in calibration}
        kept = {"settings": asdict(self.settings), "unit": self.unit, **values}
        return kept, {"coefficients": self.coefficients}

    @classmethod
    def restored(cls, settings: Any, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> Self:
        """The model from its settings, and the values and arrays that it stored."""
        return cls(arrays["coefficients"], settings, **{k: v for k, v in values.items() if k != "settings"})


def measured_surfaces(sample: Sample, settings: SurfaceSettings, n_neighbours: int) -> MappedSurfaces:
    """The particles of a sample for a model with these settings.

    Raises
    ------
    InputError
        If a setting is out of range, the sample is not expanded so far, or fewer than two particles have a
        positive radius.
    """
    if n_neighbours < 1 or not 0 <= settings.size_jitter <= 1:
        raise InputError(
            "The neighbours must be at least 1 and the size jitter 0 to 1, got "
            f"{n_neighbours} and {settings.size_jitter:g}."
        )
    if settings.l_max < 1:
        raise InputError(f"Particles that can be turned need l_max of at least 1, got {settings.l_max}.")
    return MappedSurfaces.of(sample, settings.l_max)
