"""Tables that fill themselves: every module of a folder announces one row as ``FORMAT``."""

import importlib
import pkgutil
from collections.abc import Iterable
from typing import Any


def announced(package: str, path: Iterable[str]) -> dict[str, Any]:
    """The rows of a package's modules by their keys, in the order of the modules' names.

    Parameters
    ----------
    package, path
        Its ``__name__`` and ``__path__``.
    """
    modules = sorted(module.name for module in pkgutil.iter_modules(path))
    rows = [importlib.import_module(f"{package}.{name}").FORMAT for name in modules]
    return {row.key: row for row in rows}
