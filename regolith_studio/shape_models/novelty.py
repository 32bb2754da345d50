"""How new drawn particles are: the distance to the nearest measured one over all rotations.

Particles are compared at equivalent radius one in the frames of their principal axes
(:func:`~regolith_studio.shape_models.inertia_ellipsoid.canonical`). Each is tried in the 24 rotations that
permute and flip the axes, and the nearest of these are brought nearer by Gauss-Newton steps over small
rotations: the derivative of a turned radius function is a linear map of its coefficients.
"""

from functools import cache
from math import isqrt

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.rotation import rotated

N_STARTS = 20
"""Nearest pairs of rotation and measured particle that the local search begins with."""
STEPS = 6
MAX_TURN = 0.3
"""Largest rotation of a step, in radians."""
_SMALL_TURN = 1e-4
_TAYLOR_TERMS = 16


def nearest_over_rotations(measured: FloatArray, drawn: FloatArray) -> tuple[FloatArray, IntArray]:
    """Distance from each drawn particle to the nearest measured one over rotations, and which it is.

    Parameters
    ----------
    measured, drawn
        Rows of ``canonical``, shapes (n, k) and (m, k).

    Returns
    -------
    Root-mean-square differences of the radii, and indices of measured particles, shapes (m,).
    """
    found = [_nearest(measured, row) for row in drawn]
    return np.array([distance for distance, _ in found]), np.array([index for _, index in found], np.int64)


def distances_among(measured: FloatArray, picks: IntArray) -> FloatArray:
    """Distance from each picked measured particle to the nearest of the others, shape (picks,).

    The novelty of a particle is its distance over the median of these: copies have 0, particles from the same
    source 1 in the median.
    """
    return np.array([_nearest(np.delete(measured, pick, axis=0), measured[pick])[0] for pick in picks])


def _nearest(measured: FloatArray, row: FloatArray) -> tuple[float, int]:
    starts = row @ _axis_rotations(isqrt(len(row)) - 1)
    overlaps = starts @ measured.T
    pairs = np.argsort((overlaps - 0.5 * (measured**2).sum(axis=1)).ravel())[: -N_STARTS - 1 : -1]
    rotation, index = np.unravel_index(pairs, overlaps.shape)
    turned, goal = starts[rotation], measured[index]
    for _ in range(STEPS):
        turned = _turned(turned, _best_small_turn(turned, goal))
    distances = np.linalg.norm(turned - goal, axis=1)
    best = int(distances.argmin())
    return float(distances[best]) / np.sqrt(4 * np.pi), int(index[best])


def _best_small_turn(rows: FloatArray, goal: FloatArray) -> FloatArray:
    """Rotation vectors (p, 3) that bring rows nearest to the goal, to first order in the rotation."""
    slopes = np.stack([rows @ generator for generator in _generators(isqrt(rows.shape[1]) - 1)], axis=2)
    normal = np.swapaxes(slopes, 1, 2) @ slopes + 1e-12 * np.eye(3)
    right = np.swapaxes(slopes, 1, 2) @ (goal - rows)[:, :, None]
    turns = np.linalg.solve(normal, right)[:, :, 0]
    lengths = np.linalg.norm(turns, axis=1, keepdims=True)
    return np.asarray(turns * np.minimum(1.0, MAX_TURN / np.maximum(lengths, 1e-300)))


def _turned(rows: FloatArray, turns: FloatArray) -> FloatArray:
    """Rows (p, k) rotated by rotation vectors (p, 3): the exponential of the generators, term by term."""
    generators = _generators(isqrt(rows.shape[1]) - 1)
    total, term = rows.copy(), rows
    for order in range(1, _TAYLOR_TERMS + 1):
        term = np.sum([turns[:, [i]] * (term @ generators[i]) for i in range(3)], axis=0) / order
        total = total + term
    return total


@cache
def _generators(l_max: int) -> FloatArray:
    """Derivative of rotated rows after the angle about x, y and z: ``row @ generator``, shape (3, k, k)."""
    ends = [
        [_matrix(l_max, Rotation.from_rotvec(sign * _SMALL_TURN * axis).as_matrix()) for sign in (1, -1)]
        for axis in np.eye(3)
    ]
    return np.stack([(one - other) / (2 * _SMALL_TURN) for one, other in ends])


@cache
def _axis_rotations(l_max: int) -> FloatArray:
    """The 24 rotations that map axes to axes: ``row @ matrix``, shape (24, k, k)."""
    return np.stack([_matrix(l_max, each) for each in Rotation.create_group("O").as_matrix()])


def _matrix(l_max: int, rotation: FloatArray) -> FloatArray:
    """``row @ matrix`` are the coefficients of the rotated radius function, shape (k, k)."""
    basis = np.eye((l_max + 1) ** 2)
    return np.stack([rotated(ShCoefficients(row), rotation).values for row in basis])
