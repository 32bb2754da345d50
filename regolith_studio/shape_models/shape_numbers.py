"""A particle in a few numbers: size, form, power of its surface at each degree, share of its convex hull.

The surface is what is left of ln r when that of the ellipsoid of inertia is taken away; its power at degree l
is the sum of the squared coefficients. Columns of tables of numbers, with d = l_max + 4 of them::

    ln r_eq | ln(long / middle), ln(middle / short) | ln P_1 .. ln P_l_max | ln(s / (1 - s))

where long, middle and short are the axes of the ellipsoid and s is the share of the hull that is filled.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.shape_models.forms import forms, log_ellipsoids
from regolith_studio.shape_models.hull_radii import HullGrid, hull_grid
from regolith_studio.shape_models.principal_axes import principal_axes

SIZE, FORM = 0, slice(1, 3)
POWERS = slice(3, -1)
CONVEXITY = -1
LEAST_DEGREE = 13
OVERSAMPLING = 1.6
"""Degree of the grid over that of the particles: with 1.3 hulls come out 0.8 % too large, with 1.6 0.1 %."""
LEAST_POWER = 1e-12
LEAST_SHARE = 1e-4
"""Of the hull, or of what is missing to it."""
_LEAST_RADIUS = 1e-3
_BATCH = 500


def shape_grid(l_max: int) -> HullGrid:
    """The grid on which shapes of degree `l_max` are measured and made."""
    return hull_grid(max(LEAST_DEGREE, int(OVERSAMPLING * l_max)), l_max)


def shape_numbers(coefficients: FloatArray) -> FloatArray:
    """The numbers of radius functions (n, (l_max + 1)^2), shape (n, d)."""
    parts = [_of_batch(coefficients[i : i + _BATCH]) for i in range(0, len(coefficients), _BATCH)]
    return np.concatenate(parts)


def powers(rows: FloatArray) -> FloatArray:
    """Sum of squares at each degree, shape (n, l_max + 1)."""
    return np.asarray(np.add.reduceat(rows**2, np.arange(round(rows.shape[1] ** 0.5)) ** 2, axis=1))


def with_powers(rows: FloatArray, wanted: FloatArray) -> FloatArray:
    """The rows with the power wanted (n, l_max + 1) at each degree from the first on."""
    factors = np.sqrt(wanted / np.maximum(powers(rows), 1e-300))
    factors[:, 0] = 1.0
    return np.asarray(rows * factors[:, degrees(rows.shape[1])])


def log_shape_numbers(rows: FloatArray, equivalent_radii: FloatArray) -> FloatArray:
    """The numbers of the exponentials of expansions (n, (l_max + 1)^2) with these sizes, shape (n, d).

    The exponential is not cut to the degree: that would take from the surface what it has beyond.
    """
    shapes = shape_grid(round(rows.shape[1] ** 0.5) - 1)
    logs = rows @ shapes.grid.basis
    form, axes = forms(logs, shapes.grid)
    radii = np.exp(logs - logs.mean(axis=1, keepdims=True))
    return _table(shapes, np.log(equivalent_radii), form, axes, radii)


def log_share(shares: FloatArray) -> FloatArray:
    """ln(s / (1 - s)), s kept off zero and one."""
    kept = np.clip(shares, LEAST_SHARE, 1 - LEAST_SHARE)
    return np.asarray(np.log(kept / (1 - kept)))


def _of_batch(coefficients: FloatArray) -> FloatArray:
    shapes = shape_grid(round(coefficients.shape[1] ** 0.5) - 1)
    found = principal_axes(coefficients)
    form = np.diff(found.log_ratios, axis=1)[:, ::-1]
    means = coefficients[:, :1] / np.sqrt(4 * np.pi)
    radii = np.maximum(coefficients @ shapes.grid.basis / means, _LEAST_RADIUS)
    return _table(shapes, np.log(3 * found.volumes / (4 * np.pi)) / 3, form, found.axes, radii)


def _table(
    shapes: HullGrid, log_sizes: FloatArray, form: FloatArray, axes: FloatArray, radii: FloatArray
) -> FloatArray:
    ellipsoids = log_ellipsoids(shapes.grid.directions, form, axes)
    surface = powers(shapes.grid.expanded(np.log(radii) - ellipsoids))[:, 1:]
    shares = log_share(shapes.convexities(radii))
    return np.column_stack([log_sizes, form, np.log(np.maximum(surface, LEAST_POWER)), shares])
