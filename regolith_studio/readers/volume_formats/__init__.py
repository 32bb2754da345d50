"""The volume formats: every module of this folder announces one as ``FORMAT``."""

from regolith_studio.readers.volume_format import VolumeFormat
from regolith_studio.registry import Registry

_FORMATS: Registry[VolumeFormat] = Registry(__name__, "FORMAT", "volume_readers")


def volume_formats() -> Registry[VolumeFormat]:
    """The formats by key, in the order of their modules' names; those of other packages last."""
    return _FORMATS


def volume_suffixes() -> frozenset[str]:
    """The suffixes of all volume formats, lower case, with the dot."""
    return frozenset(suffix for row in volume_formats().values() for suffix in row.suffixes)
