"""Shape features of particles for models: size, form, power at each degree, convexity, and outer features.

The surface is ln r minus that of the ellipsoid of inertia; its power at degree l is the sum of the squared
coefficients. Columns of tables of features, with d = l_max + 4 of them::

    ln r_eq | ln(long / middle), ln(middle / short) | ln P_1 .. ln P_l_max | ln(s / (1 - s))

where long, middle and short are the axes of the ellipsoid and s is the share of the hull that is filled.
Outer features (extents, sphericity, share of the hull) stand for the descriptors of meshes where thousands of
particles are compared at every step of a fit.
"""

from functools import lru_cache

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.harmonics.sphere_grid import harmonics
from regolith_studio.shape_models.convex_hull import HullGrid, hull_grid
from regolith_studio.shape_models.inertia_ellipsoid import forms, log_ellipsoids, principal_axes

SIZE, FORM = 0, slice(1, 3)
POWERS = slice(3, -1)
CONVEXITY = -1
MIN_DEGREE = 13
OVERSAMPLING = 1.6
"""Degree of the grid over that of the particles: with 1.3 hulls come out 0.8 % too large, with 1.6 0.1 %."""
MIN_POWER = 1e-12
MIN_SHARE = 1e-4
"""Minimum share of the hull, and of the gap to it."""
# Of the mean radius: a radius that is positive where it was tested may dip below zero on another grid.
_MIN_RADIUS = 1e-3
_BATCH = 500
SPHERICITY = 1
# By central differences: at degree 30 an error of (30 x 1e-4)^2 / 6 = 2e-6, and 1e-12 by rounding.
_STEP = 1e-4


def shape_grid(l_max: int) -> HullGrid:
    """The grid on which shapes of degree `l_max` are measured and drawn."""
    return hull_grid(max(MIN_DEGREE, int(OVERSAMPLING * l_max)), l_max)


def shape_features(coefficients: FloatArray) -> FloatArray:
    """Features of radius functions (n, (l_max + 1)^2), shape (n, d)."""
    parts = [_of_batch(coefficients[i : i + _BATCH]) for i in range(0, len(coefficients), _BATCH)]
    return np.concatenate(parts)


def powers(rows: FloatArray) -> FloatArray:
    """Sum of squares at each degree, shape (n, l_max + 1)."""
    return np.asarray(np.add.reduceat(rows**2, np.arange(round(rows.shape[1] ** 0.5)) ** 2, axis=1))


def with_powers(rows: FloatArray, wanted: FloatArray) -> FloatArray:
    """The rows scaled to the power `wanted` (n, l_max + 1) at each degree from the first on."""
    factors = np.sqrt(wanted / np.maximum(powers(rows), 1e-300))
    factors[:, 0] = 1.0
    return np.asarray(rows * factors[:, degrees(rows.shape[1])])


def log_shape_features(rows: FloatArray, equivalent_radii: FloatArray) -> FloatArray:
    """Features of the exponentials of expansions (n, (l_max + 1)^2) with these sizes, shape (n, d).

    The exponential is not cut at the degree, which would change the surface.
    """
    shapes = shape_grid(round(rows.shape[1] ** 0.5) - 1)
    logs = shapes.grid.values(rows)
    form, axes = forms(logs, shapes.grid)
    radii = np.exp(logs - logs.mean(axis=1, keepdims=True))
    return _table(shapes, np.log(equivalent_radii), form, axes, radii)


def log_share(shares: FloatArray) -> FloatArray:
    """ln(s / (1 - s)) of shares that are clipped to :data:`MIN_SHARE` .. 1 - :data:`MIN_SHARE`."""
    kept = np.clip(shares, MIN_SHARE, 1 - MIN_SHARE)
    return np.asarray(np.log(kept / (1 - kept)))


def _of_batch(coefficients: FloatArray) -> FloatArray:
    shapes = shape_grid(round(coefficients.shape[1] ** 0.5) - 1)
    principal = principal_axes(coefficients)
    form = np.diff(principal.log_ratios, axis=1)[:, ::-1]
    means = coefficients[:, :1] / np.sqrt(4 * np.pi)
    radii = np.maximum(shapes.grid.values(coefficients) / means, _MIN_RADIUS)
    return _table(shapes, np.log(3 * principal.volumes / (4 * np.pi)) / 3, form, principal.axes, radii)


def _table(
    shapes: HullGrid, log_sizes: FloatArray, form: FloatArray, axes: FloatArray, radii: FloatArray
) -> FloatArray:
    ellipsoids = log_ellipsoids(shapes.grid.directions, form, axes)
    surface = powers(shapes.grid.expanded(np.log(radii) - ellipsoids))[:, 1:]
    shares = log_share(shapes.convexities(radii))
    return np.column_stack([log_sizes, form, np.log(np.maximum(surface, MIN_POWER)), shares])


