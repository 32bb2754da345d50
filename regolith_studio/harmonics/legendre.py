"""Real orthonormal spherical harmonics at directions, and transforms on rings of latitude.

The Legendre functions come from stable recursions. The transforms are an FFT along each ring and Legendre
sums across the rings.
"""

# SHTOOLS has the same transforms, but lets FFTW choose its plans by timing (``FFTW_MEASURE``): the last bits
# of a result then depend on the process and on the load of the machine (one in seven processes differed).
# Here they do not. On the grid of degree 60 these take .05 to .1 ms at l_max = 10 and .8 at 60, and those of
# SHTOOLS .13 and .2.

from math import isqrt

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel


@kernel
def legendre_factors(l_max: int) -> FloatArray:
    """Square roots of the recursions below, the same for all angles, shape (2, l_max + 1, l_max + 1)."""
    factors = np.zeros((2, l_max + 1, l_max + 1))
    for m in range(l_max + 1):
        if m > 0:
            factors[0, m, m] = np.sqrt((2.0 * m + 1.0) / (2.0 * m))
        if m < l_max:
            factors[0, m + 1, m] = np.sqrt(2.0 * m + 3.0)
        for l in range(m + 2, l_max + 1):  # noqa: E741
            factors[0, l, m] = np.sqrt((4.0 * l * l - 1.0) / (l * l - m * m))
            factors[1, l, m] = np.sqrt(((l - 1.0) * (l - 1.0) - m * m) / (4.0 * (l - 1.0) * (l - 1.0) - 1.0))
    return factors


@kernel
def fill_legendre(cosine: float, sine: float, factors: FloatArray, p: FloatArray) -> None:
    """Orthonormal associated Legendre functions into `p` (l_max + 1, l_max + 1), index [l, m], m <= l.

    No Condon-Shortley phase. The factor sqrt(2) of m > 0 is included, so that Y_lm is the entry times
    cos(m phi) or sin(m phi). Columns run upward in l from P_mm, which is stable. `factors` are those of
    :func:`legendre_factors` for the same degree.
    """
    l_max = len(p) - 1
    diagonal = np.sqrt(1.0 / (4.0 * np.pi))
    for m in range(l_max + 1):
        if m > 0:
            diagonal *= sine * factors[0, m, m]
        p[m, m] = diagonal * (np.sqrt(2.0) if m > 0 else 1.0)
        if m < l_max:
            p[m + 1, m] = factors[0, m + 1, m] * cosine * p[m, m]
        for l in range(m + 2, l_max + 1):  # noqa: E741
            p[l, m] = factors[0, l, m] * (cosine * p[l - 1, m] - factors[1, l, m] * p[l - 2, m])


@kernel
def fill_basis(directions: FloatArray, l_max: int, basis: FloatArray) -> None:
    """Y_lm at unit `directions` (n, 3) into `basis` ((l_max + 1)^2, n), row k = l^2 + l + m."""
    factors, p = legendre_factors(l_max), np.zeros((l_max + 1, l_max + 1))
    for i in range(len(directions)):
        x, y, z = directions[i, 0], directions[i, 1], directions[i, 2]
        sine = np.sqrt(x * x + y * y)
        fill_legendre(z, sine, factors, p)
        c1, s1 = (x / sine, y / sine) if sine > 0.0 else (1.0, 0.0)
        c, s = 1.0, 0.0
        for m in range(l_max + 1):
            for l in range(m, l_max + 1):  # noqa: E741
                basis[l * l + l + m, i] = p[l, m] * c
                if m > 0:
                    basis[l * l + l - m, i] = p[l, m] * s
            c, s = c * c1 - s * s1, s * c1 + c * s1


def harmonics(directions: FloatArray, l_max: int) -> FloatArray:
    """Y_lm at unit `directions` (n, 3), shape ((l_max + 1)^2, n), row k = l^2 + l + m."""
    basis = np.empty(((l_max + 1) ** 2, len(directions)))
    fill_basis(np.ascontiguousarray(directions, dtype=np.float64), l_max, basis)
    return basis


def ring_nodes(cosines: FloatArray, weights: FloatArray, n_longitudes: int) -> tuple[FloatArray, FloatArray]:
    """Unit vectors (n, 3) and solid angles (n,) of evenly spaced points on rings of latitude, ring by ring.

    Parameters
    ----------
    cosines, weights
        Of the polar angle of each ring, and its quadrature weight; the weights sum to 2.
    n_longitudes
        On each ring; the first is 0.
    """
    longitudes = np.tile(2 * np.pi * np.arange(n_longitudes) / n_longitudes, len(cosines))
    z = np.repeat(cosines, n_longitudes)
    ring = np.sqrt(1 - z**2)
    directions = np.column_stack([ring * np.cos(longitudes), ring * np.sin(longitudes), z])
    return directions, np.repeat(weights * 2 * np.pi / n_longitudes, n_longitudes)


def analyse_rings(samples: FloatArray, cosines: FloatArray, weights: FloatArray, l_max: int) -> FloatArray:
    """Coefficients up to `l_max` of a function on rings of latitude, by quadrature.

    Parameters
    ----------
    samples
        At longitudes 2 pi j / n of each ring, shape (rings, n) with n > 2 `l_max`.
    cosines, weights
        Of the polar angle of each ring, and its quadrature weight; the weights sum to 2.

    Returns
    -------
    ndarray
        Shape ((l_max + 1)^2,), index k = l^2 + l + m.
    """
    n = samples.shape[1]
    waves = np.fft.rfft(samples, axis=1)[:, : l_max + 1] * (2 * np.pi / n * weights)[:, None]
    values = np.zeros((l_max + 1) ** 2)
    _sum_over_rings(waves.real.copy(), -waves.imag, cosines, l_max, values)
    return values


def synthesise_rings(values: FloatArray, cosines: FloatArray, n_longitudes: int) -> FloatArray:
    """Values on rings of the function with given coefficients: inverse of :func:`analyse_rings`.

    Parameters
    ----------
    values
        Coefficients, shape ((l_max + 1)^2,).
    cosines
        Of the polar angle of each ring.
    n_longitudes
        Greater than 2 l_max.

    Returns
    -------
    ndarray
        Shape (rings, n_longitudes).
    """
    l_max = isqrt(len(values)) - 1
    even, odd = np.zeros((len(cosines), l_max + 1)), np.zeros((len(cosines), l_max + 1))
    _sum_over_degrees(values, cosines, even, odd)
    waves = (even - 1j * odd) * (n_longitudes / 2)
    waves[:, 0] *= 2.0
    return np.fft.irfft(waves, n_longitudes, axis=1)


@kernel
def _sum_over_rings(
    even: FloatArray, odd: FloatArray, cosines: FloatArray, l_max: int, values: FloatArray
) -> None:
    """Add the cosine and sine waves (rings, l_max + 1) times the Legendre functions to `values`."""
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
    """Add the amplitudes of cosine and sine waves on each ring to `even` and `odd` (rings, l_max + 1)."""
    l_max = even.shape[1] - 1
    factors, p = legendre_factors(l_max), np.zeros((l_max + 1, l_max + 1))
    for i in range(len(cosines)):
        fill_legendre(cosines[i], np.sqrt(max(0.0, 1.0 - cosines[i] ** 2)), factors, p)
        for l in range(l_max + 1):  # noqa: E741
            even[i, 0] += p[l, 0] * values[l * l + l]
            for m in range(1, l + 1):
                even[i, m] += p[l, m] * values[l * l + l + m]
                odd[i, m] += p[l, m] * values[l * l + l - m]
