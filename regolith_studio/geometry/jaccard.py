"""How well a convex polyhedron covers a particle: the Jaccard distance (Eq. 7)."""

import numpy as np

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.ray_casting import radial_hits
from regolith_studio.geometry.sphere_points import fibonacci_directions

N_RAYS = 16_000


def jaccard_distance(mesh: Mesh, polyhedron: ConvexPolyhedron | HalfSpaces, n_rays: int = N_RAYS) -> float:
    """1 - V(M n P) / V(M u P), the paper's IoU (Eq. 7): 0 where both are the same, 1 where disjoint.

    Rays from the origin, which lies strictly inside the polyhedron, meet every crossing of the mesh, so
    that the mesh need not be star-shaped. All volumes are taken by the same quadrature; its error is
    about 0.0002 for 2,000 rays and 0.00002 for 16,000.

    Parameters
    ----------
    mesh
        Closed and outward-oriented, in the frame of the polyhedron.
    polyhedron
        Bounded; only its half-spaces count.
    n_rays
        Directions of the quadrature.

    Raises
    ------
    GeometryError
        If the mesh encloses no volume or the polyhedron is unbounded.
    """
    solid = (
        polyhedron
        if isinstance(polyhedron, ConvexPolyhedron)
        else ConvexPolyhedron.from_half_spaces(polyhedron)
    )
    directions = fibonacci_directions(n_rays)
    radius = solid.half_spaces.radii(directions)
    hits = radial_hits(mesh, np.zeros(3), directions)
    own = float(np.sum(hits.sign * hits.distance**3))
    if not own > 0.0:
        raise GeometryError("The mesh encloses no volume.")
    shared = float(np.sum(hits.sign * np.minimum(hits.distance, radius[hits.ray]) ** 3))
    return 1.0 - shared / (own + float(np.sum(radius**3)) - shared)
