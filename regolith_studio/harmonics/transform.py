"""Gauss-Legendre grids on the sphere, and the transforms between samples on them and coefficients.

The nodes are those of SHTOOLS, from the north to the south, rotated by a fixed angle so that rays do not run
along the edges of a mesh that was built on coordinate planes; the coefficients are rotated back exactly,
degree by degree, by SHTOOLS too.

Its Fortran is loaded on first use, and never run in two threads at once: the routines keep tables and plans
in saved variables, yet release the interpreter while they run, so that two threads corrupt memory (one run in
six of a loop over four threads was killed). All that the program asks of pyshtools goes through
:func:`call_shtools`.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from threading import Lock
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, locked_floats
from regolith_studio.harmonics.coefficients import (
    ShCoefficients,
    checked_degree,
    from_pyshtools,
    to_pyshtools,
)
from regolith_studio.harmonics.sphere_grid import analyse_rings, ring_nodes, synthesise_rings

_one_at_a_time = Lock()


def call_shtools(routine: str, *arguments: Any, **options: Any) -> Any:
    """What a routine of SHTOOLS returns, by its place in the package, such as ``expand.SHGLQ``."""
    with _one_at_a_time:
        return getattr(_routines(), routine.rpartition(".")[2])(*arguments, **options)


@cache
def _routines() -> ModuleType:
    """The module of the wrapped Fortran, under empty packages that are taken away again.

    The package around it imports matplotlib, pandas and xarray: a second and 90 MB in a command, many seconds
    in a window, where PySide reads the source of every module that is imported.
    """
    spec = find_spec("pyshtools")
    if "pyshtools" in sys.modules or spec is None or not spec.submodule_search_locations:
        return import_module("pyshtools.backends.shtools")
    place = Path(spec.submodule_search_locations[0])
    sys.modules["pyshtools"] = _package("pyshtools", place)
    sys.modules["pyshtools.backends"] = _package("pyshtools.backends", place / "backends")
    try:
        return import_module("pyshtools.backends.shtools")
    finally:
        # Whoever imports pyshtools later must not get the empty packages.
        for name in [name for name in sys.modules if name.split(".")[0] == "pyshtools"]:
            del sys.modules[name]


def _package(name: str, folder: Path) -> ModuleType:
    package = ModuleType(name)
    package.__path__ = [str(folder)]
    return package


def rotated(coefficients: ShCoefficients, rotation: ArrayLike) -> ShCoefficients:
    """Coefficients of the body turned by a rotation matrix (3, 3): r'(rotation @ u) = r(u).

    Raises ValueError if the matrix is not a proper rotation.
    """
    matrix = np.asarray(rotation, dtype=np.float64)
    if matrix.shape != (3, 3) or not np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-9):
        raise ValueError("rotation must be an orthogonal (3, 3) matrix")
    if np.linalg.det(matrix) < 0:
        raise ValueError("rotation must be proper, this one mirrors")
    if coefficients.l_max == 0:
        return coefficients
    # SHTOOLS rotates the coordinate system; that of a body by the same rotation is the inverse one.
    angles = -np.array(_euler_angles(matrix)[::-1])
    turned = call_shtools(
        "rotate.SHRotateRealCoef", to_pyshtools(coefficients), angles, _quarter_turn(coefficients.l_max)
    )
    return from_pyshtools(turned)


def _euler_angles(matrix: FloatArray) -> tuple[float, float, float]:
    """Angles of turns about z, the new y and the new z; about z alone the last is zero."""
    beta = np.arctan2(np.hypot(matrix[0, 2], matrix[1, 2]), matrix[2, 2])
    # Both angles about z are one rotation here, and the other formulas would divide rounding by rounding.
    if np.hypot(matrix[0, 2], matrix[1, 2]) < 1e-12:
        return float(np.arctan2(-matrix[0, 1], matrix[1, 1])), float(beta), 0.0
    alpha = np.arctan2(matrix[1, 2], matrix[0, 2])
    return float(alpha), float(beta), float(np.arctan2(matrix[2, 1], -matrix[2, 0]))


@cache
def _quarter_turn(l_max: int) -> FloatArray:
    """Wigner's d(pi/2) of pyshtools, shape (l_max + 1,) * 3, at least to degree 2.

    ``djpi2(0)`` of pyshtools 4.14 writes behind its array and kills the process later.
    """
    return np.asarray(call_shtools("rotate.djpi2", max(l_max, 2)), dtype=np.float64)


SAMPLING_DEGREE = 60
"""Degree of the ray grid. Sampling at the degree of the fit folds finer shape into it: 8.5 % of the
shape at l = 10, against 0.2 % from a grid of degree 60."""
MAX_SAMPLING_DEGREE = 500
TILT = Rotation.from_euler("ZYZ", [np.sqrt(2.0), np.sqrt(3.0) - 1.0, np.sqrt(5.0)]).as_matrix()
"""Rotation of every ray grid; its angles are irrational multiples of anything a mesh is built on."""


@dataclass(frozen=True, eq=False)
class RayGrid:
    """Directions on which a function of degree `degree` is sampled.

    - ``degree``: highest degree that the grid separates.
    - ``directions``: unit vectors, latitude by latitude, shape (n, 3).
    - ``solid_angles``: quadrature weight of each direction, shape (n,); their sum is 4 pi.
    """

    degree: int
    directions: FloatArray
    solid_angles: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "directions", locked_floats(self.directions, (None, 3), "directions"))
        weights = locked_floats(self.solid_angles, (len(self.directions),), "solid_angles")
        object.__setattr__(self, "solid_angles", weights)

    def __reduce__(self) -> tuple[Callable[..., "RayGrid"], tuple[int]]:
        return ray_grid, (self.degree,)

    def mean(self, values: FloatArray) -> float:
        """Mean of `values` (n,) over the sphere."""
        return float(self.solid_angles @ values) / (4 * np.pi)


@cache
def _rings(degree: int) -> tuple[FloatArray, FloatArray, int]:
    """Cosines of the polar angles of the rings, their weights (sum 2), and the number of longitudes."""
    zeros, weights = call_shtools("expand.SHGLQ", degree)
    return np.asarray(zeros, dtype=np.float64), np.asarray(weights, dtype=np.float64), 2 * degree + 1


def ray_grid(degree: int = SAMPLING_DEGREE) -> RayGrid:
    """The tilted Gauss-Legendre grid of one degree, cached.

    Raises InputError if the degree is out of range.
    """
    if not 1 <= degree <= MAX_SAMPLING_DEGREE:
        raise InputError(f"The sampling degree must be 1 to {MAX_SAMPLING_DEGREE}, got {degree}.")
    return _ray_grid(degree)


@cache
def _ray_grid(degree: int) -> RayGrid:
    untilted, solid_angles = ring_nodes(*_rings(degree))
    return RayGrid(degree, untilted @ TILT.T, solid_angles)


def analyse(grid: RayGrid, samples: FloatArray, l_max: int) -> ShCoefficients:
    """Coefficients up to `l_max` of a function given on a grid, shape (n,), by quadrature.

    Raises InputError if `l_max` is above the grid's degree, or a sample is not finite.
    """
    return rotated(_untilted(grid, samples, l_max), TILT)


def band_limited(grid: RayGrid, samples: FloatArray, l_max: int) -> FloatArray:
    """The function cut at degree `l_max`, on the same grid, shape (n,)."""
    return _on_rings(grid, _untilted(grid, samples, l_max))


def evaluate_on_grid(grid: RayGrid, coefficients: ShCoefficients) -> FloatArray:
    """The function of `coefficients` at the directions of a grid of no lower degree, shape (n,)."""
    checked_degree(coefficients.l_max, grid.degree)
    return _on_rings(grid, rotated(coefficients, TILT.T))


def _untilted(grid: RayGrid, samples: FloatArray, l_max: int) -> ShCoefficients:
    """Coefficients in the frame of the rings."""
    checked_degree(l_max, grid.degree)
    if samples.shape != grid.solid_angles.shape:
        raise ValueError(f"samples must have shape {grid.solid_angles.shape}, got {samples.shape}")
    cosines, weights, n_longitudes = _rings(grid.degree)
    return ShCoefficients(analyse_rings(samples.reshape(-1, n_longitudes), cosines, weights, l_max))


def _on_rings(grid: RayGrid, untilted: ShCoefficients) -> FloatArray:
    cosines, _, n_longitudes = _rings(grid.degree)
    return synthesise_rings(untilted.values, cosines, n_longitudes).ravel()
