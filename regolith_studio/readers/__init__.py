"""Every untrusted file on its way in: parsed in one guarded child process, refused in one sentence."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from regolith_studio.readers.registry import read_mesh, read_particles
    from regolith_studio.readers.sample import sample_particles

__all__ = ["read_mesh", "read_particles", "sample_particles"]


def __getattr__(name: str) -> Any:
    """Import the public functions at their first use: the child process needs none of them."""
    if name in ("read_mesh", "read_particles"):
        from regolith_studio.readers import registry

        return getattr(registry, name)
    if name == "sample_particles":
        from regolith_studio.readers.sample import sample_particles

        return sample_particles
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
