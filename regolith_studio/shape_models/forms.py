"""Ellipsoids of inertia of surfaces on a grid: what form a body has, and how it gets another.

The form of a body is ln(long / middle) and ln(middle / short) of the axes of its ellipsoid of inertia about
the star point.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.sphere_grid import SphereGrid

_LEAST_MOMENT = 1e-30


def log_ellipsoids(directions: FloatArray, form: FloatArray, frames: FloatArray) -> FloatArray:
    """ln r of ellipsoids with a product of axes of one, shape (n, k).

    Parameters
    ----------
    directions
        Unit vectors, shape (k, 3).
    form
        ln(long / middle) and ln(middle / short), shape (n, 2).
    frames
        Unit vectors along the short, the middle and the long axis as columns, shape (n, 3, 3).
    """
    rising = np.column_stack([np.zeros(len(form)), form[:, 1], form[:, 0] + form[:, 1]])
    squares = np.exp(-2 * (rising - rising.mean(axis=1, keepdims=True)))
    tensors = (frames * squares[:, None, :]) @ np.swapaxes(frames, 1, 2)
    return np.asarray(-0.5 * np.log(tensors.reshape(-1, 9) @ _products(directions).T))


def forms(log_radii: FloatArray, grid: SphereGrid) -> tuple[FloatArray, FloatArray]:
    """The form (n, 2) of surfaces (n, k) by quadrature of r^5 u u, and their axes (n, 3, 3) as columns,
    the shortest first."""
    radii = np.exp(log_radii - log_radii.mean(axis=1, keepdims=True))
    squared = radii * radii
    moments = (squared * squared * radii * grid.weights) @ _products(grid.directions)
    squares, axes = np.linalg.eigh(moments.reshape(-1, 3, 3))
    logs = 0.5 * np.log(np.maximum(squares, _LEAST_MOMENT))
    return np.diff(logs, axis=1)[:, ::-1], axes


def with_forms(log_radii: FloatArray, wanted: FloatArray, grid: SphereGrid, steps: int) -> FloatArray:
    """The surfaces times ellipsoids along their own axes, so that they have the form wanted (n, 2).

    A product with an ellipsoid is the linear map of a sphere, and nearly that of another body: each of the
    `steps` leaves a tenth of the difference or so.
    """
    for _ in range(steps):
        found, axes = forms(log_radii, grid)
        log_radii = log_radii + log_ellipsoids(grid.directions, wanted - found, axes)
    return log_radii


def _products(directions: FloatArray) -> FloatArray:
    return np.asarray((directions[:, :, None] * directions[:, None, :]).reshape(-1, 9))
