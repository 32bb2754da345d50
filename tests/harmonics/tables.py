"""Tables of coefficients as other programs write them: inverses of the functions of ``harmonics.io``."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import ShCoefficients, degrees, orders


def complex_rows(coefficients: ShCoefficients) -> FloatArray:
    """Rows ``l m Re Im``, m = -l .. l, shape ((l_max + 1)^2, 4): inverse of :func:`from_complex_rows`."""
    degree, order = degrees(len(coefficients)), orders(len(coefficients))
    size = np.abs(order)
    sign = np.where(size % 2, -1.0, 1.0)
    cosine = coefficients.values[degree**2 + degree + size]
    sine = np.where(size > 0, coefficients.values[degree**2 + degree - size], 0.0)
    scale = np.where(size > 0, 1 / np.sqrt(2), 1.0)
    mirrored = np.where(order < 0, sign, 1.0)
    real = sign * scale * cosine * mirrored
    imaginary = -sign * scale * sine * mirrored * np.where(order < 0, -1.0, 1.0)
    return np.column_stack([degree, order, real, imaginary])


def shtools_rows(coefficients: ShCoefficients, norm: str = "4pi") -> FloatArray:
    """Rows ``l m C S``, m >= 0, shape (n, 4): inverse of :func:`from_shtools_rows`."""
    degree, order = degrees(len(coefficients)), orders(len(coefficients))
    keep = order >= 0
    degree, order = degree[keep], order[keep]
    values = coefficients.values / (np.sqrt(4 * np.pi) if norm == "4pi" else 1.0)
    sine = np.where(order > 0, values[degree**2 + degree - order], 0.0)
    return np.column_stack([degree, order, values[degree**2 + degree + order], sine])
