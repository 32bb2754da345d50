"""Distances from the vertices of one surface to another, for the distance map."""

import numpy as np
from scipy.spatial import cKDTree

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh

NEAREST = 12
"""Triangles, those with the nearest middles, that are measured for each point."""


def signed_distances(points: FloatArray, surface: Mesh) -> FloatArray:
    """Distance of each point from a surface: positive outside, negative inside.

    The nearest of a few triangles whose middles are nearest; exact for surfaces of evenly sized
    triangles, as fits and contoured scans are.

    Parameters
    ----------
    points
        Shape (n, 3).
    surface
        Closed, outward oriented.

    Returns
    -------
    Shape (n,), in the unit of the points.
    """
    count = min(NEAREST, len(surface.faces))
    middles = surface.triangles.mean(axis=1)
    _, near = cKDTree(middles).query(points, k=count)
    near = near.reshape(len(points), count)
    closest = _closest_points(np.repeat(points, count, axis=0), surface.triangles[near.ravel()])
    step = np.repeat(points, count, axis=0) - closest
    length = np.linalg.norm(step, axis=1).reshape(len(points), count)
    best = length.argmin(axis=1)
    rows = np.arange(len(points))
    outward = surface.face_area_vectors[near[rows, best]]
    step = step.reshape(len(points), count, 3)[rows, best]
    side = np.where(np.einsum("ij,ij->i", step, outward) < 0.0, -1.0, 1.0)
    return np.asarray(side * length[rows, best], dtype=np.float64)


def _closest_points(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """The point of each triangle (n, 3, 3) that is nearest to its point (n, 3)."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    area = np.einsum("ij,ij->i", normal, normal)
    safe = np.where(area > 0.0, area, 1.0)
    v = np.einsum("ij,ij->i", np.cross(c - a, normal), points - a) / safe
    w = np.einsum("ij,ij->i", np.cross(normal, b - a), points - a) / safe
    inside = (area > 0.0) & (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0)
    best = a + v[:, None] * (b - a) + w[:, None] * (c - a)
    distance = np.where(inside, np.linalg.norm(points - best, axis=1), np.inf)
    for first, second in ((a, b), (b, c), (c, a)):
        along = second - first
        square = np.einsum("ij,ij->i", along, along)
        share = np.einsum("ij,ij->i", points - first, along) / np.where(square > 0.0, square, 1.0)
        foot = first + np.clip(share, 0.0, 1.0)[:, None] * along
        reach = np.linalg.norm(points - foot, axis=1)
        nearer = reach < distance
        best = np.where(nearer[:, None], foot, best)
        distance = np.where(nearer, reach, distance)
    return np.asarray(best)
