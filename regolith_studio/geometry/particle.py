"""A measured particle: its mesh with what is known about where it came from."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import locate_defects

if TYPE_CHECKING:
    from regolith_studio.geometry.repair import Repair

Solid = TypeVar("Solid")


@dataclass(frozen=True)
class Source:
    """Where a particle was read.

    - ``path``: file as the user named it, or ``sample:NAME`` for a shipped one.
    - ``sha256``: of the file's bytes, hexadecimal.
    - ``unit``: length unit that the file's numbers were taken in: ``um``, ``mm``, ``m``, ``voxel`` ...
    - ``repaired``: whether the mesh was repaired as it was read.
    - ``l_max``: degree above which the coefficients of a table were to be left out; ``None`` where all were
      taken.
    """

    path: str
    sha256: str
    unit: str
    repaired: bool = True
    l_max: int | None = None


@dataclass(frozen=True)
class ScanOfGrain:
    """What the errors of a grain depend on besides its form.

    - ``across``: diameter in voxels of the ball of its volume; beyond the ends of the table those hold.
    - ``noise``: as a share of the contrast.
    - ``follows_grey``: whether the surface follows the grey values, or is the mask's scaled to their volume.
    """

    across: float
    noise: float
    follows_grey: bool


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
        How many grains of its population it represents: above 1 where larger grains were more often
        left out because the border of a scan cut them (Miles and Lantuejoul).
    repair
        Health before and after the repair, and what was done; ``None`` if the mesh was not repaired.
    scan
        Of a grain whose surface was made from grey values: what the errors of its descriptors depend on.
    """

    name: str
    mesh: Mesh
    group: str = ""
    source: Source | None = None
    notes: tuple[str, ...] = field(default=())
    weight: float = 1.0
    repair: "Repair | None" = field(default=None, compare=False, repr=False)
    scan: ScanOfGrain | None = None

    @property
    def is_synthetic(self) -> bool:
        """Whether it is a shipped one, which no scan has measured."""
        return self.source is not None and self.source.path.startswith("sample:")


def solid_of(particle: Particle | Solid) -> Mesh | Solid:
    """The mesh of a particle; a mesh or another solid as it is."""
    return particle.mesh if isinstance(particle, Particle) else particle


def defect_triangles(particle: Particle) -> dict[str, FloatArray]:
    """Corners (k, 3, 3) of the triangles at each kind of defect of the mesh as it was read.

    The keys are those of :func:`~regolith_studio.geometry.mesh_health.locate_defects`, and ``filled`` for
    the triangles that close holes.
    """
    done = particle.repair
    given = particle.mesh if done is None or done.given is None else done.given
    corners = {kind: given.triangles[at] for kind, at in locate_defects(given).items()}
    if done is not None and done.filling_faces:
        corners["filled"] = done.mesh.triangles[-done.filling_faces :]
    return corners
