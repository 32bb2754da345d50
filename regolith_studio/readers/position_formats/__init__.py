"""The formats of particle positions: every module of this folder announces one as ``FORMAT``."""

import importlib
import pkgutil
from functools import cache

from regolith_studio.readers.position_format import PositionFormat


@cache
def position_formats() -> dict[str, PositionFormat]:
    """The formats by key, in the order of their modules' names."""
    modules = sorted(module.name for module in pkgutil.iter_modules(__path__))
    rows = [importlib.import_module(f"{__name__}.{name}").FORMAT for name in modules]
    return {row.key: row for row in rows}


def position_suffixes() -> frozenset[str]:
    """The suffixes of all position formats, lower case, with the dot."""
    return frozenset(suffix for row in position_formats().values() for suffix in row.suffixes)
