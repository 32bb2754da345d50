"""Intersection of half-spaces by dual incremental insertion: vertices as triples of planes."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel

REACH = 40.0
"""Polyhedra that reach farther than this many times their largest offset count as unbounded."""

FINE, UNBOUNDED, DEGENERATE = 0, 1, 2
"""Status of an intersection."""


@kernel
def intersect(normals: FloatArray, offsets: FloatArray) -> tuple[int, FloatArray, IntArray]:
    """Vertices of the polyhedron <n_i, x> <= h_i.

    The planes cut a large tetrahedron one after the other. A vertex is the triple (a, b, c) of its planes,
    counter-clockwise seen from outside; the edge between planes a and b runs, counter-clockwise around a,
    from the vertex that owns (b, a) to the one that owns (a, b).

    Parameters
    ----------
    normals, offsets
        Unit normals (n, 3) and positive offsets (n,), in general position.

    Returns
    -------
    status
        FINE; UNBOUNDED if a vertex lies beyond REACH; DEGENERATE if more than three planes meet in a point
        to within rounding in a way that breaks the bookkeeping.
    vertices
        Shape (v, 3).
    triples
        Planes of each vertex, shape (v, 3).
    """
    n = len(offsets)
    capacity = 4 * (n + 4) + 8
    xyz = np.empty((capacity, 3))
    planes = np.empty((capacity, 3), np.int64)
    above = np.empty(capacity)
    alive = np.zeros(capacity, np.bool_)
    owner = np.full((n + 4, n + 4), -1, np.int64)
    free = np.empty(capacity, np.int64)
    dead = np.empty(capacity, np.int64)
    used, n_free = start(xyz, planes, alive, owner, n, REACH * offsets.max()), 0
    for j in range(n):
        n_dead = 0
        for v in range(used):
            if alive[v]:
                above[v] = (
                    normals[j, 0] * xyz[v, 0]
                    + normals[j, 1] * xyz[v, 1]
                    + normals[j, 2] * xyz[v, 2]
                    - offsets[j]
                )
                if above[v] > 0.0:
                    dead[n_dead] = v
                    n_dead += 1
        for i in range(n_dead):
            alive[dead[i]] = False
        for i in range(n_dead):
            v = dead[i]
            for k in range(3):
                a, b = planes[v, k], planes[v, (k + 1) % 3]
                u = owner[b, a]
                if not alive[u]:
                    continue
                if n_free > 0:
                    n_free -= 1
                    w = free[n_free]
                elif used < capacity:
                    w = used
                    used += 1
                else:
                    return DEGENERATE, np.empty((0, 3)), np.empty((0, 3), np.int64)
                t = above[u] / (above[u] - above[v])
                for c in range(3):
                    xyz[w, c] = xyz[u, c] + t * (xyz[v, c] - xyz[u, c])
                planes[w, 0], planes[w, 1], planes[w, 2] = a, b, j
                owner[a, b] = w
                owner[b, j] = w
                owner[j, a] = w
                alive[w] = True
                above[w] = 0.0
        for i in range(n_dead):
            free[n_free] = dead[i]
            n_free += 1
    return collected(normals, offsets, xyz, planes, alive, owner, used)


@kernel
def start(xyz: FloatArray, planes: IntArray, alive, owner: IntArray, n: int, reach: float) -> int:  # type: ignore[no-untyped-def]
    """The first tetrahedron, with planes n .. n + 3 at distance `reach`; its four vertices."""
    corner = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])
    triple = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
    for v in range(4):
        for c in range(3):
            xyz[v, c] = corner[v, c] * reach * np.sqrt(3.0)
            planes[v, c] = n + triple[v, c]
        alive[v] = True
        for k in range(3):
            owner[planes[v, k], planes[v, (k + 1) % 3]] = v
    return 4


@kernel
def collected(  # type: ignore[no-untyped-def]
    normals: FloatArray,
    offsets: FloatArray,
    xyz: FloatArray,
    planes: IntArray,
    alive,
    owner: IntArray,
    used: int,
) -> tuple[int, FloatArray, IntArray]:
    """Living vertices, refined against their planes; the bookkeeping is checked by Euler's formula."""
    n = len(offsets)
    vertices = np.empty((used, 3))
    triples = np.empty((used, 3), np.int64)
    real = np.zeros(n, np.bool_)
    count = 0
    for v in range(used):
        if not alive[v]:
            continue
        for k in range(3):
            a, b = planes[v, k], planes[v, (k + 1) % 3]
            if a >= n:
                return UNBOUNDED, vertices[:0], triples[:0]
            partner = owner[b, a]
            if owner[a, b] != v or partner < 0 or not alive[partner]:
                return DEGENERATE, vertices[:0], triples[:0]
            real[a] = True
            triples[count, k] = a
        refine(normals, offsets, planes[v], xyz[v], vertices[count])
        count += 1
    if count != 2 * np.sum(real) - 4:
        return DEGENERATE, vertices[:0], triples[:0]
    return FINE, vertices[:count].copy(), triples[:count].copy()


@kernel
def refine(
    normals: FloatArray, offsets: FloatArray, triple: IntArray, guess: FloatArray, out: FloatArray
) -> None:
    """One Newton step towards the common point of three planes."""
    a, b, c = normals[triple[0]], normals[triple[1]], normals[triple[2]]
    bc0, bc1, bc2 = b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]
    ca0, ca1, ca2 = c[1] * a[2] - c[2] * a[1], c[2] * a[0] - c[0] * a[2], c[0] * a[1] - c[1] * a[0]
    ab0, ab1, ab2 = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
    det = a[0] * bc0 + a[1] * bc1 + a[2] * bc2
    out[0], out[1], out[2] = guess[0], guess[1], guess[2]
    if abs(det) < 1e-9:
        return
    ra = (offsets[triple[0]] - a[0] * guess[0] - a[1] * guess[1] - a[2] * guess[2]) / det
    rb = (offsets[triple[1]] - b[0] * guess[0] - b[1] * guess[1] - b[2] * guess[2]) / det
    rc = (offsets[triple[2]] - c[0] * guess[0] - c[1] * guess[1] - c[2] * guess[2]) / det
    out[0] += ra * bc0 + rb * ca0 + rc * ab0
    out[1] += ra * bc1 + rb * ca1 + rc * ab1
    out[2] += ra * bc2 + rb * ca2 + rc * ab2


@kernel
def edges_of(triples: IntArray, n_planes: int) -> IntArray:
    """Edges as rows (from, to, plane a, plane b), counter-clockwise around a, with a < b; shape (e, 4)."""
    owner = np.full((n_planes, n_planes), -1, np.int64)
    for v in range(len(triples)):
        for k in range(3):
            owner[triples[v, k], triples[v, (k + 1) % 3]] = v
    edges = np.empty((3 * len(triples) // 2, 4), np.int64)
    count = 0
    for v in range(len(triples)):
        for k in range(3):
            a, b = triples[v, k], triples[v, (k + 1) % 3]
            if a < b:
                edges[count, 0], edges[count, 1] = owner[b, a], v
                edges[count, 2], edges[count, 3] = a, b
                count += 1
    return edges[:count]
