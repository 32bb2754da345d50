"""Spherical-harmonics coefficients of a radius function (Eq. 3 and 4).

The convention, everywhere in the program and in its files: real spherical harmonics, orthonormal on
the unit sphere, without the Condon-Shortley phase, ::

    Y_lm =         P_l0(cos t)                 m = 0
    Y_lm = sqrt(2) P_lm(cos t) cos(m p)        m > 0
    Y_lm = sqrt(2) P_l|m|(cos t) sin(|m| p)    m < 0

with P_lm >= 0 near t = 0 and the integral of Y_lm^2 over the sphere equal to one, so that the mean
radius is c_00 / sqrt(4 pi). The flat index is k = l^2 + l + m.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from math import isqrt
from types import MappingProxyType

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats

CONVENTION = (
    "Real spherical harmonics, orthonormal on the unit sphere, without the Condon-Shortley phase; "
    "flat index k = l^2 + l + m, m < 0 for sin(|m| phi), m > 0 for cos(m phi); theta from +z, phi from "
    "+x; mean radius = c_0 / sqrt(4 pi)."
)
"""One sentence for every file that holds coefficients."""


@dataclass(frozen=True, eq=False)
class ShCoefficients(LockedRecord):
    """Coefficients c_lm up to degree l_max.

    Parameters
    ----------
    values
        Shape ((l_max + 1)^2,), index k = l^2 + l + m; in the unit of the radius.

    Raises
    ------
    InputError
        If a coefficient is not a finite number.
    ValueError
        If the length is not a square.
    """

    values: FloatArray

    def __post_init__(self) -> None:
        values = np.asarray(self.values, dtype=np.float64)
        if values.ndim != 1 or not len(values) or isqrt(len(values)) ** 2 != len(values):
            raise ValueError(f"values must have shape ((l_max + 1)^2,), got {values.shape}")
        broken = np.flatnonzero(~np.isfinite(values))
        if len(broken):
            degree, order = degrees(len(values))[broken[0]], orders(len(values))[broken[0]]
            raise InputError(
                f"{len(broken)} of {len(values)} coefficients are not finite numbers, the first at "
                f"l = {degree}, m = {order}."
            )
        object.__setattr__(self, "values", locked_floats(values, (None,), "values"))

    def __len__(self) -> int:
        return len(self.values)

    @property
    def l_max(self) -> int:
        """Highest degree."""
        return isqrt(len(self.values)) - 1

    @property
    def mean_radius(self) -> float:
        """Mean of the radius over all directions, c_00 / sqrt(4 pi)."""
        return float(self.values[0] / np.sqrt(4 * np.pi))

    @cached_property
    def content(self) -> dict[tuple[int, int], float]:
        """Coefficients by (l, m)."""
        keys = zip(degrees(len(self)).tolist(), orders(len(self)).tolist(), strict=True)
        return dict(zip(keys, self.values.tolist(), strict=True))

    def truncated(self, l_max: int) -> "ShCoefficients":
        """The coefficients up to `l_max` (Eq. 4).

        Raises InputError if `l_max` is negative or above the degree of these coefficients.
        """
        if l_max == self.l_max:
            return self
        return ShCoefficients(self.values[: (checked_degree(l_max, self.l_max) + 1) ** 2])

    def padded(self, l_max: int) -> "ShCoefficients":
        """The same function with zeros up to `l_max`, which must not be lower than the present degree."""
        if l_max < self.l_max:
            raise ValueError(f"l_max must be at least {self.l_max}, got {l_max}")
        return ShCoefficients(np.pad(self.values, (0, (l_max + 1) ** 2 - len(self))))

    def scaled(self, factor: float) -> "ShCoefficients":
        """All radii times `factor`."""
        return ShCoefficients(self.values * factor)


def checked_degree(l_max: int, highest: int) -> int:
    """`l_max` itself, if it is a whole number from 0 to `highest`.

    Raises InputError if it is not.
    """
    if not isinstance(l_max, int | np.integer) or not 0 <= l_max <= highest:
        raise InputError(f"l_max must be a whole number from 0 to {highest}, got {l_max}.")
    return int(l_max)


@cache
def degrees(length: int) -> IntArray:
    """Degree l of each of `length` flat indices, shape (length,)."""
    degree_of = np.array([isqrt(k) for k in range(length)], dtype=np.int64)
    degree_of.flags.writeable = False
    return degree_of


@cache
def orders(length: int) -> IntArray:
    """Order m of each of `length` flat indices, shape (length,)."""
    degree = degrees(length)
    order_of = np.arange(length) - degree**2 - degree
    order_of.flags.writeable = False
    return order_of


def to_pyshtools(coefficients: ShCoefficients) -> FloatArray:
    """Array of pyshtools, shape (2, l_max + 1, l_max + 1): cosine and sine terms, ortho, csphase 1."""
    length = len(coefficients)
    degree, order = degrees(length), orders(length)
    cilm = np.zeros((2, coefficients.l_max + 1, coefficients.l_max + 1))
    cilm[(order < 0).astype(np.int64), degree, np.abs(order)] = coefficients.values
    return cilm


def from_pyshtools(cilm: FloatArray) -> ShCoefficients:
    """From an array of pyshtools, shape (2, l_max + 1, l_max + 1), normalised `ortho`, csphase 1."""
    length = cilm.shape[1] ** 2
    degree, order = degrees(length), orders(length)
    return ShCoefficients(cilm[(order < 0).astype(np.int64), degree, np.abs(order)])


DEGREE_RANGES: Mapping[str, tuple[int, int]] = MappingProxyType(
    {"form": (1, 4), "roundness": (5, 15), "roughness": (16, 30)}
)
"""First and last degree of the three scales of a particle's shape. Where one scale ends is a choice:
degree l has 2 l waves round the particle, so these are more than 45, 45 to 12 and under 12 degrees."""

N_RESAMPLES = 1000
"""Bootstrap samples behind a confidence band."""


@dataclass(frozen=True, eq=False)
class PowerSpectrum(LockedRecord):
    """Variance per order at each degree: A_l, the mean of c_lm^2 over m.

    Not the "power" of pyshtools, which is (2 l + 1) / (4 pi) times as much in this convention.

    - ``values``: a_l for l = 0 .. l_max, shape (l_max + 1,), in squared units of the radius. Of a particle
      A_0 is c_00^2; of a sample it is the variance of c_00 (section 2.3).
    - ``mean_radius``: c_00 / sqrt(4 pi), of a sample its mean.
    - ``low``, ``high``: ends of the confidence band of each value, shape (l_max + 1,), or ``None``.
    """

    values: FloatArray
    mean_radius: float
    low: FloatArray | None = None
    high: FloatArray | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", locked_floats(self.values, (None,), "values"))
        for name in ("low", "high"):
            band = getattr(self, name)
            if band is not None:
                object.__setattr__(self, name, locked_floats(band, self.values.shape, name))

    @property
    def l_max(self) -> int:
        """Highest degree."""
        return len(self.values) - 1

    @property
    def relative_amplitudes(self) -> FloatArray:
        """sqrt(A_l) divided by the mean c_00, shape (l_max + 1,): free of the particle's size."""
        return np.asarray(np.sqrt(self.values) / (self.mean_radius * np.sqrt(4 * np.pi)))

    def deviation(self, first: int, last: int) -> float:
        """Root-mean-square share of the mean radius that the degrees `first` to `last` add (Parseval)."""
        degree = np.arange(max(first, 1), min(last, self.l_max) + 1)
        variance = float(((2 * degree + 1) * self.values[degree]).sum()) / (4 * np.pi)
        return float(np.sqrt(variance)) / self.mean_radius


