"""Edges of a union of convex parts, and what follows from them: exposed areas, volume, surface area.

A straight line meets a convex part in one interval. So what is exposed of an edge of a part, and of the
segment in which facets of two parts intersect, is an interval without a few others, and the boundary of each
exposed facet is made of such pieces: no polygon is ever cut.
"""

import numpy as np

from regolith_studio.coarsening.core.polyhedron_measures import add_force
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel
from regolith_studio.geometry.vectors import Vector, along, cross, dot, length, mixed, row

PARALLEL = 1e-9
"""Planes whose normals have a shorter vector product do not intersect."""


@inner_kernel
def fill_exposed_edges(
    normals: FloatArray,
    offsets: FloatArray,
    first: IntArray,
    vertices: FloatArray,
    edges: IntArray,
    covers: FloatArray,
    ends: FloatArray,
    planes: IntArray,
) -> int:
    """Number of exposed edges; fills as many as there is room for.

    Half-spaces and `first` are those of :class:`regolith_studio.coarsening.core.parts.Planes`, vertices and
    edges of all parts those of its polyhedra. Filled are from and to, (m, 6), and (plane a, plane b, sign),
    (m, 3), counter-clockwise around the exposed part of facet a and clockwise around that of b; the sign is
    -1 where two parts meet, else 1. `covers` (k, 2) is scratch.
    """
    count, k = int(np.int64(0)), len(first) - 1  # a literal 0 would be compiled by itself
    for e in range(len(edges)):
        a, b = edges[e, 2], edges[e, 3]
        p, q = row(vertices, edges[e, 0]), row(vertices, edges[e, 1])
        own = part_of(first, a)
        line = mixed(q, 1.0, p, -1.0)
        count = _add_outside(
            normals, offsets, first, own, own, p, line, 0.0, 1.0, covers, a, b, ends, planes, count
        )
    for i in range(k):
        for j in range(i + 1, k):
            for a in range(first[i], first[i + 1]):
                for b in range(first[j], first[j + 1]):
                    line = cross(row(normals, b), row(normals, a))
                    squared = dot(line, line)
                    if squared < PARALLEL * PARALLEL:
                        continue
                    p = _common_point(normals, offsets, a, b, line, squared)
                    low, high = clipped(normals, offsets, first[i], first[i + 1], a, p, line, -np.inf, np.inf)
                    low, high = clipped(normals, offsets, first[j], first[j + 1], b, p, line, low, high)
                    if low < high:
                        count = _add_outside(
                            normals,
                            offsets,
                            first,
                            i,
                            j,
                            p,
                            line,
                            low,
                            high,
                            covers,
                            a,
                            b,
                            ends,
                            planes,
                            count,
                        )
    return count


@inner_kernel
def part_of(first: IntArray, plane: int) -> int:
    """The part that a plane belongs to."""
    part = 0
    while first[part + 1] <= plane:
        part += 1
    return part


@inner_kernel
def _common_point(
    normals: FloatArray, offsets: FloatArray, a: int, b: int, line: Vector, squared: float
) -> Vector:
    """A point of both planes: from the foot point of plane a to plane b, across `line` within plane a.

    The formula with both normals loses half the digits where planes are nearly parallel. `squared` is the
    square of the length of `line`, the vector product of the normals of b and a.
    """
    n, m = row(normals, a), row(normals, b)
    foot = mixed(n, offsets[a], n, 0.0)
    return mixed(foot, 1.0, cross(n, line), (offsets[b] - dot(m, foot)) / squared)


@inner_kernel
def clipped(
    normals: FloatArray,
    offsets: FloatArray,
    start: int,
    stop: int,
    left_out: int,
    p: Vector,
    line: Vector,
    low: float,
    high: float,
) -> tuple[float, float]:
    """The piece of low <= t <= high where p + t line lies in half-spaces start to stop, all but `left_out`.

    It is empty where the second number is not above the first.
    """
    for i in range(start, stop):
        if i == left_out:
            continue
        speed, gap = along(normals, i, line), offsets[i] - along(normals, i, p)
        if speed > 0.0:
            high = min(high, gap / speed)
        elif speed < 0.0:
            low = max(low, gap / speed)
        elif gap < 0.0:
            return 1.0, 0.0
        if not low < high:
            return 1.0, 0.0
    return low, high


