"""How many particles are in the test of section 2.6, and how large a tube they fill. SI units."""

from dataclasses import replace

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest

MICROMETRE = 1e-6
FILL, PACKED = 1.375, 0.55
"""Fill height over diameter of the paper's cylinder (2.5 to 3 cm of 2 cm), and the solid share of it."""


def tube_for(test: LiftingCylinderTest, solid_volume: float, narrowest: float) -> LiftingCylinderTest:
    """The cylinder made smaller for fewer particles: they fill it as high for its width as in the paper.

    Parameters
    ----------
    solid_volume
        Of all particles, in m3.
    narrowest
        Least diameter in metres: a few of the largest particles.
    """
    diameter = float((solid_volume / PACKED / (np.pi / 4 * FILL)) ** (1 / 3))
    diameter = min(test.diameter, max(diameter, narrowest))
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
