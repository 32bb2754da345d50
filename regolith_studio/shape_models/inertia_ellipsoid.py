"""Ellipsoids of inertia about the star point: principal axes, form, and a frame that turns with the particle.

The form of a particle is ln(long / middle) and ln(middle / short) of the axes of its ellipsoid of inertia.
"""

from dataclasses import dataclass

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.sphere_grid import SphereGrid, enclosed_volumes, sphere_grid
from regolith_studio.harmonics.transform import rotated

_BATCH = 100
_MIN_MOMENT = 1e-30


@dataclass(frozen=True, eq=False)
class PrincipalAxes:
    """Second moments about the star point of n particles.

    - ``axes``: unit vectors as columns, the shortest extent first, right-handed, shape (n, 3, 3).
    - ``lengths``: root of the second moment over the volume along each, ascending, shape (n, 3).
    - ``skews``: third moment along each over the volume, shape (n, 3).
    - ``volumes``: shape (n,).
    """

    axes: FloatArray
    lengths: FloatArray
    skews: FloatArray
    volumes: FloatArray

    @property
    def log_ratios(self) -> FloatArray:
        """ln of the lengths, without their mean, shape (n, 3)."""
        logs = np.log(self.lengths)
        return np.asarray(logs - logs.mean(axis=1, keepdims=True))


def principal_axes(coefficients: FloatArray) -> PrincipalAxes:
    """Principal axes of radius functions (n, (l_max + 1)^2).

    By quadrature of r^5 u u / 5 and r^6 (u e)^3 / 6, on a grid of twice the degree: their higher degrees are
    weak.
    """
    parts = [_of_batch(coefficients[i : i + _BATCH]) for i in range(0, len(coefficients), _BATCH)]
    return PrincipalAxes(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in PrincipalAxes.__annotations__)
    )


def _of_batch(coefficients: FloatArray) -> PrincipalAxes:
    l_max = round(coefficients.shape[1] ** 0.5) - 1
    grid = sphere_grid(2 * l_max + 2, l_max)
    radii = grid.values(coefficients)
    volumes = enclosed_volumes(radii, grid)
    u = grid.directions
    products = (u[:, :, None] * u[:, None, :]).reshape(-1, 9)
    squared = radii * radii
    second = ((squared * squared * radii * grid.weights) @ products / 5).reshape(-1, 3, 3) / volumes[
        :, None, None
    ]
    squares, axes = np.linalg.eigh(second)
    axes[np.linalg.det(axes) < 0, :, 0] *= -1  # eigenvectors may be a mirror image, which rotations are not
    cubes = (products[:, :, None] * u[:, None, :]).reshape(-1, 27)
    third = ((squared * squared * squared * grid.weights) @ cubes / 6).reshape(-1, 3, 3, 3)
    skews = np.einsum("nabc,nai,nbi,nci->ni", third, axes, axes, axes, optimize=True)
    return PrincipalAxes(axes, np.sqrt(np.maximum(squares, _MIN_MOMENT)), skews / volumes[:, None], volumes)


def canonical(coefficients: FloatArray) -> FloatArray:
    """The particles at equivalent radius one in the frame of their axes, shape (n, (l_max + 1)^2).

    The longest extent along x, the shortest along z; x and y point to the heavier side (third moment).
    Mirror images stay different.
    """
    principal = principal_axes(coefficients)
    rows = np.empty_like(coefficients)
    scales = np.cbrt(3 * principal.volumes / (4 * np.pi))
    for i, row in enumerate(coefficients):
        frame = principal.axes[i, :, ::-1].T
        frame = frame * np.where(principal.skews[i, ::-1] < 0, -1.0, 1.0)[:, None]
        frame[2] = np.cross(frame[0], frame[1])  # not by its own moment, which would mirror some particles
        rows[i] = rotated(ShCoefficients(row), frame).values / scales[i]
    return rows


def log_ellipsoids(directions: FloatArray, form: FloatArray, frames: FloatArray) -> FloatArray:
    """ln r of ellipsoids with a product of axes of one, shape (n, k).

    - ``directions``: unit vectors, shape (k, 3).
    - ``form``: ln(long / middle) and ln(middle / short), shape (n, 2).
    - ``frames``: unit vectors along the short, the middle and the long axis as columns, shape (n, 3, 3).
    """
    rising = np.column_stack([np.zeros(len(form)), form[:, 1], form[:, 0] + form[:, 1]])
    squares = np.exp(-2 * (rising - rising.mean(axis=1, keepdims=True)))
    tensors = (frames * squares[:, None, :]) @ np.swapaxes(frames, 1, 2)
    # On an ellipsoid 1 / r^2 = u' T u.
    return np.asarray(-0.5 * np.log(tensors.reshape(-1, 9) @ _products(directions).T))


def forms(log_radii: FloatArray, grid: SphereGrid) -> tuple[FloatArray, FloatArray]:
    """The form (n, 2) of surfaces (n, k) by quadrature of r^5 u u, and their axes (n, 3, 3) as columns,
    the shortest first."""
    # Ratios of axes do not depend on the unit, and fifth powers of radii in small units would underflow.
    radii = np.exp(log_radii - log_radii.mean(axis=1, keepdims=True))
    squared = radii * radii
    moments = (squared * squared * radii * grid.weights) @ _products(grid.directions)
    squares, axes = np.linalg.eigh(moments.reshape(-1, 3, 3))
    logs = 0.5 * np.log(np.maximum(squares, _MIN_MOMENT))
    return np.diff(logs, axis=1)[:, ::-1], axes


def with_forms(log_radii: FloatArray, wanted: FloatArray, grid: SphereGrid, steps: int) -> FloatArray:
    """The surfaces multiplied by ellipsoids along their own axes, so that they have the form `wanted` (n, 2).

    Multiplying by an ellipsoid is a linear map of a sphere, and nearly one of other shapes: each of the
    `steps` leaves about a tenth of the difference.
    """
    for _ in range(steps):
        current, axes = forms(log_radii, grid)
        log_radii = log_radii + log_ellipsoids(grid.directions, wanted - current, axes)
    return log_radii


def _products(directions: FloatArray) -> FloatArray:
    return np.asarray((directions[:, :, None] * directions[:, None, :]).reshape(-1, 9))
