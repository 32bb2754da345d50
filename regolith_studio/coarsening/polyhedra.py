"""Half-spaces to polyhedra by the compiled intersection: quick enough for every step of a method.

Kernels get copies of the locked arrays of half-spaces: numba would compile all of them a second time for
arrays that cannot be written.
"""

import numpy as np

from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.polyhedron_measures import MeasuredPolyhedron, measure_polyhedron
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces


def polyhedron_of(half_spaces: HalfSpaces) -> ConvexPolyhedron:
    """The polyhedron of half-spaces in general position; else as :meth:`ConvexPolyhedron.from_half_spaces`.

    Raises
    ------
    GeometryError
        If the intersection is unbounded.
    """
    size = float(half_spaces.offsets.max())
    # Areas are compared with absolute tolerances.
    found = intersect_half_spaces(half_spaces.normals, half_spaces.offsets / size)
    if found.status != FINE:
        return ConvexPolyhedron.from_half_spaces(half_spaces)
    n = len(half_spaces)
    following: list[dict[int, int]] = [{} for _ in range(n)]
    for start, end, left, right in found.edges.tolist():
        following[left][start] = end
        following[right][end] = start
    kept = [plane for plane in range(n) if following[plane]]
    facets = tuple(_loop(following[plane]) for plane in kept)
    solid = HalfSpaces(half_spaces.normals[kept], half_spaces.offsets[kept])
    return ConvexPolyhedron(solid, np.asarray(found.vertices * size), facets)


def _loop(following: dict[int, int]) -> tuple[int, ...]:
    """Vertices of a facet in order, from the map of each to the next."""
    first = at = next(iter(following))
    loop = [first]
    while (at := following[at]) != first:
        loop.append(at)
    return tuple(loop)


def facet_areas(half_spaces: HalfSpaces) -> FloatArray:
    """Area of the facet of each half-space, 0 where it has none, shape (n,).

    Raises
    ------
    GeometryError
        If the intersection is unbounded.
    """
    found = intersect_half_spaces(half_spaces.normals, half_spaces.offsets)
    if found.status != FINE:
        raise GeometryError("The half-spaces bound no volume: their intersection is unbounded.")
    return found.areas


def intersect_half_spaces(normals: FloatArray, offsets: FloatArray) -> MeasuredPolyhedron:
    """The polyhedron of half-spaces, also of arrays that cannot be written, shapes (n, 3) and (n,)."""
    return measure_polyhedron(np.array(normals), np.array(offsets))
