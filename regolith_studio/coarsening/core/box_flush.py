"""The least box with a side on a facet: quick, and about 1 % above the least of all.

Along the normal of a facet the solid's shadow is bounded by the edges between facets that look up and facets
that look down. The least rectangle around it is flush with one of them; they are tried eight side by side.
"""

import numpy as np

from regolith_studio.coarsening.core.box import Solid
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.eights import (
    WIDTH,
    WORD,
    first_bit,
    least,
    load,
    most,
    pick,
    positive,
    smallest,
    splat,
    store,
)
from regolith_studio.geometry.kernels import kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector, cross, dot

NORMALS, AREAS, HEIGHT, BOUND = 0, 3, 4, 5
"""Rows of the desk: of each facet the normal, the area (0 where a plane bounds none), how high the solid is
along the normal, and a lower bound on the volume of a box."""
POINTS, FLAT = 6, 9
"""Rows of the vertices: where they are, and where across the axis that is looked along."""
RIM, RUN = 11, 13
"""Rows of the edges of a shadow: where they start and how they run."""
VOLUME, DEEP, WIDE, HIGH = 15, 16, 17, 18
"""Rows of the best boxes, one in each of eight places: the sides of a rectangle are DEEP and WIDE but for a
common factor, which follows from the volume."""
DESK = 19
"""Rows in all, each with room for the facets or the vertices, whichever are more, and eight more."""
ONE, OTHER, FROM, TO, UP = 0, 1, 2, 3, 4
"""Rows of the edges: their two facets, and their vertices, counter-clockwise around the first facet. In the
last, bit g % WORD in place g // WORD says whether facet g looks up along the axis."""
EDGES = 5


@kernel
def box_on_facets(solid: Solid) -> FloatArray:
    """Edges of the least box with a side on a facet, shape (3,): height, across and along the other edge."""
    vertices, normals, areas, edges = solid
    extents, desk = np.empty(3), np.empty((DESK, room_for(len(normals), len(vertices))))
    sides = np.empty((EDGES, max(len(edges), len(normals))), np.int64)
    for f in range(len(normals)):
        for c in range(3):
            desk[NORMALS + c, f] = normals[f, c]
        desk[AREAS, f] = areas[f]
    for i in range(len(vertices)):
        for c in range(3):
            desk[POINTS + c, i] = vertices[i, c]
    for e in range(len(edges)):
        sides[FROM, e], sides[TO, e], sides[ONE, e], sides[OTHER, e] = edges[e]
    least_on_facets(desk, sides, len(normals), len(vertices), len(edges), extents)
    return extents


@kernel_noalloc
def room_for(facets: int, vertices: int) -> int:
    """Length of the rows of a desk."""
    return in_eights(max(facets, vertices)) + WIDTH


@kernel_noalloc
def in_eights(count: int) -> int:
    """The next multiple of eight."""
    return (count + WIDTH - 1) // WIDTH * WIDTH


@kernel_noalloc
def least_on_facets(
    desk: FloatArray, sides: IntArray, facets: int, vertices: int, edges: int, extents: FloatArray
) -> None:
    """Fill `extents`. What is least by a lower bound is looked at first.

    Rows NORMALS, AREAS and POINTS of the desk and ONE, OTHER, FROM and TO of the sides are given.
    """
    for c in range(3):
        for f in range(facets, in_eights(facets)):
            desk[NORMALS + c, f] = 0.0
        for i in range(vertices, in_eights(vertices)):
            desk[POINTS + c, i] = 0.0
    promising, limit = bounded(desk, facets, vertices), np.inf
    store(desk, VOLUME * desk.shape[1], splat(np.inf))
    for step in range(facets + 1):
        f = promising if step == 0 else step - 1
        if not desk[BOUND, f] < limit:
            continue
        desk[BOUND, f] = np.inf
        axis = desk[NORMALS, f], desk[NORMALS + 1, f], desk[NORMALS + 2, f]
        looked_up(axis, desk, sides, facets)
        scale = project(axis, desk, vertices)
        count = rim_of(desk, sides, facets, edges)
        limit = least_on_rim(count, desk, desk[HEIGHT, f], scale)
    k = 0
    for other in range(1, WIDTH):
        if desk[VOLUME, other] < desk[VOLUME, k]:
            k = other
    share = np.sqrt(desk[VOLUME, k] / (desk[HIGH, k] * desk[DEEP, k] * desk[WIDE, k]))
    extents[0], extents[1], extents[2] = desk[HIGH, k], share * desk[DEEP, k], share * desk[WIDE, k]


@kernel_noalloc
def bounded(desk: FloatArray, facets: int, vertices: int) -> int:
    """Fill the heights and the bounds; the facet with the least bound.

    A box on a facet has at least the height along its normal times the area of the shadow, and no bound where
    the facet has no area.
    """
    size = desk.shape[1]
    for at in range(0, facets, WIDTH):
        x, y, z = load(desk, at), load(desk, size + at), load(desk, 2 * size + at)
        low, high, shadow, nothing = splat(np.inf), splat(-np.inf), splat(0.0), splat(0.0)
        for i in range(vertices):
            here = (
                splat(desk[POINTS, i]) * x + splat(desk[POINTS + 1, i]) * y + splat(desk[POINTS + 2, i]) * z
            )
            low, high = least(here, low), most(here, high)
        for g in range(facets):
            here = splat(desk[0, g]) * x + splat(desk[1, g]) * y + splat(desk[2, g]) * z
            shadow = shadow + most(here, nothing - here) * splat(desk[AREAS, g])
        store(desk, HEIGHT * size + at, high - low)
        store(desk, BOUND * size + at, splat(0.5) * shadow * (high - low))
    promising, low_bound = 0, np.inf
    for f in range(facets):
        if not desk[AREAS, f] > 0.0:
            desk[BOUND, f] = np.inf
        if desk[BOUND, f] < low_bound:
            promising, low_bound = f, desk[BOUND, f]
    return promising


