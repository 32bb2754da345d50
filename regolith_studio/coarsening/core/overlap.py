"""Volume shared by a polyhedron and a particle, by quadrature over rays from the origin."""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel, kernel_noalloc

BLOCK = 256
"""Crossings that are worked out together: they stay in the fastest cache."""


class RayTable(NamedTuple):
    """Every crossing of evenly spread rays from the origin with a particle of unit volume.

    Directions are unit vectors (k, 3). Crossings of ray k are ``first[k]:first[k + 1]``, their distances from
    the origin rising, with the sign +1.0 where the ray leaves the particle and -1.0 where it enters. Each ray
    stands for the share `weight` of the integral, so that the quadrature's own volume is 1.
    """

    directions: FloatArray
    first: IntArray
    distance: FloatArray
    sign: FloatArray
    weight: float


@kernel_noalloc
def shared_volume(
    first: IntArray, distance: FloatArray, sign: FloatArray, weight: float, radius: FloatArray
) -> float:
    """Volume of the part of the particle inside the polyhedron, from its radius along each ray, (k,)."""
    total = 0.0
    for k in range(len(radius)):
        r = radius[k]
        for j in range(first[k], first[k + 1]):
            t = min(distance[j], r)
            total += sign[j] * t * t * t
    return total * weight / 3.0


def crossings_of(
    directions: FloatArray, first: IntArray, distance: FloatArray, sign: FloatArray
) -> FloatArray:
    """Every crossing with its ray, for :func:`shared_by_planes`: direction, distance, sign; (5, m)."""
    ray = np.repeat(np.arange(len(directions)), np.diff(first))
    return np.ascontiguousarray(np.vstack([directions[ray].T, distance, sign]))


@kernel
def shared_by_planes(dual: FloatArray, crossings: FloatArray, weight: float) -> float:
    """:func:`shared_volume` of half-spaces, where it does not matter which plane a ray meets.

    `dual` is n_i / h_i of half-spaces <n_i, x> <= h_i with h_i > 0, (n, 3); crossings are those of
    :func:`crossings_of`.
    """
    total, nearest = 0.0, np.empty(BLOCK)
    for start in range(0, crossings.shape[1], BLOCK):
        count = min(BLOCK, crossings.shape[1] - start)
        nearest[:] = 0.0
        for i in range(len(dual)):
            a, b, c = dual[i, 0], dual[i, 1], dual[i, 2]
            for j in range(count):
                k = start + j
                here = crossings[0, k] * a + crossings[1, k] * b + crossings[2, k] * c
                nearest[j] = here if here > nearest[j] else nearest[j]  # noqa: FURB136  compiled to vectors
        for j in range(count):
            r = min(crossings[3, start + j], 1.0 / nearest[j])
            total += crossings[4, start + j] * (r * r * r)
    return total * weight / 3.0


@inner_kernel
def add_shared_charges(
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    weight: float,
    offsets: FloatArray,
    radius: FloatArray,
    plane: IntArray,
    pivots: FloatArray,
    size: float,
    charges: FloatArray,
) -> None:
    """Add `size` times the derivative of the shared volume, charges (n, 4): rays that end inside count.

    Radius and plane, (k,), are those of :func:`regolith_studio.geometry.half_spaces.exits`.
    """
    for k in range(len(radius)):
        r = radius[k]
        inside = 0.0
        # Crossings beyond r add up to the winding number at r: 1 inside the particle.
        for j in range(first[k + 1] - 1, first[k] - 1, -1):
            if distance[j] <= r:
                break
            inside += sign[j]
        if inside == 0.0:
            continue
        i = plane[k]
        # A plane that moves outward by w moves the end of the ray by r w / h, and the volume by r^2 times
        # that.
        share = size * inside * weight * r * r * r / offsets[i]
        charges[i, 0] += share
        for c in range(3):
            charges[i, 1 + c] += share * (r * directions[k, c] - pivots[i, c])


def jaccard(shared: float, particle: float, polyhedron: float) -> float:
    """1 - intersection over union, from volumes."""
    return 1.0 - shared / (particle + polyhedron - shared)
