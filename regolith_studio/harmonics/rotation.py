"""Rotation of coefficients: exact, degree by degree, without sampling."""

from functools import cache

import numpy as np
import pyshtools.rotate as pyshtools_rotate
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import ShCoefficients, from_pyshtools, to_pyshtools


def rotated(coefficients: ShCoefficients, rotation: ArrayLike) -> ShCoefficients:
    """Coefficients of the body turned by a rotation matrix (3, 3): r'(rotation @ u) = r(u).

    Raises
    ------
    ValueError
        If the matrix is not a proper rotation.
    """
    matrix = np.asarray(rotation, dtype=np.float64)
    if matrix.shape != (3, 3) or not np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-9):
        raise ValueError("rotation must be an orthogonal (3, 3) matrix")
    if np.linalg.det(matrix) < 0:
        raise ValueError("rotation must be proper, this one mirrors")
    alpha, beta, gamma = Rotation.from_matrix(matrix).as_euler("ZYZ")
    angles = np.array([-gamma, -beta, -alpha])
    turned = pyshtools_rotate.SHRotateRealCoef(
        to_pyshtools(coefficients), angles, _quarter_turn(coefficients.l_max)
    )
    return from_pyshtools(turned)


@cache
def _quarter_turn(l_max: int) -> FloatArray:
    """Wigner's d(pi/2) of pyshtools, shape (l_max + 1, l_max + 1, l_max + 1)."""
    return np.asarray(pyshtools_rotate.djpi2(l_max), dtype=np.float64)
