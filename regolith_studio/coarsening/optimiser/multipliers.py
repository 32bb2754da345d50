"""Multipliers of one step: the price that the loss pays for each term bounds its multiplier.

A step d from a point with gradient g, inverse second derivative M, residuals c and their rows R minimises

    <g, d> + d M^-1 d / (2 t) + sum of rho_r(c_r + <R_r, d>),    rho_r(u) = max(low_r u, high_r u),

whose dual is, with D = R M R' and q = R M g, the least of

    t/2 l' D l + l' (t q - c),    low_r <= l_r <= high_r.

A multiplier inside its bounds means that the term is met to first order, one at a bound that the price does
not pay for it (an exact penalty; Fletcher 1987, section 14.3). t < 1 shortens the step.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel_noalloc

SWEEPS = 60
"""Of coordinate descent between two exact solutions for the multipliers inside their bounds."""
ROUNDS = 6
RIDGE = 1e-13
"""Added to the diagonal, relative to it: terms may depend on each other, as AR on both edges."""


@kernel_noalloc
def fill_multipliers(
    products: FloatArray,
    slopes: FloatArray,
    residuals: FloatArray,
    low: FloatArray,
    high: FloatArray,
    share: float,
    factor: FloatArray,
    multipliers: FloatArray,
) -> None:
    """Fill the multipliers (m,) of a step.

    Parameters
    ----------
    products, slopes, residuals
        D (m, m), q (m,) and c (m,).
    low, high
        Bounds (m,), low <= 0 <= high; both 0 where the loss has no such term.
    share
        t.
    factor
        Scratch, shape (m, m + 1).
    """
    m = len(residuals)
    for r in range(m):
        multipliers[r] = min(high[r], max(low[r], 0.0))
    for _ in range(ROUNDS):
        change = 0.0
        for _ in range(SWEEPS):
            change = _sweep(products, slopes, residuals, low, high, share, multipliers)
            if change < 1e-12:
                return
        if _solve_free(products, slopes, residuals, low, high, share, factor, multipliers):
            return


@kernel_noalloc
def _sweep(
    products: FloatArray,
    slopes: FloatArray,
    residuals: FloatArray,
    low: FloatArray,
    high: FloatArray,
    share: float,
    multipliers: FloatArray,
) -> float:
    """One round of coordinate descent; the largest change."""
    largest = 0.0
    for r in range(len(residuals)):
        diagonal = share * products[r, r]
        if low[r] == high[r] or not diagonal > 0.0:
            continue
        slope = share * slopes[r] - residuals[r]
        for s in range(len(residuals)):
            slope += share * products[r, s] * multipliers[s]
        value = min(high[r], max(low[r], multipliers[r] - slope / (diagonal * (1.0 + RIDGE))))
        largest = max(largest, abs(value - multipliers[r]))
        multipliers[r] = value
    return largest


@kernel_noalloc
def _solve_free(
    products: FloatArray,
    slopes: FloatArray,
    residuals: FloatArray,
    low: FloatArray,
    high: FloatArray,
    share: float,
    factor: FloatArray,
    multipliers: FloatArray,
) -> bool:
    """Solve for the multipliers inside their bounds, the others held; False where they leave the bounds."""
    m = len(residuals)
    for r in range(m):
        free = low[r] < multipliers[r] < high[r]
        right = residuals[r] - share * slopes[r]
        for s in range(m):
            both = free and low[s] < multipliers[s] < high[s]
            factor[r, s] = share * products[r, s] if both else (1.0 if r == s else 0.0)
            if free and not both:
                right -= share * products[r, s] * multipliers[s]
        factor[r, m] = right if free else multipliers[r]
    if not solve_in_place(factor):
        return False
    inside = True
    for r in range(m):
        inside = inside and low[r] <= factor[r, m] <= high[r]
    for r in range(m):
        multipliers[r] = min(high[r], max(low[r], factor[r, m]))
    return inside


@kernel_noalloc
def solve_in_place(system: FloatArray) -> bool:
    """Solve a symmetric positive semidefinite system (m, m + 1), the right-hand side last, by Cholesky.

    The solution takes the place of the right-hand side. A pivot that vanishes to rounding is a row that
    depends on those before it; its unknown becomes 0. False where the matrix is not positive semidefinite.
    """
    m = len(system)
    for k in range(m):
        pivot = system[k, k]
        for i in range(k):
            pivot -= system[k, i] * system[k, i]
        if pivot < -1e-9 * abs(system[k, k]):
            return False
        depends = pivot <= RIDGE * 10.0 * system[k, k]
        root = np.inf if depends else np.sqrt(pivot)
        for j in range(k + 1, m):
            value = system[j, k]
            for i in range(k):
                value -= system[j, i] * system[k, i]
            system[j, k] = value / root
        value = system[k, m]
        for i in range(k):
            value -= system[k, i] * system[i, m]
        system[k, k], system[k, m] = root, value / root
    for k in range(m - 1, -1, -1):
        value = system[k, m]
        for j in range(k + 1, m):
            value -= system[j, k] * system[j, m]
        system[k, m] = value / system[k, k]
    return True
