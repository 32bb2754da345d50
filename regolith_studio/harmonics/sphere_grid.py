"""Many expansions at once: values on rings of latitude, and back, as products of matrices.

Legendre sums across the rings and sums of waves along them are separate products: at l_max = 30 a
twentieth of the work of one product with all harmonics at all nodes.
"""

# Not the transforms of single fits, because of the tables: made once, they let models draw thousands of
# particles; at the degrees that fits may have, up to 500, they would need gigabytes. And a fit is the input
# of coarsening, whose results must not depend on the processor, as products by BLAS do.

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.harmonics.legendre import harmonics, ring_nodes

GRIDS_KEPT = 8
"""As many as the models use for one l_max."""
VALUES_AT_ONCE = 1_000_000
"""At the nodes of a grid, 8 MB: rows are taken in blocks, so that thousands of expansions need no more."""


@dataclass(frozen=True, eq=False)
class RingBasis:
    """Harmonics on rings of latitude with evenly spaced longitudes.

    Parameters
    ----------
    legendre
        For each order m the Legendre functions of degrees m to l_max on the rings, shape
        (l_max + 1 - m, rings).
    waves
        Cosines of orders 0 to l_max, and sines of orders 1 to l_max, along a ring, shape
        (2 l_max + 1, longitudes).
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
        found = np.empty((len(values), (l_max + 1) ** 2))
        for m, functions in enumerate(self.legendre):
            zonal = _zonal(m, l_max)
            found[:, zonal + m] = amplitudes[:, :, m] @ functions.T
            if m:
                found[:, zonal - m] = amplitudes[:, :, l_max + m] @ functions.T
        return found


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

    Parameters
    ----------
    directions
        Unit vectors, shape (k, 3).
    weights
        Solid angles, shape (k,), with sum 4 pi; products of functions are integrated exactly as long as
        their degrees add up to at most twice the degree of the grid.
    rings
        Harmonics at the nodes.
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
        found = np.empty(len(coefficients))
        for rows, values in self.blocks(coefficients):
            found[rows] = values.min(axis=1)
        return found

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
    found = np.empty(len(coefficients))
    for rows, values in grid.blocks(coefficients):
        found[rows] = enclosed_volumes(np.exp(values) if exponential else values, grid)
    return found
