"""How far a star-shaped surface is from its convex hull, and surfaces drawn part of the way towards it.

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
from regolith_studio.geometry.kernels import kernel
from regolith_studio.harmonics.sphere_grid import SphereGrid, sphere_grid

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


@kernel
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
