"""Decorators that compile numerical functions with numba, and the folder on disk where machine code is kept.

A kernel is a plain function of arrays and numbers. It is compiled when it is first called with arguments of
certain types, and it runs without the interpreter lock. ``kernel.py_func`` is the same function as pure
Python, which the tests compare it with.

Machine code contains a copy of the kernels that a function calls, also of those in other files, while numba
compares the date of the function's own file only. Code is therefore cached in a folder named after a hash of
the sources of all kernels that the function may call: no edit and no update leaves old code behind.
"""

import hashlib
import os
import shutil
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from platformdirs import user_cache_path

F = TypeVar("F", bound=Callable[..., object])

UNUSED_DAYS = 60
"""Folders of machine code that no process has used for so long are deleted."""

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": False}
_NO_COUNTING: dict[str, Any] = {"_nrt": False}
# An option of numba without documentation. Each use of an array of a named tuple otherwise counts references
# up and down: atomic operations that cost more than the arithmetic around them.
_CONFIG: Any = numba.config
_PACKAGE = Path(__file__).resolve().parents[1]
_MARKS = (b"@kernel", b"@inline_kernel")


def kernel(function: F) -> F:
    """Compile `function` with numba: cached on disk, no interpreter lock, IEEE arithmetic.

    A kernel that Python calls returns a number or a tuple of numbers, and fills arrays that it is given.
    Numba makes the arrays and named tuples that a kernel returns by running Python, and does not look whether
    that succeeded: where Ctrl+C raises its exception there, the interpreter ends with a segmentation fault.
    """
    return _compiled(function, {})


def kernel_noalloc(function: F) -> F:
    """Compile a function that allocates no memory, as :func:`kernel` does, but without counting references.

    Numba refuses to compile it if it allocates; it may call other such kernels only.
    """
    return _compiled(function, _NO_COUNTING)


def inline_kernel(function: F) -> F:
    """Compile a small function of innermost loops: only kernels call it, and LLVM inlines it there."""
    return cast(F, numba.njit(**_OPTIONS, **_NO_COUNTING)(function))


def _compiled(function: F, options: dict[str, Any]) -> F:
    folder = _cache_folder(_package_of(Path(function.__code__.co_filename)))
    before = _CONFIG.CACHE_DIR
    try:
        _CONFIG.CACHE_DIR = str(folder or "")
        decorate = numba.njit(cache=folder is not None, **_OPTIONS, **options)
        return cast(F, decorate(function))
    finally:
        _CONFIG.CACHE_DIR = before


def _package_of(path: Path) -> Path | None:
    """Folder below the package that a source file belongs to; ``None`` for a file outside of the package."""
    if not path.is_relative_to(_PACKAGE):
        return None
    folder = _PACKAGE / path.relative_to(_PACKAGE).parts[0]
    return folder if folder.is_dir() else None


@cache
def _cache_folder(package: Path | None) -> Path | None:
    """Folder for the machine code of kernels in `package`; ``None`` where nothing can be written.

    They may call kernels of their own part of the program and of `geometry`. The folder lies below
    ``NUMBA_CACHE_DIR`` where that is set, else below the user's cache folder.
    """
    parts = [_PACKAGE / "geometry"]
    if package is not None and package not in parts:
        parts.append(package)
    digest = hashlib.sha256(numba.__version__.encode())
    for part in parts:
        digest.update(kernel_sources(part).encode())
    base = _CONFIG.CACHE_DIR or user_cache_path("regolith-studio", appauthor=False) / "kernels"
    folder = Path(base) / f"{parts[-1].name}-{digest.hexdigest()[:16]}"
    try:
        _delete_unused(folder)
        folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)  # used now
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def _delete_unused(new: Path) -> None:
    """Delete code of other versions that no process has used for long, when a folder is made."""
    if new.exists() or not new.parent.is_dir():
        return
    limit = time.time() - UNUSED_DAYS * 86_400
    for folder in new.parent.glob("*-" + "[0-9a-f]" * 16):
        with suppress(OSError):  # another process may have deleted it
            if folder.stat().st_mtime < limit:
                shutil.rmtree(folder, ignore_errors=True)


@cache
def kernel_sources(folder: Path) -> str:
    """SHA-256 of the files in a folder that contain kernels, as hexadecimal digits."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*.py")):
        source = path.read_bytes()
        if any(mark in source for mark in _MARKS):
            digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + source + b"\0")
    return digest.hexdigest()
