"""The smallest rectangle around a convex polygon."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.inlined import inlined

TIE = 1e-9
"""Areas and volumes that differ by a smaller share are equal; the shorter longest side decides."""

SHORTEST = 1e-12
"""Sides of a polygon shorter than this, at solid size 1, have no direction of their own."""

SLACK = 1e-13
"""Rounding that a caliper may climb over, at solid size 1."""


@kernel
def outline(x: FloatArray, y: FloatArray) -> IntArray:
    """Indices of the convex hull of points in the plane, counter-clockwise (Andrew's monotone chain)."""
    order = np.argsort(x + 1e-9 * y)
    n = len(x)
    chain = np.empty(2 * n, np.int64)
    m = 0
    for turn in range(2):
        base = m
        for i in range(n):
            k = order[i] if turn == 0 else order[n - 1 - i]
            while m >= base + 2 and _turn(x, y, chain[m - 2], chain[m - 1], k) <= 0.0:
                m -= 1
            chain[m] = k
            m += 1
        m -= 1
    return chain[:m]


@inlined
def _turn(x: FloatArray, y: FloatArray, a: int, b: int, c: int) -> float:
    return float((x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a]))


@inlined
def polygon_area(x: FloatArray, y: FloatArray, n: int) -> float:
    """Area of a counter-clockwise polygon whose corners are the first `n` of `x` and `y`."""
    total = x[n - 1] * y[0] - x[0] * y[n - 1]
    for i in range(n - 1):
        total += x[i] * y[i + 1] - x[i + 1] * y[i]
    return float(total / 2.0)


@inlined
def smallest_rectangle(x: FloatArray, y: FloatArray, n: int, result: FloatArray) -> None:
    """Rotating calipers around a convex counter-clockwise polygon.

    Parameters
    ----------
    x, y, n
        Corners; only the first `n` count.
    result
        Receives area, direction cosine and sine of one side, and the longer side's length.
    """
    result[0], result[3] = np.inf, np.inf
    right = up = left = -1
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        dx, dy = x[j] - x[i], y[j] - y[i]
        squared = dx * dx + dy * dy
        if squared < SHORTEST**2:
            continue
        shrink = 1.0 / np.sqrt(squared)
        dx, dy = dx * shrink, dy * shrink
        if right < 0:
            right = up = left = i
        right = _advanced(x, y, n, right, dx, dy)
        up = _advanced(x, y, n, right if up == i else up, -dy, dx)
        left = _advanced(x, y, n, up if left == i else left, -dx, -dy)
        wide = (x[right] - x[left]) * dx + (y[right] - y[left]) * dy
        high = (x[i] - x[up]) * dy - (y[i] - y[up]) * dx
        area = wide * high
        if area < result[0] * (1.0 + TIE):
            longer = max(wide, high)
            if area < result[0] * (1.0 - TIE) or longer < result[3] * (1.0 - TIE):
                result[0], result[1], result[2], result[3] = area, dx, dy, longer


@inlined
def _advanced(x: FloatArray, y: FloatArray, n: int, start: int, dx: float, dy: float) -> int:
    """The corner farthest along (dx, dy), walking counter-clockwise from `start`."""
    here = start
    for _ in range(n):
        there = here + 1 if here + 1 < n else 0
        if (x[there] - x[here]) * dx + (y[there] - y[here]) * dy < -SLACK:
            break
        here = there
    return here
