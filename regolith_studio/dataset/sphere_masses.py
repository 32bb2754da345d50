"""Masses of overlapping spheres for programs that add them up, as if none overlapped.

Such a program takes every sphere as a solid ball. With masses in proportion to volume what overlaps counts
more than once; masses of their own give the sum the polyhedron's mass, centre and inertia.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import Polyhedron

LOWEST = 0.05
"""Lowest mass of a sphere, in that which it has at equal density; some programs refuse spheres without."""
EVENNESS = 1e-4
"""Weight of equal density against the moments."""

CENTRE_WEIGHT = 30.0
"""Of mass and centre against inertia where few spheres cannot have all of it."""


@dataclass(frozen=True, eq=False)
class SphereMasses:
    """Masses at density 1 of a polyhedron of any size.

    Parameters
    ----------
    values
        Of each sphere, shape (n,); they add up to the volume.
    centre_error
        Distance of their centre from the centroid, in cube roots of the volume.
    inertia_error
        Largest difference of an entry of the tensor of inertia about the centroid, over the largest moment.
    """

    values: FloatArray
    centre_error: float
    inertia_error: float


def sphere_masses(shape: Polyhedron, spheres: FloatArray) -> SphereMasses:
    """Masses of solid balls, rows x, y, z, r, that together have the shape's mass, centre and inertia.

    Among all that do, nearly those of the most even density; as near as it goes where few spheres cannot.
    """
    size = shape.volume ** (1 / 3)
    centres, radii = (spheres[:, :3] - shape.centroid) / size, spheres[:, 3] / size
    wanted = np.asarray(shape.mesh.inertia) / size**5
    tensors = ((centres**2).sum(axis=1) + 0.4 * radii**2)[:, None, None] * np.eye(3)
    tensors = tensors - centres[:, :, None] * centres[:, None, :]
    upper = np.triu_indices(3)
    first = CENTRE_WEIGHT * np.vstack([np.ones(len(spheres)), centres.T])
    rows = np.vstack([first, tensors[:, *upper].T / wanted.max()])
    goal = np.array([CENTRE_WEIGHT, 0.0, 0.0, 0.0, *(wanted[upper] / wanted.max())])
    even = radii**3 / (radii**3).sum()
    matrix = np.vstack([rows * even, EVENNESS * np.eye(len(spheres))])
    found = lsq_linear(matrix, np.concatenate([goal, np.full(len(spheres), EVENNESS)]), (LOWEST, np.inf))
    masses = found.x * even
    masses /= masses.sum()
    off = rows @ masses - goal
    centre = float(np.linalg.norm(off[1:4])) / CENTRE_WEIGHT
    return SphereMasses(masses * shape.volume, centre, float(np.abs(off[4:]).max()))
