"""Geometry of the lifting-cylinder test of section 2.6: number of particles, size and meshes of the cylinder.

SI units.
"""

from dataclasses import replace

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh

MICROMETRE = 1e-6
FILL, PACKED = 1.375, 0.55
"""Fill height over diameter of the paper's cylinder (2.5 to 3 cm of 2 cm), and its solid fraction."""


def scaled_cylinder(
    test: LiftingCylinderTest, solid_volume: float, min_diameter: float
) -> LiftingCylinderTest:
    """The cylinder scaled down for fewer particles, so that fill height over diameter is that of the paper.

    Parameters
    ----------
    solid_volume
        Of all particles, in m3.
    min_diameter
        Minimum diameter in metres: a few of the largest particles.
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


def tube_mesh(diameter: float, height: float, sides: int = 96, thickness: float = 0.05) -> Mesh:
    """An upright tube on z = 0 as a closed surface; its inner polygon has the area of the circle.

    Parameters
    ----------
    diameter
        Inner.
    thickness
        Of the wall, as a fraction of the diameter.
    """
    angles = 2 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    inner = diameter / 2 * np.sqrt(2 * np.pi / sides / np.sin(2 * np.pi / sides))
    rings = [(inner, 0.0), (inner + thickness * diameter, 0.0)]
    rings = [*rings, *((radius, height) for radius, _ in reversed(rings))]
    vertices = np.vstack([np.column_stack([circle * r, np.full(sides, z)]) for r, z in rings])
    here, there = np.arange(sides), (np.arange(sides) + 1) % sides
    faces = []
    for ring in range(4):
        a, b = ring * sides, (ring + 1) % 4 * sides
        faces += [np.column_stack([a + here, b + here, b + there])]
        faces += [np.column_stack([a + here, b + there, a + there])]
    mesh = Mesh(vertices, np.vstack(faces))
    return mesh if mesh.volume > 0.0 else Mesh(vertices, np.vstack(faces)[:, ::-1])


def box_mesh(corners: FloatArray) -> Mesh:
    """An upright box between two opposite corners, shape (2, 3)."""
    middle, half = corners.mean(axis=0), np.ptp(corners, axis=0) / 2
    planes = HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.concatenate([half, half]))
    return ConvexPolyhedron.from_half_spaces(planes).mesh.moved(shift=middle)
