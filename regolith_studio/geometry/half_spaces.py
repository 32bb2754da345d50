"""Half-spaces about an inner origin, as in Eq. 6 of the paper."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import linprog

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.geometry.kernels import inner_kernel, kernel
from regolith_studio.geometry.vectors import Vector

BLOCK = 512
"""Rays that are worked out together: they stay in the fastest cache."""


@kernel
def exits(
    normals: FloatArray, offsets: FloatArray, directions: FloatArray, radius: FloatArray, plane: IntArray
) -> None:
    """Fill `radius` (k,), infinite where no plane is met, and `plane` (k,), the first of several that tie.

    The half-spaces are <n_i, x> <= h_i with h_i > 0, the directions unit vectors (k, 3).
    """
    coordinates, largest, place = np.empty((3, BLOCK)), np.empty(BLOCK), np.empty(BLOCK)
    for start in range(0, len(directions), BLOCK):
        count = min(BLOCK, len(directions) - start)
        for j in range(count):
            largest[j] = place[j] = 0.0
            for c in range(3):
                coordinates[c, j] = directions[start + j, c]
        for i in range(len(offsets)):
            # Along u plane i is met at h_i / <n_i, u>: the nearest has the largest product of u with n_i /
            # h_i.
            a, b, c = normals[i, 0] / offsets[i], normals[i, 1] / offsets[i], normals[i, 2] / offsets[i]
            _compare(coordinates, (a, b, c), float(i), count, largest, place)
        for j in range(count):
            radius[start + j] = 1.0 / largest[j] if largest[j] > 0.0 else np.inf
            plane[start + j] = int(place[j])


@inner_kernel
def _compare(
    coordinates: FloatArray, dual: Vector, number: float, count: int, largest: FloatArray, place: FloatArray
) -> None:
    """Keep the product of each ray with a plane, and the plane's number, where it is larger than before."""
    a, b, c = dual
    for j in range(count):  # compiled to vectors: no branch, and only floats
        here = coordinates[0, j] * a + coordinates[1, j] * b + coordinates[2, j] * c
        place[j] = number if here > largest[j] else place[j]
        largest[j] = here if here > largest[j] else largest[j]  # noqa: FURB136


@dataclass(frozen=True, eq=False)
class HalfSpaces:
    """The half-spaces <n_i, x> <= h_i, i = 1..n, all with the origin strictly inside (h_i > 0).

    Parameters
    ----------
    normals
        Outward normals, shape (n, 3); normalised on construction.
    offsets
        Distances h_i of the planes from the origin, shape (n,), in the unit of the particle.

    Raises
    ------
    ValueError
        If the shapes differ or a normal vanishes.
    GeometryError
        If an offset is not positive.
    """

    normals: FloatArray
    offsets: FloatArray

    def __post_init__(self) -> None:
        normals = locked_floats(self.normals, (None, 3), "normals")
        offsets = locked_floats(self.offsets, (len(normals),), "offsets")
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        if not (length > 0.0).all():
            raise ValueError("normals must not vanish")
        if not (offsets > 0.0).all():
            raise GeometryError(
                f"Half-spaces must hold the origin inside: the smallest offset is {offsets.min():.3g}."
            )
        # Divided by lengths that are 1 but for rounding, normals would change their last bits with every
        # copy.
        unit = normals if np.all(np.abs(length - 1.0) < 4e-16) else normals / length
        object.__setattr__(self, "normals", locked_floats(unit, (None, 3), "normals"))
        object.__setattr__(self, "offsets", offsets)

    def __reduce__(self) -> tuple[Callable[..., "HalfSpaces"], tuple[ArrayLike, ArrayLike]]:
        return HalfSpaces, (self.normals, self.offsets)

    def __len__(self) -> int:
        return len(self.offsets)

    @classmethod
    def from_points(cls, points: ArrayLike) -> "HalfSpaces":
        """From the foot points p_i of Eq. 6, shape (n, 3): normal p_i / d_i, offset d_i, its length.

        Raises GeometryError if a point lies at the origin.
        """
        feet = np.asarray(points, dtype=np.float64)
        lengths = np.linalg.norm(feet, axis=1)
        if not (lengths > 0.0).all():
            raise GeometryError("A foot point of a half-space lies at the origin and has no direction.")
        return cls(feet / lengths[:, None], lengths)

    @property
    def points(self) -> FloatArray:
        """Foot points p_i = h_i n_i of Eq. 6, shape (n, 3)."""
        return np.asarray(self.normals * self.offsets[:, None])

    @property
    def equations(self) -> FloatArray:
        """Plane equations, shape (n, 4), outward normals, same sign as scipy's ``ConvexHull``."""
        return np.column_stack([self.normals, -self.offsets])

    def scaled(self, factor: float) -> "HalfSpaces":
        """All offsets times `factor`."""
        return HalfSpaces(self.normals, self.offsets * factor)

    def radii(self, directions: FloatArray) -> FloatArray:
        """Distance to the boundary along unit `directions` (k, 3), infinite where no plane is met; (k,)."""
        rays = np.array(directions, dtype=np.float64, order="C")
        radius, plane = np.empty(len(rays)), np.empty(len(rays), dtype=np.int64)
        # Copies, as the kernel would be compiled once more for arrays that cannot be written.
        exits(np.array(self.normals), np.array(self.offsets), rays, radius, plane)
        return radius


def inscribed_ball(normals: FloatArray, offsets: FloatArray) -> tuple[FloatArray, float]:
    """Centre (3,) and radius of the largest ball in <n_i, x> <= h_i (Chebyshev centre, HiGHS).

    The radius is negative where the half-spaces have no point in common, and NaN where they are unbounded.
    Normals are unit vectors, offsets of any sign; sizes must be near 1, as HiGHS has absolute tolerances.
    """
    rows = np.column_stack([normals, np.ones(len(normals))])
    optimum = linprog([0, 0, 0, -1], A_ub=rows, b_ub=offsets, bounds=(None, None), method="highs")
    if optimum.x is None:
        return np.full(3, np.nan), float("nan")
    return np.asarray(optimum.x[:3]), float(optimum.x[3])
