"""Packing of a heap away from its surface and the plate: solid fraction and coordination number."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation
from scipy.stats.qmc import Sobol

from regolith_studio.dem.angle_of_repose import ReposeMeasurement
from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.initial_packing import enclosing_radii, facet_planes
from regolith_studio.dem.separation import separations
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray

SURFACE_DISTANCE, PLATE_DISTANCE = 1.5, 1.0
"""Between the region and the surface of the heap, and the plate, in mean diameters."""
CONTACT_MARGIN = 0.01
"""Particles touch if they are at most this far apart, in mean diameters."""
# Of as many random points the fraction would scatter by 0.002.
N_POINTS = 2**16
"""Quasi-random points in the box of the region at which the solid fraction is counted."""
MIN_PARTICLES = 20
"""Centres in the region below which nothing is stated."""
MAX_PARTICLES = 300
"""Particles whose contacts are counted, at most."""


@dataclass(frozen=True)
class HeapPacking:
    """Packing in the region of a heap that lies :data:`SURFACE_DISTANCE` below its surface and
    :data:`PLATE_DISTANCE` above the plate.

    - ``solid_fraction``: share of the region's volume within a particle.
    - ``coordination_number``: mean number of particles that touch a particle whose centre is in the region,
      within :data:`CONTACT_MARGIN`.
    - ``n_particles``: with their centres in the region.
    """

    solid_fraction: float
    coordination_number: float
    n_particles: int


def measure_packing(
    prepared: PreparedCase, heap: ParticleState, measurement: ReposeMeasurement
) -> HeapPacking | None:
    """The packing of a heap whose angle is known; ``None`` if fewer than :data:`MIN_PARTICLES` are inside.

    The surface is the cone of the symmetric fits, cut off at the height of the heap.
    """
    d = measurement.mean_diameter
    # The median: single particles that rolled far away do not move it.
    axis = np.array([*np.median(heap.points[:, :2], axis=0), measurement.base])
    # The cone of one angle: the region has to have a closed form for the quasi-random points.
    slope = float(np.tan(np.radians(measurement.symmetric.mean)))
    apex = float(np.mean([each.symmetric.apex[1] for each in measurement.sections]))
    top = min(
        apex - SURFACE_DISTANCE * d * float(np.hypot(1.0, slope)), measurement.height - SURFACE_DISTANCE * d
    )

    def inside(points: FloatArray) -> BoolArray:
        across = np.linalg.norm(points[:, :2], axis=1)
        cone = apex - slope * across - SURFACE_DISTANCE * d * np.hypot(1.0, slope)
        return np.asarray((points[:, 2] > PLATE_DISTANCE * d) & (points[:, 2] < np.minimum(cone, top)))

    kernel = np.flatnonzero(inside(heap.points - axis))
    if len(kernel) < MIN_PARTICLES:
        return None
    radius = (apex - PLATE_DISTANCE * d) / slope
    box = np.array([[-radius, -radius, PLATE_DISTANCE * d], [radius, radius, top]])
    # Without scrambling, so that a run states the same fraction again.
    points = box[0] + Sobol(3, scramble=False).random(N_POINTS) * (box[1] - box[0])
    points = points[inside(points)] + axis
    return HeapPacking(
        solid_fraction=float(within_particles(prepared, heap, points).mean()),
        # Every so many-th, not the first: particles lie in the order of their filling, hence by height.
        coordination_number=_contacts(prepared, heap, kernel[:: -(-len(kernel) // MAX_PARTICLES)], d),
        n_particles=len(kernel),
    )


def packing_document(density: float, filled: float | None, heap: HeapPacking | None) -> dict[str, Any]:
    """Solid fractions and bulk densities of filling and heap as JSON; lengths in mean diameters.

    ``density``: of the particles, in kg/m^3. ``filled``: solid fraction of the filled cylinder.
    """
    document: dict[str, Any] = {
        "filled_solid_fraction": filled,
        "filled_bulk_density": None if filled is None else density * filled,
        "heap": None,
    }
    if heap is not None:
        document["heap"] = {
            **asdict(heap),
            "bulk_density": density * heap.solid_fraction,
            "contact_margin": CONTACT_MARGIN,
            "distance_from_surface": SURFACE_DISTANCE,
            "distance_from_plate": PLATE_DISTANCE,
        }
    return document


def within_particles(prepared: PreparedCase, particles: ParticleState, points: FloatArray) -> BoolArray:
    """Whether each point is in a particle, shape (m,)."""
    inside = np.zeros(len(points), dtype=bool)
    near = cKDTree(points).query_ball_point(particles.points, enclosing_radii(prepared))
    if prepared.case.shapes == "spheres":
        inside[np.unique(np.concatenate([np.asarray(each, dtype=int) for each in near]))] = True
        return inside
    planes = facet_planes(prepared)
    turns = Rotation.from_quat(particles.orientations, scalar_first=True).as_matrix()
    for k, close in enumerate(near):
        index = np.asarray(close, dtype=int)
        own = (points[index] - particles.points[k]) @ turns[k] / prepared.scales[k]
        for part in planes[int(prepared.class_index[k])]:
            inside[index] |= (own @ part[:, :3].T + part[:, 3] <= 0.0).all(axis=1)
    return inside


def _contacts(prepared: PreparedCase, heap: ParticleState, chosen: IntArray, d: float) -> float:
    """Mean number of particles that touch one of the chosen particles."""
    reach, margin = enclosing_radii(prepared), CONTACT_MARGIN * d
    near = cKDTree(heap.points).query_ball_point(heap.points[chosen], reach[chosen] + reach.max() + margin)
    pairs = np.array(
        [(k, other) for k, close in zip(chosen, near, strict=True) for other in close if other != k]
    )
    apart = np.linalg.norm(heap.points[pairs[:, 0]] - heap.points[pairs[:, 1]], axis=1)
    pairs = pairs[apart < reach[pairs].sum(axis=1) + margin]
    return float((separations(prepared, heap, pairs, margin) <= margin).sum() / len(chosen))
