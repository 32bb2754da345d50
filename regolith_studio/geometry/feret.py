"""Feret diameters of a convex solid: its largest and smallest width between parallel tangent planes."""

import numpy as np

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.longest_chord import longest_chord
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.minimum_box.extents import extreme_vertices_of_each
from regolith_studio.geometry.minimum_box.hull_topology import facets_of_hull
from regolith_studio.geometry.vectors import along, cross, dot, length, mixed, row

PARALLEL = 1e-8
"""Sine of the angle between edges below which the planes through both are those through a face."""

ROUNDING = 1e-12
"""By how much a plane may cut into the solid, as a share of an edge."""


def feret_max(hull: Mesh) -> float:
    """Largest Feret diameter: the largest distance between two vertices."""
    middle, size = _frame(hull)
    return size * longest_chord((hull.vertices - middle) / size)


def feret_min(hull: Mesh) -> float:
    """Smallest Feret diameter, exact.

    The planes touch a face and a vertex, or two edges that are not parallel (Houle and Toussaint 1988).
    """
    middle, size = _frame(hull)
    return size * _min_width((hull.vertices - middle) / size, hull.faces)


def _frame(hull: Mesh) -> tuple[FloatArray, float]:
    low, high = hull.bounds
    return (low + high) / 2, float((high - low).max())


def _min_width(points: FloatArray, faces: IntArray) -> float:
    """Least distance between parallel tangent planes of a closed convex triangulation."""
    facets = facets_of_hull(points, faces)
    if facets is None:
        raise GeometryError("The convex hull of the mesh does not close, so it has no Feret diameter.")
    top, bottom = extreme_vertices_of_each(facets.points, np.ascontiguousarray(facets.normals.T))
    heights = (facets.normals * (points[top] - points[bottom])).sum(axis=1)
    start, end = points[facets.edges[:, 0]], points[facets.edges[:, 1]]
    sides = facets.normals[facets.edges[:, 2:]]
    return min(float(heights.min()), _width_between_edges(start, end - start, sides))


@kernel_noalloc
def _width_between_edges(start: FloatArray, way: FloatArray, sides: FloatArray) -> float:
    """Least :func:`_width_between` of all pairs of edges: starts, vectors (e, 3) and normals (e, 2, 3)."""
    width = np.inf
    for i in range(len(start)):
        for j in range(i):
            width = min(width, _width_between(start, way, sides, i, j))
    return width


@kernel_noalloc
def _width_between(start: FloatArray, way: FloatArray, sides: FloatArray, i: int, j: int) -> float:
    """Distance between the parallel planes through two edges, infinite unless both planes are tangent."""
    one, two = row(way, i), row(way, j)
    if along(sides[j], 0, one) * along(sides[j], 1, one) > ROUNDING * dot(one, one):
        return np.inf
    if along(sides[i], 0, two) * along(sides[i], 1, two) > ROUNDING * dot(two, two):
        return np.inf
    normal = cross(one, two)
    size = length(normal)
    if size <= PARALLEL * length(one) * length(two):
        return np.inf
    turn = 1.0 if along(sides[i], 0, normal) + along(sides[i], 1, normal) > 0.0 else -1.0
    if turn * (along(sides[j], 0, normal) + along(sides[j], 1, normal)) > 0.0:
        return np.inf
    return turn * dot(mixed(row(start, i), 1.0, row(start, j), -1.0), normal) / size
