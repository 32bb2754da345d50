"""Every untrusted file on its way in: parsed in one guarded child process, refused in one sentence."""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from regolith_studio.readers.coefficient_tables import read_coefficients
    from regolith_studio.readers.positions import read_positions
    from regolith_studio.readers.registry import read_mesh, read_particles
    from regolith_studio.readers.sample import sample_particles
    from regolith_studio.readers.volumes import describe_volume, open_slabs, read_volume, volume_files

__all__ = [
    "describe_volume",
    "open_slabs",
    "read_coefficients",
    "read_mesh",
    "read_particles",
    "read_positions",
    "read_volume",
    "sample_particles",
    "volume_files",
]

_HOMES = {
    "coefficient_tables": ("read_coefficients",),
    "positions": ("read_positions",),
    "registry": ("read_mesh", "read_particles"),
    "sample": ("sample_particles",),
    "volumes": ("describe_volume", "open_slabs", "read_volume", "volume_files"),
}


def __getattr__(name: str) -> Any:
    """Import the public functions at their first use: the child process needs none of them."""
    for home, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(f"{__name__}.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
