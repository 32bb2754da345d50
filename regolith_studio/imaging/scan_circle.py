"""The part of the slices that a scanner sees, and how many places in it a grain can have."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from regolith_studio.geometry.arrays import BoolArray, FloatArray

_PLACES = 256
"""Places along an edge at which the shares of areas are taken."""


@dataclass(frozen=True, eq=False)
class ScanCircle:
    """The convex hull of the pixels that a scanner sees, by its half-planes ``normals @ p <= offsets``.

    Parameters
    ----------
    normals, offsets
        Shapes (n, 2) and (n,), in pixels.
    places
        Points spread evenly over the hull, shape (m, 2).
    """

    normals: FloatArray
    offsets: FloatArray
    places: FloatArray

    @classmethod
    def of(cls, seen: BoolArray) -> "ScanCircle":
        """The circle of the pixels that are seen, shape (nx, ny)."""
        hull = ConvexHull(_corners(seen, 0.5))
        low, high = hull.min_bound, hull.max_bound
        steps = (np.arange(_PLACES) + 0.5) / _PLACES
        x, y = (low[k] + steps * (high[k] - low[k]) for k in (0, 1))
        grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        normals, offsets = hull.equations[:, :2], -hull.equations[:, 2]
        return cls(normals, offsets, grid[(grid @ normals.T <= offsets).all(axis=1)])

    def share_inside(self, shadow: BoolArray) -> float:
        """Of the places of a grain in the circle, the share where it keeps clear of the edge.

        The grain lies clear of the edge if it does in each half-plane, moved inwards by its extent along the
        normal: the erosion of the circle, of area pi R^2 - R P + A for a convex grain of perimeter P and area
        A (Miles 1974).

        Parameters
        ----------
        shadow
            Pixels that have a voxel of the grain, shape (bx, by).
        """
        points = _corners(shadow, 1.0) - (np.array(shadow.shape) - 1.0) / 2.0
        extent = (points @ self.normals.T).max(axis=0)
        clear = (self.places @ self.normals.T <= self.offsets - extent).all(axis=1)
        return max(float(clear.mean()), 1.0 / len(self.places))


def _corners(pixels: BoolArray, reach: float) -> FloatArray:
    """Corners of squares of half edge `reach` about the first and last pixel of each row, shape (n, 2)."""
    rows = np.flatnonzero(pixels.any(axis=1))
    first = pixels[rows].argmax(axis=1)
    last = pixels.shape[1] - 1 - pixels[rows, ::-1].argmax(axis=1)
    centres = np.concatenate([np.stack([rows, first], axis=1), np.stack([rows, last], axis=1)])
    signs = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    return np.asarray((centres[:, None] + reach * signs).reshape(-1, 2), dtype=np.float64)
