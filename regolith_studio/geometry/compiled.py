"""One door to numba: how every kernel of the program is compiled and cached.

A kernel is a plain function of arrays and numbers. It is compiled at its first call for its
argument types, the machine code is cached on disk, and it runs without the interpreter lock.
``kernel.py_func`` is the pure-Python reference that the tests compare it with.

Machine code holds a copy of the kernels that the function calls, also of those in other files. Numba by
itself looks only at the date of the function's own file; here what is cached is also marked with the sources
of all kernels that it could call, so that no edit and no update leaves old code behind.
"""

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

from regolith_studio.geometry.quiet_results import return_quietly

F = TypeVar("F", bound=Callable[..., object])

OPTIONS: Any = {"cache": True, "nogil": True, "error_model": "numpy", "fastmath": False}

_PACKAGE = Path(__file__).resolve().parents[1]
_MARKS = (b"@kernel", b"@leaf", b"@inlined", b"lower_builtin", b"_boxers")

return_quietly()


def kernel(function: F) -> F:
    """Compile `function` with numba: cached on disk, no interpreter lock, IEEE arithmetic."""
    compiled = numba.njit(**OPTIONS)(function)
    _mark_cache(compiled, Path(function.__code__.co_filename))
    return cast(F, compiled)


def leaf(function: F) -> F:
    """Compile a function that allocates no memory, as :func:`kernel` does, but without counting references.

    Every look at an array of a named tuple counts references up and down, each an atomic operation that
    costs more than the arithmetic around it. Numba refuses to compile a leaf that allocates; it may call
    other leaves only.
    """
    options: Any = {**OPTIONS, "_nrt": False}
    compiled = numba.njit(**options)(function)
    _mark_cache(compiled, Path(function.__code__.co_filename))
    return cast(F, compiled)


def _mark_cache(compiled: Any, path: Path) -> None:
    """Let the cached code be valid only for these sources of kernels.

    Numba has no public way to add to its stamp; where the attribute is not found its own is left.
    """
    index: Any = getattr(getattr(compiled, "_cache", None), "_cache_file", None)
    if hasattr(index, "_source_stamp"):
        index._source_stamp = (index._source_stamp, *(kernel_sources(folder) for folder in _reach(path)))


def _reach(path: Path) -> tuple[Path, ...]:
    """Folders with kernels that one in `path` may call: its own part of the program, and geometry."""
    folders = [_PACKAGE / "geometry"]
    if path.is_relative_to(_PACKAGE):
        own = _PACKAGE / path.relative_to(_PACKAGE).parts[0]
        folders += [own] if own.is_dir() and own not in folders else []
    return tuple(folders)


@cache
def kernel_sources(folder: Path) -> str:
    """SHA-256 of the files in a folder that hold kernels, as hexadecimal digits."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*.py")):
        source = path.read_bytes()
        if any(mark in source for mark in _MARKS):
            digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + source + b"\0")
    return digest.hexdigest()
