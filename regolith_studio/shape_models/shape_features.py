"""Shape features of particles for models: size, form, power at each degree, convexity, and outer features.

The surface is ln r minus that of the ellipsoid of inertia; its power at degree l is the sum of the squared
coefficients. Columns of tables of features, with d = l_max + 4 of them::

    ln r_eq | ln(long / middle), ln(middle / short) | ln P_1 .. ln P_l_max | ln(s / (1 - s))

where long, middle and short are the axes of the ellipsoid and s is the share of the hull that is filled.
Outer features (extents, sphericity, share of the hull) stand for the descriptors of meshes where thousands of
particles are compared at every step of a fit.

How far a star-shaped surface is from its convex hull, and surfaces drawn part of the way towards it.

On a grid of directions u_k the hull of a radius function r has the support h(u) = max over k of r_k (u_k u)
and the radius min over k of h(u_k) / (u_k u), which is one over the support of 1 / h. Hollows are filled and
ridges stay, so that facets and edges come about. Drawing a surface towards its hull,
ln r + s (ln hull - ln r), leaves the hull as it is for every s <= 1, so that the share of the hull that a
body fills grows steadily with s and can be set.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.harmonics.sphere_grid import SphereGrid, harmonics, sphere_grid
from regolith_studio.shape_models.inertia_ellipsoid import forms, log_ellipsoids, principal_axes

Floats = NDArray[np.float32]

ROWS = 4
"""Directions, neighbours on the grid, that the kernel takes in one go."""
BATCH = 16
"""Bodies that it takes in turn while these directions are at hand."""
NEWTON_STEPS = 4
SHARES = (-1.0, 1.0)
"""Least and most that a surface is drawn towards its hull; below zero away from it."""


@dataclass(frozen=True, eq=False)
class HullGrid:
    """A grid of directions with the cosines between them.

    - ``grid``: directions, weights and harmonics.
    - ``cosines``: shape (k, k).
    - ``reaches``: for every :data:`ROWS` directions in a row: the first that lies less than a right angle
      from any of them, and the one after the last, shape (ceil(k / ROWS), 2).
    """

    grid: SphereGrid
    cosines: Floats
    reaches: IntArray

    def hulls(self, radii: FloatArray | Floats) -> Floats:
        """Radii of the convex hulls of `radii`, both of shape (n, k)."""
        given = np.ascontiguousarray(radii, dtype=np.float32)
        inverse, found = np.zeros((2, *given.shape), dtype=np.float32)
        supports(given, self.cosines, self.reaches, inverse)
        np.reciprocal(inverse, out=inverse)
        supports(inverse, self.cosines, self.reaches, found)
        np.reciprocal(found, out=found)
        # A hull holds its body, which rounding to single precision may deny.
        return np.asarray(np.maximum(found, given, out=found))

    def convexities(self, radii: FloatArray) -> FloatArray:
        """Share of its hull that each body fills, shape (n,); hulls are seen on the grid only, and so are
        some 1.5 % larger than those of fine meshes."""
        weights = self.grid.weights
        hulls = self.hulls(radii).astype(np.float64)
        return np.asarray((radii**3 @ weights) / (hulls**3 @ weights))

    def drawn(self, log_radii: FloatArray, share: float) -> FloatArray:
        """The surfaces drawn by `share` towards their hulls, shapes (n, k)."""
        return np.asarray(log_radii + share * self._distance(log_radii)[0])

    def with_convexities(self, log_radii: FloatArray, convexities: FloatArray) -> FloatArray:
        """The surfaces drawn towards or away from their hulls until each fills the share asked for.

        ``log_radii``: shape (n, k). ``convexities``: by the measure of :meth:`convexities`, shape (n,).
        """
        distance, hulls = self._distance(log_radii)
        weights = self.grid.weights.astype(np.float32)
        wanted = convexities * ((hulls * hulls * hulls) @ weights)
        cubes = np.exp(3 * log_radii.astype(np.float32))
        shares = np.zeros((len(log_radii), 1), dtype=np.float32)
        for _ in range(NEWTON_STEPS):
            filled = cubes * np.exp(3 * shares * distance)
            volume, slope = filled @ weights, 3 * ((filled * distance) @ weights)
            # Newton's method on ln V, which is nearly linear in the share; a convex body has no distance and
            # no slope.
            step = np.log(wanted / volume) * volume / np.maximum(slope, 1e-6 * volume)
            shares = np.clip(shares + step[:, None], *SHARES).astype(np.float32)
        return np.asarray(log_radii + shares * distance)

    def _distance(self, log_radii: FloatArray) -> tuple[Floats, Floats]:
        """ln of the hull's radius over the surface's, and the hull's radius."""
        logs = log_radii.astype(np.float32)
        hulls = self.hulls(np.exp(logs))
        return np.log(hulls) - logs, hulls


@inner_kernel
def _max_of_five(a: float, b: float, c: float, d: float, e: float) -> float:
    left = a if a > b else b  # noqa: FURB136  vectorised, as below
    right = c if c > d else d  # noqa: FURB136
    both = left if left > right else right  # noqa: FURB136
    return both if both > e else e  # noqa: FURB136


@kernel
def supports(radii: Floats, cosines: Floats, reaches: IntArray, found: Floats) -> None:
    """Largest of radius times cosine over all directions, along each of them; fills `found`, 0 before.

    As in a product of matrices, four directions and two bodies share what is read from memory; the inner loop
    is one that compilers turn into vectors. The order of the maxima does not change them.

    ``radii``: positive, shape (n, k). ``cosines``, ``reaches``: see :class:`HullGrid`.
    """
    n, size = radii.shape
    for first in range(0, n, BATCH):
        for group in range(len(reaches)):
            low, high = reaches[group]
            k0 = ROWS * group
            k1, k2, k3 = min(k0 + 1, size - 1), min(k0 + 2, size - 1), min(k0 + 3, size - 1)
            c0, c1 = cosines[k0, low:high], cosines[k1, low:high]
            c2, c3 = cosines[k2, low:high], cosines[k3, low:high]
            for p in range(first, min(n, first + BATCH), 2):
                q = min(p + 1, n - 1)
                mine, other = found[p, low:high], found[q, low:high]
                p0, p1, p2, p3 = radii[p, k0], radii[p, k1], radii[p, k2], radii[p, k3]
                q0, q1, q2, q3 = radii[q, k0], radii[q, k1], radii[q, k2], radii[q, k3]
                for j in range(len(mine)):
                    a, b, c, d = c0[j], c1[j], c2[j], c3[j]  # once, before anything is written
                    mine[j] = _max_of_five(p0 * a, p1 * b, p2 * c, p3 * d, mine[j])
                    other[j] = _max_of_five(q0 * a, q1 * b, q2 * c, q3 * d, other[j])


@lru_cache(maxsize=2)
def hull_grid(degree: int, l_max: int) -> HullGrid:
    """The Gauss-Legendre grid of `degree` with harmonics up to `l_max`; kept and read-only."""
    grid = sphere_grid(degree, l_max)
    cosines = grid.directions @ grid.directions.T
    near = np.logical_or.reduceat(cosines > 0, np.arange(0, len(cosines), ROWS), axis=0)
    reaches = np.column_stack([near.argmax(axis=1), len(cosines) - near[:, ::-1].argmax(axis=1)])
    hull = HullGrid(grid, cosines.astype(np.float32), reaches)
    for array in (hull.cosines, hull.reaches):
        array.flags.writeable = False
    return hull


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
