"""The edges of an icosphere: where its flat triangles stay furthest inside a smooth surface."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.sparse import csr_array

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.sphere_points import icosphere


@dataclass(frozen=True, eq=False)
class IcosphereEdges:
    """The edges of an icosphere with n vertices.

    Parameters
    ----------
    ends
        Vertex indices, shape (e, 2).
    middles
        Directions of the edges' middles, shape (e, 3).
    spans
        Length of the sum of the two end directions, shape (e,).
    weights
        Weight of each edge in the mean over the triangles round each vertex, sparse, shape (n, e).
    """

    ends: IntArray
    middles: FloatArray
    spans: FloatArray
    weights: "csr_array[np.float64, tuple[int, int]]"

    def shortfalls(self, radius: FloatArray, between: FloatArray) -> FloatArray:
        """How far the flat triangles round each vertex stay inside the surface on average, shape (n,).

        Over a triangle the shortfall is nearly quadratic and vanishes at the corners, so that its mean is
        that of its values in the middles of the three edges.

        Parameters
        ----------
        radius, between
            Radius of the surface at the vertices (n,) and in the middles of the edges (e,).
        """
        start, end = radius[self.ends[:, 0]], radius[self.ends[:, 1]]
        chord = start * end / (start + end) * self.spans
        return np.asarray(self.weights @ (between - chord))


@cache
def icosphere_edges(level: int) -> IcosphereEdges:
    """Edges of ``icosphere(level)``, cached."""
    sphere = icosphere(level)
    sides = np.sort(sphere.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    ends, of_face = np.unique(sides, axis=0, return_inverse=True)
    sums = sphere.vertices[ends].sum(axis=1)
    spans = np.linalg.norm(sums, axis=1)
    n_triangles = np.bincount(sphere.faces.ravel())
    rows = np.repeat(sphere.faces, 3, axis=1).ravel()
    columns = np.tile(of_face.reshape(-1, 3), (1, 3)).ravel()
    shares = 1 / (3 * n_triangles[rows])
    weights = csr_array((shares, (rows, columns)), shape=(len(sphere.vertices), len(ends)))
    return IcosphereEdges(ends, sums / spans[:, None], spans, weights)
