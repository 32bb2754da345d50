"""The outline of points in the plane."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.inlined import inlined


@kernel
def outline(x: FloatArray, y: FloatArray) -> IntArray:
    """Indices of the convex hull of points in the plane, counter-clockwise (Andrew 1979)."""
    order = np.argsort(x)
    for i in range(1, len(x)):
        k = i
        while k > 0 and x[order[k - 1]] == x[order[k]] and y[order[k - 1]] > y[order[k]]:
            order[k - 1], order[k] = order[k], order[k - 1]
            k -= 1
    chain = np.empty(2 * len(x), np.int64)
    n = 0
    for half in range(2):
        base = n + 1
        for i in range(len(x)):
            v = order[i] if half == 0 else order[len(x) - 1 - i]
            while n > base and _turn(x, y, chain[n - 2], chain[n - 1], v) <= 0.0:
                n -= 1
            chain[n] = v
            n += 1
        n -= 1
    return chain[: min(n, len(x))]


@inlined
def _turn(x: FloatArray, y: FloatArray, a: int, b: int, c: int) -> float:
    """Twice the area of a triangle; positive where a, b, c run counter-clockwise."""
    return float((x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a]))
