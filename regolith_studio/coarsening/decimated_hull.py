"""The convex hull decimated by quadric error: the baseline and the start of annealing (section 2.4)."""

from threading import Lock

import fast_simplification
import numpy as np

from regolith_studio.coarsening.target import Target
from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh

_one_at_a_time = Lock()


def decimated(mesh: Mesh, n_faces: int) -> Mesh:
    """The mesh with about `n_faces` triangles, as a rule closed but not convex (Garland and Heckbert 1997).

    The library keeps what it is given in variables of its own from loading to reading back: threads must wait
    for each other, or get pieces of each other's meshes.

    Raises ValueError if the mesh has fewer triangles.
    """
    with _one_at_a_time:
        # A copy of the vertices: the library refuses arrays that cannot be written.
        vertices, faces = fast_simplification.simplify(
            np.array(mesh.vertices), mesh.faces.astype(np.int32), target_count=n_faces
        )
    return Mesh(vertices, faces)


def decimated_hull(target: Target, n_facets: int) -> Mesh:
    """The convex hull of the unit-volume particle, decimated to `n_facets` triangles.

    Quadric edge collapse as in fast-simplification. The result is closed but as a rule not convex.

    Raises
    ------
    InputError
        If the hull has fewer triangles than asked for.
    """
    hull = target.mesh.hull
    if len(hull.faces) < n_facets:
        raise InputError(
            f"The particle's convex hull has {len(hull.faces)} triangles only, fewer than the"
            f" {n_facets} facets asked for."
        )
    return decimated(hull, n_facets)


def quadric_half_spaces(target: Target, n_facets: int) -> HalfSpaces:
    """The half-spaces of the decimated hull's triangles (the start of section 2.4).

    Raises
    ------
    GeometryError
        If the planes that hold the particle's centroid inside bound no solid.
    """
    mesh = decimated_hull(target, n_facets)
    # Triangles without area have no normal, and half-spaces must hold the centroid.
    sound = mesh.face_areas > 1e-12
    normals = mesh.face_area_vectors[sound] / mesh.face_areas[sound, None]
    offsets = np.einsum("ij,ij->i", normals, mesh.triangles[sound, 0])
    inside = offsets > 1e-6
    try:
        half_spaces = HalfSpaces(normals[inside], offsets[inside])
        ConvexPolyhedron.from_half_spaces(half_spaces)
    except GeometryError as error:
        raise GeometryError(
            f"The planes of the convex hull decimated to {n_facets} triangles bound no solid about the"
            " particle's centroid: ask for more facets, or take the exact method."
        ) from error
    return half_spaces
