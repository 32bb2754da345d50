"""Loads pyvista without what comes along and draws nothing."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

_TYPE_CHECKER = "mypy"


def load_pyvista() -> None:
    """Import pyvista as every module of the scene will do, but without mypy where that is installed.

    pyvista would import it for a plug-in that only mypy itself asks for: 16 MB in the window.
    """
    if "pyvista" not in sys.modules:
        with _hidden(_TYPE_CHECKER):
            import pyvista.plotting  # noqa: F401


@contextmanager
def _hidden(name: str) -> Iterator[None]:
    """Let a module seem not to be installed, unless it is loaded already."""
    if name in sys.modules:
        yield
        return
    sys.modules[name] = None  # type: ignore[assignment]  # what the import system asks for
    try:
        yield
    finally:
        del sys.modules[name]
