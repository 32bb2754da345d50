"""The formats of particle positions: every module of this folder announces one as ``FORMAT``."""

from functools import cache

from regolith_studio.readers.announced import announced
from regolith_studio.readers.position_format import PositionFormat


@cache
def position_formats() -> dict[str, PositionFormat]:
    """The formats by key, in the order of their modules' names."""
    return announced(__name__, __path__)


def position_suffixes() -> frozenset[str]:
    """The suffixes of all position formats, lower case, with the dot."""
    return frozenset(suffix for row in position_formats().values() for suffix in row.suffixes)
