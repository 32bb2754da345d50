"""Search kernels for the minimum-volume box of a convex hull.

O'Rourke (1985): two adjacent sides of a minimum-volume box are each flush with an edge of the hull. A
side that is flush with an edge has its normal on the edge's Gauss arc, the arc between the normals of
the two faces that meet there. For a fixed normal the best box is its height times the smallest
rectangle around the shadow, whose sides are flush with an edge of the shadow (rotating calipers).
So the search runs over all Gauss arcs, sampled and then refined by golden section.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel

SAMPLE_ANGLE = np.radians(12.0)
PROMISING = 1.12
GOLDEN = (5.0**0.5 - 1.0) / 2.0
PARALLEL = 1e-10
TIE = 1e-9


@kernel
def minimum_box(points: FloatArray, faces: IntArray) -> FloatArray:
    """Axes of the minimum-volume box, one a row, shape (3, 3).

    Parameters
    ----------
    points
        Vertices of a convex solid, centred and scaled to a size of about 1, shape (n, 3).
    faces
        Its outward triangles, shape (m, 3).
    """
    edges = hull_edges(faces)
    vectors = face_vectors(points, faces)
    normals = face_normals(vectors, edges)
    best = np.zeros((3, 3))
    record = np.full(2, np.inf)
    axes = np.empty((3, 3))
    scratch = np.empty((2, len(points)))
    chain = np.empty(len(points), np.int64)
    for f in range(len(faces)):
        try_axis(normals[f], points, edges, vectors, normals, axes, record, best, scratch, chain)
    for e in range(len(edges)):
        search_arc(e, points, edges, vectors, normals, axes, record, best, scratch, chain)
    return best


@kernel
def hull_edges(faces: IntArray) -> IntArray:
    """Edges of a closed triangulation as rows (from, to, face on the left, face on the right)."""
    m = len(faces)
    edges = np.empty((3 * m // 2, 4), np.int64)
    n_points = faces.max() + 1
    key = np.empty(3 * m, np.int64)
    for f in range(m):
        for k in range(3):
            u, v = faces[f, k], faces[f, (k + 1) % 3]
            key[3 * f + k] = min(u, v) * n_points + max(u, v)
    order = np.argsort(key)
    n = 0
    for i in range(0, 3 * m - 1, 2):
        one, two = order[i], order[i + 1]
        if key[one] != key[two]:
            return np.empty((0, 4), np.int64)
        f, k = one // 3, one % 3
        edges[n, 0], edges[n, 1], edges[n, 2], edges[n, 3] = faces[f, k], faces[f, (k + 1) % 3], f, two // 3
        n += 1
    return edges


@kernel
def face_vectors(points: FloatArray, faces: IntArray) -> FloatArray:
    """Normal of each triangle times its area, shape (m, 3)."""
    vectors = np.empty((len(faces), 3))
    for f in range(len(faces)):
        a, b, c = points[faces[f, 0]], points[faces[f, 1]], points[faces[f, 2]]
        vectors[f] = np.cross(b - a, c - a) / 2.0
    return vectors


@kernel
def face_normals(vectors: FloatArray, edges: IntArray) -> FloatArray:
    """Unit normals; slivers take the normal of a neighbour that is none."""
    normals = np.zeros(vectors.shape)
    for f in range(len(vectors)):
        length = np.sqrt(np.sum(vectors[f] ** 2))
        if length > 1e-13:
            normals[f] = vectors[f] / length
    for _ in range(3):
        for e in range(len(edges)):
            f, g = edges[e, 2], edges[e, 3]
            if not normals[f].any():
                normals[f] = normals[g]
            elif not normals[g].any():
                normals[g] = normals[f]
    return normals


@kernel
def search_arc(e, points, edges, vectors, normals, axes, record, best, scratch, chain):  # type: ignore[no-untyped-def]
    one, two = normals[edges[e, 2]], normals[edges[e, 3]]
    cosine = min(1.0, max(-1.0, one[0] * two[0] + one[1] * two[1] + one[2] * two[2]))
    perpendicular = two - cosine * one
    sine = np.sqrt(np.sum(perpendicular**2))
    if sine < 1e-9:
        return
    perpendicular /= sine
    angle = np.arctan2(sine, cosine)
    n = int(np.ceil(angle / SAMPLE_ANGLE)) + 1
    n = max(n, 3)
    volume = np.empty(n)
    for i in range(n):
        t = angle * i / (n - 1)
        axis = np.cos(t) * one + np.sin(t) * perpendicular
        volume[i] = try_axis(axis, points, edges, vectors, normals, axes, record, best, scratch, chain)
    for i in range(n):
        left, right = max(i - 1, 0), min(i + 1, n - 1)
        if volume[i] > volume[left] or volume[i] > volume[right] or volume[i] > PROMISING * record[0]:
            continue
        low, high = angle * left / (n - 1), angle * right / (n - 1)
        a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        axis = np.cos(a) * one + np.sin(a) * perpendicular
        at_a = try_axis(axis, points, edges, vectors, normals, axes, record, best, scratch, chain)
        axis = np.cos(b) * one + np.sin(b) * perpendicular
        at_b = try_axis(axis, points, edges, vectors, normals, axes, record, best, scratch, chain)
        while high - low > 1e-9:
            if at_a < at_b:
                high, b, at_b = b, a, at_a
                a = high - GOLDEN * (high - low)
                axis = np.cos(a) * one + np.sin(a) * perpendicular
                at_a = try_axis(axis, points, edges, vectors, normals, axes, record, best, scratch, chain)
            else:
                low, a, at_a = a, b, at_b
                b = low + GOLDEN * (high - low)
                axis = np.cos(b) * one + np.sin(b) * perpendicular
                at_b = try_axis(axis, points, edges, vectors, normals, axes, record, best, scratch, chain)


@kernel
def try_axis(axis, points, edges, vectors, normals, axes, record, best, scratch, chain):  # type: ignore[no-untyped-def]
    """Volume of the best box with a side normal to `axis`; keeps the best so far in `record`, `best`."""
    first = np.zeros(3)
    first[np.argmin(np.abs(axis))] = 1.0
    first -= axis * (first[0] * axis[0] + first[1] * axis[1] + first[2] * axis[2])
    first /= np.sqrt(np.sum(first**2))
    second = np.cross(axis, first)
    volume, cosine, sine, longest = np.inf, 1.0, 0.0, np.inf
    n = len(points)
    x, y = np.empty(n), np.empty(n)
    low = high = 0.0
    for i in range(n):
        p = points[i]
        x[i] = p[0] * first[0] + p[1] * first[1] + p[2] * first[2]
        y[i] = p[0] * second[0] + p[1] * second[1] + p[2] * second[2]
        z = p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2]
        low, high = min(low, z), max(high, z)
    height = high - low
    side = np.empty(len(normals))
    for f in range(len(normals)):
        side[f] = normals[f, 0] * axis[0] + normals[f, 1] * axis[1] + normals[f, 2] * axis[2]
    seen = np.zeros(n, np.bool_)
    rim = np.empty((len(edges), 2), np.int64)
    m = 0
    for e in range(len(edges)):
        if side[edges[e, 2]] * side[edges[e, 3]] <= PARALLEL:
            rim[m] = edges[e, :2]
            seen[rim[m, 0]] = True
            seen[rim[m, 1]] = True
            m += 1
    on = np.nonzero(seen)[0]
    for k in range(m):
        dx, dy = x[rim[k, 1]] - x[rim[k, 0]], y[rim[k, 1]] - y[rim[k, 0]]
        length = np.sqrt(dx * dx + dy * dy)
        if length < 1e-12:
            continue
        dx /= length
        dy /= length
        a = b = np.inf
        c = d = -np.inf
        for i in on:
            s, t = x[i] * dx + y[i] * dy, y[i] * dx - x[i] * dy
            a, b, c, d = min(a, s), min(b, t), max(c, s), max(d, t)
        here = height * (c - a) * (d - b)
        long = max(height, c - a, d - b)
        if here < volume * (1 - TIE) or (here < volume * (1 + TIE) and long < longest * (1 - 1e-9)):
            volume, cosine, sine, longest = here, dx, dy, long
    if volume < record[0] * (1 - TIE) or (
        volume < record[0] * (1 + TIE) and longest < record[1] * (1 - 1e-9)
    ):
        record[0], record[1] = volume, longest
        best[0] = axis
        best[1] = cosine * first + sine * second
        best[2] = cosine * second - sine * first
    return volume
