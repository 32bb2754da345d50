"""Approximate a convex polyhedron by inscribed spheres: greedy, from the largest sphere down."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog
from scipy.spatial.distance import cdist
from scipy.stats import qmc

from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.sphere_points import fibonacci_directions

PROBES = 4096
"""Points to be covered by the spheres; a power of two for Sobol's sequence."""
CENTRES = 1500
"""Candidate centres of spheres."""
VOLUME_PROBES = 1 << 16
SURFACE_PROBES = 4096
"""Points on each sphere for the area of the union."""


@dataclass(frozen=True)
class SphereFitErrors:
    """Relative errors of a union of spheres that approximates a polyhedron.

    Parameters
    ----------
    volume, area
        Ratio of union and polyhedron minus 1; the volume error is always negative.
    inertia
        Largest difference of a principal moment about the polyhedron's centroid, at equal mass.
    """

    volume: float
    area: float
    inertia: float


def fit_spheres(shape: ConvexPolyhedron, count: int) -> FloatArray:
    """At most `count` spheres inside `shape`, each row x, y, z, r; the first is the largest that fits.

    Each further sphere is the one that covers most of the uncovered points, among many candidate centres with
    the maximum radius that fits there. Fewer are returned if no candidate covers anything more.
    """
    probes = inner_points(shape, PROBES)
    centres = np.vstack([_incentre(shape), probes[:CENTRES]])
    radii = (shape.half_spaces.offsets - centres @ shape.half_spaces.normals.T).min(axis=1)
    inside = cdist(centres, probes) <= radii[:, None]
    uncovered, chosen = np.ones(len(probes), dtype=bool), [0]
    uncovered &= ~inside[0]
    while len(chosen) < count:
        gain = (inside & uncovered).sum(axis=1)
        best = int(gain.argmax())
        if gain[best] == 0:
            break
        chosen.append(best)
        uncovered &= ~inside[best]
    return np.column_stack([centres[chosen], radii[chosen]])


def union_volume(shape: ConvexPolyhedron, spheres: FloatArray) -> float:
    """Volume of the union of spheres that lie inside `shape`; standard error about 0.001 of the shape's."""
    probes = inner_points(shape, VOLUME_PROBES)
    return shape.volume * float(_covered(probes, spheres).mean())


def union_area(spheres: FloatArray) -> float:
    """Area of the outer surface of the union of spheres; to about 0.1 %."""
    directions, area = fibonacci_directions(SURFACE_PROBES), 0.0
    for k, (x, y, z, radius) in enumerate(spheres):
        uncovered = ~_covered((x, y, z) + radius * directions, np.delete(spheres, k, axis=0))
        area += 4 * np.pi * radius**2 * float(uncovered.mean())
    return area


def sphere_fit_errors(shape: ConvexPolyhedron, spheres: FloatArray) -> SphereFitErrors:
    """Errors of volume, area and inertia of spheres that lie inside `shape`."""
    probes = inner_points(shape, VOLUME_PROBES)
    covered = _covered(probes, spheres)
    union = _moments(probes[covered] - shape.centroid)
    solid = np.linalg.eigvalsh(shape.mesh.inertia) / shape.volume
    return SphereFitErrors(
        volume=float(covered.mean()) - 1.0,
        area=float(union_area(spheres) / shape.surface_area - 1.0),
        inertia=float(np.abs(union / solid - 1.0).max()),
    )


def _covered(points: FloatArray, spheres: FloatArray) -> BoolArray:
    """Which points lie in a sphere, shape (k,)."""
    covered = np.zeros(len(points), dtype=bool)
    for x, y, z, radius in spheres:
        covered |= ((points - (x, y, z)) ** 2).sum(axis=1) <= radius**2
    return covered


def _moments(points: FloatArray) -> FloatArray:
    """Principal moments about the origin of points of total mass 1, ascending."""
    second = points.T @ points / len(points)
    return np.asarray(np.linalg.eigvalsh(np.trace(second) * np.eye(3) - second))


def inner_points(shape: ConvexPolyhedron, count: int) -> FloatArray:
    """About `count` points inside, evenly spread (Sobol, no chance in it), shape (k, 3)."""
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    share = shape.volume / float(np.prod(high - low))
    power = int(np.ceil(np.log2(count / share)))
    points = low + np.asarray(qmc.Sobol(3, scramble=False).random_base2(power)) * (high - low)
    planes = shape.half_spaces
    return np.asarray(points[(points @ planes.normals.T <= planes.offsets).all(axis=1)])


def _incentre(shape: ConvexPolyhedron) -> FloatArray:
    """Centre of the largest sphere inside, by linear programming."""
    planes = shape.half_spaces
    matrix = np.column_stack([planes.normals, np.ones(len(planes))])
    answer = linprog([0, 0, 0, -1], A_ub=matrix, b_ub=planes.offsets, bounds=[(None, None)] * 3 + [(0, None)])
    return np.asarray(answer.x)[:3]
