"""The Fortran of pyshtools: loaded on first use, and never in two threads at once.

Its routines keep tables and FFT plans in saved variables, yet release the interpreter while they run: two
threads in them at once corrupt memory (one run in six of a loop over four threads was killed). Everything
that the program asks of pyshtools therefore goes through :func:`call`.

Only the wrapped Fortran is loaded, ``pyshtools.backends.shtools``. The package around it imports
matplotlib, pandas and xarray: a second and 90 MB in a command, many seconds in a window, where PySide
reads the source of every module that is imported.
"""

import sys
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from threading import RLock
from types import ModuleType
from typing import Any

_one_at_a_time = RLock()


def call(routine: str, *arguments: Any, **options: Any) -> Any:
    """What a routine of SHTOOLS returns, by its place in the package: ``call("expand.SHGLQ", 60)``."""
    with _one_at_a_time:
        return getattr(_routines(), routine.rpartition(".")[2])(*arguments, **options)


@cache
def _routines() -> ModuleType:
    """The module of the wrapped Fortran, under empty packages that are taken away again."""
    found = find_spec("pyshtools")
    if "pyshtools" in sys.modules or found is None or not found.submodule_search_locations:
        return import_module("pyshtools.backends.shtools")
    place = Path(found.submodule_search_locations[0])
    sys.modules["pyshtools"] = _package("pyshtools", place)
    sys.modules["pyshtools.backends"] = _package("pyshtools.backends", place / "backends")
    try:
        return import_module("pyshtools.backends.shtools")
    finally:
        for name in [name for name in sys.modules if name.split(".")[0] == "pyshtools"]:
            del sys.modules[name]


def _package(name: str, folder: Path) -> ModuleType:
    package = ModuleType(name)
    package.__path__ = [str(folder)]
    return package
