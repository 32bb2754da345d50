"""Putting redundant half-spaces back to work as small cuts across corners."""

import numpy as np

from regolith_studio.coarsening.core.intersection import FINE, intersect
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel


@kernel
def redundant(triples: IntArray, n_planes: int) -> IntArray:
    """Planes that bound no facet, by index."""
    real = np.zeros(n_planes, np.bool_)
    for v in range(len(triples)):
        for k in range(3):
            real[triples[v, k]] = True
    return np.nonzero(~real)[0]


@kernel
def overhang(position: FloatArray, directions: FloatArray, first: IntArray, distance: FloatArray) -> float:
    """How far a point lies beyond the particle's surface, along the ray nearest to it."""
    nearest, at = -np.inf, 0
    for k in range(len(directions)):
        here = (
            directions[k, 0] * position[0] + directions[k, 1] * position[1] + directions[k, 2] * position[2]
        )
        if here > nearest:
            nearest, at = here, k
    reach = distance[first[at + 1] - 1] if first[at + 1] > first[at] else 0.0
    return float(np.sqrt(np.sum(position * position)) - reach)


@kernel
def with_all_facets(
    normals: FloatArray,
    offsets: FloatArray,
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    depth: float,
) -> tuple[int, FloatArray, FloatArray]:
    """Replace each redundant plane by a cut across the corner that hangs out farthest of the particle.

    A cut takes at most the share `depth` of the way to the nearest neighbouring corner, so no other facet
    is lost.

    Returns
    -------
    n_cuts
        Planes replaced; -1 if the half-spaces bound nothing.
    normals, offsets
        All planes, in their old order.
    """
    normals, offsets = normals.copy(), offsets.copy()
    n_cuts = 0
    for _ in range(len(offsets)):
        status, vertices, triples = intersect(normals, offsets)
        if status != FINE:
            return -1, normals, offsets
        idle = redundant(triples, len(offsets))
        if len(idle) == 0:
            break
        most, at = -np.inf, 0
        for v in range(len(vertices)):
            here = overhang(vertices[v], directions, first, distance)
            if here > most:
                most, at = here, v
        normal = normals[triples[at, 0]] + normals[triples[at, 1]] + normals[triples[at, 2]]
        normal /= np.sqrt(np.sum(normal * normal))
        top = np.sum(normal * vertices[at])
        room = np.inf
        for v in range(len(vertices)):
            if neighbours(triples[v], triples[at]):
                room = min(room, top - np.sum(normal * vertices[v]))
        normals[idle[0]] = normal
        offsets[idle[0]] = top - depth * room
        n_cuts += 1
    return n_cuts, normals, offsets


@kernel
def neighbours(one: IntArray, two: IntArray) -> bool:
    """Whether two vertices, given by their planes, share an edge."""
    shared = 0
    for i in range(3):
        for j in range(3):
            if one[i] == two[j]:
                shared += 1
    return shared == 2
