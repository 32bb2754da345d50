"""Crossings of Fibonacci rays from the origin with a mesh, by bands of equal height."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel


@kernel
def cast_fibonacci(
    points: FloatArray, faces: IntArray, directions: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """All crossings, sorted by ray and distance, in compressed rows.

    A triangle is seen from the origin inside a cap, and a cap spans a band of z in which the rays of a
    Fibonacci spiral are neighbours: only these are tested.

    Parameters
    ----------
    points, faces
        Mesh with vertices (n, 3) and triangles (m, 3).
    directions
        Fibonacci directions, z falling, shape (k, 3).

    Returns
    -------
    first
        Crossings of ray k are ``first[k]:first[k + 1]``, shape (k + 1,).
    distance, sign
        Of each crossing; sign +1 where the ray leaves, -1 where it enters.
    """
    n = len(directions)
    size = 2 * n + 16
    ray, distance, sign = np.empty(size, np.int64), np.empty(size), np.empty(size)
    found = 0
    first = np.zeros(n + 1, np.int64)
    for f in range(len(faces)):
        a, b, c = points[faces[f, 0]], points[faces[f, 1]], points[faces[f, 2]]
        ab0, ab1, ab2 = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
        bc0, bc1, bc2 = b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]
        ca0, ca1, ca2 = c[1] * a[2] - c[2] * a[1], c[2] * a[0] - c[0] * a[2], c[0] * a[1] - c[1] * a[0]
        six = ab0 * c[0] + ab1 * c[1] + ab2 * c[2]
        way = 1.0 if six > 0.0 else -1.0
        low, high = band(a, b, c)
        start = max(0, int(np.floor((n * (1.0 - high) - 1.0) / 2.0)))
        stop = min(n, int(np.ceil((n * (1.0 - low) - 1.0) / 2.0)) + 1)
        for k in range(start, stop):
            u0, u1, u2 = directions[k, 0], directions[k, 1], directions[k, 2]
            e0 = way * (ab0 * u0 + ab1 * u1 + ab2 * u2)
            if e0 < 0.0 or (e0 == 0.0 and way < 0.0):
                continue
            e1 = way * (bc0 * u0 + bc1 * u1 + bc2 * u2)
            if e1 < 0.0 or (e1 == 0.0 and way < 0.0):
                continue
            e2 = way * (ca0 * u0 + ca1 * u1 + ca2 * u2)
            if e2 < 0.0 or (e2 == 0.0 and way < 0.0) or e0 + e1 + e2 <= 0.0:
                continue
            if found == size:
                ray = np.concatenate((ray, np.empty(size, np.int64)))
                distance = np.concatenate((distance, np.empty(size)))
                sign = np.concatenate((sign, np.empty(size)))
                size *= 2
            ray[found], distance[found], sign[found] = k, way * six / (e0 + e1 + e2), way
            first[k + 1] += 1
            found += 1
    for k in range(n):
        first[k + 1] += first[k]
    return sorted_rows(first, ray[:found], distance[:found], sign[:found])


@kernel
def band(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[float, float]:
    """Lowest and highest z of the directions in which the triangle a, b, c is seen from the origin."""
    la, lb, lc = np.sqrt(np.sum(a * a)), np.sqrt(np.sum(b * b)), np.sqrt(np.sum(c * c))
    if la == 0.0 or lb == 0.0 or lc == 0.0:
        return -1.0, 1.0
    m0 = a[0] / la + b[0] / lb + c[0] / lc
    m1 = a[1] / la + b[1] / lb + c[1] / lc
    m2 = a[2] / la + b[2] / lb + c[2] / lc
    length = np.sqrt(m0 * m0 + m1 * m1 + m2 * m2)
    if length < 1e-3:
        return -1.0, 1.0
    m0, m1, m2 = m0 / length, m1 / length, m2 / length
    widest = min(
        (m0 * a[0] + m1 * a[1] + m2 * a[2]) / la,
        (m0 * b[0] + m1 * b[1] + m2 * b[2]) / lb,
        (m0 * c[0] + m1 * c[1] + m2 * c[2]) / lc,
    )
    if widest <= 0.0:
        return -1.0, 1.0
    tilt, radius = np.arccos(min(1.0, max(-1.0, m2))), np.arccos(min(1.0, widest)) + 1e-9
    return np.cos(min(np.pi, tilt + radius)), np.cos(max(0.0, tilt - radius))


@kernel
def sorted_rows(
    first: IntArray, ray: IntArray, distance: FloatArray, sign: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Crossings in the order of their rays, each row by rising distance."""
    placed_distance, placed_sign = np.empty(len(ray)), np.empty(len(ray))
    filled = first[:-1].copy()
    for i in range(len(ray)):
        k = ray[i]
        j = filled[k]
        filled[k] += 1
        while j > first[k] and placed_distance[j - 1] > distance[i]:
            placed_distance[j], placed_sign[j] = placed_distance[j - 1], placed_sign[j - 1]
            j -= 1
        placed_distance[j], placed_sign[j] = distance[i], sign[i]
    return first, placed_distance, placed_sign
