"""Degrees above those of a hull field: power by a particle's features, with random phases.

Size, form, roughness and hull ratio of a particle tell most of the power of its higher degrees: ln P_l is
linear in the features, and what is left is a normal law over the degrees, correlated.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, locked_floats
from regolith_studio.shape_models.shape_features import MIN_POWER, log_shape_features, powers, with_powers

RIDGE = 0.1
"""Of the regression, as a share of the number of particles, on standardised features."""


@dataclass(frozen=True, eq=False)
class FineDegrees:
    """ln P_l of the degrees above the hull field's: offset + slopes features + factor normal numbers.

    Parameters
    ----------
    offset
        Shape (m,), one for each degree.
    slopes
        Shape (m, d).
    factor
        Lower triangular, of the covariance that is left, shape (m, m).

    Raises
    ------
    InputError
        If a number is not finite.
    """

    offset: FloatArray
    slopes: FloatArray
    factor: FloatArray

    def __post_init__(self) -> None:
        m = len(self.offset)
        for name, shape in (("offset", (m,)), ("slopes", (m, None)), ("factor", (m, m))):
            values = locked_floats(getattr(self, name), shape, name)
            if not np.isfinite(values).all():
                raise InputError(f"The {name} of the fine degrees must be finite.")
            object.__setattr__(self, name, values)

    def __reduce__(self) -> tuple[Callable[..., "FineDegrees"], tuple[Any, ...]]:
        return FineDegrees, (self.offset, self.slopes, self.factor)

    def __len__(self) -> int:
        return len(self.offset)

    @classmethod
    def of(cls, rows: FloatArray, equivalent_radii: FloatArray, base: int) -> "FineDegrees":
        """From expansions of ln r of measured particles, shape (n, (l_max + 1)^2), above degree `base`."""
        table = log_shape_features(rows[:, : (base + 1) ** 2], equivalent_radii)
        fine = np.log(np.maximum(powers(rows)[:, base + 1 :], MIN_POWER))
        middle, spread = table.mean(axis=0), np.maximum(table.std(axis=0), 1e-9)
        standard = (table - middle) / spread
        normal = standard.T @ standard + RIDGE * len(table) * np.eye(table.shape[1])
        slopes = np.linalg.solve(normal, standard.T @ (fine - fine.mean(axis=0))).T / spread
        left = fine - table @ slopes.T
        covariance = np.cov(left.T).reshape(2 * [fine.shape[1]]) + 1e-9 * np.eye(fine.shape[1])
        return cls(left.mean(axis=0), slopes, np.asarray(np.linalg.cholesky(covariance), dtype=np.float64))

    def first(self, count: int) -> "FineDegrees":
        """The lowest `count` of the degrees, at least one."""
        return FineDegrees(self.offset[:count], self.slopes[:count], self.factor[:count, :count])

    def louder(self, change: float) -> "FineDegrees":
        """The same with ln P_l larger by `change` at all degrees."""
        return replace(self, offset=np.asarray(self.offset) + change)

    def added(self, rows: FloatArray, equivalent_radii: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Expansions of ln r of the lower degrees (n, k) with the higher ones."""
        n, base = len(rows), round(rows.shape[1] ** 0.5) - 1
        normal = rng.standard_normal((n, len(self)))
        wanted = log_shape_features(rows, equivalent_radii) @ self.slopes.T + normal @ self.factor.T
        field = rng.standard_normal((n, (base + len(self) + 1) ** 2))
        field[:, : rows.shape[1]] = rows
        power = np.hstack([powers(rows), np.exp(wanted + self.offset)])
        return with_powers(field, power)

    def stored(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {name: getattr(self, name).tolist() for name in self.__dataclass_fields__}

    @classmethod
    def restored(cls, values: Mapping[str, Any]) -> "FineDegrees":
        """From its stored values."""
        return cls(*(np.array(values[name], dtype=np.float64) for name in cls.__dataclass_fields__))
