"""Polyhedra with six facets on the sides of the particle's own least box: for particles that nearly fill it.

The box of a body that nearly fills it has hardly any room to move: no condition is smooth within a step of
it, and Gauss-Newton fails. With six half-spaces held at its sides the diameters are met by themselves, and
volume and sphericity are left to the other half-spaces.
"""

import numpy as np

from regolith_studio.coarsening.exact.starts import grouped_planes
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray

SIDES = 6
FLUSH = 0.02
"""Triangles of the hull belong to a side of the box up to this sine, and this distance at unit volume."""
INWARD = 1e-3
"""The other half-spaces begin so much farther in than the hull, as a share: so that none is redundant."""


def boxed_planes(
    target: Target, n_faces: int, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray] | None:
    """The sides of the particle's least box first, then groups of the hull's triangles that lie elsewhere.

    ``None`` where nothing lies elsewhere, or `n_faces` leaves no half-space for it.
    """
    if n_faces <= SIDES:
        return None
    box = target.box
    sides = np.vstack([box.axes, -box.axes])
    reach = sides @ box.centre + np.tile(box.extents, 2) / 2
    hull = target.mesh.hull
    areas = hull.face_areas
    normals = hull.face_area_vectors / np.maximum(areas, 1e-300)[:, None]
    centres = hull.triangles.mean(axis=1)
    cosine = normals @ sides.T
    near = np.abs(reach - centres @ sides.T) < FLUSH
    elsewhere = (areas > 0.0) & ~((cosine > np.sqrt(1.0 - FLUSH**2)) & near).any(axis=1)
    if not elsewhere.any():
        return None
    others, offsets = grouped_planes(
        normals[elsewhere], areas[elsewhere], centres[elsewhere], rng.random(n_faces - SIDES), 10
    )
    offsets = np.maximum(offsets, 0.05) * (1.0 - INWARD * rng.random(len(offsets)))
    return np.vstack([sides, others]), np.concatenate([reach, offsets])
