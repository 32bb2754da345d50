"""Convex hull of a union of convex parts, its locally minimal boxes, and how both follow the planes."""

from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from regolith_studio.coarsening.compound.measures import MeasuredCompound
from regolith_studio.coarsening.core.box import Solid
from regolith_studio.coarsening.core.polyhedron_measures import add_vertex_charges
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import cross, dot, mixed, row


class HullOfParts(NamedTuple):
    """The convex hull of all corners.

    Parameters
    ----------
    volume
        Of the hull.
    faces, area_vectors
        Triangles by their corners, outward, (m, 3), and their normals times their areas, (m, 3).
    """

    volume: float
    faces: IntArray
    area_vectors: FloatArray


def hull_of(vertices: FloatArray) -> HullOfParts | None:
    """The hull, or ``None`` where it is flat."""
    try:
        hull = ConvexHull(vertices)
    except QhullError:
        return None
    faces, vectors = hull.simplices.astype(np.int64), np.empty((len(hull.simplices), 3))
    volume = _fill_outward(vertices, hull.equations, faces, vectors)
    return HullOfParts(volume, faces, vectors)


@kernel_noalloc
def _fill_outward(vertices: FloatArray, equations: FloatArray, faces: IntArray, vectors: FloatArray) -> float:
    """Volume; turns triangles outward and fills their normals times their areas."""
    volume = 0.0
    for f in range(len(faces)):
        a, b, c = row(vertices, faces[f, 0]), row(vertices, faces[f, 1]), row(vertices, faces[f, 2])
        normal = cross(mixed(b, 1.0, a, -1.0), mixed(c, 1.0, a, -1.0))
        way = 0.5
        if dot(normal, row(equations, f)) < 0.0:
            faces[f, 1], faces[f, 2] = faces[f, 2], faces[f, 1]
            way = -0.5
        for x in range(3):
            vectors[f, x] = way * normal[x]
        volume += way * dot(a, normal) / 3.0
    return volume


def hull_solid(hull: HullOfParts, vertices: FloatArray) -> Solid:
    """For the search of boxes; corners that are not on the hull do not matter to it."""
    origin, end = hull.faces.reshape(-1), np.roll(hull.faces, -1, axis=1).reshape(-1)
    face = np.repeat(np.arange(len(hull.faces)), 3)
    forward, backward = origin * len(vertices) + end, end * len(vertices) + origin
    order = np.argsort(forward)
    twin = face[order[np.searchsorted(forward, backward, sorter=order)]]
    once = face < twin
    edges = np.column_stack([origin, end, face, twin])[once]
    areas = np.linalg.norm(hull.area_vectors, axis=1)
    normals = hull.area_vectors / np.maximum(areas, 1e-300)[:, None]
    return Solid(vertices, normals, areas, edges)


def add_hull_charges(compound: MeasuredCompound, hull: HullOfParts, size: float, charges: FloatArray) -> None:
    """Add `size` times the derivative of the hull's volume, shape (n, 4), pivots as of `compound`."""
    forces = np.zeros_like(compound.vertices)
    for corner in range(3):
        np.add.at(forces, hull.faces[:, corner], hull.area_vectors * (size / 3.0))
    corners = np.flatnonzero(forces.any(axis=1))
    _add_corner_charges(
        compound.planes.normals,
        compound.triples,
        compound.vertices,
        corners,
        forces,
        compound.centroids,
        charges,
    )


@kernel_noalloc
def _add_corner_charges(
    normals: FloatArray,
    triples: IntArray,
    vertices: FloatArray,
    corners: IntArray,
    forces: FloatArray,
    pivots: FloatArray,
    charges: FloatArray,
) -> None:
    """Add the derivative of the sum of <force, x> at corners, shape (n, 4)."""
    for v in corners:
        add_vertex_charges(normals, triples, vertices, v, row(forces, v), pivots, charges)
