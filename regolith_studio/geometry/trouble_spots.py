"""Where a mesh is wrong: the triangles behind each number of its health."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.edges import bodies, edge_table, neighbours
from regolith_studio.geometry.health import MOST_FACES_SEARCHED, body_volumes, degenerate, unit_size
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.self_intersection import crossing_pairs


def trouble_spots(mesh: Mesh) -> dict[str, IntArray]:
    """Numbers of the triangles at each kind of fault; kinds without a fault are left out.

    The keys are ``open`` and ``crowded`` (triangles at such edges), ``turned`` (the fewer of those
    that disagree), ``degenerate``, ``double``, ``crossing``, and ``small bodies`` (all triangles of
    all bodies but the one of the largest volume).
    """
    vertices, faces = unit_size(mesh)
    if not len(faces):
        return {}
    table = edge_table(faces, len(vertices))
    uses = table.uses[table.edge].reshape(-1, 3)
    parts = bodies(neighbours(table), table.forward)
    share = np.bincount(parts.body, parts.turned) / np.bincount(parts.body)
    volumes = np.abs(body_volumes(vertices, faces, parts.body))
    _, group, members = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    crossing = crossing_pairs(vertices, faces) if len(faces) <= MOST_FACES_SEARCHED else None
    spots = {
        "open": (uses == 1).any(axis=1),
        "crowded": (uses > 2).any(axis=1),
        "turned": parts.turned ^ (share > 0.5)[parts.body],
        "degenerate": degenerate(vertices, faces),
        "double": members[group.ravel()] > 1,
        "crossing": np.zeros(len(faces), dtype=np.bool_) if crossing is None else crossing[1],
        "small bodies": parts.body != np.argmax(volumes),
    }
    return {kind: np.flatnonzero(marked) for kind, marked in spots.items() if marked.any()}


def fault_triangles(particle: Particle) -> dict[str, FloatArray]:
    """Corners (k, 3, 3) of the triangles at each kind of fault that the mesh had when it came.

    The keys are those of :func:`trouble_spots`, and ``filled`` for the triangles that now close holes.
    """
    done = particle.repair
    given = particle.mesh if done is None or done.given is None else done.given
    found = {kind: given.triangles[at] for kind, at in trouble_spots(given).items()}
    if done is not None and done.filling_faces:
        found["filled"] = done.mesh.triangles[-done.filling_faces :]
    return found
