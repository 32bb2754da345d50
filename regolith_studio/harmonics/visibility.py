"""Which part of the surface cannot be seen from the star point, and so cannot be kept by a radius."""

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.ray_casting import radial_hits

N_PROBES = 8000
"""Faces that are probed for the share of a large mesh."""
_TOLERANCE = 1e-7


def faces_away(mesh: Mesh, star_point: FloatArray) -> BoolArray:
    """Faces whose inner side looks away from the star point or along the view, shape (m,).

    None of a closed mesh means that it is star-shaped about the point.
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
        Indices of the faces to judge, shape (k,); all if ``None``. The result has their length.
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

    Of meshes with more than :data:`N_PROBES` faces as many are probed, evenly spread over the area.
    """
    if not faces_away(mesh, star_point).any():
        return 0.0
    if len(mesh.faces) <= N_PROBES:
        hidden = hidden_faces(mesh, star_point)
        return float(mesh.face_areas[hidden].sum() / mesh.surface_area)
    steps = (np.arange(N_PROBES) + 0.5) / N_PROBES * mesh.surface_area
    picks = np.minimum(np.searchsorted(np.cumsum(mesh.face_areas), steps), len(mesh.faces) - 1)
    return float(hidden_faces(mesh, star_point, picks.astype(np.int64)).mean())
