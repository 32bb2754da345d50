"""The point that radii are measured from (section 2.3).

On real particles the centre of mass is the best plain choice. The centre of the kernel, which sees the
whole surface, exists only for star-shaped particles; where the kernel is empty the linear programme's
point is far off and worse than the centre of mass, so it is refused.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from scipy import optimize

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.half_spaces import inscribed_ball
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.geometry.sphere_points import fibonacci_directions
from regolith_studio.harmonics.radius_function import sample_radius

SEARCH_RADIUS = 0.25
"""Radius of the search for the least hidden volume, as a share of the equivalent radius."""
N_SEARCH_RAYS = 1000


def centre_of_mass(mesh: Mesh) -> FloatArray:
    """Centre of mass, shape (3,); of a curved particle it may lie outside."""
    return mesh.centroid


def kernel_centre(mesh: Mesh) -> FloatArray:
    """The point deepest in the kernel: the largest distance to every face's plane (HiGHS), shape (3,).

    Raises
    ------
    GeometryError
        If the kernel is empty: no point sees the whole surface.
    """
    size = mesh.volume ** (1 / 3)
    keep = mesh.face_areas > 1e-14 * mesh.surface_area  # slivers have a normal of rounding errors
    normals = mesh.face_area_vectors[keep] / mesh.face_areas[keep, None]
    # HiGHS has absolute tolerances of 1e-7: the programme is solved at unit volume about the centroid.
    corners = (mesh.triangles[keep, 0] - mesh.centroid) / size
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

    Raises
    ------
    GeometryError
        If no point inside is found.
    """
    start = centre_of_mass(mesh)
    if not np.isfinite(hidden_volume(mesh, start)):
        start = inner_point(mesh)
    radius = (3 * mesh.volume / (4 * np.pi)) ** (1 / 3)
    reach = SEARCH_RADIUS * radius

    def cost(step: FloatArray) -> float:
        length = float(np.linalg.norm(step))
        return hidden_volume(mesh, start + step * reach) if length <= 1 else np.inf

    if cost(np.zeros(3)) == 0.0:
        return start
    simplex = np.vstack([np.zeros(3), 0.4 * np.eye(3)])
    with np.errstate(invalid="ignore"):  # costs of two points outside are both infinite
        found = optimize.minimize(
            cost,
            np.zeros(3),
            method="Nelder-Mead",
            options={"initial_simplex": simplex, "maxfev": 80, "xatol": 1e-2, "fatol": 1e-5},
        )
    return np.asarray(start + found.x * reach)


def inner_point(mesh: Mesh) -> FloatArray:
    """A point well inside, shape (3,): the middle of the longest segment of a few lines inside the mesh.

    Raises
    ------
    GeometryError
        If no line enters the particle.
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
