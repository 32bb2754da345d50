"""Measured surfaces under linear maps, expanded again: what models that reuse measured particles share.

The share of its convex hull that a body fills does not change under linear maps. Particles are mapped with
all degrees that the sample has, up to twice that of the draws, and cut afterwards, as measured ones are: so
both lose the same by the cut.

Radius functions under linear maps of space: tables of measured radii, looked up where a map leads.

The image of the body r(u) under L has the radius r(v / |v|) / |v| along u, with v = L^-1 u. Tables are even
in colatitude and longitude; between their nodes Lagrange's cubic holds in both.
"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from math import isqrt
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.geometry.kernels import inner_kernel, kernel
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.harmonics.sphere_grid import SphereGrid, ring_basis, sphere_grid
from regolith_studio.messages import N_, Message
from regolith_studio.settings import setting
from regolith_studio.shape_models.chunked_sampling import SizedSampler
from regolith_studio.shape_models.inertia_ellipsoid import PrincipalAxes, principal_axes
from regolith_studio.shape_models.protocol import amplitudes_of
from regolith_studio.shape_models.realizations import Scale, positive_rows
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.size_law import LogNormalSizes

Tables = NDArray[np.float32]

ROWS_PER_DEGREE = 2.4
# The cubic takes two nodes on either side.
MARGIN = 2
_BATCH = 500


def radius_tables(coefficients: FloatArray) -> Tables:
    """Radii on a grid of colatitudes and longitudes, wrapped, shape (n, rows + 4, 2 rows + 4)."""
    l_max = round(coefficients.shape[1] ** 0.5) - 1
    rows = max(16, int(np.ceil(ROWS_PER_DEGREE * l_max)))
    colatitude = (np.arange(rows) + 0.5) * np.pi / rows
    basis = ring_basis(np.cos(colatitude), 2 * rows, l_max)
    tables = np.empty((len(coefficients), rows + 2 * MARGIN, 2 * rows + 2 * MARGIN), dtype=np.float32)
    for first in range(0, len(coefficients), _BATCH):
        values = basis.values(coefficients[first : first + _BATCH]).astype(np.float32)
        tables[first : first + _BATCH] = _wrapped(values.reshape(-1, rows, 2 * rows))
    return tables


def _wrapped(grid: Tables) -> Tables:
    """With two more rows beyond each pole and two more columns on each side."""
    rows = grid.shape[1]
    # Beyond a pole the meridian goes on at the opposite longitude.
    opposite = np.roll(grid, rows, axis=2)
    tall = np.concatenate([opposite[:, MARGIN - 1 :: -1], grid, opposite[:, : -MARGIN - 1 : -1]], axis=1)
    return np.concatenate([tall[:, :, -MARGIN:], tall, tall[:, :, :MARGIN]], axis=2)


@kernel
def mapped_radii(
    tables: Tables, picks: IntArray, inverses: FloatArray, directions: FloatArray, radii: FloatArray
) -> None:
    """Fill `radii` of mapped particles, shape (n, k).

    - ``tables``: of :func:`radius_tables`.
    - ``picks``: which table each particle has, shape (n,).
    - ``inverses``: inverse of each linear map, shape (n, 3, 3).
    - ``directions``: unit vectors, shape (k, 3).
    """
    step = np.pi / (tables.shape[1] - 4)
    for n in range(len(picks)):
        a = inverses[n]
        table = tables[picks[n]]
        for k in range(len(directions)):
            x, y, z = directions[k, 0], directions[k, 1], directions[k, 2]
            p = a[0, 0] * x + a[0, 1] * y + a[0, 2] * z
            q = a[1, 0] * x + a[1, 1] * y + a[1, 2] * z
            r = a[2, 0] * x + a[2, 1] * y + a[2, 2] * z
            length = np.sqrt(p * p + q * q + r * r)
            row = np.arctan2(np.sqrt(p * p + q * q), r) / step - 0.5
            column = np.arctan2(q, p) / step
            if column < 0.0:
                column += tables.shape[2] - 4
            i, j = int(np.floor(row)), int(np.floor(column))
            radii[n, k] = _cubic(table, i, j, row - i, column - j) / length


@inner_kernel
def _cubic(table: Tables, i: int, j: int, s: float, t: float) -> float:
    """Value at (i + s, j + t) of a table with a margin of two, 0 <= s, t <= 1."""
    total = 0.0
    c0 = -t * (t - 1.0) * (t - 2.0) / 6.0
    c1 = (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0
    c2 = -(t + 1.0) * t * (t - 2.0) / 2.0
    c3 = (t + 1.0) * t * (t - 1.0) / 6.0
    for d in range(4):
        if d == 0:
            weight = -s * (s - 1.0) * (s - 2.0) / 6.0
        elif d == 1:
            weight = (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0
        elif d == 2:
            weight = -(s + 1.0) * s * (s - 2.0) / 2.0
        else:
            weight = (s + 1.0) * s * (s - 1.0) / 6.0
        line = table[i + 1 + d]
        total += weight * (c0 * line[j + 1] + c1 * line[j + 2] + c2 * line[j + 3] + c3 * line[j + 4])
    return total


OVERSAMPLING = 2
"""Measured particles are mapped with degrees up to so many times that of the draws."""
MIN_MATCHED_DEGREE = 3
"""Degrees below belong to the ellipsoid, and their power is left alone."""
LIMITS = (0.8, 1.5)
"""Of the factor of a degree."""
GAIN_TERMS = 3
FIT_STEPS = 6


@dataclass(frozen=True, eq=False)
class MappedSurfaces:
    """Measured particles, to be mapped and expanded to a degree.

    ``coefficients``: of the radii, shape (n, (base + 1)^2), positive everywhere, also where they are cut at
    `l_max`. ``l_max``: degree of the mapped particles, at most `base`.
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

        Raises InputError if the sample is not expanded to `l_max`, or fewer than two particles have a
        positive radius.
        """
        sample.truncated(l_max)  # refuses what the sample lacks
        usable = sample.truncated(min(sample.l_max, OVERSAMPLING * l_max)).star_shaped()
        if usable.l_max > l_max:
            # A radius that is positive with all degrees may fall below zero where it is cut.
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
        # Exact for harmonics up to l_max times surfaces up to 1.2 times the degree of the measured ones: maps
        # raise it.
        grid = sphere_grid((5 * self.l_max + 6 * self._base) // 10 + 1, self.l_max)
        radii = np.empty((len(picks), len(grid.directions)))
        mapped_radii(self._tables, picks, np.ascontiguousarray(inverses), grid.directions, radii)
        # Measured particles that are cut have ripples, as draws have that are cut alike.
        return fitted_evenly(grid, radii) if self.loses_by_mapping else grid.expanded(radii)


def fitted_evenly(grid: SphereGrid, radii: FloatArray) -> FloatArray:
    """Least-squares coefficients (n, (l_max + 1)^2) of radii (n, k) at the nodes, weighted by r^-4.

    What a cut at l_max leaves out of the tips of a long body comes back as ripples of one height everywhere,
    which show as concentric rings where its flat sides are near the star point. The weights, those of an
    error in 1 / r, leave the error where the radius is large. A radius of degree l_max is found exactly.
    """
    weights = radii**-4.0
    weights /= weights.max(axis=1, keepdims=True)
    rows = grid.expanded(radii)
    # Conjugate gradients from the unweighted fit: six steps bring rings below what shading shows.
    residual = grid.expanded(weights * (radii - grid.values(rows)))
    direction, square = residual, (residual**2).sum(axis=1)
    for _ in range(FIT_STEPS):
        image = grid.expanded(weights * grid.values(direction))
        step = (square / np.maximum((direction * image).sum(axis=1), 1e-300))[:, None]
        rows, residual = rows + step * direction, residual - step * image
        before, square = square, (residual**2).sum(axis=1)
        direction = residual + (square / np.maximum(before, 1e-300))[:, None] * direction
    return np.asarray(rows, dtype=np.float64)


def roughness_gain(mapped: FloatArray, measured: FloatArray) -> FloatArray:
    """A factor for each degree with which mapped particles have nearly the mean power of the measured ones.

    ``mapped``, ``measured``: coefficients of the radii of the same particles, shapes (n, (l_max + 1)^2).

    Returns shape (l_max + 1,); ones for the lowest degrees. Above, its logarithm is a parabola in the degree:
    a gain that jumps from one degree to the next would put rings about all that stands out.
    """
    ratio = np.sqrt(_power(measured) / np.maximum(_power(mapped), 1e-300))
    matched = np.clip(ratio[MIN_MATCHED_DEGREE:], *LIMITS)
    ratio[:MIN_MATCHED_DEGREE] = 1.0
    if len(matched) > GAIN_TERMS:
        degree = np.linspace(-1.0, 1.0, len(matched))
        fitted = np.polynomial.Polynomial.fit(degree, np.log(matched), GAIN_TERMS - 1)
        matched = np.clip(np.exp(fitted(degree)), *LIMITS)
    ratio[MIN_MATCHED_DEGREE:] = matched
    return np.asarray(ratio)


def _power(rows: FloatArray) -> FloatArray:
    """Mean over the particles of the sum of squares at each degree, sizes divided out."""
    starts = np.arange(round(rows.shape[1] ** 0.5)) ** 2
    return np.asarray(np.add.reduceat(((rows / rows[:, :1]) ** 2).mean(axis=0), starts))


@dataclass(frozen=True)
class SurfaceSettings:
    """Settings of mapped surfaces.

    - ``l_max``: degree of the particles drawn; by default all that the sample has.
    - ``size_jitter``: standard deviation of ln r_eq about the measured one.
    """

    l_max: int = 30
    size_jitter: float = setting(0.02, N_("Size noise"), N_("Deviation in ln r_eq."), maximum=1.0, decimals=3)


@dataclass(frozen=True, eq=False)
class SurfaceSampler(SizedSampler):
    """Base of fitted models that keep the measured particles and map them linearly.

    - ``coefficients``: of the measured radii, shape (n, (base l_max + 1)^2), positive everywhere.
    - ``settings``: of the fit.
    - ``unit``: length unit of the sample.
    - ``gain``: factor of each degree of mapped particles, shape (l_max + 1,); ones if ``None``.
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
        better.__dict__.update({name: value for name, value in self.__dict__.items() if name not in names})
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

    Raises InputError if a setting is out of range, the sample is not expanded so far, or fewer than two
    particles have a positive radius.
    """
    if n_neighbours < 1 or not 0 <= settings.size_jitter <= 1:
        raise InputError(
            "The neighbours must be at least 1 and the size jitter 0 to 1, got "
            f"{n_neighbours} and {settings.size_jitter:g}."
        )
    if settings.l_max < 1:
        sentence = N_("Particles that can be turned need l_max of at least 1, got {l_max}.")
        raise InputError(Message(sentence, l_max=settings.l_max))
    return MappedSurfaces.of(sample, settings.l_max)
