"""Lets a process that lives for long hold less memory; changes no result."""

import ctypes
import sys
from contextlib import suppress
from functools import cache
from importlib import import_module
from typing import Any

_ARENA_MAX = -8
"""``M_ARENA_MAX`` of glibc's ``mallopt``."""


@cache
def share_one_heap() -> None:
    """No heap of its own for each thread: what one of them frees, the others could not use.

    Has its effect on threads that begin later. 35 to 50 MB less in the window with the shipped sample.
    """
    if sys.platform.startswith("linux"):
        with suppress(OSError, AttributeError):  # another C library
            ctypes.CDLL(None).mallopt(_ARENA_MAX, 1)


@cache
def pack_loaded_kernels() -> None:
    """Keep the intermediate code of kernels from the disk cache as the bytes that it was read from.

    Numba holds on to it unpacked, ten times as large, for kernels that are compiled later and call the loaded
    one; here it is unpacked once that happens. Where numba has changed inside, nothing is done. To be called
    before the first kernel is loaded; 45 to 65 MB less in the window with the shipped sample.
    """
    llvm: Any = import_module("llvmlite.binding")
    library: Any = getattr(import_module("numba.core.codegen"), "JITCodeLibrary", None)
    load = getattr(getattr(library, "_unserialize", None), "__func__", None)
    link = getattr(library, "_get_module_for_linking", None)
    if load is None or link is None:
        return

    def load_packed(cls: Any, codegen: Any, state: Any) -> Any:
        made = load(cls, codegen, state)
        _name, kind, data = state
        if kind == "object" and getattr(made, "_shared_module", None) is not None:
            made._packed_module, made._shared_module = data[1], None
        return made

    def link_unpacked(self: Any) -> Any:
        packed = self.__dict__.pop("_packed_module", None)
        if packed is not None:
            self._shared_module = llvm.parse_bitcode(packed)
        return link(self)

    library._unserialize = classmethod(load_packed)
    library._get_module_for_linking = link_unpacked
