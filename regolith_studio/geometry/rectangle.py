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
    """Indices of the convex hull of points in the plane, counter-clockwise, by gift wrapping.

    Of points closer than `SHORTEST` only one is taken: rounding would let the others hide it.
    """
    start = 0
    for i in range(len(x)):
        if y[i] < y[start] - SLACK or (y[i] <= y[start] + SLACK and x[i] > x[start]):
            start = i
    chain = np.empty(len(x), np.int64)
    here, n = start, 0
    while n < len(x):
        best, far = -1, 0.0
        for i in range(len(x)):
            dx, dy = x[i] - x[here], y[i] - y[here]
            distance = dx * dx + dy * dy
            if distance < SHORTEST**2:
                continue
            turn = dy * (x[best] - x[here]) - dx * (y[best] - y[here]) if best >= 0 else -1.0
            if turn < -SLACK or (turn <= SLACK and distance > far):
                best, far = i, distance
        first = chain[0]
        if best < 0 or (n > 0 and (x[best] - x[first]) ** 2 + (y[best] - y[first]) ** 2 < SHORTEST**2):
            break
        chain[n], here = best, best
        n += 1
    return chain[:n]


@inlined
def polygon_area(x: FloatArray, y: FloatArray, n: int) -> float:
    """Area of a counter-clockwise polygon whose corners are the first `n` of `x` and `y`."""
    total = x[n - 1] * y[0] - x[0] * y[n - 1]
    for i in range(n - 1):
        total += x[i] * y[i + 1] - x[i + 1] * y[i]
    return float(total / 2.0)


@kernel
def smallest_rectangle(x: FloatArray, y: FloatArray, n: int) -> tuple[float, float, float, float]:
    """Rotating calipers around a convex counter-clockwise polygon.

    Parameters
    ----------
    x, y, n
        Corners; only the first `n` count.

    Returns
    -------
    tuple
        Area, direction cosine and sine of one side, and the longer side's length.
    """
    least, cosine, sine, longest = np.inf, 1.0, 0.0, np.inf
    right = up = left = -1
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        dx, dy = x[j] - x[i], y[j] - y[i]
        squared = dx * dx + dy * dy
        if squared < SHORTEST**2:
            continue
        shrink = 1.0 / np.sqrt(squared)
        dx, dy = dx * shrink, dy * shrink
        # Three calipers, written out: a function for one costs ten times as much.
        right = i if right < 0 else right
        for _ in range(n):
            k = right + 1 if right + 1 < n else 0
            if (x[k] - x[right]) * dx + (y[k] - y[right]) * dy < -SLACK:
                break
            right = k
        up = right if up < 0 else up
        for _ in range(n):
            k = up + 1 if up + 1 < n else 0
            if (y[k] - y[up]) * dx - (x[k] - x[up]) * dy < -SLACK:
                break
            up = k
        left = up if left < 0 else left
        for _ in range(n):
            k = left + 1 if left + 1 < n else 0
            if (x[left] - x[k]) * dx + (y[left] - y[k]) * dy < -SLACK:
                break
            left = k
        wide = (x[right] - x[left]) * dx + (y[right] - y[left]) * dy
        high = (y[up] - y[i]) * dx - (x[up] - x[i]) * dy
        area = wide * high
        if area < least * (1.0 + TIE):
            longer = max(wide, high)
            if area < least * (1.0 - TIE) or longer < longest * (1.0 - TIE):
                least, cosine, sine, longest = area, dx, dy, longer
    wide, high = _extents(x, y, n, cosine, sine)
    if wide * high > least * (1.0 + TIE):
        return _measured_rectangle(x, y, n)
    return wide * high, cosine, sine, max(wide, high)


@kernel
def _measured_rectangle(x: FloatArray, y: FloatArray, n: int) -> tuple[float, float, float, float]:
    """As :func:`smallest_rectangle`, but measuring all corners for each side.

    For when rounding in a very short side sent a caliper too far.
    """
    least, cosine, sine, longest = np.inf, 1.0, 0.0, np.inf
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        dx, dy = x[j] - x[i], y[j] - y[i]
        size = np.sqrt(dx * dx + dy * dy)
        if size < SHORTEST:
            continue
        wide, high = _extents(x, y, n, dx / size, dy / size)
        area, longer = wide * high, max(wide, high)
        shorter = longest - longer > TIE * longest
        if area < least * (1.0 - TIE) or (area < least * (1.0 + TIE) and shorter):
            least, cosine, sine, longest = area, dx / size, dy / size, longer
    return least, cosine, sine, longest


@inlined
def _extents(x: FloatArray, y: FloatArray, n: int, dx: float, dy: float) -> tuple[float, float]:
    """Width along (dx, dy) and height across it of the first `n` points."""
    low, high, bottom, top = np.inf, -np.inf, np.inf, -np.inf
    for i in range(n):
        s, t = x[i] * dx + y[i] * dy, y[i] * dx - x[i] * dy
        low, high, bottom, top = min(low, s), max(high, s), min(bottom, t), max(top, t)
    return high - low, top - bottom
