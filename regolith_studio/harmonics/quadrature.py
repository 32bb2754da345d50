"""Volume and area of an expanded surface by Gauss-Legendre quadrature of the exact surface element.

With r(u) on the unit sphere and its surface gradient g, ::

    V = integral of r^3 / 3            A = integral of r sqrt(r^2 + |g|^2)

V is exact once the grid has degree 1.5 l_max; A converges fast, because the integrand is smooth.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.legendre import fill_legendre, legendre_factors, legendre_slopes
from regolith_studio.harmonics.reference import Ellipsoid
from regolith_studio.harmonics.transform import evaluate_on_grid, ray_grid

AREA_TOLERANCE = 1e-6
"""Relative change between two grids at which the area counts as converged."""
HIGHEST_DEGREE = 480


@dataclass(frozen=True)
class SurfaceMeasures:
    """Volume and area of an expanded surface.

    Parameters
    ----------
    volume, surface_area
        In the unit of the radius, cubed and squared; meaningful only if `lowest_radius` is positive.
    lowest_radius
        Smallest radius on the quadrature grid.
    area_change
        Relative change of the area at the last refinement: an estimate of its error.
    """

    volume: float
    surface_area: float
    lowest_radius: float
    area_change: float


def measure(coefficients: ShCoefficients, reference: Ellipsoid | None = None) -> SurfaceMeasures:
    """Volume and area of the surface; the grid is refined until the area stands still."""
    degree = max(20, 2 * coefficients.l_max)
    volume, area, lowest = measure_on_grid(coefficients, degree, reference)
    change = np.inf
    while change > AREA_TOLERANCE and degree < HIGHEST_DEGREE:
        degree = min(HIGHEST_DEGREE, degree * 3 // 2)
        before = area
        volume, area, low = measure_on_grid(coefficients, degree, reference)
        lowest = min(lowest, low)
        change = abs(area / before - 1)
    return SurfaceMeasures(volume, area, lowest, change)


def measure_on_grid(
    coefficients: ShCoefficients, degree: int, reference: Ellipsoid | None = None
) -> tuple[float, float, float]:
    """Volume, area and lowest radius on one Gauss-Legendre grid."""
    cosines, weights = _nodes(degree)
    radius, south, east = np.zeros((3, len(cosines), 2 * degree + 1))
    _fill_fields(coefficients.values, coefficients.l_max, cosines, radius, south, east)
    if reference is not None:
        radius, south, east = _multiplied(reference, cosines, radius, south, east)
    solid_angle = weights * 2 * np.pi / radius.shape[1]
    volume = float(solid_angle @ (radius**3).sum(axis=1)) / 3
    area = float(solid_angle @ (radius * np.sqrt(radius**2 + south**2 + east**2)).sum(axis=1))
    return volume, area, float(radius.min())


def enclosed_volume(coefficients: ShCoefficients, reference: Ellipsoid | None = None) -> float:
    """Signed volume of the surface; exact to rounding without a reference."""
    if reference is not None:
        return measure_on_grid(coefficients, max(60, 2 * coefficients.l_max), reference)[0]
    grid = ray_grid(max(1, 3 * coefficients.l_max // 2 + 1))
    return 4 * np.pi / 3 * grid.mean(evaluate_on_grid(grid, coefficients) ** 3)


@cache
def _nodes(degree: int) -> tuple[FloatArray, FloatArray]:
    """Cosines of the polar angles and weights (sum 2), shapes (degree + 1,)."""
    cosines, weights = np.polynomial.legendre.leggauss(degree + 1)
    return cosines, weights


@kernel
def _fill_fields(
    values: FloatArray,
    l_max: int,
    cosines: FloatArray,
    radius: FloatArray,
    south: FloatArray,
    east: FloatArray,
) -> None:
    """Add radius and its derivatives to the south and the east to arrays of shape (latitudes, longitudes)."""
    n_longitudes = radius.shape[1]
    cosine = np.cos(2 * np.pi / n_longitudes * np.arange(n_longitudes))
    sines = np.sin(2 * np.pi / n_longitudes * np.arange(n_longitudes))
    factors, p = legendre_factors(l_max), np.zeros((l_max + 1, l_max + 1))
    for j in range(len(cosines)):
        sine = np.sqrt(1 - cosines[j] ** 2)
        fill_legendre(cosines[j], sine, factors, p)
        slope = legendre_slopes(p, cosines[j], sine)
        for m in range(l_max + 1):
            a, b, da, db = 0.0, 0.0, 0.0, 0.0
            for degree in range(m, l_max + 1):
                k = degree * degree + degree
                a += values[k + m] * p[degree, m]
                da += values[k + m] * slope[degree, m]
                if m > 0:
                    b += values[k - m] * p[degree, m]
                    db += values[k - m] * slope[degree, m]
            for i in range(n_longitudes):
                c, s = cosine[(m * i) % n_longitudes], sines[(m * i) % n_longitudes]
                radius[j, i] += a * c + b * s
                south[j, i] += da * c + db * s
                east[j, i] += m * (b * c - a * s) / sine


def _multiplied(
    reference: Ellipsoid, cosines: FloatArray, radius: FloatArray, south: FloatArray, east: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The fields times those of the reference, by the product rule."""
    phi = 2 * np.pi / radius.shape[1] * np.arange(radius.shape[1])[None, :]
    z = np.broadcast_to(cosines[:, None], radius.shape)
    ring = np.sqrt(1 - z**2)
    up = np.stack([ring * np.cos(phi), ring * np.sin(phi), z], axis=-1).reshape(-1, 3)
    to_south = np.stack([z * np.cos(phi), z * np.sin(phi), -ring], axis=-1).reshape(-1, 3)
    to_east = np.stack([-np.sin(phi) + 0 * z, np.cos(phi) + 0 * z, 0 * z], axis=-1).reshape(-1, 3)
    base, slope = reference.radii(up).reshape(radius.shape), reference.gradients(up)
    base_south = np.einsum("ij,ij->i", slope, to_south).reshape(radius.shape)
    base_east = np.einsum("ij,ij->i", slope, to_east).reshape(radius.shape)
    return radius * base, south * base + radius * base_south, east * base + radius * base_east
