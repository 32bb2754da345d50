"""Small functions that kernels call in their innermost loops.

A call between compiled functions costs about 25 ns for each array that it hands over; these are
copied into their callers instead. ``function.py_func`` is the pure-Python reference.
"""

from collections.abc import Callable
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])


def inlined(function: F) -> F:
    """Compile `function` into every kernel that calls it."""
    compiled = numba.njit(inline="always", nogil=True, error_model="numpy", fastmath=False)(function)
    return cast(F, compiled)
