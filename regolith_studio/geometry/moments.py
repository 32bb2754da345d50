"""Volume, centroid and second moments of the solid inside a mesh, in one compiled pass."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.vectors import cross, dot, mixed, row


@kernel
def volume_moments(
    points: FloatArray, faces: IntArray, middle: FloatArray
) -> tuple[float, FloatArray, FloatArray]:
    """Signed volume, its first moments (3,) and its second moments (3, 3), all about `middle`.

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
    second = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
    return volume / 6.0, np.array([x, y, z]) / 24.0, second / 120.0
