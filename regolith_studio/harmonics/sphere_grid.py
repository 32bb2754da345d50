"""Many expansions at once: values on a Gauss-Legendre grid, and back, as products of matrices."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.legendre import harmonics

GRIDS_KEPT = 8
"""As many as the models use for one l_max; one of l_max = 30 takes up to 60 MB."""


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
    basis
        Y_lm at the nodes, shape ((l_max + 1)^2, k), so that ``coefficients @ basis`` are values.
    """

    directions: FloatArray
    weights: FloatArray
    basis: FloatArray

    def expanded(self, values: FloatArray) -> FloatArray:
        """Coefficients (n, (l_max + 1)^2) of functions given at the nodes (n, k)."""
        return np.asarray((values * self.weights) @ self.basis.T)


@lru_cache(maxsize=GRIDS_KEPT)
def sphere_grid(degree: int, l_max: int) -> SphereGrid:
    """The Gauss-Legendre grid of `degree` with harmonics up to `l_max`, kept and read-only."""
    cosines, weights = np.polynomial.legendre.leggauss(degree + 1)
    n_longitudes = 2 * degree + 1
    longitudes = np.tile(2 * np.pi * np.arange(n_longitudes) / n_longitudes, degree + 1)
    z = np.repeat(cosines, n_longitudes)
    ring = np.sqrt(1 - z**2)
    directions = np.column_stack([ring * np.cos(longitudes), ring * np.sin(longitudes), z])
    grid = SphereGrid(
        directions, np.repeat(weights * 2 * np.pi / n_longitudes, n_longitudes), harmonics(directions, l_max)
    )
    for array in (grid.directions, grid.weights, grid.basis):
        array.flags.writeable = False
    return grid


def enclosed_volumes(radii: FloatArray, grid: SphereGrid) -> FloatArray:
    """Volumes (n,) of radius functions given at the nodes, shape (n, k): integral of r^3 / 3."""
    return np.asarray((radii * radii * radii) @ grid.weights / 3)
