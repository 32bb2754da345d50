"""The angular power spectrum of a particle, and what it says about form and roughness."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import chdtri

from regolith_studio.geometry.arrays import FloatArray, locked_floats

DEGREE_RANGES: Mapping[str, tuple[int, int]] = MappingProxyType(
    {"form": (1, 4), "roundness": (5, 15), "roughness": (16, 30)}
)
"""First and last degree of the three scales of a particle's shape. Where one scale ends is a choice:
degree l has 2 l waves round the particle, so these are more than 45, 45 to 12 and under 12 degrees."""


@dataclass(frozen=True, eq=False)
class PowerSpectrum:
    """Variance per order at each degree: A_l, the mean of c_lm^2 over m.

    Not the "power" of pyshtools, which is (2 l + 1) / (4 pi) times as much in this convention.

    Parameters
    ----------
    values
        A_l for l = 0 .. l_max, shape (l_max + 1,), in squared units of the radius. Of a particle
        A_0 is c_00^2; of a sample it is the variance of c_00 (section 2.3).
    mean_radius
        c_00 / sqrt(4 pi), of a sample its mean.
    low, high
        Ends of the confidence band of each value, shape (l_max + 1,), or ``None``.
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

    def __reduce__(self) -> tuple[Callable[..., "PowerSpectrum"], tuple[ArrayLike | None, ...]]:
        return PowerSpectrum, (self.values, self.mean_radius, self.low, self.high)

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


def roughness_split(
    spectrum: PowerSpectrum, ranges: Mapping[str, tuple[int, int]] = DEGREE_RANGES
) -> dict[str, float]:
    """Root-mean-square deviation from a sphere on each scale, as a share of the mean radius."""
    return {name: spectrum.deviation(first, last) for name, (first, last) in ranges.items()}


def with_gaussian_band(spectrum: PowerSpectrum, confidence: float = 0.95) -> PowerSpectrum:
    """A particle's spectrum with the band in which the true A_l of a Gaussian field lies.

    (2 l + 1) times the estimate over the true value follows chi-square with 2 l + 1 degrees of freedom.
    """
    freedom = 2 * np.arange(spectrum.l_max + 1) + 1
    tail = (1 - confidence) / 2
    low = spectrum.values * freedom / chdtri(freedom, tail)
    high = spectrum.values * freedom / chdtri(freedom, 1 - tail)
    return PowerSpectrum(spectrum.values, spectrum.mean_radius, low, high)
