"""The star point of a particle, and the part of it that no radius function about that point can represent."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy import optimize

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.half_spaces import inscribed_ball
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.harmonics.radius_function import require_solid, sample_radius

# Searches without this limit ended 18 to 40 % of the equivalent radius off the centre of mass; from there 4
# of 20 fits of lunar rocks had negative radii.
SEARCH_RADIUS = 0.25
"""Radius of the search for the least hidden volume, as a share of the equivalent radius."""
N_SEARCH_RAYS = 1000


def centre_of_mass(mesh: Mesh) -> FloatArray:
    """Centre of mass, shape (3,); of a curved particle it may lie outside."""
    return mesh.centroid


def kernel_centre(mesh: Mesh) -> FloatArray:
    """The point deepest in the kernel: the largest distance to every face's plane (HiGHS), shape (3,).

    Raises GeometryError if the kernel is empty: no point sees the whole surface.
    """
    size = mesh.volume ** (1 / 3)
    sound = mesh.face_areas > 1e-14 * mesh.surface_area  # slivers have a normal of rounding errors
    normals = mesh.face_area_vectors[sound] / mesh.face_areas[sound, None]
    # HiGHS has absolute tolerances of 1e-7: the programme is solved at unit volume about the centroid.
    corners = (mesh.triangles[sound, 0] - mesh.centroid) / size
    offsets = np.einsum("ij,ij->i", normals, corners)
    centre, distance = inscribed_ball(normals, offsets)
    if not distance > 1e-9:
        raise GeometryError("No point inside the particle sees its whole surface: its kernel is empty.")
    return np.asarray(mesh.centroid + centre * size)


def hidden_volume(mesh: Mesh, star_point: FloatArray, n_rays: int = N_SEARCH_RAYS) -> float:
    """Share of the particle's volume that is not visible from `star_point`; infinite outside."""
    try:
        radius = sample_radius(mesh, star_point, fibonacci_directions(n_rays))
    except GeometryError:
        return np.inf
    return float(radius.hidden_cubes.sum() / (radius.volume**3).sum())


def least_hidden_volume(mesh: Mesh) -> FloatArray:
    """Point near the centre of mass from which the least volume is hidden, shape (3,).

    Downhill simplex search within a quarter of the equivalent radius.

    Raises GeometryError if no point inside is found.
    """
    start = centre_of_mass(mesh)
    if not np.isfinite(hidden_volume(mesh, start)):
        start = inner_point(mesh)
    radius = (3 * mesh.volume / (4 * np.pi)) ** (1 / 3)
    search_radius = SEARCH_RADIUS * radius

    def cost(step: FloatArray) -> float:
        length = float(np.linalg.norm(step))
        return hidden_volume(mesh, start + step * search_radius) if length <= 1 else np.inf

    if cost(np.zeros(3)) == 0.0:
        return start
    simplex = np.vstack([np.zeros(3), 0.4 * np.eye(3)])
    with np.errstate(invalid="ignore"):  # costs of two points outside are both infinite
        optimum = optimize.minimize(
            cost,
            np.zeros(3),
            method="Nelder-Mead",
            options={"initial_simplex": simplex, "maxfev": 80, "xatol": 1e-2, "fatol": 1e-5},
        )
    return np.asarray(start + optimum.x * search_radius)


def inner_point(mesh: Mesh) -> FloatArray:
    """A point well inside, shape (3,): the middle of the longest segment of a few lines inside the mesh.

    Raises GeometryError if no line enters the particle.
    """
    size = float(np.ptp(mesh.bounds, axis=0).max())
    best, length = None, 0.0
    # Large faces first: a line from a sliver may leave at once.
    for face in np.argsort(mesh.face_areas)[::-1][:32]:
        inward = -mesh.face_area_vectors[face] / mesh.face_areas[face]
        # Off the face, which would otherwise be the first that the line meets.
        origin = mesh.triangles[face].mean(axis=0) + 1e-9 * size * inward
        hits = radial_hits(mesh, origin, inward[None, :])
        if len(hits.distance) and hits.sign[0] > 0 and hits.distance[0] > length:
            length = float(hits.distance[0])
            best = origin + inward * (length / 2)
    if best is None:
        raise GeometryError("No point inside the particle was found: the mesh encloses no volume.")
    return np.asarray(best)


STAR_POINT_RULES: Mapping[str, Callable[[Mesh], FloatArray]] = MappingProxyType(
    {
        "centre_of_mass": centre_of_mass,
        "kernel_centre": kernel_centre,
        "least_hidden_volume": least_hidden_volume,
    }
)
"""Ways to choose the star point, by key; the first is the default."""


N_PROBES = 8000
"""Faces that are tested for the share of a large mesh."""
# The middle of a sliver also lies in its neighbour, but for rounding.
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
    # For a face in whose plane the star point lies, the product is rounding error of this order.
    return np.asarray(facing < -1e-12 * size * mesh.face_areas)


def hidden_faces(mesh: Mesh, star_point: FloatArray, faces: IntArray | None = None) -> BoolArray:
    """Whether the middle of each face is hidden from the star point by another part of the surface.

    ``faces``: indices of the faces to test, shape (k,); all if ``None``. The result has their length.
    """
    chosen = np.arange(len(mesh.faces)) if faces is None else faces
    spokes = mesh.triangles[chosen].mean(axis=1) - star_point
    distance = np.linalg.norm(spokes, axis=1)
    apart = distance > 0
    directions = np.divide(spokes, distance[:, None], out=np.zeros_like(spokes), where=apart[:, None])
    directions[~apart] = (0.0, 0.0, 1.0)
    hits = radial_hits(mesh, star_point, directions)
    in_front = hits.distance < distance[hits.ray] * (1 - _TOLERANCE)
    # The face itself is hit in its middle, before or behind it by rounding.
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
    # The last cumulative sum may be a rounding error below the sum of the areas.
    picks = np.minimum(np.searchsorted(np.cumsum(mesh.face_areas), steps), len(mesh.faces) - 1)
    return float(hidden_faces(mesh, star_point, picks.astype(np.int64)).mean())


@dataclass(frozen=True)
class StarPointVisibility:
    """Share of a particle that is visible from its star point.

    - ``star_point``: in the frame of the particle.
    - ``rule``: key of ``STAR_POINT_RULES`` by which the point was found.
    - ``hidden_surface_share``: share of the surface that is not visible from the star point; exactly 0 for
      star-shaped particles.
    - ``unrepresentable_volume_share``: share of the volume behind the first crossing of a ray.
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

    Raises GeometryError if the mesh is open or inside out, or no star point is found inside.
    """
    solid = require_solid(mesh)
    for name in ("centre_of_mass", "least_hidden_volume"):
        point = STAR_POINT_RULES[name](solid)
        volume = hidden_volume(solid, point, N_RAYS)
        if np.isfinite(volume):
            x, y, z = point.tolist()
            hidden = hidden_surface_share(solid, point)
            return StarPointVisibility((x, y, z), name, hidden, volume if hidden else 0.0)
    raise GeometryError("No star point was found inside the particle.")
