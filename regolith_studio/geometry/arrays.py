"""Array types, and the copy-and-lock that keeps value objects from changing."""

from dataclasses import dataclass, fields
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class LockedRecord:
    """A record of locked arrays; pickled by its constructor, as pickle forgets that an array is read-only."""

    def __reduce__(self) -> tuple[type[Self], tuple[Any, ...]]:
        return type(self), tuple(getattr(self, each.name) for each in fields(self) if each.init)


def locked_floats(values: ArrayLike, shape: tuple[int | None, ...], name: str) -> FloatArray:
    """`values` as float64 that nobody can change, copied unless they are that; ``None``: any length.

    Raises ValueError if the shape differs or a value is not finite.
    """
    array = _own(values, np.float64)
    _check_shape(array, shape, name)
    if not np.isfinite(array).all():
        raise ValueError(
            f"{name} must be finite, got {np.count_nonzero(~np.isfinite(array))} values that are not"
        )
    array.flags.writeable = False
    return array


def locked_integers(values: ArrayLike, shape: tuple[int | None, ...], name: str) -> IntArray:
    """`values` as int64 that nobody can change, copied unless they are that; ``None``: any length.

    Raises ValueError if the shape differs or a value is not a whole number.
    """
    given = np.asarray(values)
    array = _own(given, np.int64)
    _check_shape(array, shape, name)
    if array is not given and not np.array_equal(array, given):
        raise ValueError(f"{name} must be whole numbers")
    array.flags.writeable = False
    return array


def _own(values: ArrayLike, kind: type[np.float64] | type[np.int64]) -> NDArray[Any]:
    """A copy, unless nobody can change `values`: a locked array that owns its memory, as all of ours are."""
    if isinstance(values, np.ndarray) and values.dtype == kind:
        flags = values.flags
        if flags.owndata and flags.c_contiguous and not flags.writeable:
            return values
    return np.array(values, dtype=kind, order="C")  # kernels are compiled ahead for this order


def _check_shape(array: NDArray[Any], shape: tuple[int | None, ...], name: str) -> None:
    fits = array.ndim == len(shape) and all(
        want is None or have == want for have, want in zip(array.shape, shape, strict=True)
    )
    if not fits:
        wanted = "(" + ", ".join("n" if want is None else str(want) for want in shape) + ")"
        raise ValueError(f"{name} must have shape {wanted}, got {array.shape}")
