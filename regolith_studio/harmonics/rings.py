"""Functions on rings of equal latitude to coefficients and back: an FFT along rings, Legendre sums across.

SHTOOLS does the same, but lets FFTW time its plans (``FFTW_MEASURE``): another process, or a busier machine,
then rounds otherwise. Here the same samples give the same bits.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.harmonics.legendre import fill_legendre, legendre_factors


def analysed(samples: FloatArray, cosines: FloatArray, weights: FloatArray, l_max: int) -> FloatArray:
    """Coefficients up to `l_max` by quadrature, shape ((l_max + 1)^2,), index k = l^2 + l + m.

    Parameters
    ----------
    samples
        At longitudes 2 pi j / n of each ring, shape (rings, n) with n > 2 `l_max`.
    cosines, weights
        Of the polar angle of each ring, and its quadrature weight; the weights sum to 2.
    """
    n = samples.shape[1]
    waves = np.fft.rfft(samples, axis=1)[:, : l_max + 1] * (2 * np.pi / n * weights)[:, None]
    values = np.zeros((l_max + 1) ** 2)
    _sum_over_rings(waves.real.copy(), -waves.imag, cosines, values)
    return values


def synthesised(values: FloatArray, cosines: FloatArray, n_longitudes: int) -> FloatArray:
    """The function with coefficients `values`, shape ((l_max + 1)^2,), on rings: :func:`analysed` undone.

    `n_longitudes` must be greater than 2 l_max.
    """
    even, odd = np.zeros((2, len(cosines), round(len(values) ** 0.5)))
    _sum_over_degrees(values, cosines, even, odd)
    waves = (even - 1j * odd) * (n_longitudes / 2)
    waves[:, 0] *= 2.0
    return np.fft.irfft(waves, n_longitudes, axis=1)


@kernel
def _sum_over_rings(even: FloatArray, odd: FloatArray, cosines: FloatArray, values: FloatArray) -> None:
    """Add cosine and sine waves (rings, l_max + 1) times the Legendre functions to `values`."""
    l_max = even.shape[1] - 1
    factors, p = legendre_factors(l_max), np.zeros((l_max + 1, l_max + 1))
    for i in range(len(cosines)):
        fill_legendre(cosines[i], np.sqrt(max(0.0, 1.0 - cosines[i] ** 2)), factors, p)
        for l in range(l_max + 1):  # noqa: E741
            values[l * l + l] += p[l, 0] * even[i, 0]
            for m in range(1, l + 1):
                values[l * l + l + m] += p[l, m] * even[i, m]
                values[l * l + l - m] += p[l, m] * odd[i, m]


@kernel
def _sum_over_degrees(values: FloatArray, cosines: FloatArray, even: FloatArray, odd: FloatArray) -> None:
    """Add amplitudes of cosine and sine waves on each ring to `even` and `odd`, shape (rings, l_max + 1)."""
    l_max = even.shape[1] - 1
    factors, p = legendre_factors(l_max), np.zeros((l_max + 1, l_max + 1))
    for i in range(len(cosines)):
        fill_legendre(cosines[i], np.sqrt(max(0.0, 1.0 - cosines[i] ** 2)), factors, p)
        for l in range(l_max + 1):  # noqa: E741
            even[i, 0] += p[l, 0] * values[l * l + l]
            for m in range(1, l + 1):
                even[i, m] += p[l, m] * values[l * l + l + m]
                odd[i, m] += p[l, m] * values[l * l + l - m]