def outer_features(log_radii: FloatArray, slopes: FloatArray, shares: FloatArray, l_max: int) -> FloatArray:
    """Columns ln(longest / shortest extent along the axes of inertia), and ln(s / (1 - s)) of the sphericity
    and of the share of the hull, shape (n, 3).

    - ``log_radii``, ``slopes``: ln r and the squared length of its gradient on the unit sphere, at the nodes
      of ``shape_grid(l_max)``, shapes (n, k).
    - ``shares``: ln(s / (1 - s)) of the share of the hull that is filled, shape (n,).
    """
    grid = shape_grid(l_max).grid
    radii = np.exp(log_radii - log_radii.mean(axis=1, keepdims=True))
    # An element of the surface is r^2 sqrt(1 + |grad ln r|^2) times its solid angle.
    volumes, areas = radii**3 @ grid.weights / 3, (radii**2 * np.sqrt(1 + slopes)) @ grid.weights
    sphericity = np.pi ** (1 / 3) * (6 * volumes) ** (2 / 3) / areas
    _, axes = forms(log_radii, grid)
    extents = [np.ptp((grid.directions @ axes[:, :, i].T).T * radii, axis=1) for i in range(3)]
    ratio = np.log(np.max(extents, axis=0) / np.min(extents, axis=0))
    return np.column_stack([ratio, log_share(sphericity), shares])


def outer_features_of_radii(coefficients: FloatArray, shares: FloatArray) -> FloatArray:
    """Outer features of radius functions (n, (l_max + 1)^2)."""
    l_max = round(coefficients.shape[1] ** 0.5) - 1
    rows = coefficients / (coefficients[:, :1] / np.sqrt(4 * np.pi))
    radii = np.maximum(shape_grid(l_max).grid.values(rows), _MIN_RADIUS)
    return outer_features(np.log(radii), _squared_slopes(rows, l_max) / radii**2, shares, l_max)


def outer_features_of_log_radii(rows: FloatArray, shares: FloatArray) -> FloatArray:
    """Outer features of the exponentials of expansions (n, (l_max + 1)^2)."""
    l_max = round(rows.shape[1] ** 0.5) - 1
    return outer_features(shape_grid(l_max).grid.values(rows), _squared_slopes(rows, l_max), shares, l_max)


def whole_features_of_radii(coefficients: FloatArray) -> FloatArray:
    """Outer features of radius functions (n, (l_max + 1)^2), their share of the hull measured too."""
    parts = []
    for first in range(0, len(coefficients), _BATCH):
        rows = coefficients[first : first + _BATCH]
        means = rows[:, :1] / np.sqrt(4 * np.pi)
        shapes = shape_grid(round(rows.shape[1] ** 0.5) - 1)
        shares = shapes.convexities(np.maximum(shapes.grid.values(rows) / means, _MIN_RADIUS))
        parts.append(outer_features_of_radii(rows, log_share(shares)))
    return np.concatenate(parts)


def whole_features_of_log_radii(coefficients: FloatArray) -> FloatArray:
    """The same of the exponentials of expansions."""
    parts = []
    for first in range(0, len(coefficients), _BATCH):
        rows = coefficients[first : first + _BATCH]
        shapes = shape_grid(round(rows.shape[1] ** 0.5) - 1)
        logs = shapes.grid.values(rows)
        shares = shapes.convexities(np.exp(logs - logs.mean(axis=1, keepdims=True)))
        parts.append(outer_features_of_log_radii(rows, log_share(shares)))
    return np.concatenate(parts)


def _squared_slopes(rows: FloatArray, l_max: int) -> FloatArray:
    along, across = _slope_bases(l_max)
    return np.asarray((rows @ along) ** 2 + (rows @ across) ** 2)


@lru_cache(maxsize=2)
def _slope_bases(l_max: int) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the harmonics along two tangents at the nodes, by central differences."""
    u = shape_grid(l_max).grid.directions
    # Near the poles the cross product with z would be short.
    away = np.where(np.abs(u[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    first = np.cross(away, u)
    first /= np.linalg.norm(first, axis=1, keepdims=True)

    def slope(tangent: FloatArray) -> FloatArray:
        ends = [harmonics(np.cos(_STEP) * u + sign * np.sin(_STEP) * tangent, l_max) for sign in (1, -1)]
        gradient = (ends[0] - ends[1]) / (2 * _STEP)
        gradient.flags.writeable = False
        return gradient

    return slope(first), slope(np.cross(u, first))
