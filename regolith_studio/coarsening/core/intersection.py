"""Intersection of half-spaces by dual incremental insertion: vertices as triples of planes."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kept_in_thread
from regolith_studio.geometry.vectors import Vector, cross, dot, row

REACH = 40.0
"""Polyhedra that reach farther than this many times their largest offset count as unbounded."""
FINE, UNBOUNDED, DEGENERATE = 0, 1, 2
"""Status of an intersection; the last if more than three planes meet in a point to within rounding in a way
that breaks the bookkeeping."""

PlaceArray = NDArray[np.uint32]
"""Numbers of places and planes: unsigned, so that compiled code need not ask for negative ones."""
HEIGHT = 3
DEAD, FREE = 0, 1
NUMBER = 0
"""Row of the lists in the end: which vertex lives in a place."""


class IntersectionWorkspace(NamedTuple):
    """Memory of one intersection; a vertex lives in a place that is used again when it has been cut off.

    Of the places: coordinates, and the height above the present plane, NaN where no vertex lives, (4, p), and
    the planes of the vertex (p, 3). `owner` is the place of the vertex that owns the planes (a, b), (n + 4, n
    + 4); the lists (2, p) hold places above the present plane, and free ones.
    """

    place: FloatArray
    planes: PlaceArray
    owner: PlaceArray
    lists: PlaceArray


@kept_in_thread
def workspace_for(n: int) -> IntersectionWorkspace:
    """Memory for n planes."""
    # Twice as many as n + 4 planes have vertices: new ones come before those cut off are free.
    places = 4 * (n + 4) + 16
    return IntersectionWorkspace(
        np.empty((4, places)),
        np.empty((places, 3), np.uint32),
        np.empty((n + 4, n + 4), np.uint32),
        np.empty((2, places), np.uint32),
    )


@inner_kernel
def fill_vertices(
    normals: FloatArray,
    offsets: FloatArray,
    reach: float,
    work: IntersectionWorkspace,
    vertices: FloatArray,
    triples: IntArray,
) -> tuple[int, int]:
    """Vertices of the polyhedron <n_i, x> <= h_i: the status, and how many there are.

    The planes cut a large tetrahedron one after the other. A vertex is the triple (a, b, c) of its planes,
    counter-clockwise seen from outside; the edge between planes a and b runs, counter-clockwise around a,
    from the vertex that owns (b, a) to the one that owns (a, b).

    Unit normals (n, 3) and positive offsets (n,) are in general position; a polyhedron that touches the
    tetrahedron's sides, at the distance `reach`, counts as unbounded. Coordinates and planes of each vertex
    are filled, (2 n, 3).
    """
    place, planes, owner, lists = work
    n = len(offsets)
    used, n_free = fill_tetrahedron(work, n, reach), np.uintp(place.shape[1] - 5)
    for j in range(n):
        n_dead = above_plane(place, used, row(normals, j), offsets[j], lists)
        # A vertex that is cut off leaves at most three, one on each of its edges.
        if n_free < 3 * n_dead:
            return DEGENERATE, 0
        for i in range(n_dead):
            v = np.uintp(lists[DEAD, i])
            for k in range(3):
                a, b = np.uintp(planes[v, k]), np.uintp(planes[v, (k + 1) % 3])
                u = np.uintp(owner[b, a])
                # Not `> 0`: where no vertex lives the height is NaN.
                if not place[HEIGHT, u] <= 0.0:
                    continue
                n_free -= np.uintp(1)
                w = np.uintp(lists[FREE, n_free])
                used = max(used, int(w) + 1)
                t = place[HEIGHT, u] / (place[HEIGHT, u] - place[HEIGHT, v])
                for c in range(3):
                    place[c, w] = place[c, u] + t * (place[c, v] - place[c, u])
                place[HEIGHT, w] = 0.0
                planes[w, 0], planes[w, 1], planes[w, 2] = a, b, j
                owner[a, b] = owner[b, j] = owner[j, a] = w
        for i in range(n_dead):
            v = np.uintp(lists[DEAD, i])
            # A coordinate, too, so that the height above every later plane is NaN.
            place[0, v] = place[HEIGHT, v] = np.nan
            lists[FREE, n_free] = v
            n_free += np.uintp(1)
    return collect(normals, offsets, work, used, vertices, triples)


@inner_kernel
def above_plane(place: FloatArray, used: int, normal: Vector, offset: float, lists: PlaceArray) -> int:
    """Heights of all vertices above a plane; those above 0 are listed as dead, and counted."""
    x, y, z = normal
    for v in range(used):
        place[HEIGHT, v] = x * place[0, v] + y * place[1, v] + z * place[2, v] - offset
    count = np.uintp(0)
    for v in range(used):
        if place[HEIGHT, v] > 0.0:
            lists[DEAD, count] = v
            count += np.uintp(1)
    return count  # type: ignore[return-value]


@inner_kernel
def fill_tetrahedron(work: IntersectionWorkspace, n: int, reach: float) -> int:
    """The first tetrahedron, with planes n .. n + 3 at distance `reach`; its four vertices.

    The last place belongs to nobody and counts as dead; the others are free, the first on top.
    """
    place, planes, owner, lists = work
    places = place.shape[1]
    for v in range(places):
        place[0, v] = place[HEIGHT, v] = np.nan
    for a in range(n + 4):
        for b in range(n + 4):
            owner[a, b] = places - 1
    for i in range(places - 5):
        lists[FREE, i] = places - 2 - i
    # Planes with normals (+-1, +-1, +-1) / sqrt(3) at this distance meet in corners of a cube.
    far = reach * np.sqrt(3.0)
    for v in range(4):
        for c in range(3):
            place[c, v] = far if v in (0, c + 1) else -far
    for v, triple in enumerate(((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))):
        a, b, c = n + triple[0], n + triple[1], n + triple[2]
        planes[v, 0], planes[v, 1], planes[v, 2] = a, b, c
        owner[a, b] = owner[b, c] = owner[c, a] = v
    return v + 1  # no constant, for which numba would compile once more what is called with it


@inner_kernel
def collect(
    normals: FloatArray,
    offsets: FloatArray,
    work: IntersectionWorkspace,
    used: int,
    vertices: FloatArray,
    triples: IntArray,
) -> tuple[int, int]:
    """Living vertices, refined against their planes; the bookkeeping is checked by Euler's formula."""
    place, planes, owner, _ = work
    n, count, facets = len(offsets), 0, 0
    for v in range(used):
        if not place[HEIGHT, v] <= 0.0:
            continue
        if count == len(triples):
            return DEGENERATE, 0
        for k in range(3):
            a, b = np.uintp(planes[v, k]), np.uintp(planes[v, (k + 1) % 3])
            if a >= n:
                return UNBOUNDED, 0
            if owner[a, b] != v or not place[HEIGHT, np.uintp(owner[b, a])] <= 0.0:
                return DEGENERATE, 0
            triples[count, k] = a
        # Coordinates interpolated cut by cut carry the rounding of all cuts before.
        refine(normals, offsets, planes, place, v, vertices, count)
        work.lists[NUMBER, v] = count
        count += 1
    for i in range(n):
        # The rows of the artificial planes are free by now.
        owner[n, i] = 1
    for v in range(count):
        for k in range(3):
            facets += owner[n, triples[v, k]]
            owner[n, triples[v, k]] = 0
    return (FINE, count) if count == 2 * facets - 4 else (DEGENERATE, 0)


@inner_kernel
def refine(
    normals: FloatArray,
    offsets: FloatArray,
    planes: PlaceArray,
    place: FloatArray,
    v: int,
    out: FloatArray,
    to: int,
) -> None:
    """One Newton step from place v towards the common point of its three planes, into row `to` of `out`."""
    i, j, k = planes[v, 0], planes[v, 1], planes[v, 2]
    a, b, c, at = row(normals, i), row(normals, j), row(normals, k), (place[0, v], place[1, v], place[2, v])
    bc, ca, ab = cross(b, c), cross(c, a), cross(a, b)
    det = dot(a, bc)
    out[to, 0], out[to, 1], out[to, 2] = at
    if abs(det) < 1e-9:
        return
    ra = (offsets[i] - a[0] * at[0] - a[1] * at[1] - a[2] * at[2]) / det
    rb = (offsets[j] - b[0] * at[0] - b[1] * at[1] - b[2] * at[2]) / det
    rc = (offsets[k] - c[0] * at[0] - c[1] * at[1] - c[2] * at[2]) / det
    for d in range(3):
        out[to, d] += ra * bc[d] + rb * ca[d] + rc * ab[d]