@kernel_noalloc
def looked_up(axis: Vector, desk: FloatArray, sides: IntArray, facets: int) -> None:
    """Bits of the facets that look up along an axis."""
    size, x, y, z = desk.shape[1], splat(axis[0]), splat(axis[1]), splat(axis[2])
    for word in range((facets + WORD - 1) // WORD):
        bits = 0
        for at in range(word * WORD, min(facets, word * WORD + WORD), WIDTH):
            here = load(desk, at) * x + load(desk, size + at) * y + load(desk, 2 * size + at) * z
            bits |= positive(here) << (at - word * WORD)
        sides[UP, word] = bits


@kernel_noalloc
def project(axis: Vector, desk: FloatArray, vertices: int) -> float:
    """Where vertices lie across an axis, along two directions at right angles; their length squared."""
    one = (0.0, -axis[2], axis[1]) if abs(axis[0]) < 0.7 else (axis[2], 0.0, -axis[0])
    two, size = cross(axis, one), desk.shape[1]
    u, v, w, p, q, r = (
        splat(one[0]),
        splat(one[1]),
        splat(one[2]),
        splat(two[0]),
        splat(two[1]),
        splat(two[2]),
    )
    for at in range(0, vertices, WIDTH):
        x = load(desk, POINTS * size + at)
        y = load(desk, (POINTS + 1) * size + at)
        z = load(desk, (POINTS + 2) * size + at)
        store(desk, FLAT * size + at, x * u + y * v + z * w)
        store(desk, (FLAT + 1) * size + at, x * p + y * q + z * r)
    return dot(one, one)


@kernel_noalloc
def rim_of(desk: FloatArray, sides: IntArray, facets: int, edges: int) -> int:
    """Edges between a facet that looks up and one that does not, counter-clockwise: how many.

    The last is repeated eight times, to fill up an Eight.
    """
    count, up = np.uintp(0), sides[UP, 0]
    for first in range(0, edges, WORD):
        bits = outlined(sides, facets, first, min(edges, first + WORD))
        while bits != 0:
            e = np.uintp(first + first_bit(bits))
            bits &= bits - 1
            one = sides[ONE, e]
            way = (up >> one if facets <= WORD else sides[UP, one // WORD] >> (one % WORD)) & 1
            start, end = np.uintp(sides[np.uintp(TO - way), e]), np.uintp(sides[np.uintp(FROM + way), e])
            x, y = desk[FLAT, start], desk[FLAT + 1, start]
            desk[RIM, count], desk[RIM + 1, count] = x, y
            desk[RUN, count], desk[RUN + 1, count] = desk[FLAT, end] - x, desk[FLAT + 1, end] - y
            count += np.uintp(1)
    for c in range(RIM, RIM + 4):
        store(desk, c * desk.shape[1] + int(count), splat(desk[c, count - np.uintp(1)]))
    return int(count)


@kernel_noalloc
def outlined(sides: IntArray, facets: int, first: int, last: int) -> int:
    """Bits of the edges from `first` on that have one facet that looks up and one that does not."""
    bits = 0
    if facets <= WORD:
        up = sides[UP, 0]
        for e in range(first, last):
            bits |= (((up >> sides[ONE, e]) ^ (up >> sides[OTHER, e])) & 1) << (e - first)
        return bits
    for e in range(first, last):
        one, other = sides[ONE, e], sides[OTHER, e]
        differ = (sides[UP, one // WORD] >> (one % WORD)) ^ (sides[UP, other // WORD] >> (other % WORD))
        bits |= (differ & 1) << (e - first)
    return bits


@kernel_noalloc
def least_on_rim(count: int, desk: FloatArray, height: float, scale: float) -> float:
    """The least volume so far, after the boxes that are flush with an edge of the rim."""
    size, factor = desk.shape[1], splat(height / scale)
    volume, depth, width = load(desk, VOLUME * size), load(desk, DEEP * size), load(desk, WIDE * size)
    heights = load(desk, HIGH * size)
    for at in range(0, count, WIDTH):
        dx, dy = load(desk, RUN * size + at), load(desk, (RUN + 1) * size + at)
        low, high, far = splat(np.inf), splat(-np.inf), splat(-np.inf)
        for j in range(count):
            x, y = splat(desk[RIM, j]), splat(desk[RIM + 1, j])
            here = x * dx + y * dy
            low, high, far = least(here, low), most(here, high), most(y * dx - x * dy, far)
        deep = far - (load(desk, (RIM + 1) * size + at) * dx - load(desk, RIM * size + at) * dy)
        wide = high - low
        found = factor * (deep * wide) / (dx * dx + dy * dy)
        depth, width = pick(found, volume, deep, depth), pick(found, volume, wide, width)
        heights = pick(found, volume, splat(height), heights)
        volume = least(found, volume)
    store(desk, VOLUME * size, volume)
    store(desk, DEEP * size, depth)
    store(desk, WIDE * size, width)
    store(desk, HIGH * size, heights)
    return smallest(volume)
