"""A measured particle: its mesh with what is known about where it came from."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from regolith_studio.geometry.mesh import Mesh

if TYPE_CHECKING:
    from regolith_studio.geometry.repair import Repair


@dataclass(frozen=True)
class Source:
    """Where a particle was read.

    Parameters
    ----------
    path
        File as the user named it, or ``sample:NAME`` for a shipped one.
    sha256
        Of the file's bytes, hexadecimal.
    unit
        Length unit that the file's numbers were taken in: ``um``, ``mm``, ``m``, ``voxel`` ...
    repaired
        Whether what was wrong with the mesh was mended as it was read.
    """

    path: str
    sha256: str
    unit: str
    repaired: bool = True


@dataclass(frozen=True)
class Particle:
    """One particle, ready to be measured.

    Parameters
    ----------
    name
        Unique within its sample; used in tables and file names.
    mesh
        Outward-oriented surface, in micrometres.
    group
        Sample, simulant or size fraction that it belongs to; may be empty.
    source
        Where it was read, or ``None`` for virtual particles.
    notes
        One sentence for each thing that was wrong with the input and each repair made.
    weight
        How many grains of its population it stands for: above 1 where larger grains were more often
        left out because the border of a scan cut them (Miles and Lantuejoul).
    repair
        What the mesh was like before it was mended and what was done; ``None`` if it was taken as it is.
    """

    name: str
    mesh: Mesh
    group: str = ""
    source: Source | None = None
    notes: tuple[str, ...] = field(default=())
    weight: float = 1.0
    repair: "Repair | None" = field(default=None, compare=False, repr=False)
