"""Random unions of convex parts, as half-spaces and as manifold3d's solids; a body that is not convex."""

import manifold3d
import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection

from regolith_studio.coarsening.core.parts import Parts, Planes, parts_for
from regolith_studio.coarsening.core.polyhedron_measures import tangents_of
from regolith_studio.coarsening.optimiser.body import Body, body_scratch, empty_body, fill_body
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from tests.geometry.solids import rotation


def random_planes(seed: int, parts: int = 4, planes: int = 10) -> Planes:
    """Parts that overlap in part, of about unit volume each."""
    rng = np.random.default_rng(seed)
    cube = np.vstack([np.eye(3), -np.eye(3)])
    normals, offsets = [], []
    inner = rng.normal(scale=0.35, size=(parts, 3))
    for place in inner:
        sides = np.vstack([cube + rng.normal(scale=0.1, size=(6, 3)), rng.normal(size=(planes - 6, 3))])
        sides /= np.linalg.norm(sides, axis=1)[:, None]
        normals.append(sides)
        offsets.append(rng.uniform(0.4, 0.6, planes) + sides @ place)
    first = np.arange(parts + 1) * planes
    return Planes(np.concatenate(normals), np.concatenate(offsets), first, inner)


WANTED = np.array([1.0, 0.9, 0.8, 1.4, 1.75, 1.2])


def measured(planes: Planes) -> tuple[Body, Parts, bool]:
    """The union as the descent measures it, and whether it is one body."""
    n, parts = len(planes.offsets), parts_for(planes)
    body = empty_body(n, parts)
    body.normals[:], body.offsets[:] = planes.normals, planes.offsets
    body.tangents[:] = tangents_of(planes.normals)
    return body, parts, fill_body(body, WANTED, True, body_scratch(n))


def solid_of(planes: Planes) -> manifold3d.Manifold:
    """The union by manifold3d, of hulls of the corners that Qhull finds."""
    parts = []
    for j in range(len(planes.inner)):
        mine = slice(planes.first[j], planes.first[j + 1])
        equations = np.column_stack([planes.normals[mine], -planes.offsets[mine]])
        corners = HalfspaceIntersection(equations, planes.inner[j]).intersections
        hull = Mesh(corners, np.empty((0, 3), dtype=np.int64)).hull
        assert len(hull.vertices) == len(ConvexHull(corners).vertices)
        parts.append(manifold_of(hull))
    return manifold3d.Manifold.batch_boolean(parts, manifold3d.OpType.Add)


def manifold_of(mesh: Mesh) -> manifold3d.Manifold:
    """A closed mesh for manifold3d."""
    return manifold3d.Manifold(manifold3d.Mesh64(np.array(mesh.vertices), mesh.faces.astype(np.uint64)))


def dumbbell(level: int = 3) -> Mesh:
    """A rough body with a waist, at any place and unit."""
    sphere = icosphere(level).vertices
    rough = np.random.default_rng(2).uniform(0.9, 1.1, (len(sphere), 1))
    waist = rough * (0.55 + 0.7 * sphere[:, :1] ** 2)
    shape = sphere * np.hstack([np.full_like(waist, 1.8), waist, 0.8 * waist])
    return Mesh(shape @ rotation(8).T * 40.0 + [5.0, -70.0, 300.0], icosphere(level).faces)
