"""The volume formats: every module of this folder announces one as ``FORMAT``."""

from functools import cache

from regolith_studio.readers.announced import announced
from regolith_studio.readers.volume_format import VolumeFormat


@cache
def volume_formats() -> dict[str, VolumeFormat]:
    """The formats by key, in the order of their modules' names."""
    return announced(__name__, __path__)


def volume_suffixes() -> frozenset[str]:
    """The suffixes of all volume formats, lower case, with the dot."""
    return frozenset(suffix for row in volume_formats().values() for suffix in row.suffixes)
