"""Starting half-spaces: the hull's triangles grouped by the direction of their normals."""

import numpy as np

from regolith_studio.coarsening.core.facet_insertion import insert_lost_facets
from regolith_studio.coarsening.core.intersection import DEGENERATE, FINE
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron
from regolith_studio.coarsening.polyhedra import polyhedron_of
from regolith_studio.coarsening.target import Target
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.sphere_points import fibonacci_directions

CUT_DEPTH = 0.3
"""Of cuts for half-spaces without a facet."""
TIE_BREAK = 1e-7
MIN_OFFSET = 0.05
SPHERE_POINTS = 2000
"""Of the sphere whose cells are as equal as can be, and of the ellipsoid that round half-spaces touch."""
ROUNDS = 20
"""Of Lloyd's method."""


def start_planes(target: Target, n_facets: int, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Half-spaces through groups of the hull's triangles, in general position, each with a facet.

    Groups of a smooth needle can all run from end to end, so that nothing bounds the ends; then half-spaces
    that touch it all around are taken.
    """
    hull = target.mesh.hull
    areas = hull.face_areas
    sound = areas > 0.0
    normals, offsets = grouped_planes(
        hull.face_area_vectors[sound] / areas[sound, None],
        areas[sound],
        hull.triangles[sound].mean(axis=1),
        rng.random(n_facets),
        10,
    )
    offsets = np.maximum(offsets, MIN_OFFSET) * (1.0 + TIE_BREAK * rng.random(n_facets))
    if not _bounds_a_solid(normals, offsets):
        normals, offsets = touching_planes(hull.vertices, fibonacci_directions(n_facets), rng)
    rays = target.rays
    cuts, more_normals, more_offsets = insert_lost_facets(
        normals, offsets, rays.directions, rays.first, rays.distance, CUT_DEPTH
    )
    return (more_normals, more_offsets) if cuts >= 0 else (normals, offsets)


def round_planes(
    target: Target, n_facets: int, rng: np.random.Generator, around_hull: bool
) -> tuple[FloatArray, FloatArray]:
    """Half-spaces of a polyhedron nearly as round as Goldberg allows, stretched as the particle's box.

    Their normals are the middles of a centroidal Voronoi partition of the sphere; they touch the hull, or an
    ellipsoid of unit volume.
    """
    sphere, box = fibonacci_directions(SPHERE_POINTS), target.box
    even, _ = grouped_planes(sphere, np.ones(SPHERE_POINTS), sphere, rng.random(n_facets), ROUNDS)
    radii = box.extents / np.cbrt(4.0 / 3.0 * np.pi * box.extents.prod())
    points = target.mesh.hull.vertices @ box.axes.T if around_hull else sphere * radii
    normals, offsets = touching_planes(points, even, rng)
    return normals @ box.axes, offsets


def touching_planes(
    points: FloatArray, directions: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Half-spaces that touch points about the origin, with the normals of an ellipsoid of their extents.

    They are those at the `directions` of a sphere, turned at random, that becomes the ellipsoid.
    """
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    normals = directions @ rotation / np.ptp(points, axis=0)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offsets = (points @ normals.T).max(axis=0) * (1.0 + TIE_BREAK * rng.random(len(normals)))
    return normals, offsets


def _bounds_a_solid(normals: FloatArray, offsets: FloatArray) -> bool:
    status = measure_polyhedron(normals, offsets).status
    if status != DEGENERATE:
        return bool(status == FINE)
    try:  # not in general position?
        polyhedron_of(HalfSpaces(normals, offsets))
    except GeometryError:
        return False
    return True


def grouped_planes(
    normals: FloatArray, areas: FloatArray, centres: FloatArray, numbers: FloatArray, rounds: int
) -> tuple[FloatArray, FloatArray]:
    """Spherical k-means of the hull's triangles, weighted by area, started as k-means++.

    Parameters
    ----------
    normals, areas, centres
        Of the hull's triangles, shapes (m, 3), (m,), (m, 3).
    numbers
        Uniform random numbers in [0, 1), shape (k,): one a group.
    rounds
        Of reassignment.

    Returns
    -------
    normals, offsets
        Mean normal of each group and the area-weighted mean of <n, x> over it, shapes (k, 3) and (k,).
    """
    k, distance = len(numbers), np.full(len(areas), 2.0)
    middles = np.empty((k, 3))
    for j in range(k):
        total = np.cumsum(areas * distance)
        middles[j] = normals[min(len(areas) - 1, np.searchsorted(total, numbers[j] * total[-1]))]
        distance = np.minimum(distance, np.maximum(0.0, 1.0 - normals @ middles[j]))
    for _ in range(rounds):
        group = (normals @ middles.T).argmax(axis=1)
        sums = np.column_stack([np.bincount(group, areas * normals[:, c], k) for c in range(3)])
        lengths = np.linalg.norm(sums, axis=1)
        moved = lengths > 1e-9
        middles[moved] = sums[moved] / lengths[moved, None]
    group = (normals @ middles.T).argmax(axis=1)
    weights = np.bincount(group, areas, k)
    heights = np.bincount(group, areas * (middles[group] * centres).sum(axis=1), k)
    furthest = (centres @ middles.T).max(axis=0)
    return middles, np.where(weights > 0.0, heights / np.where(weights > 0.0, weights, 1.0), furthest)
