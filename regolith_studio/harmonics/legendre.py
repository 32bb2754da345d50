"""Real orthonormal spherical harmonics at given directions, from stable Legendre recursions."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel


@kernel
def legendre_factors(l_max: int) -> FloatArray:
    """Square roots of the recursions below, the same for all angles, shape (2, l_max + 1, l_max + 1)."""
    factors = np.zeros((2, l_max + 1, l_max + 1))
    for m in range(l_max + 1):
        if m > 0:
            factors[0, m, m] = np.sqrt((2.0 * m + 1.0) / (2.0 * m))
        if m < l_max:
            factors[0, m + 1, m] = np.sqrt(2.0 * m + 3.0)
        for l in range(m + 2, l_max + 1):  # noqa: E741
            factors[0, l, m] = np.sqrt((4.0 * l * l - 1.0) / (l * l - m * m))
            factors[1, l, m] = np.sqrt(((l - 1.0) * (l - 1.0) - m * m) / (4.0 * (l - 1.0) * (l - 1.0) - 1.0))
    return factors


@kernel
def fill_legendre(cosine: float, sine: float, factors: FloatArray, p: FloatArray) -> None:
    """Orthonormal associated Legendre functions into `p` (l_max + 1, l_max + 1), index [l, m], m <= l.

    No Condon-Shortley phase. The factor sqrt(2) of m > 0 is included, so that Y_lm is the entry times
    cos(m phi) or sin(m phi). Columns run upward in l from P_mm, which is stable. `factors` are those of
    :func:`legendre_factors` for the same degree.
    """
    l_max = len(p) - 1
    diagonal = np.sqrt(1.0 / (4.0 * np.pi))
    for m in range(l_max + 1):
        if m > 0:
            diagonal *= sine * factors[0, m, m]
        p[m, m] = diagonal * (np.sqrt(2.0) if m > 0 else 1.0)
        if m < l_max:
            p[m + 1, m] = factors[0, m + 1, m] * cosine * p[m, m]
        for l in range(m + 2, l_max + 1):  # noqa: E741
            p[l, m] = factors[0, l, m] * (cosine * p[l - 1, m] - factors[1, l, m] * p[l - 2, m])


@kernel
def legendre(cosine: float, sine: float, l_max: int) -> FloatArray:
    """What :func:`fill_legendre` gives at one angle; zero above the diagonal."""
    p = np.zeros((l_max + 1, l_max + 1))
    fill_legendre(cosine, sine, legendre_factors(l_max), p)
    return p


@kernel
def legendre_slopes(p: FloatArray, cosine: float, sine: float) -> FloatArray:
    """Derivatives of `legendre` with respect to the polar angle, same shape; `sine` must not be zero."""
    n = len(p)
    slopes = np.zeros((n, n))
    for l in range(n):  # noqa: E741
        for m in range(l + 1):
            lower = 0.0
            if l > m:
                lower = np.sqrt((2.0 * l + 1.0) / (2.0 * l - 1.0) * (l * l - m * m)) * p[l - 1, m]
            slopes[l, m] = (l * cosine * p[l, m] - lower) / sine
    return slopes


@kernel
def fill_basis(directions: FloatArray, l_max: int, basis: FloatArray) -> None:
    """Y_lm at unit `directions` (n, 3) into `basis` ((l_max + 1)^2, n), row k = l^2 + l + m."""
    factors, p = legendre_factors(l_max), np.zeros((l_max + 1, l_max + 1))
    for i in range(len(directions)):
        x, y, z = directions[i, 0], directions[i, 1], directions[i, 2]
        sine = np.sqrt(x * x + y * y)
        fill_legendre(z, sine, factors, p)
        c1, s1 = (x / sine, y / sine) if sine > 0.0 else (1.0, 0.0)
        c, s = 1.0, 0.0
        for m in range(l_max + 1):
            for l in range(m, l_max + 1):  # noqa: E741
                basis[l * l + l + m, i] = p[l, m] * c
                if m > 0:
                    basis[l * l + l - m, i] = p[l, m] * s
            c, s = c * c1 - s * s1, s * c1 + c * s1


def harmonics(directions: FloatArray, l_max: int) -> FloatArray:
    """Y_lm at unit `directions` (n, 3), shape ((l_max + 1)^2, n), row k = l^2 + l + m."""
    basis = np.empty(((l_max + 1) ** 2, len(directions)))
    fill_basis(np.ascontiguousarray(directions, dtype=np.float64), l_max, basis)
    return basis
