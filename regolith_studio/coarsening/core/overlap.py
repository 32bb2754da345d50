"""Volume shared by a polyhedron and a particle, by quadrature over rays from the origin."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.exits import exits
from regolith_studio.geometry.inlined import inlined

__all__ = ["exits", "jaccard", "shared_by_planes", "shared_charge", "shared_volume"]

RAYS = 256
"""Rays that are worked out side by side."""


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
def shared_by_planes(
    normals: FloatArray,
    offsets: FloatArray,
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    weight: float,
) -> float:
    """:func:`shared_volume` of half-spaces, where nobody asks which plane a ray meets; other last bits.

    Parameters
    ----------
    normals, offsets
        Half-spaces <n_i, x> <= h_i with h_i > 0, shapes (n, 3) and (n,).
    directions
        Of the rays, unit vectors, shape (k, 3).
    """
    n = len(offsets)
    dual = np.zeros((n + 3, 3))
    for i in range(n):
        for c in range(3):
            dual[i, c] = normals[i, c] / offsets[i]
    x, y, z, most, sums = np.empty(RAYS), np.empty(RAYS), np.empty(RAYS), np.empty(RAYS), np.zeros(RAYS)
    total = 0.0
    for start in range(0, len(directions), RAYS):
        rays = min(RAYS, len(directions) - start)
        for j in range(rays):
            x[j], y[j], z[j] = directions[start + j, 0], directions[start + j, 1], directions[start + j, 2]
            most[j] = 0.0
        for i in range(0, n, 4):
            a0, a1, a2, b0, b1, b2 = _two_rows(dual, i)
            c0, c1, c2, d0, d1, d2 = _two_rows(dual, i + 2)
            for j in range(rays):
                here = max(x[j] * a0 + y[j] * a1 + z[j] * a2, x[j] * b0 + y[j] * b1 + z[j] * b2)
                there = max(x[j] * c0 + y[j] * c1 + z[j] * c2, x[j] * d0 + y[j] * d1 + z[j] * d2)
                most[j] = max(most[j], max(here, there))
        from_here = first[start]
        single = 0
        for j in range(rays):
            single += first[start + j + 1] - first[start + j] == 1
        if single == rays:
            for j in range(rays):
                t = min(distance[from_here + j], 1.0 / most[j])
                sums[j] += sign[from_here + j] * t * t * t
        else:
            for j in range(rays):
                for k in range(first[start + j], first[start + j + 1]):
                    t = min(distance[k], 1.0 / most[j])
                    total += sign[k] * t * t * t
    return float((total + sums.sum()) * weight / 3.0)


@inlined
def _two_rows(rows: FloatArray, i: int) -> tuple[float, float, float, float, float, float]:
    """Rows i and i + 1 of an array of shape (n, 3)."""
    return rows[i, 0], rows[i, 1], rows[i, 2], rows[i + 1, 0], rows[i + 1, 1], rows[i + 1, 2]


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
