"""Decorators that compile numerical functions with numba, and the folder on disk where machine code is kept.

A kernel is a plain function of arrays and numbers. It is compiled when it is first called with arguments of
certain types, and it runs without the interpreter lock. ``kernel.py_func`` is the same function as pure
Python, which the tests compare it with.

Machine code contains a copy of the kernels that a function calls, also of those in other files, while numba
compares the date of the function's own file only. Code is therefore cached in a folder named after a hash of
the sources of all kernels that the function may call: no edit and no update leaves old code behind. Their
places and dates are in the hash too, since numba takes no code of another checkout or date: what a folder
says is compiled is so for this checkout.

Code that cannot be read is compiled again. Where the cache cannot be written, code is kept in a temporary
folder of the user's, or not at all. Each says so in one line.
"""

import hashlib
import logging
import multiprocessing
import os
import shutil
import stat
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache, lru_cache, wraps
from pathlib import Path
from threading import get_ident
from typing import Any, TypeVar, cast

import numba
from numba.core.caching import FunctionCache
from numba.core.registry import CPUDispatcher
from platformdirs import user_cache_path

F = TypeVar("F", bound=Callable[..., object])
T = TypeVar("T")

UNUSED_DAYS = 60
"""Folders of machine code that no process has used for so long are deleted."""

# Divisions by zero give infinity: a test for each would keep loops from being vectorised. No fastmath: it
# adds up in another order on each kind of processor. Nothing calls kernels as functions of C, for which each
# would be compiled once more.
_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": False}
_OPTIONS |= {"no_cfunc_wrapper": True}
_NO_COUNTING: dict[str, Any] = {"_nrt": False}
# An option of numba without documentation. Each use of an array of a named tuple otherwise counts references
# up and down: atomic operations that cost more than the arithmetic around them.
_CONFIG: Any = numba.config
_FUNCTION_CACHE: Any = FunctionCache  # numba has no types
_PACKAGE = Path(__file__).resolve().parents[1]
_CODE = "*-" + "[0-9a-f]" * 16  # folders of machine code; NUMBA_CACHE_DIR may hold those of other programs
# The first begins the mark of `kernel_noalloc`, too.
_MARKS = (b"@kernel", b"@inner_kernel")


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


def inner_kernel(function: F) -> F:
    """Compile a function that only kernels call, and that allocates no memory.

    Numba makes no entry for Python, which takes a tenth of the time of compilation: a named tuple of arrays
    is taken apart there, array by array. Python that calls such a kernel runs the function as it is written.
    """
    compiled: Any = _compiled(function, _NO_COUNTING | {"no_cpython_wrapper": True})
    compiled.__class__ = _InnerKernel
    return cast(F, compiled)


class _InnerKernel(CPUDispatcher):
    """Numba's dispatcher of a kernel without an entry: to jump there would end the interpreter."""

    def __call__(self, *arguments: Any) -> Any:
        return self.py_func(*arguments)


def kept_in_thread(make: Callable[[int], T]) -> Callable[[int], T]:
    """Make the scratch memory of a kernel once for each size, in each thread; every call overwrites it."""

    @lru_cache(maxsize=256)
    def of_thread(size: int, _thread: int) -> T:
        return make(size)

    @wraps(make)
    def scratch(size: int) -> T:
        return of_thread(size, get_ident())

    return scratch


class _KernelCache(_FUNCTION_CACHE):  # type: ignore[misc]
    """Numba's cache of one function, whose faults cost time and nothing else."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # noqa: BLE001  a damaged file may raise any
            _report(f"Compiled code in {self.cache_path} is damaged; it is made again.")
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except Exception as error:  # noqa: BLE001  numba reads its index first
            _report(f"Compiled code cannot be kept in {self.cache_path} ({error}); it is compiled each time.")


@cache
def _report(sentence: str) -> None:
    """Write a line to stderr, once."""
    logging.getLogger(__name__).warning(sentence)


def machine_code_folder(part: str) -> Path | None:
    """Folder for the machine code of a part of the program (``coarsening``); ``None`` where there is none."""
    return _cache_folder(_PACKAGE / part)


def _compiled(function: F, options: dict[str, Any]) -> F:
    folder = _cache_folder(_package_of(Path(function.__code__.co_filename)))
    compiled = numba.njit(**_OPTIONS, **options)(function)
    if folder is None:
        return cast(F, compiled)
    before = _CONFIG.CACHE_DIR
    try:
        _CONFIG.CACHE_DIR = str(folder)
        compiled._cache = _KernelCache(function)  # private to numba, whose own cache raises what it meets
    finally:
        _CONFIG.CACHE_DIR = before
    return cast(F, compiled)


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
    base = _cache_base()
    if base is None:
        return None
    folder = base / f"{parts[-1].name}-{digest.hexdigest()[:16]}"
    try:
        _delete_unused(folder)
        folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)  # used now
    except OSError:
        return None
    return folder


def compiled_code() -> list[Path]:
    """Folders of machine code of all versions."""
    return [found for folder in cache_folders() for found in sorted(folder.glob(_CODE))]


def cache_folders() -> tuple[Path, Path]:
    """Folder for machine code, and the temporary one that takes its place where it cannot be written."""
    user = os.getuid() if hasattr(os, "getuid") else "kernels"
    wanted = Path(_CONFIG.CACHE_DIR or user_cache_path("regolith-studio", appauthor=False) / "kernels")
    try:
        temporary = tempfile.gettempdir()
    except FileNotFoundError:  # nothing can be written, as in the process that reads untrusted files
        return wanted, wanted
    return wanted, Path(temporary, f"regolith-studio-{user}")


@cache
def _cache_base() -> Path | None:
    """Folder that can be written for the machine code of all kernels; ``None`` if there is none.

    Other processes that this one starts use the same.
    """
    wanted, mine = cache_folders()
    if _is_writable(wanted):
        return wanted
    if _is_private(mine) and _is_writable(mine):
        _report(f"The folder {wanted} cannot be written; compiled code is kept in {mine}.")
        os.environ["NUMBA_CACHE_DIR"] = str(mine)
        return mine
    if multiprocessing.parent_process() is None:
        _report(f"The folder {wanted} cannot be written; code is compiled each time.")
    return None


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"1")
    except OSError:
        return False
    return True


def _is_private(folder: Path) -> bool:
    """Whether a folder is the user's and nobody else's; machine code of others is not run."""
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return False
    mine = not hasattr(os, "getuid") or (found.st_uid == os.getuid() and not found.st_mode & 0o077)
    return stat.S_ISDIR(found.st_mode) and mine


def _delete_unused(new: Path) -> None:
    """Delete code of other versions that no process has used for long, when a folder is made."""
    if new.exists() or not new.parent.is_dir():
        return
    limit = time.time() - UNUSED_DAYS * 86_400
    for folder in new.parent.glob(_CODE):
        with suppress(OSError):  # another process may have deleted it
            if folder.stat().st_mtime < limit:
                shutil.rmtree(folder, ignore_errors=True)


@cache
def kernel_sources(folder: Path) -> str:
    """SHA-256 of the files in a folder that contain kernels, with their places and dates, as hexadecimal."""
    digest = hashlib.sha256(os.fsencode(folder))
    for path in sorted(folder.rglob("*.py")):
        source = path.read_bytes()
        if any(mark in source for mark in _MARKS):
            name = f"{path.relative_to(folder).as_posix()}\0{path.stat().st_mtime_ns}\0"
            digest.update(name.encode() + source + b"\0")
    return digest.hexdigest()
