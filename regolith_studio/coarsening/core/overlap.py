"""Volume shared by a polyhedron and a particle, by quadrature over rays from the origin."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.eights import least, load, most, splat, total
from regolith_studio.geometry.exits import exits
from regolith_studio.geometry.kernels import kernel, kernel_noalloc

__all__ = ["crossings_of", "exits", "jaccard", "shared_by_planes", "shared_charge", "shared_volume"]

SIDE_BY_SIDE = 16
"""Crossings that are worked out together."""


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
def crossings_of(
    directions: FloatArray, first: IntArray, distance: FloatArray, sign: FloatArray
) -> FloatArray:
    """Every crossing with its ray, for :func:`shared_by_planes`: direction, distance and sign, shape (5, m).

    The last are at distance 0, so that m is a multiple of sixteen.
    """
    m = len(distance)
    crossings = np.zeros((5, (m + SIDE_BY_SIDE - 1) // SIDE_BY_SIDE * SIDE_BY_SIDE))
    for k in range(len(directions)):
        for j in range(first[k], first[k + 1]):
            for c in range(3):
                crossings[c, j] = directions[k, c]
            crossings[3, j], crossings[4, j] = distance[j], sign[j]
    return crossings


@kernel_noalloc
def shared_by_planes(dual: FloatArray, crossings: FloatArray, weight: float) -> float:
    """:func:`shared_volume` of half-spaces, where nobody asks which plane a ray meets; other last bits.

    Parameters
    ----------
    dual
        n_i / h_i of half-spaces <n_i, x> <= h_i with h_i > 0, shape (n, 3).
    crossings
        Of the particle, as from :func:`crossings_of`.
    weight
        Of each ray.
    """
    m, one = crossings.shape[1], splat(1.0)
    sums = splat(0.0)
    for at in range(0, m, SIDE_BY_SIDE):
        x, y, z = load(crossings, at), load(crossings, m + at), load(crossings, 2 * m + at)
        u, v, w = load(crossings, at + 8), load(crossings, m + at + 8), load(crossings, 2 * m + at + 8)
        near, far = splat(0.0), splat(0.0)
        for i in range(len(dual)):
            a, b, c = splat(dual[i, 0]), splat(dual[i, 1]), splat(dual[i, 2])
            near, far = most(x * a + y * b + z * c, near), most(u * a + v * b + w * c, far)
        t = least(load(crossings, 3 * m + at), one / near)
        r = least(load(crossings, 3 * m + at + 8), one / far)
        sums = sums + load(crossings, 4 * m + at) * (t * t * t)
        sums = sums + load(crossings, 4 * m + at + 8) * (r * r * r)
    return total(sums) * weight / 3.0


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
