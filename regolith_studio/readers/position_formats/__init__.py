"""The formats of particle positions: every module of this folder announces one as ``FORMAT``."""

from regolith_studio.readers.position_format import PositionFormat
from regolith_studio.registry import Registry

_FORMATS: Registry[PositionFormat] = Registry(__name__, "FORMAT", "position_readers")


def position_formats() -> Registry[PositionFormat]:
    """The formats by key, in the order of their modules' names; those of other packages last."""
    return _FORMATS


def position_suffixes() -> frozenset[str]:
    """The suffixes of all position formats, lower case, with the dot."""
    return frozenset(suffix for row in position_formats().values() for suffix in row.suffixes)
