"""Extents and plane facets of a convex solid, and which of its edges its minimum-volume box can touch."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel_noalloc
from regolith_studio.geometry.minimum_box.edge_pair import unit
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed, row

MIN_CELLS, MAX_CELLS = 12, 64
"""Directions are told apart by a grid of so many cells along the edge of a cube: as many as the square root
of the number of vertices."""
BLOCK = 256
"""Directions that are looked along together: they stay in the fastest cache."""


class SpanTable(NamedTuple):
    """A vector across the solid for each cell of directions.

    - ``spans``: between the vertices farthest along and against the cell's middle, shape (3 cells^2, 3).
    - ``cells``: along the edge of a cube; those of one direction and of its opposite are the same.
    """

    spans: FloatArray
    cells: int


@inner_kernel
def extreme_vertices(points: FloatArray, direction: Vector) -> tuple[int, int]:
    """The vertices farthest along and against `direction`, the first of equal ones; points (3, n)."""
    x, y, z = direction
    low, high, bottom, top = np.inf, -np.inf, 0, 0
    for i in range(points.shape[1]):
        here = points[0, i] * x + points[1, i] * y + points[2, i] * z
        if here < low:
            low, bottom = here, i
        if here > high:
            high, top = here, i
    return top, bottom


@inner_kernel
def between(points: FloatArray, one: int, two: int) -> Vector:
    """Vector from vertex `two` to vertex `one`."""
    return points[0, one] - points[0, two], points[1, one] - points[1, two], points[2, one] - points[2, two]


def extreme_vertices_of_each(points: FloatArray, directions: FloatArray) -> IntArray:
    """:func:`extreme_vertices` for all directions, shape (3, m): shape (2, m), top and bottom."""
    ends = np.empty((2, directions.shape[1]), dtype=np.int64)
    fill_extreme_vertices(points, directions, np.empty((4, BLOCK)), ends)
    return ends


@kernel_noalloc
def fill_extreme_vertices(
    points: FloatArray, directions: FloatArray, block: FloatArray, ends: IntArray
) -> None:
    """Fill `ends` (2, m); `block` (4, BLOCK) is scratch."""
    low, high, bottom, top = block[0], block[1], block[2], block[3]
    for start in range(0, directions.shape[1], BLOCK):
        count = min(BLOCK, directions.shape[1] - start)
        for k in range(count):
            low[k], high[k], bottom[k], top[k] = np.inf, -np.inf, 0.0, 0.0
        for i in range(points.shape[1]):
            x, y, z, number = points[0, i], points[1, i], points[2, i], float(i)
            for k in range(count):  # compiled to vectors: no branch, and only floats
                at = start + k
                here = x * directions[0, at] + y * directions[1, at] + z * directions[2, at]
                bottom[k] = number if here < low[k] else bottom[k]
                low[k] = here if here < low[k] else low[k]  # noqa: FURB136
                top[k] = number if here > high[k] else top[k]
                high[k] = here if here > high[k] else high[k]  # noqa: FURB136
        for k in range(count):
            ends[0, start + k], ends[1, start + k] = int(top[k]), int(bottom[k])


def span_table(points: FloatArray) -> SpanTable:
    """Look along the middle of every cell; points of shape (3, n)."""
    cells = n_cells(points.shape[1])
    top, bottom = extreme_vertices_of_each(points, cell_directions(cells))
    return SpanTable(np.ascontiguousarray((points[:, top] - points[:, bottom]).T), cells)


def n_cells(n_points: int) -> int:
    """Cells along the edge of the cube for so many vertices."""
    return min(MAX_CELLS, max(MIN_CELLS, int(np.sqrt(n_points))))


@lru_cache(maxsize=8)
def cell_directions(cells: int) -> FloatArray:
    """Directions to the middles of all cells (k, i, j), number (k cells + i) cells + j; (3, 3 cells^2)."""
    middles = (2.0 * np.arange(cells) + 1.0) / cells - 1.0
    directions = np.empty((3, 3, cells, cells))
    for k in range(3):
        directions[k, k] = 1.0
        directions[(k + 1) % 3, k] = middles[:, None]
        directions[(k + 2) % 3, k] = middles
    return directions.reshape(3, -1)


@inner_kernel
def span_near(table: SpanTable, direction: Vector) -> Vector:
    """A vector between two vertices that is nearly as long along `direction` as the solid is wide."""
    x, y, z = direction
    if abs(x) >= abs(y) and abs(x) >= abs(z):
        k, u, v = 0, y / x, z / x
    elif abs(y) >= abs(z):
        k, u, v = 1, z / y, x / y
    else:
        k, u, v = 2, x / z, y / z
    spans, cells = table
    i = min(cells - 1, int((u + 1.0) * (0.5 * cells)))
    j = min(cells - 1, int((v + 1.0) * (0.5 * cells)))
    at = (k * cells + i) * cells + j
    return spans[at, 0], spans[at, 1], spans[at, 2]


SLIVER = 1e-9
"""A triangle of less height, at solid size 1, has no normal of its own."""

EPSILON = 1e-15
"""Rounding of coordinates, at solid size 1, with some reserve."""

COPLANAR = 1e-9
"""Neighbouring faces whose normals differ by less, in radians, are one facet."""
QUARTER_TURNS = 24
MAX_TILT = 0.1
"""Square of the sine of the angle beyond which a bound on the third side is not worth its time."""


class Facets(NamedTuple):
    """A convex solid of size about 1 near the origin.

    - ``points``: vertices, shape (3, v).
    - ``normals``: of the facets, shape (n, 3); no two neighbours lie in one plane.
    - ``edges``: rows (from, to, facet, other facet), shape (e, 4).
    """

    points: FloatArray
    normals: FloatArray
    edges: IntArray


def facets_of_hull(points: FloatArray, faces: IntArray) -> Facets | None:
    """Plane facets of a closed triangulated convex solid, and the edges between them.

    The solid has a size of about 1 and lies near the origin. ``None`` where the triangles do not close: where
    an edge is not run once each way, a vertex has no triangle, or a triangle neither a normal nor a neighbour
    with one.
    """
    origin, end = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    forward, backward = origin * len(points) + end, end * len(points) + origin
    order = np.argsort(forward)
    at = np.minimum(np.searchsorted(forward, backward, sorter=order), len(order) - 1)
    opposite = order[at]
    closed = np.array_equal(forward[opposite], backward) and np.array_equal(
        opposite[opposite], np.arange(len(opposite))
    )
    if not closed or not (np.bincount(origin, minlength=len(points)) > 0).all():
        return None
    normals, blur = _face_normals(points, faces, opposite)
    if not normals.any(axis=1).all():
        return None
    facet = np.full(len(faces), -1)
    _fill_facets(normals, blur, np.argsort(blur), opposite, facet, np.empty(len(faces), dtype=np.int64))
    first, number = np.unique(facet, return_inverse=True)
    one, two = number[np.arange(len(opposite)) // 3], number[opposite // 3]
    kept = (np.arange(len(opposite)) < opposite) & (one != two)
    edges = np.column_stack([origin, end, one, two])[kept]
    return Facets(np.ascontiguousarray(points.T), normals[first], edges)


def _face_normals(points: FloatArray, faces: IntArray, opposite: IntArray) -> tuple[FloatArray, FloatArray]:
    """Unit normals, and how far rounding may tilt them.

    A sliver takes that of the neighbour across its longest edge; if that has none, across its longest edge
    to one that has.
    """
    corners = points[faces]
    edges = np.roll(corners, -1, axis=1) - corners
    lengths = np.linalg.norm(edges, axis=2)
    normals = np.cross(edges[:, 0], -edges[:, 2])
    sizes = np.linalg.norm(normals, axis=1)
    heights = sizes / np.maximum(lengths.max(axis=1), 1e-300)
    sound = heights > SLIVER
    blur = np.where(sound, EPSILON / np.where(sound, heights, 1.0), EPSILON / SLIVER)
    normals = np.where(sound[:, None], normals / np.where(sound, sizes, 1.0)[:, None], 0.0)
    slivers, neighbours = np.flatnonzero(~sound), opposite.reshape(-1, 3) // 3
    for attempt in range(2 * len(slivers)):
        for f in slivers[~normals[slivers].any(axis=1)]:
            share = lengths[f]
            # Two slivers whose longest edge is the same would take from each other what neither has.
            if attempt >= len(slivers):
                share = share * normals[neighbours[f]].any(axis=1)
            if share.any():
                normals[f] = normals[neighbours[f, share.argmax()]]
        if normals[slivers].any(axis=1).all():
            break
    return normals, blur


@kernel_noalloc
def _fill_facets(
    normals: FloatArray,
    blur: FloatArray,
    order: IntArray,
    opposite: IntArray,
    facet: IntArray,
    stack: IntArray,
) -> None:
    """Fill the first face of the facet of each face; all its faces get the normal that rounding tilts least.

    `order` has the faces by rising blur; `facet` (m,) must be -1, `stack` (m,) is scratch.
    """
    for i in range(len(order)):
        seed = order[i]
        if facet[seed] >= 0:
            continue
        facet[seed], stack[0], n = seed, seed, 1
        while n > 0:
            n -= 1
            face = stack[n]
            for h in range(3 * face, 3 * face + 3):
                f = opposite[h] // 3
                if facet[f] >= 0:
                    continue
                if length(mixed(row(normals, f), 1.0, row(normals, seed), -1.0)) < COPLANAR + blur[f]:
                    facet[f], stack[n] = seed, f
                    for k in range(3):
                        normals[f, k] = normals[seed, k]
                    n += 1


def arcs_of(facets: Facets) -> FloatArray:
    """For each edge its unit direction, a span across the solid, and a bound on the width along its arc.

    The span runs from the vertex opposite to the edge to the edge. Last the middle of the arc, and how far
    its ends are from there; shape (e, 11).
    """
    points, normals, edges = facets
    one, two = normals[edges[:, 2]], normals[edges[:, 3]]
    lowest = extreme_vertices_of_each(points, np.ascontiguousarray((one + two).T))[1]
    start, end = points.T[edges[:, 0]], points.T[edges[:, 1]]
    span, middle = start - points.T[lowest], one + two
    middle /= np.linalg.norm(middle, axis=1)[:, None]
    arcs = np.empty((len(edges), 11))
    arcs[:, :3] = (end - start) / np.linalg.norm(end - start, axis=1)[:, None]
    arcs[:, 3:6], arcs[:, 7:10] = span, middle
    arcs[:, 6] = np.minimum((span * one).sum(axis=1), (span * two).sum(axis=1))
    arcs[:, 10] = np.linalg.norm(one - middle, axis=1)
    return arcs


@inner_kernel
def min_third_extent(arcs: FloatArray, table: SpanTable, i: int, k: int) -> float:
    """A bound on the width across two sides that are flush with edges i and k; 0 where there is no use in it.

    The third axis is normal to one axis on either arc, so its products with the middles m of the arcs are at
    most their half widths h, and the part of it that lies in the plane of the middles is at most
    sqrt((h_i^2 + h_k^2 + 2 |m_i m_k| h_i h_k) / (1 - (m_i m_k)^2)).
    """
    one, two = (arcs[i, 7], arcs[i, 8], arcs[i, 9]), (arcs[k, 7], arcs[k, 8], arcs[k, 9])
    h, g, cosine = arcs[i, 10], arcs[k, 10], abs(dot(one, two))
    apart = 1.0 - cosine * cosine
    tilt = h * h + g * g + 2.0 * cosine * h * g
    if not tilt < MAX_TILT * apart:
        return 0.0
    third = cross(one, two)
    span = span_near(table, third)
    tilt, squared = tilt / apart, dot(span, third) ** 2 / apart
    across = max(0.0, dot(span, span) - squared)
    return float(np.sqrt(squared * (1.0 - tilt)) - np.sqrt(across * tilt))


def edges_that_may_bound(facets: Facets, arcs: FloatArray, table: SpanTable, limit: float) -> BoolArray:
    """Which edges some box below the limit could be flush with, shape (e,)."""
    angles = np.linspace(0.0, np.pi / 2.0, QUARTER_TURNS, endpoint=False)
    may_bound = np.zeros(len(facets.edges), dtype=np.bool_)
    fill_edges_that_may_bound(facets, arcs, table, limit, np.cos(angles), np.sin(angles), may_bound)
    return may_bound


@kernel_noalloc
def fill_edges_that_may_bound(
    facets: Facets,
    arcs: FloatArray,
    table: SpanTable,
    limit: float,
    cosines: FloatArray,
    sines: FloatArray,
    may_bound: BoolArray,
) -> None:
    """Fill which edges some box below the limit could be flush with, shape (e,), all False before.

    With its first side normal to an axis of the edge's arc, the other two directions of a box are nearly
    those of a quarter turn in steps about the arc's middle. A turn of angle t shortens a distance at most to
    its cos t-fold, less sin t times what the span is long across.
    """
    _, normals, edges = facets
    for e in range(len(edges)):
        one, two = row(normals, edges[e, 2]), row(normals, edges[e, 3])
        axis, first = unit(mixed(one, 1.0, two, 1.0)), row(arcs, e)
        second = cross(axis, first)
        # From the middle of the arc to its end, and half a step of the quarter turn.
        turn = np.arccos(min(1.0, dot(axis, one))) + np.pi / 4.0 / QUARTER_TURNS
        cosine, sine = np.cos(turn), np.sin(turn)
        for step in range(QUARTER_TURNS):
            b = mixed(first, cosines[step], second, sines[step])
            c = mixed(first, -sines[step], second, cosines[step])
            wide = _after_turn(span_near(table, b), b, cosine, sine)
            high = _after_turn(span_near(table, c), c, cosine, sine)
            if min(wide, high) <= 0.0 or arcs[e, 6] * wide * high < limit:
                may_bound[e] = True
                break


@inner_kernel
def facet_excluded(table: SpanTable, axis: Vector, height: float, limit: float) -> bool:
    """Whether no box below the limit has a side normal to an axis, along which the solid is `height` wide.

    As in :func:`edges_that_may_bound`, for one axis only.
    """
    first = unit(cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.6 else (0.0, 1.0, 0.0)))
    second, half = cross(axis, first), np.pi / 4.0 / QUARTER_TURNS
    cosine, sine = np.cos(half), np.sin(half)
    step_cosine, step_sine = np.cos(2.0 * half), np.sin(2.0 * half)
    for _ in range(QUARTER_TURNS):
        wide = _after_turn(span_near(table, first), first, cosine, sine)
        high = _after_turn(span_near(table, second), second, cosine, sine)
        if min(wide, high) <= 0.0 or height * wide * high < limit:
            return False
        first, second = (
            mixed(first, step_cosine, second, step_sine),
            mixed(first, -step_sine, second, step_cosine),
        )
    return True


def facets_with_all_edges(facets: Facets, kept: BoolArray) -> BoolArray:
    """Facets of which every edge is kept, shape (n,): a box on one is flush with all its edges."""
    asked = np.full(len(facets.normals), True)
    asked[facets.edges[~kept, 2:]] = False
    return asked


@inner_kernel
def _after_turn(span: Vector, direction: Vector, cosine: float, sine: float) -> float:
    """Least length of a span along a direction that turns by at most an angle of this cosine and sine."""
    here = abs(dot(span, direction))
    across = np.sqrt(max(0.0, dot(span, span) - here * here))
    return float(here * cosine - sine * across)
