"""Samples of a function on the sphere to coefficients: quadrature grids and least squares.

The grids are pyshtools' (Gauss-Legendre, or Driscoll and Healy 1994 with twice as many longitudes as
latitudes), turned by a fixed rotation so that rays do not run along the edges of a mesh that was built
on coordinate planes; the coefficients are turned back exactly.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import lstsq
from scipy.spatial.transform import Rotation

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, locked_floats
from regolith_studio.harmonics import shtools
from regolith_studio.harmonics.coefficients import ShCoefficients, checked_degree
from regolith_studio.harmonics.legendre import harmonics
from regolith_studio.harmonics.rings import analysed, synthesised
from regolith_studio.harmonics.rotation import rotated

SAMPLING_DEGREE = 60
"""Degree of the ray grid. Sampling at the degree of the fit folds finer shape into it: 8.5 % of the
shape at l = 10, against 0.2 % from a grid of degree 60."""
HIGHEST_SAMPLING_DEGREE = 500
TILT = Rotation.from_euler("ZYZ", [np.sqrt(2.0), np.sqrt(3.0) - 1.0, np.sqrt(5.0)]).as_matrix()
"""Rotation of every ray grid; its angles are irrational multiples of anything a mesh is built on."""


@dataclass(frozen=True, eq=False)
class RayGrid:
    """Directions on which a function of degree `degree` is sampled.

    Parameters
    ----------
    kind
        Key of :data:`GRIDS`.
    degree
        Highest degree that the grid separates.
    directions
        Unit vectors, latitude by latitude, shape (n, 3).
    solid_angles
        Quadrature weight of each direction, shape (n,); their sum is 4 pi.
    """

    kind: str
    degree: int
    directions: FloatArray
    solid_angles: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "directions", locked_floats(self.directions, (None, 3), "directions"))
        weights = locked_floats(self.solid_angles, (len(self.directions),), "solid_angles")
        object.__setattr__(self, "solid_angles", weights)

    def __reduce__(self) -> tuple[Callable[..., "RayGrid"], tuple[int, str]]:
        return ray_grid, (self.degree, self.kind)

    def mean(self, values: FloatArray) -> float:
        """Mean of `values` (n,) over the sphere."""
        return float(self.solid_angles @ values) / (4 * np.pi)


@dataclass(frozen=True)
class GridKind:
    """How one kind of grid is laid out.

    Parameters
    ----------
    label
        For a list of choices.
    layout
        Of a degree: cosines of the polar angles, their weights (sum 2), number of longitudes.
    """

    label: str
    layout: Callable[[int], tuple[FloatArray, FloatArray, int]]


@cache
def _glq_layout(degree: int) -> tuple[FloatArray, FloatArray, int]:
    zeros, weights = shtools.call("expand.SHGLQ", degree)
    return np.asarray(zeros, dtype=np.float64), np.asarray(weights, dtype=np.float64), 2 * degree + 1


@cache
def _dh2_layout(degree: int) -> tuple[FloatArray, FloatArray, int]:
    n = 2 * (degree + 1)
    weights = np.asarray(shtools.call("utils.DHaj", n))
    return np.cos(np.pi * np.arange(n) / n), weights * 2 / weights.sum(), 2 * n


GRIDS = {
    "glq": GridKind("Gauss-Legendre", _glq_layout),
    "dh2": GridKind("Driscoll-Healy, n x 2n", _dh2_layout),
}
"""Kinds of quadrature grids by key; "dh2" takes four times the rays of "glq" for the same degree."""


def ray_grid(degree: int = SAMPLING_DEGREE, kind: str = "glq") -> RayGrid:
    """The tilted grid of one degree, cached.

    Raises
    ------
    InputError
        If the degree is out of range or the kind unknown.
    """
    if kind not in GRIDS:
        raise InputError(f"The grid must be one of {', '.join(GRIDS)}, got {kind!r}.")
    if not 1 <= degree <= HIGHEST_SAMPLING_DEGREE:
        raise InputError(f"The sampling degree must be 1 to {HIGHEST_SAMPLING_DEGREE}, got {degree}.")
    return _ray_grid(degree, kind)


@cache
def _ray_grid(degree: int, kind: str) -> RayGrid:
    cosine, weights, n_longitudes = GRIDS[kind].layout(degree)
    longitude = 2 * np.pi * np.arange(n_longitudes) / n_longitudes
    z = np.repeat(cosine, n_longitudes)
    ring = np.sqrt(1 - z**2)
    angle = np.tile(longitude, len(cosine))
    upright = np.column_stack([ring * np.cos(angle), ring * np.sin(angle), z])
    solid_angles = np.repeat(weights * 2 * np.pi / n_longitudes, n_longitudes)
    return RayGrid(kind, degree, upright @ TILT.T, solid_angles)


def expand(grid: RayGrid, samples: FloatArray, l_max: int) -> ShCoefficients:
    """Coefficients up to `l_max` of a function given on a grid, shape (n,), by quadrature.

    Raises
    ------
    InputError
        If `l_max` is above the grid's degree, or a sample is not finite.
    """
    return rotated(_upright(grid, samples, l_max), TILT)


def smoothed(grid: RayGrid, samples: FloatArray, l_max: int) -> FloatArray:
    """The function cut at degree `l_max`, on the same grid, shape (n,)."""
    return _on_rings(grid, _upright(grid, samples, l_max))


def evaluate_on_grid(grid: RayGrid, coefficients: ShCoefficients) -> FloatArray:
    """The function of `coefficients` at the directions of a grid of no lower degree, shape (n,)."""
    checked_degree(coefficients.l_max, grid.degree)
    return _on_rings(grid, rotated(coefficients, TILT.T))


def _upright(grid: RayGrid, samples: FloatArray, l_max: int) -> ShCoefficients:
    """Coefficients in the frame of the rings."""
    checked_degree(l_max, grid.degree)
    if samples.shape != grid.solid_angles.shape:
        raise ValueError(f"samples must have shape {grid.solid_angles.shape}, got {samples.shape}")
    cosines, weights, n_longitudes = GRIDS[grid.kind].layout(grid.degree)
    return ShCoefficients(analysed(samples.reshape(-1, n_longitudes), cosines, weights, l_max))


def _on_rings(grid: RayGrid, upright: ShCoefficients) -> FloatArray:
    cosines, _, n_longitudes = GRIDS[grid.kind].layout(grid.degree)
    return synthesised(upright.values, cosines, n_longitudes).ravel()


def expand_least_squares(directions: ArrayLike, samples: ArrayLike, l_max: int) -> ShCoefficients:
    """Coefficients up to `l_max` of a function known at any directions (n, 3), by least squares.

    Nothing guards against finer shape folding into the fit: use many more samples than coefficients.

    Raises
    ------
    InputError
        If there are fewer samples than coefficients, or they leave some coefficients undetermined.
    """
    rays = locked_floats(directions, (None, 3), "directions")
    values = locked_floats(samples, (len(rays),), "samples")
    n_coefficients = (checked_degree(l_max, HIGHEST_SAMPLING_DEGREE) + 1) ** 2
    if len(rays) < n_coefficients:
        raise InputError(
            f"A fit up to l = {l_max} has {n_coefficients} coefficients and needs at least as many samples, "
            f"got {len(rays)}."
        )
    unit = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    found, _, rank, _ = lstsq(harmonics(unit, l_max).T, values, lapack_driver="gelsd", cond=1e-10)
    if rank < n_coefficients:
        raise InputError(
            f"The {len(rays)} samples lie so that only {rank} of the {n_coefficients} coefficients up to "
            f"l = {l_max} can be told apart."
        )
    return ShCoefficients(found)
