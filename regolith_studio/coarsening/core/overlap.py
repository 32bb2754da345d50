"""Volume shared by a polyhedron and a particle, by quadrature over rays from the origin."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.exits import exits

__all__ = ["exits", "jaccard", "shared_charge", "shared_volume"]


@kernel
def shared_volume(
    first: IntArray, distance: FloatArray, sign: FloatArray, weight: float, radius: FloatArray
) -> float:
    """Volume of the part of the particle inside the polyhedron.

    Parameters
    ----------
    first, distance, sign
        Crossings of the particle by ray, as from :func:`regolith_studio.coarsening.core.rays.cast_fibonacci`.
    weight
        Of each ray.
    radius
        Of the polyhedron along each ray, shape (k,).
    """
    total = 0.0
    for k in range(len(radius)):
        r = radius[k]
        for j in range(first[k], first[k + 1]):
            t = min(distance[j], r)
            total += sign[j] * t * t * t
    return total * weight / 3.0


@kernel
def shared_charge(
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    weight: float,
    offsets: FloatArray,
    radius: FloatArray,
    plane: IntArray,
    pivots: FloatArray,
) -> FloatArray:
    """Derivative of the shared volume as charges, shape (n, 4): rays that end inside the particle count."""
    charge = np.zeros((len(offsets), 4))
    for k in range(len(radius)):
        r = radius[k]
        inside = 0.0
        for j in range(first[k + 1] - 1, first[k] - 1, -1):
            if distance[j] <= r:
                break
            inside += sign[j]
        if inside == 0.0:
            continue
        i = plane[k]
        share = inside * weight * r * r * r / offsets[i]
        charge[i, 0] += share
        for c in range(3):
            charge[i, 1 + c] += share * (r * directions[k, c] - pivots[i, c])
    return charge


@kernel
def jaccard(shared: float, particle: float, polyhedron: float) -> float:
    """1 - intersection over union, from volumes."""
    return 1.0 - shared / (particle + polyhedron - shared)
