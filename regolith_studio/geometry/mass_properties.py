"""Mass properties of the solid inside a mesh: volume, area, moments, and the ellipsoid of equal inertia."""

import numpy as np
from scipy.special import elliprg

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed, row


@kernel
def volume_moments(
    points: FloatArray, faces: IntArray, middle: FloatArray, first: FloatArray, second: FloatArray
) -> float:
    """Signed volume; fills its first moments (3,) and its second moments (3, 3), all about `middle`.

    Sums of the signed tetrahedra between `middle` and the triangles: with corners a, b, c and their sum s the
    moments of one are s / 24 and (s s' + a a' + b b' + c c') / 120 times six volumes (divergence theorem).

    Parameters
    ----------
    points, faces
        Closed mesh, shapes (n, 3) and (m, 3).
    middle
        Near the mesh, so that little is lost to rounding, shape (3,).
    """
    volume = x = y = z = xx = yy = zz = xy = yz = zx = 0.0
    origin = middle[0], middle[1], middle[2]
    for f in range(len(faces)):
        a = mixed(row(points, faces[f, 0]), 1.0, origin, -1.0)
        b = mixed(row(points, faces[f, 1]), 1.0, origin, -1.0)
        c = mixed(row(points, faces[f, 2]), 1.0, origin, -1.0)
        s = mixed(mixed(a, 1.0, b, 1.0), 1.0, c, 1.0)
        six = dot(a, cross(b, c))
        volume += six
        x, y, z = x + six * s[0], y + six * s[1], z + six * s[2]
        xx += six * (s[0] * s[0] + a[0] * a[0] + b[0] * b[0] + c[0] * c[0])
        yy += six * (s[1] * s[1] + a[1] * a[1] + b[1] * b[1] + c[1] * c[1])
        zz += six * (s[2] * s[2] + a[2] * a[2] + b[2] * b[2] + c[2] * c[2])
        xy += six * (s[0] * s[1] + a[0] * a[1] + b[0] * b[1] + c[0] * c[1])
        yz += six * (s[1] * s[2] + a[1] * a[2] + b[1] * b[2] + c[1] * c[2])
        zx += six * (s[2] * s[0] + a[2] * a[0] + b[2] * b[0] + c[2] * c[0])
    first[0], first[1], first[2] = x / 24.0, y / 24.0, z / 24.0
    second[0, 0], second[1, 1], second[2, 2] = xx / 120.0, yy / 120.0, zz / 120.0
    second[0, 1] = second[1, 0] = xy / 120.0
    second[1, 2] = second[2, 1] = yz / 120.0
    second[2, 0] = second[0, 2] = zx / 120.0
    return volume / 6.0


def volume_and_area(vertices: FloatArray, faces: IntArray) -> tuple[float, float]:
    """Signed volume (divergence theorem, about the middle of the bounds) and surface area of triangles.

    Equal to ``Mesh.volume`` and ``Mesh.surface_area`` but for rounding, in one compiled pass.

    Parameters
    ----------
    vertices, faces
        Shapes (n, 3) and (m, 3); no faces give 0.
    """
    return _measured(vertices, faces) if len(faces) else (0.0, 0.0)


@kernel
def _measured(points: FloatArray, faces: IntArray) -> tuple[float, float]:
    middle = _middle(points)
    volume = area = 0.0
    for f in range(len(faces)):
        a = mixed(row(points, faces[f, 0]), 1.0, middle, -1.0)
        b = mixed(row(points, faces[f, 1]), 1.0, middle, -1.0)
        c = mixed(row(points, faces[f, 2]), 1.0, middle, -1.0)
        normal = cross(mixed(b, 1.0, a, -1.0), mixed(c, 1.0, a, -1.0))
        volume += dot(a, normal)
        area += length(normal)
    return volume / 6.0, area / 2.0


@kernel
def _middle(points: FloatArray) -> Vector:
    """Middle of the bounds."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for i in range(len(points)):
        for k in range(3):
            low[k], high[k] = min(low[k], points[i, k]), max(high[k], points[i, k])
    return (low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, (low[2] + high[2]) / 2.0


def equal_ellipsoid(inertia: FloatArray, volume: float) -> FloatArray:
    """Semi-axes, longest first, of the ellipsoid of this volume and the same ratios of second moments.

    Parameters
    ----------
    inertia
        Tensor of inertia of the solid at volume and density 1, shape (3, 3).
    """
    second = np.trace(inertia) / 2 * np.eye(3) - inertia
    shape = np.sqrt(np.linalg.eigvalsh(second)[::-1])
    radius = np.cbrt(3.0 * volume / (4.0 * np.pi))
    return np.asarray(shape * radius / np.cbrt(np.prod(shape)))


def ellipsoid_area(semi_axes: FloatArray) -> float:
    """Surface area of an ellipsoid, by Carlson's symmetric elliptic integral R_G."""
    a, b, c = np.asarray(semi_axes) / semi_axes[0]
    return float(4.0 * np.pi * elliprg((a * b) ** 2, (a * c) ** 2, (b * c) ** 2) * semi_axes[0] ** 2)
