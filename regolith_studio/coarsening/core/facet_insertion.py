"""Putting half-spaces that bound no facet back to work as small cuts across corners."""

import numpy as np

from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector, along, cross, dot, length, mixed, row

MIN_CUT = 3e-3
"""Least depth of a cut that is worth it, at unit volume."""
DEEPEST = 0.3
"""Share of the way to the nearest neighbouring corner that a cut of this least depth may take."""
ROOMY = 0.6
"""Corners with less than this share of the largest room are left alone: cuts there would be slivers."""
TOUCHING = 1e-6
"""Corners as near as this to a side of a box touch it."""
MIN_FACET = 1e-6
"""Facets of less area, at unit volume, count as lost."""


def insert_lost_facets(
    normals: FloatArray,
    offsets: FloatArray,
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    depth: float,
    most: int | None = None,
    axes: FloatArray | None = None,
    passed: int = 0,
) -> tuple[int, FloatArray, FloatArray]:
    """Replace each half-space without a facet by a cut across the corner that hangs out farthest.

    A cut takes the share `depth` of the way to the nearest neighbouring corner, so no other facet is lost;
    one of less than :data:`MIN_CUT` takes up to the share :data:`DEEPEST` instead. At most so many (`most`)
    are replaced, and so many corners that hang out farthest are passed over. Corners that touch a box with
    these axes (3, 3) are left alone, where others have room, since a cut there would change the box to first
    order.

    Returns how many were replaced (-1 if the half-spaces bound nothing), normals and offsets. Rays and
    crossings are those of :class:`regolith_studio.coarsening.core.overlap.RayTable`.
    """
    normals, offsets, n_cuts = np.array(normals), np.array(offsets), 0
    for _ in range(len(offsets) if most is None else most):
        # Anew for each cut, whose own corners may be the next to be cut.
        polyhedron = measure_polyhedron(normals, offsets)
        if polyhedron.status != FINE:
            return -1, normals, offsets
        lost = np.flatnonzero(polyhedron.areas < MIN_FACET)
        if len(lost) == 0:
            break
        vertices, triples = polyhedron.vertices, polyhedron.triples
        rooms, neighbours = np.empty(len(vertices)), np.empty((len(vertices), 3), dtype=np.int64)
        fill_neighbours(polyhedron.edges, neighbours)
        corners = normals, vertices, triples, neighbours, directions, first, distance, depth
        free = _not_touching(vertices, axes)
        at = _best_corner(*corners, free, rooms)
        if not rooms[at] > 0.0:
            free[:] = True
            at = _best_corner(*corners, free, rooms)
        for _ in range(passed):
            free[at] = False
            at = _best_corner(*corners, free, rooms)
        if not rooms[at] > 0.0:
            break
        cut = normals[triples[at]].sum(axis=0)
        cut /= np.sqrt((cut * cut).sum())
        normals[lost[0]], offsets[lost[0]] = cut, (cut * vertices[at]).sum() - _below(depth, rooms[at])
        n_cuts += 1
    return n_cuts, normals, offsets


def _not_touching(vertices: FloatArray, axes: FloatArray | None) -> BoolArray:
    """Which corners touch no side of the box; all where there is none."""
    everywhere = np.ones(len(vertices), dtype=np.bool_)
    if axes is None:
        return everywhere
    for axis in axes:
        heights = vertices[:, 0] * axis[0] + vertices[:, 1] * axis[1] + vertices[:, 2] * axis[2]
        everywhere &= (heights < heights.max() - TOUCHING) & (heights > heights.min() + TOUCHING)
    return everywhere


@kernel_noalloc
def fill_neighbours(edges: IntArray, neighbours: IntArray) -> None:
    """The three vertices that share an edge with each, in ascending order, (v, 3)."""
    for v in range(len(neighbours)):
        neighbours[v, 0] = neighbours[v, 1] = neighbours[v, 2] = len(neighbours)
    for e in range(len(edges)):
        for end in range(2):
            v, other = edges[e, end], edges[e, 1 - end]
            for k in range(3):
                if other < neighbours[v, k]:
                    other, neighbours[v, k] = neighbours[v, k], other


@kernel_noalloc
def _best_corner(
    normals: FloatArray,
    vertices: FloatArray,
    triples: IntArray,
    neighbours: IntArray,
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    depth: float,
    free: BoolArray,
    rooms: FloatArray,
) -> int:
    """Index of the corner that hangs out farthest of the free ones with room for a cut.

    Fills `rooms`: for each corner the way along its cut's normal to the nearest neighbouring corner, (v,);
    none where it is not free, or so sharp that the cut would not count as a facet.
    """
    for v in range(len(vertices)):
        rooms[v] = 0.0
        if not free[v]:
            continue
        normal = _corner_normal(normals, triples, v)
        one = two = three = (0.0, 0.0, 0.0)
        room = np.inf
        for k in range(3):
            edge = mixed(row(vertices, neighbours[v, k]), 1.0, row(vertices, v), -1.0)
            fall = -dot(edge, normal)
            room = min(room, fall)
            edge = mixed(edge, 1.0 / max(fall, 1e-300), edge, 0.0)  # down to one below the corner
            one, two, three = two, three, edge
        below = _below(depth, room)
        sides = cross(mixed(two, 1.0, one, -1.0), mixed(three, 1.0, one, -1.0))
        # Twice the least area, or the cut would soon count as lost again.
        if room > 0.0 and 0.5 * below * below * length(sides) > 2.0 * MIN_FACET:
            rooms[v] = room
    at, max_overhang = int(rooms.argmax()), -np.inf
    enough = max(MIN_CUT / depth, ROOMY * rooms[at])
    for v in range(len(vertices)):
        if rooms[v] > enough:
            overhang = _overhang(row(vertices, v), directions, first, distance)
            if overhang > max_overhang:
                at, max_overhang = v, overhang
    return at


@kernel_noalloc
def _below(depth: float, room: float) -> float:
    """How far below its corner a cut lies."""
    return max(depth * room, min(MIN_CUT, DEEPEST * room))


@inner_kernel
def _overhang(position: Vector, directions: FloatArray, first: IntArray, distance: FloatArray) -> float:
    """How far a point lies beyond the particle's surface, along the ray nearest to it."""
    nearest, at = -np.inf, 0
    for k in range(len(directions)):
        here = along(directions, k, position)
        if here > nearest:
            nearest, at = here, k
    surface = distance[first[at + 1] - 1] if first[at + 1] > first[at] else 0.0
    return float(length(position) - surface)


@inner_kernel
def _corner_normal(normals: FloatArray, triples: IntArray, v: int) -> Vector:
    """Mean direction of the three planes of a corner."""
    normal = mixed(row(normals, triples[v, 0]), 1.0, row(normals, triples[v, 1]), 1.0)
    normal = mixed(normal, 1.0, row(normals, triples[v, 2]), 1.0)
    return mixed(normal, 1.0 / length(normal), normal, 0.0)
