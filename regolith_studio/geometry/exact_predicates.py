"""Signs of small determinants without rounding error.

Products are split into sums of two floats (Dekker 1971) and added up as expansions whose parts do not
overlap (Shewchuk 1997), so that the sign is the true one for the numbers given. They must be free of
underflow: either zero or not far below 1e-60.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel

SPLITTER = 134217729.0
"""2**27 + 1: cuts a float in two halves of 26 bits."""


@kernel
def sign_of_triple_product(a: FloatArray, b: FloatArray, c: FloatArray) -> int:
    """Sign of a . (b x c): -1, 0 or +1."""
    parts = np.zeros(24)
    count = 0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        count = _add_product(parts, count, b[j], c[k], a[i])
        count = _add_product(parts, count, -b[k], c[j], a[i])
    return _sign(parts, count)


@kernel
def sign_of_cross_product(a: FloatArray, b: FloatArray, axis: int) -> int:
    """Sign of component `axis` of a x b: -1, 0 or +1."""
    parts = np.zeros(8)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    count = _add_product(parts, 0, a[j], b[k], 1.0)
    count = _add_product(parts, count, -a[k], b[j], 1.0)
    return _sign(parts, count)


@kernel
def _add_product(parts: FloatArray, count: int, x: float, y: float, z: float) -> int:
    """Add x * y * z to an expansion of `count` parts; returns how many it has now."""
    high, low = _product(x, y)
    for part in (high, low):
        first, second = _product(part, z)
        count = _add(parts, count, second)
        count = _add(parts, count, first)
    return count


@kernel
def _product(x: float, y: float) -> tuple[float, float]:
    """x * y as a rounded product and what the rounding lost."""
    product = x * y
    x_high = SPLITTER * x - (SPLITTER * x - x)
    y_high = SPLITTER * y - (SPLITTER * y - y)
    x_low, y_low = x - x_high, y - y_high
    lost = x_low * y_low - (((product - x_high * y_high) - x_low * y_high) - x_high * y_low)
    return product, lost


@kernel
def _add(parts: FloatArray, count: int, value: float) -> int:
    """Grow an expansion by one float: its parts stay free of overlap and rise in magnitude."""
    carried = value
    for i in range(count):
        total = carried + parts[i]
        virtual = total - carried
        parts[i] = (carried - (total - virtual)) + (parts[i] - virtual)
        carried = total
    parts[count] = carried
    return count + 1


@kernel
def _sign(parts: FloatArray, count: int) -> int:
    for i in range(count - 1, -1, -1):
        if parts[i] != 0.0:
            return 1 if parts[i] > 0.0 else -1
    return 0
