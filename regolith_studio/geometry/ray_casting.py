"""All crossings of rays from one origin with a triangular mesh."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats, locked_integers
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.mesh import Mesh


@dataclass(frozen=True, eq=False)
class RadialHits:
    """Where rays from one origin cross a mesh, sorted by ray, then by distance.

    Parameters
    ----------
    ray
        Index of the direction, shape (k,).
    distance
        From the origin, shape (k,), in the unit of the mesh.
    sign
        +1 where the ray leaves the solid, -1 where it enters, shape (k,).
    face
        Index of the triangle, shape (k,).
    """

    ray: IntArray
    distance: FloatArray
    sign: IntArray
    face: IntArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "ray", locked_integers(self.ray, (None,), "ray"))
        n_hits = len(self.ray)
        object.__setattr__(self, "distance", locked_floats(self.distance, (n_hits,), "distance"))
        object.__setattr__(self, "sign", locked_integers(self.sign, (n_hits,), "sign"))
        object.__setattr__(self, "face", locked_integers(self.face, (n_hits,), "face"))


def radial_hits(mesh: Mesh, origin: ArrayLike, directions: FloatArray) -> RadialHits:
    """Every crossing of the rays ``origin + t * directions[k]``, t > 0, with the mesh."""
    centre = locked_floats(origin, (3,), "origin")
    rays = locked_floats(directions, (None, 3), "directions")
    ray, distance, sign, face = _cast(mesh.vertices - centre, mesh.faces, rays)
    order = np.lexsort((face, distance, ray))
    return RadialHits(ray[order], distance[order], sign[order], face[order])


@kernel
def _cast(
    points: FloatArray, faces: IntArray, directions: FloatArray
) -> tuple[IntArray, FloatArray, IntArray, IntArray]:
    size = 4 * len(directions) + 16
    ray, face, sign, distance = (
        np.empty(size, np.int64),
        np.empty(size, np.int64),
        np.empty(size, np.int64),
        np.empty(size),
    )
    n = 0
    for f in range(len(faces)):
        a = points[faces[f, 0]]
        b = points[faces[f, 1]]
        c = points[faces[f, 2]]
        ab = np.cross(a, b)
        bc = np.cross(b, c)
        ca = np.cross(c, a)
        six = ab[0] * c[0] + ab[1] * c[1] + ab[2] * c[2]
        way = 1.0 if six > 0 else -1.0
        for k in range(len(directions)):
            u = directions[k]
            e0 = way * (ab[0] * u[0] + ab[1] * u[1] + ab[2] * u[2])
            e1 = way * (bc[0] * u[0] + bc[1] * u[1] + bc[2] * u[2])
            e2 = way * (ca[0] * u[0] + ca[1] * u[1] + ca[2] * u[2])
            if (
                (e0 > 0 or (e0 == 0 and way > 0))
                and (e1 > 0 or (e1 == 0 and way > 0))
                and (e2 > 0 or (e2 == 0 and way > 0))
                and e0 + e1 + e2 > 0
            ):
                if n == size:
                    size *= 2
                    ray = np.concatenate((ray, np.empty(n, np.int64)))
                    face = np.concatenate((face, np.empty(n, np.int64)))
                    sign = np.concatenate((sign, np.empty(n, np.int64)))
                    distance = np.concatenate((distance, np.empty(n)))
                ray[n], face[n], sign[n] = k, f, int(way)
                distance[n] = way * six / (e0 + e1 + e2)
                n += 1
    return ray[:n], distance[:n], sign[:n], face[:n]
