"""Rotation of coefficients: exact, degree by degree, without sampling."""

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics import shtools
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
    if coefficients.l_max == 0:
        return coefficients
    angles = -np.array(_euler_angles(matrix)[::-1])
    turned = shtools.call(
        "rotate.SHRotateRealCoef", to_pyshtools(coefficients), angles, _quarter_turn(coefficients.l_max)
    )
    return from_pyshtools(turned)


def _euler_angles(matrix: FloatArray) -> tuple[float, float, float]:
    """Angles of turns about z, the new y and the new z; about z alone the last is zero."""
    beta = np.arctan2(np.hypot(matrix[0, 2], matrix[1, 2]), matrix[2, 2])
    if np.hypot(matrix[0, 2], matrix[1, 2]) < 1e-12:
        return float(np.arctan2(-matrix[0, 1], matrix[1, 1])), float(beta), 0.0
    alpha = np.arctan2(matrix[1, 2], matrix[0, 2])
    return float(alpha), float(beta), float(np.arctan2(matrix[2, 1], -matrix[2, 0]))


@cache
def _quarter_turn(l_max: int) -> FloatArray:
    """Wigner's d(pi/2) of pyshtools, shape (l_max + 1,) * 3, at least to degree 2.

    ``djpi2(0)`` of pyshtools 4.14 writes behind its array and kills the process later.
    """
    return np.asarray(shtools.call("rotate.djpi2", max(l_max, 2)), dtype=np.float64)
