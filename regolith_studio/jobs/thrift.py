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


def give_back() -> None:
    """Return memory that is free, but lies between pieces that are not, to the system; about 10 ms."""
    if sys.platform.startswith("linux"):
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).malloc_trim(0)


@cache
def pack_loaded_kernels() -> None:
    """Keep the intermediate code of kernels from the disk cache as the bytes that it was read from.

    Numba holds on to it unpacked, ten times as large, for kernels that are compiled later and call the loaded
    one; here it is unpacked once that happens. The symbols that it defines are read in a context of its own,
    as the common one would keep types and constants of all that it has ever seen. Where numba has changed
    inside, nothing is done. To be called before the first kernel is loaded.
    """
    llvm: Any = import_module("llvmlite.binding")
    codegen: Any = import_module("numba.core.codegen")
    library: Any = getattr(codegen, "JITCodeLibrary", None)
    load = getattr(getattr(library, "_unserialize", None), "__func__", None)
    link = getattr(library, "_get_module_for_linking", None)
    if load is None or link is None or not hasattr(codegen.JitEngine, "_load_defined_symbols"):
        return
    nothing = llvm.parse_assembly("").as_bitcode()

    def load_packed(cls: Any, owner: Any, state: Any) -> Any:
        name, kind, data = state
        if kind != "object":
            return load(cls, owner, state)
        made = load(cls, owner, (name, kind, (data[0], nothing)))
        owner._engine._load_defined_symbols(llvm.parse_bitcode(data[1], llvm.create_context()))
        made._packed_module, made._shared_module = data[1], None
        return made

    def link_unpacked(self: Any) -> Any:
        packed = self.__dict__.pop("_packed_module", None)
        if packed is not None:
            self._shared_module = llvm.parse_bitcode(packed)
        return link(self)

    library._unserialize = classmethod(load_packed)
    library._get_module_for_linking = link_unpacked


@cache
def load_runtime_of_kernels() -> None:
    """Take the few functions that count references for kernels from the disk cache, not from the compiler.

    Numba compiles them in each process when the first kernel is loaded, which brings the optimiser and the
    code generator into memory for nothing else: 20 MB. They are kept beside the kernels, for this processor
    and version. Where numba has changed inside, nothing is done. To be called before the first kernel.
    """
    caching: Any = import_module("numba.core.caching")
    runtime: Any = import_module("numba.core.runtime.nrtdynmod")
    inside = hasattr(caching, "make_library_cache") and hasattr(caching.Cache, "_load_overload")
    if not (inside and hasattr(runtime, "create_nrt_module") and hasattr(runtime, "compile_nrt_functions")):
        return
    kept = caching.make_library_cache("runtime.")(_compiled_runtime)

    def load_or_compile(context: Any) -> Any:
        library = kept._load_overload((), context)
        if library is None:
            library = _compiled_runtime(context)
            kept.save_overload((), library)
        return library

    runtime.compile_nrt_functions = load_or_compile


def _compiled_runtime(context: Any) -> Any:
    """What numba does itself, with the code kept so that it can be saved."""
    module, library = import_module("numba.core.runtime.nrtdynmod").create_nrt_module(context)
    library.enable_object_caching()
    library.add_ir_module(module)
    library.finalize()
    return library
