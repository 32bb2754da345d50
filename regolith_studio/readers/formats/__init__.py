"""The mesh formats: every module of this folder announces one as ``FORMAT``."""

from functools import cache

from regolith_studio.readers.announced import announced
from regolith_studio.readers.mesh_format import MeshFormat


@cache
def mesh_formats() -> dict[str, MeshFormat]:
    """The formats by key, in the order of their modules' names."""
    return announced(__name__, __path__)


def mesh_suffixes() -> frozenset[str]:
    """The suffixes of all mesh formats, lower case, with the dot."""
    return frozenset(suffix for row in mesh_formats().values() for suffix in row.suffixes)