def power_spectrum(coefficients: ShCoefficients) -> PowerSpectrum:
    """Spectrum of one particle: the mean of c_lm^2 over the orders of each degree."""
    degree = np.arange(coefficients.l_max + 1)
    sums = np.add.reduceat(coefficients.values**2, degree**2)
    return PowerSpectrum(sums / (2 * degree + 1), coefficients.mean_radius)


def roughness_split(spectrum: PowerSpectrum) -> dict[str, float]:
    """Root-mean-square deviation from a sphere on each scale, as a share of the mean radius."""
    return {name: spectrum.deviation(first, last) for name, (first, last) in DEGREE_RANGES.items()}


def sample_spectrum(particles: Sequence[ShCoefficients]) -> PowerSpectrum:
    """Spectrum of a sample, by the unbiased estimates of section 2.3, with bootstrap bands of 95 %.

    mu is the mean of c_00, A_0 its variance and A_l the mean of c_lm^2.

    The mean of c_lm for l >= 1 is zero by the model, so that nothing is subtracted there. The bands are
    percentiles over resampled particles, not over coefficients: those of one particle are not
    independent.

    ``particles``: coefficients of at least two particles; cut to the lowest degree among them.

    Raises InputError if there are fewer than two particles.
    """
    if len(particles) < 2:
        raise InputError(f"The spectrum of a sample needs at least two particles, got {len(particles)}.")
    l_max = min(particle.l_max for particle in particles)
    powers = np.stack([power_spectrum(particle.truncated(l_max)).values for particle in particles])
    firsts = np.array([particle.values[0] for particle in particles])
    # A fixed seed: the same sample has the same band in every figure and file.
    generator = np.random.default_rng(np.random.SeedSequence(0))
    resampled = np.empty((N_RESAMPLES, l_max + 1))
    for row in resampled:  # one resample at a time: a sample may have a hundred thousand particles
        pick = generator.integers(len(particles), size=len(particles))
        row[:] = np.bincount(pick, minlength=len(particles)) / len(particles) @ powers
        row[0] = firsts[pick].var(ddof=1)
    low, high = np.percentile(resampled, [2.5, 97.5], axis=0)
    estimate = powers.mean(axis=0)
    estimate[0] = firsts.var(ddof=1)
    return PowerSpectrum(estimate, float(firsts.mean() / np.sqrt(4 * np.pi)), low, high)
