"""Convex hull of a union of convex parts, its locally minimal boxes, and how both follow the planes."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.compound.measures import MeasuredCompound
from regolith_studio.coarsening.core.box import Solid
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.polyhedron_measures import add_vertex_charges, measure_polyhedron
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import cross, dot, mixed, row

MAX_CORNERS = 1000
"""Of parts that have 500 facets in all, in general position."""
JOGGLE = 1.0 + 1e-11 * np.random.default_rng(0).uniform(size=MAX_CORNERS)
"""By what distances of corners are divided to find the triangles, so that no four corners lie in a plane."""


class HullOfParts(NamedTuple):
    """The convex hull of all corners.

    Parameters
    ----------
    volume
        Of the hull.
    faces, area_vectors
        Triangles by their corners, outward, (m, 3), and their normals times their areas, (m, 3).
    edges
        Rows (from, to, triangle a, triangle b), counter-clockwise around a, shape (3 m / 2, 4).
    """

    volume: float
    faces: IntArray
    area_vectors: FloatArray
    edges: IntArray


def hull_of(vertices: FloatArray) -> HullOfParts | None:
    """The hull, or ``None`` where it is flat.

    Its triangles are the corners of the dual polyhedron <x_i - c, y> <= 1, where c is the mean of the corners
    x_i: faster than Qhull for some 60 corners.
    """
    middle = vertices.mean(axis=0)
    spokes = vertices - middle
    distance = np.sqrt(np.einsum("ij,ij->i", spokes, spokes))
    if not distance.min() > 0.0:
        return None
    dual = measure_polyhedron(spokes / distance[:, None], JOGGLE[: len(vertices)] / distance)
    if dual.status != FINE:
        return None
    vectors = np.empty((len(dual.triples), 3))
    volume = _fill_area_vectors(spokes, dual.triples, vectors)
    return HullOfParts(volume, dual.triples, vectors, dual.edges[:, [2, 3, 1, 0]])


@kernel_noalloc
def _fill_area_vectors(points: FloatArray, faces: IntArray, vectors: FloatArray) -> float:
    """Fill the normals of triangles times their areas; the volume that the triangles enclose."""
    volume = 0.0
    for f in range(len(faces)):
        a, b, c = row(points, faces[f, 0]), row(points, faces[f, 1]), row(points, faces[f, 2])
        normal = cross(mixed(b, 1.0, a, -1.0), mixed(c, 1.0, a, -1.0))
        for x in range(3):
            vectors[f, x] = 0.5 * normal[x]
        volume += dot(a, normal) / 6.0
    return volume


def hull_solid(hull: HullOfParts, vertices: FloatArray) -> Solid:
    """For the search of boxes; corners that are not on the hull do not matter to it."""
    areas = np.linalg.norm(hull.area_vectors, axis=1)
    normals = hull.area_vectors / np.maximum(areas, 1e-300)[:, None]
    return Solid(vertices, normals, areas, hull.edges)


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
