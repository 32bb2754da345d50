"""Real orthonormal spherical harmonics at given directions, from stable Legendre recursions."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.compiled import kernel


@kernel
def legendre(cosine: float, sine: float, l_max: int) -> FloatArray:
    """Orthonormal associated Legendre functions, shape (l_max + 1, l_max + 1), index [l, m], m <= l.

    No Condon-Shortley phase. The factor sqrt(2) of m > 0 is included, so that Y_lm is the entry times
    cos(m phi) or sin(m phi). Columns run upward in l from P_mm, which is stable.
    """
    p = np.zeros((l_max + 1, l_max + 1))
    diagonal = np.sqrt(1.0 / (4.0 * np.pi))
    for m in range(l_max + 1):
        if m > 0:
            diagonal *= sine * np.sqrt((2.0 * m + 1.0) / (2.0 * m))
        p[m, m] = diagonal * (np.sqrt(2.0) if m > 0 else 1.0)
        if m < l_max:
            p[m + 1, m] = np.sqrt(2.0 * m + 3.0) * cosine * p[m, m]
        for l in range(m + 2, l_max + 1):  # noqa: E741
            up = np.sqrt((4.0 * l * l - 1.0) / (l * l - m * m))
            down = np.sqrt(((l - 1.0) * (l - 1.0) - m * m) / (4.0 * (l - 1.0) * (l - 1.0) - 1.0))
            p[l, m] = up * (cosine * p[l - 1, m] - down * p[l - 2, m])
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
    for i in range(len(directions)):
        x, y, z = directions[i, 0], directions[i, 1], directions[i, 2]
        sine = np.sqrt(x * x + y * y)
        p = legendre(z, sine, l_max)
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
