"""Feret diameters of a convex solid: its largest and smallest width between parallel tangent planes."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.minimum_box.hull_topology import after, hull_graph
from regolith_studio.geometry.vectors import along, cross, dot, length, mixed, row

PARALLEL = 1e-8
"""Sine of the angle between edges below which the planes through both are those through a face."""

ROUNDING = 1e-12
"""By how much a plane may cut into the solid, as a share of an edge."""


def feret_max(hull: Mesh) -> float:
    """Largest Feret diameter: the largest distance between two vertices."""
    middle, size = _frame(hull)
    return size * _longest_chord((hull.vertices - middle) / size)


def feret_min(hull: Mesh) -> float:
    """Smallest Feret diameter, exact.

    The planes touch a face and a vertex, or two edges that are not parallel (Houle and Toussaint 1988).
    """
    middle, size = _frame(hull)
    return size * _least_width((hull.vertices - middle) / size, hull.faces)


def _frame(hull: Mesh) -> tuple[FloatArray, float]:
    low, high = hull.bounds
    return (low + high) / 2, float((high - low).max())


@kernel
def _longest_chord(points: FloatArray) -> float:
    """Largest distance between two points."""
    longest = 0.0
    for i in range(len(points)):
        for j in range(i):
            chord = mixed(row(points, i), 1.0, row(points, j), -1.0)
            longest = max(longest, dot(chord, chord))
    return float(np.sqrt(longest))


@kernel
def _least_width(points: FloatArray, faces: IntArray) -> float:
    """Least distance between parallel tangent planes of a closed convex triangulation."""
    graph = hull_graph(points, faces)
    least = np.inf
    for f in range(len(faces)):
        normal = row(graph.normals, f)
        low = np.inf
        for i in range(len(points)):
            low = min(low, along(points, i, normal))
        least = min(least, along(points, faces[f, 0], normal) - low)
    n = 0
    edges, sides = np.empty((len(graph.twin) // 2, 2, 3)), np.empty((len(graph.twin) // 2, 2, 3))
    for h in range(len(graph.twin)):
        if h < graph.twin[h] and graph.facet[h // 3] != graph.facet[graph.twin[h] // 3]:
            for k in range(3):
                edges[n, 0, k] = points[graph.origin[h], k]
                edges[n, 1, k] = points[graph.origin[after(h)], k] - edges[n, 0, k]
                sides[n, 0, k] = graph.normals[h // 3, k]
                sides[n, 1, k] = graph.normals[graph.twin[h] // 3, k]
            n += 1
    for i in range(n):
        for j in range(i):
            least = min(least, _width_between(edges[i], sides[i], edges[j], sides[j]))
    return float(least)


@kernel
def _width_between(edge: FloatArray, sides: FloatArray, other: FloatArray, other_sides: FloatArray) -> float:
    """Distance between the parallel planes through two edges, infinite unless both planes are tangent."""
    way, other_way = row(edge, 1), row(other, 1)
    if along(other_sides, 0, way) * along(other_sides, 1, way) > ROUNDING * dot(way, way):
        return np.inf
    if along(sides, 0, other_way) * along(sides, 1, other_way) > ROUNDING * dot(other_way, other_way):
        return np.inf
    normal = cross(way, other_way)
    size = length(normal)
    if size <= PARALLEL * length(way) * length(other_way):
        return np.inf
    turn = 1.0 if along(sides, 0, normal) + along(sides, 1, normal) > 0.0 else -1.0
    if turn * (along(other_sides, 0, normal) + along(other_sides, 1, normal)) > 0.0:
        return np.inf
    return turn * dot(mixed(row(edge, 0), 1.0, row(other, 0), -1.0), normal) / size
