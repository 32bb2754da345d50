"""The convex hull decimated by quadric error: the baseline and the start of annealing (section 2.4)."""

from contextlib import suppress
from dataclasses import dataclass
from threading import Lock

import fast_simplification
import numpy as np

from regolith_studio.coarsening.target import Target
from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh

AGGRESSIVENESS = 7.0
"""How fast the library raises the quadric error that a collapse may have; its own default."""
OTHERS = (6.0, 5.0, 8.0, 9.0, 10.0, 11.0, 12.0)
"""Tried in this order where the planes bound no solid: each collapses other edges."""

_one_at_a_time = Lock()


def decimated(mesh: Mesh, n_faces: int, aggressiveness: float = AGGRESSIVENESS) -> Mesh:
    """The mesh with about `n_faces` triangles, as a rule closed but not convex (Garland and Heckbert 1997).

    The library keeps what it is given in variables of its own from loading to reading back: threads must wait
    for each other, or get pieces of each other's meshes.

    Raises ValueError if the mesh has fewer triangles.
    """
    with _one_at_a_time:
        # A copy of the vertices: the library refuses arrays that cannot be written.
        vertices, faces = fast_simplification.simplify(
            np.array(mesh.vertices), mesh.faces.astype(np.int32), target_count=n_faces, agg=aggressiveness
        )
    return Mesh(vertices, faces)


@dataclass(frozen=True)
class DecimatedHull:
    """A convex hull after quadric edge collapse, and what its planes bound.

    Parameters
    ----------
    mesh
        The triangles: closed, but as a rule not convex.
    half_spaces
        Of the triangles' planes that have the particle's centroid inside.
    polyhedron
        Their intersection.
    """

    mesh: Mesh
    half_spaces: HalfSpaces
    polyhedron: ConvexPolyhedron


def decimated_hull(target: Target, n_facets: int) -> DecimatedHull:
    """The convex hull of the unit-volume particle, decimated to `n_facets` triangles.

    Quadric edge collapse as in fast-simplification; where the planes bound no solid, other edges are
    collapsed.

    Raises
    ------
    InputError
        If the hull has fewer triangles than asked for.
    GeometryError
        If no sequence of collapses leaves planes that bound a solid about the particle's centroid.
    """
    hull = target.mesh.hull
    if len(hull.faces) < n_facets:
        raise InputError(
            f"The particle's convex hull has {len(hull.faces)} triangles only, fewer than the"
            f" {n_facets} facets asked for."
        )
    try:
        return _bounded(decimated(hull, n_facets))
    except GeometryError as error:
        for other in OTHERS:
            mesh = decimated(hull, n_facets, other)
            # Cautious collapses may end above the number asked for.
            if len(mesh.faces) <= n_facets:
                with suppress(GeometryError):
                    return _bounded(mesh)
        raise GeometryError(
            f"The planes of the convex hull decimated to {n_facets} triangles bound no solid about the"
            " particle's centroid: ask for more facets, or take the exact method."
        ) from error


def _bounded(mesh: Mesh) -> DecimatedHull:
    """The mesh with what its planes bound; a GeometryError where that is no solid."""
    # Triangles without area have no normal, and half-spaces must hold the centroid.
    sound = mesh.face_areas > 1e-12
    normals = mesh.face_area_vectors[sound] / mesh.face_areas[sound, None]
    offsets = np.einsum("ij,ij->i", normals, mesh.triangles[sound, 0])
    inside = offsets > 1e-6
    half_spaces = HalfSpaces(normals[inside], offsets[inside])
    return DecimatedHull(mesh, half_spaces, ConvexPolyhedron.from_half_spaces(half_spaces))
