"""Real orthonormal spherical harmonics at directions, and transforms on rings of latitude.

The Legendre functions come from stable recursions. The transforms of one function are an FFT along each ring
and Legendre sums across the rings; those of many are products of matrices, Legendre sums and sums of waves
apart: at l_max = 30 a twentieth of the work of one product with all harmonics at all nodes.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from math import isqrt

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel

# SHTOOLS has the same transforms, but lets FFTW choose its plans by timing (``FFTW_MEASURE``): the last bits
# of a result then depend on the process and on the load of the machine (one in seven processes differed).
# Here they do not. On the grid of degree 60 these take .05 to .1 ms at l_max = 10 and .8 at 60, and those of
# SHTOOLS .13 and .2.


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


@inner_kernel
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
        # At the poles, where all orders above 0 vanish, any longitude will do.
        c1, s1 = (x / sine, y / sine) if sine > 0.0 else (1.0, 0.0)
        c, s = 1.0, 0.0
        for m in range(l_max + 1):
            for l in range(m, l_max + 1):  # noqa: E741
                basis[l * l + l + m, i] = p[l, m] * c
                if m > 0:
                    basis[l * l + l - m, i] = p[l, m] * s
            # The next cosine and sine by addition of angles, in place of a call for each order.
            c, s = c * c1 - s * s1, s * c1 + c * s1


def harmonics(directions: FloatArray, l_max: int) -> FloatArray:
    """Y_lm at unit `directions` (n, 3), shape ((l_max + 1)^2, n), row k = l^2 + l + m."""
    basis = np.empty(((l_max + 1) ** 2, len(directions)))
    fill_basis(np.ascontiguousarray(directions, dtype=np.float64), l_max, basis)
    return basis


def ring_nodes(cosines: FloatArray, weights: FloatArray, n_longitudes: int) -> tuple[FloatArray, FloatArray]:
    """Unit vectors (n, 3) and solid angles (n,) of evenly spaced points on rings of latitude, ring by ring.

    ``cosines``, ``weights``: of the polar angle of each ring, and its quadrature weight; the weights sum to
    2. ``n_longitudes``: on each ring; the first is 0.
    """
    longitudes = np.tile(2 * np.pi * np.arange(n_longitudes) / n_longitudes, len(cosines))
    z = np.repeat(cosines, n_longitudes)
    ring = np.sqrt(1 - z**2)
    directions = np.column_stack([ring * np.cos(longitudes), ring * np.sin(longitudes), z])
    return directions, np.repeat(weights * 2 * np.pi / n_longitudes, n_longitudes)


def analyse_rings(samples: FloatArray, cosines: FloatArray, weights: FloatArray, l_max: int) -> FloatArray:
    """Coefficients up to `l_max` of a function on rings of latitude, by quadrature.

    ``samples``: at longitudes 2 pi j / n of each ring, shape (rings, n) with n > 2 `l_max`. ``cosines``,
    ``weights``: of the polar angle of each ring, and its quadrature weight; the weights sum to 2.

    Returns shape ((l_max + 1)^2,), index k = l^2 + l + m.
    """
    n = samples.shape[1]
    waves = np.fft.rfft(samples, axis=1)[:, : l_max + 1] * (2 * np.pi / n * weights)[:, None]
    values = np.zeros((l_max + 1) ** 2)
    # rfft sums with exp(-i m phi), so that the sine waves are minus its imaginary part; the copy is
    # contiguous, which the kernel is compiled for.
    _sum_over_rings(waves.real.copy(), -waves.imag, cosines, l_max, values)
    return values


def synthesise_rings(values: FloatArray, cosines: FloatArray, n_longitudes: int) -> FloatArray:
    """Values on rings of the function with given coefficients: inverse of :func:`analyse_rings`.

    - ``values``: coefficients, shape ((l_max + 1)^2,).
    - ``cosines``: of the polar angle of each ring.
    - ``n_longitudes``: greater than 2 l_max.

    Returns shape (rings, n_longitudes).
    """
    l_max = isqrt(len(values)) - 1
    even, odd = np.zeros((len(cosines), l_max + 1)), np.zeros((len(cosines), l_max + 1))
    _sum_over_degrees(values, cosines, even, odd)
    waves = (even - 1j * odd) * (n_longitudes / 2)
    # irfft adds the conjugate of every wave but the constant one.
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


# Not the transforms of single fits, because of the tables: made once, they let models draw thousands of
# particles; at the degrees that fits may have, up to 500, they would need gigabytes. And a fit is the input
# of coarsening, whose results must not depend on the processor, as products by BLAS do.


GRIDS_KEPT = 8
"""As many as the models use for one l_max."""
VALUES_AT_ONCE = 1_000_000
"""At the nodes of a grid, 8 MB: rows are taken in blocks, so that thousands of expansions need no more."""


@dataclass(frozen=True, eq=False)
class RingBasis:
    """Harmonics on rings of latitude with evenly spaced longitudes.

    - ``legendre``: for each order m the Legendre functions of degrees m to l_max on the rings, shape (l_max
      + 1 - m, rings).
    - ``waves``: cosines of orders 0 to l_max, and sines of orders 1 to l_max, along a ring, shape (2 l_max +
      1, longitudes).
    """

    legendre: tuple[FloatArray, ...]
    waves: FloatArray

    def values(self, coefficients: FloatArray) -> FloatArray:
        """Values (n, rings * longitudes), ring by ring, of expansions (n, (l_max + 1)^2)."""
        l_max, rings = len(self.legendre) - 1, self.legendre[0].shape[1]
        amplitudes = np.empty((len(coefficients), rings, 2 * l_max + 1))
        for m, functions in enumerate(self.legendre):
            zonal = _zonal(m, l_max)
            amplitudes[:, :, m] = coefficients[:, zonal + m] @ functions
            if m:
                amplitudes[:, :, l_max + m] = coefficients[:, zonal - m] @ functions
        return (amplitudes.reshape(-1, 2 * l_max + 1) @ self.waves).reshape(len(coefficients), -1)

    def sums(self, values: FloatArray) -> FloatArray:
        """Sums (n, (l_max + 1)^2) over all nodes of values (n, rings * longitudes) times each harmonic."""
        l_max, rings = len(self.legendre) - 1, self.legendre[0].shape[1]
        amplitudes = (values.reshape(len(values) * rings, -1) @ self.waves.T).reshape(len(values), rings, -1)
        totals = np.empty((len(values), (l_max + 1) ** 2))
        for m, functions in enumerate(self.legendre):
            zonal = _zonal(m, l_max)
            totals[:, zonal + m] = amplitudes[:, :, m] @ functions.T
            if m:
                totals[:, zonal - m] = amplitudes[:, :, l_max + m] @ functions.T
        return totals


def ring_basis(cosines: FloatArray, n_longitudes: int, l_max: int) -> RingBasis:
    """Harmonics up to `l_max` on rings with these cosines of the colatitude, shape (rings,).

    The first longitude is 0.
    """
    meridian = np.column_stack([np.sqrt(1 - cosines**2), np.zeros(len(cosines)), cosines])
    functions = harmonics(meridian, l_max)
    angles = np.outer(np.arange(l_max + 1), 2 * np.pi * np.arange(n_longitudes) / n_longitudes)
    waves = np.concatenate([np.cos(angles), np.sin(angles[1:])])
    return RingBasis(tuple(functions[_zonal(m, l_max) + m] for m in range(l_max + 1)), waves)


def _zonal(m: int, l_max: int) -> IntArray:
    """Indices of the harmonics of order 0 with degrees m to `l_max`."""
    degree = np.arange(m, l_max + 1)
    return degree * degree + degree


@dataclass(frozen=True, eq=False)
class SphereGrid:
    """A quadrature rule with the harmonics at its nodes.

    - ``directions``: unit vectors, shape (k, 3).
    - ``weights``: solid angles, shape (k,), with sum 4 pi; products of functions are integrated exactly as
      long as their degrees add up to at most twice the degree of the grid.
    - ``rings``: harmonics at the nodes.
    """

    directions: FloatArray
    weights: FloatArray
    rings: RingBasis

    def values(self, coefficients: FloatArray) -> FloatArray:
        """Values (n, k) at the nodes of expansions (n, (l_max + 1)^2)."""
        return self.rings.values(coefficients)

    def blocks(self, coefficients: FloatArray) -> Iterator[tuple[slice, FloatArray]]:
        """Blocks of rows of `coefficients`, with their :meth:`values`."""
        step = max(1, VALUES_AT_ONCE // len(self.weights))
        for first in range(0, len(coefficients), step):
            rows = slice(first, first + step)
            yield rows, self.values(coefficients[rows])

    def lowest(self, coefficients: FloatArray) -> FloatArray:
        """Smallest value (n,) at the nodes of expansions (n, (l_max + 1)^2)."""
        minima = np.empty(len(coefficients))
        for rows, values in self.blocks(coefficients):
            minima[rows] = values.min(axis=1)
        return minima

    def expanded(self, values: FloatArray) -> FloatArray:
        """Coefficients (n, (l_max + 1)^2) of functions given at the nodes (n, k)."""
        return self.rings.sums(values * self.weights)


@lru_cache(maxsize=GRIDS_KEPT)
def sphere_grid(degree: int, l_max: int) -> SphereGrid:
    """The Gauss-Legendre grid of `degree` with harmonics up to `l_max`, kept and read-only."""
    cosines, weights = np.polynomial.legendre.leggauss(degree + 1)
    n_longitudes = 2 * degree + 1
    directions, solid_angles = ring_nodes(cosines, weights, n_longitudes)
    for array in (directions, solid_angles):
        array.flags.writeable = False
    return SphereGrid(directions, solid_angles, ring_basis(cosines, n_longitudes, l_max))


def enclosed_volumes(radii: FloatArray, grid: SphereGrid) -> FloatArray:
    """Volumes (n,) of radius functions given at the nodes, shape (n, k): integral of r^3 / 3."""
    return np.asarray((radii * radii * radii) @ grid.weights / 3)


def expanded_volumes(coefficients: FloatArray, grid: SphereGrid, exponential: bool = False) -> FloatArray:
    """Volumes (n,) of expansions (n, (l_max + 1)^2) of r, or of ln r if `exponential`."""
    volumes = np.empty(len(coefficients))
    for rows, values in grid.blocks(coefficients):
        volumes[rows] = enclosed_volumes(np.exp(values) if exponential else values, grid)
    return volumes
