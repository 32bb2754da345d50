"""One door to numba: how every kernel of the program is compiled and cached.

A kernel is a plain function of arrays and numbers. It is compiled at its first call for its
argument types, the machine code is cached on disk, and it runs without the interpreter lock.
``kernel.py_func`` is the pure-Python reference that the tests compare it with.
"""

from collections.abc import Callable
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])


def kernel(function: F) -> F:
    """Compile `function` with numba: cached on disk, no interpreter lock, IEEE arithmetic."""
    compiled = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath=False)(function)
    return cast(F, compiled)
