"""Spherical-harmonics coefficients of a radius function (Eq. 3 and 4).

The convention, everywhere in the program and in its files: real spherical harmonics, orthonormal on
the unit sphere, without the Condon-Shortley phase, ::

    Y_lm =         P_l0(cos t)                 m = 0
    Y_lm = sqrt(2) P_lm(cos t) cos(m p)        m > 0
    Y_lm = sqrt(2) P_l|m|(cos t) sin(|m| p)    m < 0

with P_lm >= 0 near t = 0 and the integral of Y_lm^2 over the sphere equal to one, so that the mean
radius is c_00 / sqrt(4 pi). The flat index is k = l^2 + l + m.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from math import isqrt

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats

CONVENTION = (
    "Real spherical harmonics, orthonormal on the unit sphere, without the Condon-Shortley phase; "
    "flat index k = l^2 + l + m, m < 0 for sin(|m| phi), m > 0 for cos(m phi); theta from +z, phi from "
    "+x; mean radius = c_0 / sqrt(4 pi)."
)
"""One sentence for every file that holds coefficients."""


@dataclass(frozen=True, eq=False)
class ShCoefficients:
    """Coefficients c_lm up to degree l_max.

    Parameters
    ----------
    values
        Shape ((l_max + 1)^2,), index k = l^2 + l + m; in the unit of the radius.

    Raises
    ------
    InputError
        If a coefficient is not a finite number.
    ValueError
        If the length is not a square.
    """

    values: FloatArray

    def __post_init__(self) -> None:
        values = np.asarray(self.values, dtype=np.float64)
        if values.ndim != 1 or not len(values) or isqrt(len(values)) ** 2 != len(values):
            raise ValueError(f"values must have shape ((l_max + 1)^2,), got {values.shape}")
        broken = np.flatnonzero(~np.isfinite(values))
        if len(broken):
            degree, order = degrees(len(values))[broken[0]], orders(len(values))[broken[0]]
            raise InputError(
                f"{len(broken)} of {len(values)} coefficients are not finite numbers, the first at "
                f"l = {degree}, m = {order}."
            )
        object.__setattr__(self, "values", locked_floats(values, (None,), "values"))

    def __reduce__(self) -> tuple[Callable[..., "ShCoefficients"], tuple[ArrayLike]]:
        return ShCoefficients, (self.values,)

    def __len__(self) -> int:
        return len(self.values)

    @property
    def l_max(self) -> int:
        """Highest degree."""
        return isqrt(len(self.values)) - 1

    @property
    def mean_radius(self) -> float:
        """Mean of the radius over all directions, c_00 / sqrt(4 pi)."""
        return float(self.values[0] / np.sqrt(4 * np.pi))

    @cached_property
    def content(self) -> dict[tuple[int, int], float]:
        """Coefficients by (l, m)."""
        keys = zip(degrees(len(self)).tolist(), orders(len(self)).tolist(), strict=True)
        return dict(zip(keys, self.values.tolist(), strict=True))

    def truncated(self, l_max: int) -> "ShCoefficients":
        """The coefficients up to `l_max` (Eq. 4).

        Raises
        ------
        InputError
            If `l_max` is negative or above the degree of these coefficients.
        """
        if l_max == self.l_max:
            return self
        return ShCoefficients(self.values[: (checked_degree(l_max, self.l_max) + 1) ** 2])

    def padded(self, l_max: int) -> "ShCoefficients":
        """The same function with zeros up to `l_max`, which must not be lower than the present degree."""
        if l_max < self.l_max:
            raise ValueError(f"l_max must be at least {self.l_max}, got {l_max}")
        return ShCoefficients(np.pad(self.values, (0, (l_max + 1) ** 2 - len(self))))

    def scaled(self, factor: float) -> "ShCoefficients":
        """All radii times `factor`."""
        return ShCoefficients(self.values * factor)


def checked_degree(l_max: int, highest: int) -> int:
    """`l_max` itself, if it is a whole number from 0 to `highest`.

    Raises
    ------
    InputError
        If it is not.
    """
    if not isinstance(l_max, int | np.integer) or not 0 <= l_max <= highest:
        raise InputError(f"l_max must be a whole number from 0 to {highest}, got {l_max}.")
    return int(l_max)


@cache
def degrees(length: int) -> IntArray:
    """Degree l of each of `length` flat indices, shape (length,)."""
    found = np.array([isqrt(k) for k in range(length)], dtype=np.int64)
    found.flags.writeable = False
    return found


@cache
def orders(length: int) -> IntArray:
    """Order m of each of `length` flat indices, shape (length,)."""
    degree = degrees(length)
    found = np.arange(length) - degree**2 - degree
    found.flags.writeable = False
    return found


def to_pyshtools(coefficients: ShCoefficients) -> FloatArray:
    """Array of pyshtools, shape (2, l_max + 1, l_max + 1): cosine and sine terms, ortho, csphase 1."""
    length = len(coefficients)
    degree, order = degrees(length), orders(length)
    cilm = np.zeros((2, coefficients.l_max + 1, coefficients.l_max + 1))
    cilm[(order < 0).astype(np.int64), degree, np.abs(order)] = coefficients.values
    return cilm


def from_pyshtools(cilm: FloatArray) -> ShCoefficients:
    """From an array of pyshtools, shape (2, l_max + 1, l_max + 1), normalised `ortho`, csphase 1."""
    length = cilm.shape[1] ** 2
    degree, order = degrees(length), orders(length)
    return ShCoefficients(cilm[(order < 0).astype(np.int64), degree, np.abs(order)])