@inner_kernel
def _add_outside(
    normals: FloatArray,
    offsets: FloatArray,
    first: IntArray,
    i: int,
    j: int,
    p: Vector,
    line: Vector,
    low: float,
    high: float,
    covers: FloatArray,
    a: int,
    b: int,
    ends: FloatArray,
    planes: IntArray,
    count: int,
) -> int:
    """Add the pieces of an edge outside of all parts but i and j; the new number of edges."""
    n = 0
    for part in range(len(first) - 1):
        if part in (i, j):
            continue
        # `first[part + 1]` is no plane of that part: none is left out.
        enter, leave = clipped(
            normals, offsets, first[part], first[part + 1], first[part + 1], p, line, low, high
        )
        if enter < leave:
            at = n
            while at > 0 and covers[at - 1, 0] > enter:
                covers[at, 0], covers[at, 1] = covers[at - 1, 0], covers[at - 1, 1]
                at -= 1
            covers[at, 0], covers[at, 1] = enter, leave
            n += 1
    begin = low
    for c in range(n + 1):
        end = covers[c, 0] if c < n else high
        if end > begin:
            if count < len(ends):
                for x in range(3):
                    ends[count, x], ends[count, 3 + x] = p[x] + begin * line[x], p[x] + end * line[x]
                planes[count, 0], planes[count, 1] = a, b
                planes[count, 2] = 1 if i == j else -1
            count += 1
        if c < n:
            begin = max(begin, covers[c, 1])
    return count


@inner_kernel
def fill_exposed_areas(
    normals: FloatArray,
    offsets: FloatArray,
    ends: FloatArray,
    planes: IntArray,
    areas: FloatArray,
    centroids: FloatArray,
) -> tuple[float, float]:
    """Volume and surface area; fills exposed areas (n,) and their centroids (n, 3), the foot point for none.

    Both are sums over the edges (Green's theorem in each plane).
    """
    areas[:] = 0.0
    centroids[:] = 0.0
    for e in range(len(ends)):
        for side in range(2):
            i = planes[e, side]
            normal = row(normals, i)
            foot = mixed(normal, -offsets[i], normal, 0.0)
            one = mixed((ends[e, 0], ends[e, 1], ends[e, 2]), 1.0, foot, 1.0)
            two = mixed((ends[e, 3], ends[e, 4], ends[e, 5]), 1.0, foot, 1.0)
            area = 0.5 * dot(normal, cross(one, two)) * (1.0 - 2.0 * side)
            areas[i] += area
            for c in range(3):
                centroids[i, c] += area * (one[c] + two[c]) / 3.0
    volume = surface = 0.0
    for i in range(len(areas)):
        for c in range(3):
            inner = centroids[i, c] / areas[i] if areas[i] > NO_AREA else 0.0
            centroids[i, c] = normals[i, c] * offsets[i] + inner
        volume += offsets[i] * areas[i] / 3.0
        surface += areas[i]
    return volume, surface


NO_AREA = 1e-12
"""Facets exposed by less have no centroid of their own."""


@inner_kernel
def add_exposed_surface_charges(
    normals: FloatArray,
    ends: FloatArray,
    planes: IntArray,
    pivots: FloatArray,
    size: float,
    charges: FloatArray,
) -> None:
    """Add `size` times the derivative of the exposed surface area, shape (n, 4).

    Where plane a moves outward at the speed w_a(x), the area grows at the rate
    sum over edges of sign l tan(theta / 2) (w_a + w_b)(midpoint), theta the angle between the normals.
    """
    for e in range(len(ends)):
        p, q = (ends[e, 0], ends[e, 1], ends[e, 2]), (ends[e, 3], ends[e, 4], ends[e, 5])
        n, m = row(normals, planes[e, 0]), row(normals, planes[e, 1])
        edge = length(mixed(p, 1.0, q, -1.0))
        # |n x m| / (1 + <n, m>) = tan(theta / 2).
        weight = planes[e, 2] * size * edge * length(cross(n, m)) / max(1.0 + dot(n, m), 1e-12)
        for side in range(2):
            add_force(charges, planes[e, side], weight, mixed(p, 0.5, q, 0.5), pivots)
