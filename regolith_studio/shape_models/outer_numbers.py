"""What is seen of a particle from outside, quickly and on a grid: extents, sphericity, share of its hull.

They stand for the descriptors of meshes where thousands of particles are compared at every step of a fit.
"""

from functools import lru_cache

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.legendre import harmonics
from regolith_studio.shape_models.forms import forms
from regolith_studio.shape_models.shape_numbers import log_share, shape_grid

SPHERICITY = 1
_STEP = 1e-4
_LEAST_RADIUS = 1e-3


def outer_numbers(log_radii: FloatArray, slopes: FloatArray, shares: FloatArray, l_max: int) -> FloatArray:
    """Columns ln(longest / shortest extent along the axes of inertia), and ln(s / (1 - s)) of the sphericity
    and of the share of the hull, shape (n, 3).

    Parameters
    ----------
    log_radii, slopes
        ln r and the squared length of its gradient on the unit sphere, at the nodes of
        ``shape_grid(l_max)``, shapes (n, k).
    shares
        ln(s / (1 - s)) of the share of the hull that is filled, shape (n,).
    """
    grid = shape_grid(l_max).grid
    radii = np.exp(log_radii - log_radii.mean(axis=1, keepdims=True))
    volumes, areas = radii**3 @ grid.weights / 3, (radii**2 * np.sqrt(1 + slopes)) @ grid.weights
    sphericity = np.pi ** (1 / 3) * (6 * volumes) ** (2 / 3) / areas
    _, axes = forms(log_radii, grid)
    extents = [np.ptp((grid.directions @ axes[:, :, i].T).T * radii, axis=1) for i in range(3)]
    ratio = np.log(np.max(extents, axis=0) / np.min(extents, axis=0))
    return np.column_stack([ratio, log_share(sphericity), shares])


def of_radii(coefficients: FloatArray, shares: FloatArray) -> FloatArray:
    """Those of radius functions (n, (l_max + 1)^2)."""
    l_max = round(coefficients.shape[1] ** 0.5) - 1
    rows = coefficients / (coefficients[:, :1] / np.sqrt(4 * np.pi))
    radii = np.maximum(rows @ shape_grid(l_max).grid.basis, _LEAST_RADIUS)
    return outer_numbers(np.log(radii), _squared_slopes(rows, l_max) / radii**2, shares, l_max)


def of_log_radii(rows: FloatArray, shares: FloatArray) -> FloatArray:
    """Those of the exponentials of expansions (n, (l_max + 1)^2)."""
    l_max = round(rows.shape[1] ** 0.5) - 1
    return outer_numbers(rows @ shape_grid(l_max).grid.basis, _squared_slopes(rows, l_max), shares, l_max)


def _squared_slopes(rows: FloatArray, l_max: int) -> FloatArray:
    along, across = _slope_bases(l_max)
    return np.asarray((rows @ along) ** 2 + (rows @ across) ** 2)


@lru_cache(maxsize=2)
def _slope_bases(l_max: int) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the harmonics along two tangents at the nodes, by central differences."""
    u = shape_grid(l_max).grid.directions
    away = np.where(np.abs(u[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    first = np.cross(away, u)
    first /= np.linalg.norm(first, axis=1, keepdims=True)

    def slope(tangent: FloatArray) -> FloatArray:
        ends = [harmonics(np.cos(_STEP) * u + sign * np.sin(_STEP) * tangent, l_max) for sign in (1, -1)]
        found = (ends[0] - ends[1]) / (2 * _STEP)
        found.flags.writeable = False
        return found

    return slope(first), slope(np.cross(u, first))
