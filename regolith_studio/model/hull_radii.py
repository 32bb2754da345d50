"""How far a star-shaped surface is from its convex hull, and surfaces drawn part of the way towards it.

On a grid of directions u_k the hull of a radius function r has the support h(u) = max over k of r_k (u_k u)
and the radius min over k of h(u_k) / (u_k u). Hollows are filled and ridges stay, so that facets and edges
come about. Drawing a surface towards its hull, ln r + s (ln hull - ln r), leaves the hull as it is for every
s <= 1, so that the share of the hull that a body fills grows steadily with s and can be set.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.model.sphere_grid import SphereGrid, sphere_grid

Floats = NDArray[np.float32]

GRAZING = 0.05
"""Cosine below which a direction does not limit the radius along another."""
NEWTON_STEPS = 4
SHARES = (-1.0, 1.0)
"""Least and most that a surface is drawn towards its hull; below zero away from it."""


@dataclass(frozen=True, eq=False)
class HullGrid:
    """A grid of directions with the cosines between them.

    Parameters
    ----------
    grid
        Directions, weights and harmonics.
    cosines
        Shape (k, k).
    reciprocals
        1 / cosine, infinite where the cosine is below :data:`GRAZING`, shape (k, k).
    """

    grid: SphereGrid
    cosines: Floats
    reciprocals: Floats

    def hulls(self, radii: FloatArray | Floats) -> Floats:
        """Radii of the convex hulls of `radii`, both of shape (n, k)."""
        given = np.ascontiguousarray(radii, dtype=np.float32)
        return np.maximum(hull_radii(given, self.cosines, self.reciprocals), given)

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

        Parameters
        ----------
        log_radii
            Shape (n, k).
        convexities
            By the measure of :meth:`convexities`, shape (n,).
        """
        distance, hulls = self._distance(log_radii)
        weights = self.grid.weights.astype(np.float32)
        wanted = convexities * ((hulls * hulls * hulls) @ weights)
        cubes = np.exp(3 * log_radii.astype(np.float32))
        shares = np.zeros((len(log_radii), 1), dtype=np.float32)
        for _ in range(NEWTON_STEPS):
            filled = cubes * np.exp(3 * shares * distance)
            volume, slope = filled @ weights, 3 * ((filled * distance) @ weights)
            step = np.log(wanted / volume) * volume / np.maximum(slope, 1e-6 * volume)
            shares = np.clip(shares + step[:, None], *SHARES).astype(np.float32)
        return np.asarray(log_radii + shares * distance)

    def _distance(self, log_radii: FloatArray) -> tuple[Floats, Floats]:
        """ln of the hull's radius over the surface's, and the hull's radius."""
        logs = log_radii.astype(np.float32)
        hulls = self.hulls(np.exp(logs))
        return np.log(hulls) - logs, hulls


@kernel
def hull_radii(radii: Floats, cosines: Floats, reciprocals: Floats) -> Floats:
    """Radii of convex hulls along the directions of a grid, shape (n, k); see :class:`HullGrid`."""
    n, size = radii.shape
    found = np.empty((n, size), np.float32)
    support = np.empty(size, np.float32)
    for p in range(n):
        support[:] = 0.0
        for k in range(size):
            radius = radii[p, k]
            row = cosines[k]
            for j in range(size):
                height = radius * row[j]
                support[j] = height if height > support[j] else support[j]  # noqa: FURB136  vectorised
        nearest = found[p]
        nearest[:] = np.inf
        for k in range(size):
            height = support[k]
            row = reciprocals[k]
            for j in range(size):
                reach = height * row[j]
                nearest[j] = reach if reach < nearest[j] else nearest[j]  # noqa: FURB136
    return found


@cache
def hull_grid(degree: int, l_max: int) -> HullGrid:
    """The Gauss-Legendre grid of `degree` with harmonics up to `l_max`; cached and read-only."""
    grid = sphere_grid(degree, l_max)
    cosines = grid.directions @ grid.directions.T
    near = cosines > GRAZING
    reciprocals = np.where(near, 1 / np.where(near, cosines, 1.0), np.inf)
    found = HullGrid(grid, cosines.astype(np.float32), reciprocals.astype(np.float32))
    for array in (found.cosines, found.reciprocals):
        array.flags.writeable = False
    return found
