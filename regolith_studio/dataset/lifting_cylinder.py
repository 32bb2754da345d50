"""Geometry of the lifting-cylinder test of section 2.6: number of particles, size and meshes of the cylinder.

SI units.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import MICROMETRE, ExportOptions
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dataset.size_distributions import SizeDistribution
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh

FILL, PACKED = 1.375, 0.55
"""Fill height over diameter of the paper's cylinder (2.5 to 3 cm of 2 cm), and its solid fraction."""


def scaled_cylinder(
    test: LiftingCylinderTest, solid_volume: float, min_diameter: float
) -> LiftingCylinderTest:
    """The cylinder scaled down for fewer particles, so that fill height over diameter is that of the paper.

    ``solid_volume``: of all particles, in m3. ``min_diameter``: minimum diameter in metres: a few of the
    largest particles.
    """
    diameter = float((solid_volume / PACKED / (np.pi / 4 * FILL)) ** (1 / 3))
    diameter = min(test.diameter, max(diameter, min_diameter))
    return replace(test, diameter=diameter, height=test.height * diameter / test.diameter)


def mean_particle_mass(dataset: Dataset, density: float, coarse_graining_factor: float = 1.0) -> float:
    """Mean mass of a particle counted by number, in kg: density pi/6 f^3 <d^3>."""
    cubes = np.array([one.sizes.mean_cube() for one in dataset.representatives])
    mean_cube = float(dataset.class_weights("number") @ cubes)
    return density * np.pi / 6 * (coarse_graining_factor * MICROMETRE) ** 3 * mean_cube


def particle_count(
    dataset: Dataset, total_mass: float, density: float, coarse_graining_factor: float = 1.0
) -> float:
    """Particles in `total_mass` (kg); with the paper's sizes, density and factor 378,000 in 15 g."""
    return total_mass / mean_particle_mass(dataset, density, coarse_graining_factor)


MANY_PARTICLES = 500_000
"""Above the number that the paper simulates (378,000); more take a solver weeks."""

QUANTILES = 65
"""Of each class that represent it in the median size; odd, so that the median of one class is exact."""


@dataclass(frozen=True)
class CylinderFilling:
    """The particles that fill the mass of a lifting-cylinder test.

    - ``n_particles``: expected number.
    - ``mass``: of all particles, in kg.
    - ``median_diameter``: by mass, after coarse graining, in micrometres.
    - ``sufficient_factor``: coarse-graining factor, of two digits, at which there are at most
      :data:`MANY_PARTICLES`.
    """

    n_particles: float
    mass: float
    median_diameter: float
    sufficient_factor: float


def cylinder_filling(
    number_weights: Sequence[float], sizes: Sequence[SizeDistribution], options: ExportOptions
) -> CylinderFilling:
    """Number and median size of the particles of a script that fills the test's mass.

    ``number_weights``: share of each class of the particles counted by number; divided by their sum.
    ``sizes``: of each class, in micrometres.
    """
    weights = np.asarray(number_weights) / np.sum(number_weights)
    cubes = np.array([each.mean_cube() for each in sizes])
    factor, mass = options.coarse_graining_factor, options.test.mass
    one = options.contact.density * np.pi / 6 * (factor * MICROMETRE) ** 3 * float(weights @ cubes)
    count = mass / one
    shares = weights * cubes / (weights @ cubes)
    probabilities = (np.arange(QUANTILES) + 0.5) / QUANTILES
    diameters = np.concatenate([each.weighted("volume").quantile(probabilities) for each in sizes])
    order = np.argsort(diameters)
    below = np.cumsum(np.repeat(shares / QUANTILES, QUANTILES)[order])
    median = float(diameters[order][np.searchsorted(below, 0.5)])
    sufficient = _two_digits_up(factor * np.cbrt(count / MANY_PARTICLES))
    return CylinderFilling(count, mass, factor * median, sufficient)


def _two_digits_up(value: float) -> float:
    # 1e-9: what has two digits already must not be rounded up by its last bit.
    step = 10.0 ** (np.floor(np.log10(value)) - 1)
    return float(f"{np.ceil(value / step - 1e-9) * step:.2g}")


TUBE_SIDES, TUBE_THICKNESS = 96, 0.05
"""Sides of the polygon of a tube, and thickness of its wall as a fraction of the inner diameter."""


def tube_mesh(diameter: float, height: float) -> Mesh:
    """An upright tube on z = 0 as a closed surface; its inner polygon has the area of the circle.

    ``diameter``: inner.
    """
    sides = TUBE_SIDES
    angles = 2 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    inner = diameter / 2 * np.sqrt(2 * np.pi / sides / np.sin(2 * np.pi / sides))
    rings = [(inner, 0.0), (inner + TUBE_THICKNESS * diameter, 0.0)]
    rings = [*rings, *((radius, height) for radius, _ in reversed(rings))]
    vertices = np.vstack([np.column_stack([circle * r, np.full(sides, z)]) for r, z in rings])
    here, there = np.arange(sides), (np.arange(sides) + 1) % sides
    faces = []
    for ring in range(4):
        a, b = ring * sides, (ring + 1) % 4 * sides
        faces += [np.column_stack([b + there, b + here, a + here])]
        faces += [np.column_stack([a + there, b + there, a + here])]
    return Mesh(vertices, np.vstack(faces))


def box_mesh(corners: FloatArray) -> Mesh:
    """An upright box between two opposite corners, shape (2, 3)."""
    middle, half = corners.mean(axis=0), np.ptp(corners, axis=0) / 2
    planes = HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.concatenate([half, half]))
    return ConvexPolyhedron.from_half_spaces(planes).mesh.moved(shift=middle)
