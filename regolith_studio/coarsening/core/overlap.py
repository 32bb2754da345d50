"""Volume shared by a polyhedron and a particle, by quadrature over rays from the origin."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel


@kernel
def exits(
    normals: FloatArray, offsets: FloatArray, directions: FloatArray, radius: FloatArray, plane: IntArray
) -> None:
    """Where each ray leaves the polyhedron: `radius` (k,) and `plane` (k,) are filled."""
    n = len(offsets)
    dual = np.empty((n, 3))
    for i in range(n):
        for c in range(3):
            dual[i, c] = normals[i, c] / offsets[i]
    for k in range(len(directions)):
        u0, u1, u2 = directions[k, 0], directions[k, 1], directions[k, 2]
        best, at = 0.0, 0
        for i in range(n):
            here = u0 * dual[i, 0] + u1 * dual[i, 1] + u2 * dual[i, 2]
            if here > best:
                best, at = here, i
        radius[k] = 1.0 / best if best > 0.0 else np.inf
        plane[k] = at


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
