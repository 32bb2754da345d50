"""The part of a particle that is hidden from its star point and that no radius function can represent."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.harmonics.radius_function import require_solid
from regolith_studio.harmonics.star_point import STAR_POINT_RULES, hidden_volume

N_PROBES = 8000
"""Faces that are tested for the share of a large mesh."""
_TOLERANCE = 1e-7
N_RAYS = 2000
"""Rays for the share of the volume, which then differs by about 0.0005 from that of a fit."""


def faces_away(mesh: Mesh, star_point: FloatArray) -> BoolArray:
    """Faces whose inner side does not face the star point, shape (m,).

    A closed mesh without any is star-shaped about the point.
    """
    spokes = mesh.triangles[:, 0] - star_point
    facing = np.einsum("ij,ij->i", mesh.face_area_vectors, spokes)
    size = float(np.ptp(mesh.bounds, axis=0).max())
    return np.asarray(facing < -1e-12 * size * mesh.face_areas)


def hidden_faces(mesh: Mesh, star_point: FloatArray, faces: IntArray | None = None) -> BoolArray:
    """Whether the middle of each face is hidden from the star point by another part of the surface.

    Parameters
    ----------
    faces
        Indices of the faces to test, shape (k,); all if ``None``. The result has their length.
    """
    chosen = np.arange(len(mesh.faces)) if faces is None else faces
    spokes = mesh.triangles[chosen].mean(axis=1) - star_point
    distance = np.linalg.norm(spokes, axis=1)
    apart = distance > 0
    directions = np.divide(spokes, distance[:, None], out=np.zeros_like(spokes), where=apart[:, None])
    directions[~apart] = (0.0, 0.0, 1.0)
    hits = radial_hits(mesh, star_point, directions)
    in_front = hits.distance < distance[hits.ray] * (1 - _TOLERANCE)
    other = hits.face != chosen[hits.ray]
    hidden = np.zeros(len(chosen), dtype=np.bool_)
    hidden[hits.ray[in_front & other]] = True
    return hidden


def hidden_surface_share(mesh: Mesh, star_point: FloatArray) -> float:
    """Share of the surface area that is hidden from the star point; exactly 0 for star-shaped meshes.

    Of larger meshes :data:`N_PROBES` faces are tested, evenly spread over the area.
    """
    if not faces_away(mesh, star_point).any():
        return 0.0
    if len(mesh.faces) <= N_PROBES:
        hidden = hidden_faces(mesh, star_point)
        return float(mesh.face_areas[hidden].sum() / mesh.surface_area)
    steps = (np.arange(N_PROBES) + 0.5) / N_PROBES * mesh.surface_area
    picks = np.minimum(np.searchsorted(np.cumsum(mesh.face_areas), steps), len(mesh.faces) - 1)
    return float(hidden_faces(mesh, star_point, picks.astype(np.int64)).mean())


@dataclass(frozen=True)
class StarPointVisibility:
    """Share of a particle that is visible from its star point.

    Parameters
    ----------
    star_point
        In the frame of the particle.
    rule
        Key of ``STAR_POINT_RULES`` by which the point was found.
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


def star_point_visibility(mesh: Mesh) -> StarPointVisibility:
    """Visibility of a closed mesh from its star point.

    As for fits this is the centre of mass, and where that lies outside the particle, the nearby point that
    hides the least volume.

    Raises
    ------
    GeometryError
        If the mesh is open or inside out, or no star point is found inside.
    """
    solid = require_solid(mesh)
    for name in ("centre_of_mass", "least_hidden_volume"):
        point = STAR_POINT_RULES[name](solid)
        volume = hidden_volume(solid, point, N_RAYS)
        if np.isfinite(volume):
            x, y, z = point.tolist()
            hidden = hidden_surface_share(solid, point)
            return StarPointVisibility((x, y, z), name, hidden, max(volume, 0.0) if hidden else 0.0)
    raise GeometryError("No star point was found inside the particle.")
