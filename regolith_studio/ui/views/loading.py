"""Loads pyvista without what comes along and draws nothing."""

import gc
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any

_PYPLOT, _AGG = "matplotlib.pyplot", "matplotlib.backends.backend_agg"


def load_pyvista() -> None:
    """Import pyvista as every module of the scene will do, but with less around it.

    pyvista imports mypy where it is installed, for a plug-in that only mypy itself asks for, and matplotlib's
    figures for charts. The first is left out; the second is loaded when somebody asks for something in it.
    """
    if "pyvista" in sys.modules:
        return
    with _in_place({"mypy": None, _PYPLOT: _Later(_PYPLOT), _AGG: _Later(_AGG, "FigureCanvasAgg")}):
        import pyvista.plotting  # noqa: F401
    gc.freeze()


class _Later(ModuleType):
    """Stands for a module until one of its attributes is asked for.

    Parameters
    ----------
    name
        Of the module.
    functions
        What is imported from it by name, to be called later.
    """

    def __init__(self, name: str, *functions: str) -> None:
        super().__init__(name)
        for each in functions:
            setattr(
                self, each, lambda *given, of=each, **more: getattr(import_module(name), of)(*given, **more)
            )

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(import_module(self.__name__), name)


@contextmanager
def _in_place(modules: Mapping[str, ModuleType | None]) -> Iterator[None]:
    """Put modules in the place of others, or none at all, where those have not been loaded before."""
    put = {name: module for name, module in modules.items() if name not in sys.modules}
    sys.modules.update(put)  # type: ignore[arg-type]  # None is how the import system says: not there
    try:
        yield
    finally:
        for name in put:
            del sys.modules[name]
