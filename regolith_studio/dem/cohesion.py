"""Cohesion of a stepped solver: a pull-off force along the normal of each pair of particles that touches."""

import numpy as np

from regolith_studio.dem.case import PreparedCase, bond_number
from regolith_studio.dem.engine import MASS
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.messages import N_

PULL_OFF = N_("one pull-off force for each pair that touches, none on walls and plate")
"""As a capability of an engine."""

# Not wider: across 0.01 d grains that did not touch, and so had no friction, pulled each other into flatter
# heaps, of 16 degrees instead of 25 for 400 polyhedra.
RANGE = 0.004
"""Gap in mean diameters across which particles attract: Box3D keeps the points of a contact within it."""


def pull_off_forces(prepared: PreparedCase) -> tuple[float, FloatArray]:
    """Force of two mean particles, and diameters, shape (n,), in the solver's units."""
    contact, mean = prepared.case.contact, prepared.mean_diameter
    bond = bond_number(prepared.surface_energy, mean, contact.density, prepared.case.test.gravity)
    return bond * MASS, prepared.diameters / mean


def pulls(
    force: float,
    sizes: FloatArray,
    pairs: IntArray,
    normals: FloatArray,
    arms: tuple[FloatArray, FloatArray],
) -> FloatArray:
    """Force and torque on every particle, shape (n, 6): one force for a pair, wherever and in how many points
    it touches, in proportion to its reduced diameter, as that of Johnson, Kendall and Roberts is.

    - ``pairs``: particles of each pair, shape (m, 2); ``normals``: from the first to the second.
    - ``arms``: from the centre of each of the two to the point at which it is pulled, shape (m, 3).
    """
    first, second = pairs.T
    reduced = 2 * sizes[first] * sizes[second] / (sizes[first] + sizes[second])
    drawn = (force * reduced)[:, None] * normals
    forces = np.zeros((len(sizes), 6))
    np.add.at(forces, first, np.column_stack([drawn, np.cross(arms[0], drawn)]))
    np.add.at(forces, second, np.column_stack([-drawn, -np.cross(arms[1], drawn)]))
    return forces
