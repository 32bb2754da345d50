"""Is a radius positive everywhere, not only at the nodes of a grid, and a particle of the right size?"""

from functools import lru_cache
from math import isqrt

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.legendre import harmonics
from regolith_studio.harmonics.sphere_grid import enclosed_volumes, sphere_grid

SAFE_SHARE = 0.15
"""Lowest radius on the coarse grid, as a share of the mean, above which no closer look is taken."""
CLOSE_LEVEL = 5


def positive_rows(coefficients: FloatArray) -> BoolArray:
    """Whether each radius function, rows of shape (n, (l_max + 1)^2), is positive, shape (n,).

    First on a Gauss-Legendre grid of twice the degree; those that come near zero there are looked at on
    ``icosphere(5)`` (10,242 directions).
    """
    l_max = isqrt(coefficients.shape[1]) - 1
    grid = sphere_grid(2 * l_max + 1, l_max)
    lowest = (coefficients @ grid.basis).min(axis=1)
    positive: BoolArray = (lowest > 0) & (coefficients[:, 0] > 0)
    mean = coefficients[:, 0] / np.sqrt(4 * np.pi)
    close = np.flatnonzero(positive & (lowest < SAFE_SHARE * mean))
    if len(close):
        positive[close] = (coefficients[close] @ _fine_basis(l_max)).min(axis=1) > 0
    return positive


def acceptable(bounds: tuple[float, float] | None, coefficients: FloatArray) -> BoolArray:
    """Whether each radius function is positive, and its equivalent radius inside `bounds`, shape (n,)."""
    good = positive_rows(coefficients)
    if bounds is not None:
        l_max = isqrt(coefficients.shape[1]) - 1
        grid = sphere_grid(3 * l_max // 2 + 1, l_max)
        sizes = np.cbrt(3 * np.abs(enclosed_volumes(coefficients @ grid.basis, grid)) / (4 * np.pi))
        good &= (sizes >= bounds[0]) & (sizes <= bounds[1])
    return good


@lru_cache(maxsize=2)
def _fine_basis(l_max: int) -> FloatArray:
    return harmonics(icosphere(CLOSE_LEVEL).vertices, l_max)
