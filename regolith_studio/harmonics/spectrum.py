"""Angular power spectra of particles and samples, and the shares of form, roundness and roughness."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, locked_floats
from regolith_studio.harmonics.coefficients import ShCoefficients

DEGREE_RANGES: Mapping[str, tuple[int, int]] = MappingProxyType(
    {"form": (1, 4), "roundness": (5, 15), "roughness": (16, 30)}
)
"""First and last degree of the three scales of a particle's shape. Where one scale ends is a choice:
degree l has 2 l waves round the particle, so these are more than 45, 45 to 12 and under 12 degrees."""

N_RESAMPLES = 1000
"""Bootstrap samples behind a confidence band."""


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

    Parameters
    ----------
    particles
        Coefficients of at least two particles; cut to the lowest degree among them.

    Raises
    ------
    InputError
        If there are fewer than two particles.
    """
    if len(particles) < 2:
        raise InputError(f"The spectrum of a sample needs at least two particles, got {len(particles)}.")
    l_max = min(particle.l_max for particle in particles)
    powers = np.stack([power_spectrum(particle.truncated(l_max)).values for particle in particles])
    firsts = np.array([particle.values[0] for particle in particles])
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
