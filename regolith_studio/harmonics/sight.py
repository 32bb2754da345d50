"""How much of a particle its best star point cannot see, so that no radius function can keep it."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.harmonics.closed_surface import checked_solid
from regolith_studio.harmonics.star_point import STAR_POINT_RULES, hidden_volume
from regolith_studio.harmonics.visibility import hidden_surface_share

N_RAYS = 2000
"""For the share of the volume; it then differs by some 0.0005 from the share that a fit works out."""


@dataclass(frozen=True)
class Sight:
    """What is seen of a particle from inside.

    Parameters
    ----------
    star_point
        In the frame of the particle.
    rule
        Key of ``STAR_POINT_RULES`` that has found it.
    hidden_surface_share
        Share of the surface that is not visible from the star point; exactly 0 for star-shaped particles.
    unrepresentable_volume_share
        Share of the volume behind the first crossing of a ray.
    """

    star_point: tuple[float, float, float]
    rule: str
    hidden_surface_share: float
    unrepresentable_volume_share: float

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON; lengths in micrometres."""
        return {
            "hidden_surface_share": self.hidden_surface_share,
            "unrepresentable_volume_share": self.unrepresentable_volume_share,
            "star_point": list(self.star_point),
            "star_point_rule": self.rule,
        }


def sight(mesh: Mesh, rule: str | None = None) -> Sight:
    """What the star point of a closed mesh can see.

    Parameters
    ----------
    rule
        Key of ``STAR_POINT_RULES``. By itself the star point that fits begin with: the centre of mass, and
        where that lies outside, the point near by from which the least volume is hidden.

    Raises
    ------
    GeometryError
        If the mesh is open or inside out, or no star point is found inside.
    """
    solid = checked_solid(mesh)
    for name in ("centre_of_mass", "least_hidden_volume") if rule is None else (rule,):
        point = STAR_POINT_RULES[name](solid)
        volume = hidden_volume(solid, point, N_RAYS)
        if np.isfinite(volume):
            x, y, z = point.tolist()
            hidden = hidden_surface_share(solid, point)
            return Sight((x, y, z), name, hidden, max(volume, 0.0) if hidden else 0.0)
    raise GeometryError("No star point was found inside the particle.")
