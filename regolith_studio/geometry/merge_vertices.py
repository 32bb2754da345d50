"""Vertices at the same place made one: seams of textures, triangle soups, rounded coordinates."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from regolith_studio.geometry.arrays import FloatArray, IntArray


def merged_vertices(
    vertices: FloatArray, faces: IntArray, tolerance: float = 0.0
) -> tuple[FloatArray, IntArray]:
    """Mesh data in which vertices no farther apart than `tolerance` are one.

    Chains of near vertices become one too; each group keeps the place of its first vertex.
    Vertices that no face uses are left out.
    """
    used, compact = np.unique(faces, return_inverse=True)
    points = vertices[used]
    group = _equal(points) if tolerance == 0.0 else _near(points, tolerance)
    _, first, inverse = np.unique(group, return_index=True, return_inverse=True)
    return points[first], inverse[compact].reshape(-1, 3).astype(np.int64)


def _equal(points: FloatArray) -> IntArray:
    """For each point the index of the first one at exactly the same place."""
    order = np.lexsort(points.T)
    ordered = points[order]
    new = np.ones(len(points), dtype=np.bool_)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    number = np.cumsum(new) - 1
    group = np.empty(len(points), dtype=np.int64)
    group[order] = order[new][number] if len(points) else number
    return group


def _near(points: FloatArray, tolerance: float) -> IntArray:
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(points),) * 2)
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)
