"""Arithmetic on vectors of three floats inside kernels: tuples stay in registers, arrays do not."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import inner_kernel

Vector = tuple[float, float, float]


@inner_kernel
def row(rows: FloatArray, i: int) -> Vector:
    """Row `i` of an array of shape (n, 3)."""
    return rows[i, 0], rows[i, 1], rows[i, 2]


@inner_kernel
def along(rows: FloatArray, i: int, direction: Vector) -> float:
    """Scalar product of row `i` of an array of shape (n, 3) with `direction`."""
    return float(rows[i, 0] * direction[0] + rows[i, 1] * direction[1] + rows[i, 2] * direction[2])


@inner_kernel
def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inner_kernel
def cross(a: Vector, b: Vector) -> Vector:
    """Vector product; swapping the arguments changes its sign and not one bit more."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inner_kernel
def length(a: Vector) -> float:
    """Euclidean norm."""
    return float(np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]))


@inner_kernel
def mixed(a: Vector, share: float, b: Vector, other: float) -> Vector:
    """``share * a + other * b``."""
    return share * a[0] + other * b[0], share * a[1] + other * b[1], share * a[2] + other * b[2]
