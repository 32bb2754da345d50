"""Putting redundant half-spaces back to work as small cuts across corners."""

import numpy as np

from regolith_studio.coarsening.core.intersection import FINE, edges_of, intersect
from regolith_studio.coarsening.core.measures import facets_of
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel

LEAST_CUT = 3e-3
"""Least depth of a cut that is worth it, at unit volume."""
SMALLEST_FACET = 1e-6
"""Facets of less area, at unit volume, count as lost."""


@kernel
def redundant(normals: FloatArray, offsets: FloatArray, vertices: FloatArray, triples: IntArray) -> IntArray:
    """Planes that bound no facet worth the name, by index."""
    area, _ = facets_of(normals, offsets, vertices, edges_of(triples, len(offsets)))
    return np.nonzero(area < SMALLEST_FACET)[0]


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
) -> int:
    """Replace each redundant plane, in place, by a cut across the corner that hangs out farthest.

    A cut takes at most the share `depth` of the way to the nearest neighbouring corner, so no other facet
    is lost.

    Returns
    -------
    n_cuts
        Planes replaced; -1 if the half-spaces bound nothing.
    """
    n_cuts = 0
    for _ in range(len(offsets)):
        status, vertices, triples = intersect(normals, offsets)
        if status != FINE:
            return -1
        idle = redundant(normals, offsets, vertices, triples)
        if len(idle) == 0:
            break
        at, normal, room = best_corner(normals, vertices, triples, directions, first, distance, depth)
        top = normal[0] * vertices[at, 0] + normal[1] * vertices[at, 1] + normal[2] * vertices[at, 2]
        normals[idle[0]] = normal
        offsets[idle[0]] = top - depth * room
        n_cuts += 1
    return n_cuts


@kernel
def best_corner(
    normals: FloatArray,
    vertices: FloatArray,
    triples: IntArray,
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    depth: float,
) -> tuple[int, FloatArray, float]:
    """The corner that hangs out farthest of those with room for a cut, else the one with the most room.

    Returns its index, the normal of the cut and the way along it to the nearest neighbouring corner.
    """
    at, most, roomiest, best_room = -1, -np.inf, 0, -np.inf
    rooms = np.empty(len(vertices))
    for v in range(len(vertices)):
        normal = corner_normal(normals, triples[v])
        rooms[v] = np.inf
        for u in range(len(vertices)):
            if neighbours(triples[u], triples[v]):
                rooms[v] = min(rooms[v], np.sum(normal * (vertices[v] - vertices[u])))
        if rooms[v] > best_room:
            roomiest, best_room = v, rooms[v]
        if depth * rooms[v] > LEAST_CUT:
            here = overhang(vertices[v], directions, first, distance)
            if here > most:
                at, most = v, here
    if at < 0:
        at = roomiest
    return at, corner_normal(normals, triples[at]), rooms[at]


@kernel
def corner_normal(normals: FloatArray, triple: IntArray) -> FloatArray:
    """Mean direction of the three planes of a corner."""
    normal = normals[triple[0]] + normals[triple[1]] + normals[triple[2]]
    return np.asarray(normal / np.sqrt(np.sum(normal * normal)))


@kernel
def neighbours(one: IntArray, two: IntArray) -> bool:
    """Whether two vertices, given by their planes, share an edge."""
    shared = 0
    for i in range(3):
        for j in range(3):
            if one[i] == two[j]:
                shared += 1
    return shared == 2
