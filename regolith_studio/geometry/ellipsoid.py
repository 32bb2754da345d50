"""The ellipsoid that stands for a solid."""

import numpy as np
from scipy.special import elliprg

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh


def equal_ellipsoid(mesh: Mesh) -> FloatArray:
    """Semi-axes, longest first, of the ellipsoid of the same volume and the same ratios of second moments."""
    unit = mesh.normalised()
    second = np.trace(unit.inertia) / 2 * np.eye(3) - unit.inertia
    shape = np.sqrt(np.linalg.eigvalsh(second)[::-1])
    radius = np.cbrt(3.0 * mesh.volume / (4.0 * np.pi))
    return np.asarray(shape * radius / np.cbrt(np.prod(shape)))


def ellipsoid_area(semi_axes: FloatArray) -> float:
    """Surface area of an ellipsoid, by Carlson's symmetric elliptic integral R_G."""
    a, b, c = np.asarray(semi_axes) / semi_axes[0]
    return float(4.0 * np.pi * elliprg((a * b) ** 2, (a * c) ** 2, (b * c) ** 2) * semi_axes[0] ** 2)
