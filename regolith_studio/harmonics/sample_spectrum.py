"""The angular power spectrum of a sample of particles, with bootstrap confidence bands."""

from collections.abc import Sequence

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.spectrum import PowerSpectrum

N_RESAMPLES = 1000


def sample_spectrum(
    particles: Sequence[ShCoefficients],
    confidence: float = 0.95,
    rng: np.random.Generator | None = None,
) -> PowerSpectrum:
    """Unbiased estimates of section 2.3: mu = mean of c_00, A_0 its variance, A_l = mean of c_lm^2.

    The mean of c_lm for l >= 1 is zero by the model, so that nothing is subtracted there. The bands are
    percentiles over resampled particles, not over coefficients: those of one particle are not
    independent.

    Parameters
    ----------
    particles
        Coefficients of at least two particles; cut to the lowest degree among them.
    confidence
        Share that the band holds.
    rng
        Source of the resampling; a fixed one if ``None``.

    Raises
    ------
    InputError
        If there are fewer than two particles.
    """
    if len(particles) < 2:
        raise InputError(f"The spectrum of a sample needs at least two particles, got {len(particles)}.")
    l_max = min(particle.l_max for particle in particles)
    powers = np.stack([particle.truncated(l_max).power_spectrum().values for particle in particles])
    firsts = np.array([particle.values[0] for particle in particles])
    generator = np.random.default_rng(np.random.SeedSequence(0)) if rng is None else rng
    resampled = np.empty((N_RESAMPLES, l_max + 1))
    for row in resampled:  # one resample at a time: a sample may have a hundred thousand particles
        pick = generator.integers(len(particles), size=len(particles))
        row[:] = np.bincount(pick, minlength=len(particles)) / len(particles) @ powers
        row[0] = firsts[pick].var(ddof=1)
    tail = 50 * (1 - confidence)
    low, high = np.percentile(resampled, [tail, 100 - tail], axis=0)
    return PowerSpectrum(_estimate(powers, firsts), float(firsts.mean() / np.sqrt(4 * np.pi)), low, high)


def _estimate(powers: FloatArray, firsts: FloatArray) -> FloatArray:
    """A_l of the sample, shape (l_max + 1,), from A_l (n, l_max + 1) and c_00 (n,) of its particles."""
    spectrum = powers.mean(axis=0)
    spectrum[0] = firsts.var(ddof=1)
    return np.asarray(spectrum)
