"""The volume formats: every module of this folder announces one as ``FORMAT``."""

import importlib
import pkgutil
from functools import cache

from regolith_studio.readers.volume_format import VolumeFormat


@cache
def volume_formats() -> dict[str, VolumeFormat]:
    """The formats by key, in the order of their modules' names."""
    modules = sorted(module.name for module in pkgutil.iter_modules(__path__))
    rows = [importlib.import_module(f"{__name__}.{name}").FORMAT for name in modules]
    return {row.key: row for row in rows}


def volume_suffixes() -> frozenset[str]:
    """The suffixes of all volume formats, lower case, with the dot."""
    return frozenset(suffix for row in volume_formats().values() for suffix in row.suffixes)
