"""The mesh formats: every module of this folder announces one as ``FORMAT``."""

from regolith_studio.readers.mesh_format import MeshFormat
from regolith_studio.registry import Registry

_FORMATS: Registry[MeshFormat] = Registry(__name__, "FORMAT", "readers")


def mesh_formats() -> Registry[MeshFormat]:
    """The formats by key, in the order of their modules' names; those of other packages last."""
    return _FORMATS


def mesh_suffixes() -> frozenset[str]:
    """The suffixes of all mesh formats, lower case, with the dot."""
    return frozenset(suffix for row in mesh_formats().values() for suffix in row.suffixes)
