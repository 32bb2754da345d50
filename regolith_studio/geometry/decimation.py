"""Quadric edge collapse by fast-simplification, which works on one mesh at a time."""

from threading import Lock

import fast_simplification
import numpy as np

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
