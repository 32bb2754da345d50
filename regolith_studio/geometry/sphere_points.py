"""Evenly spread directions on the unit sphere."""

from functools import cache, lru_cache

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.mesh import Mesh

# 2 pi (1 - 1 / golden ratio), which simple fractions approximate worst: points never line up in spokes.
GOLDEN_ANGLE = np.pi * (3.0 - 5.0**0.5)


def fibonacci_directions(n: int) -> FloatArray:
    """`n` unit vectors on a Fibonacci spiral, shape (n, 3), each standing for the same solid angle 4 pi / n.

    Raises ValueError if `n` is not positive.
    """
    if n < 1:
        raise ValueError(f"n must be at least 1, got {n}")
    return _spiral(n).copy()


@lru_cache(maxsize=4)
def _spiral(n: int) -> FloatArray:
    step = np.arange(n)
    # Bands of equal height on a sphere have equal areas (Archimedes); these are their middles.
    z = 1.0 - (2.0 * step + 1.0) / n
    ring = np.sqrt(1.0 - z**2)
    angle = GOLDEN_ANGLE * step
    return np.column_stack([ring * np.cos(angle), ring * np.sin(angle), z])


@cache
def icosphere(level: int) -> Mesh:
    """The unit sphere as an icosahedron whose triangles are cut in four `level` times.

    The mesh has 10 * 4**level + 2 vertices and 20 * 4**level faces (level 4: 2,562 and 5,120), wound
    counter-clockwise seen from outside. Vertices of level k come first in level k + 1.

    Raises ValueError if `level` is negative or above 8 (1.3 million faces).
    """
    if not 0 <= level <= 8:
        raise ValueError(f"level must be 0 to 8, got {level}")
    return _icosahedron() if level == 0 else _subdivided(icosphere(level - 1))


def _icosahedron() -> Mesh:
    golden = (1.0 + 5.0**0.5) / 2.0
    rectangle = np.array([[-1.0, golden], [1.0, golden], [-1.0, -golden], [1.0, -golden]])
    zero = np.zeros((4, 1))
    vertices = np.vstack(
        [
            np.hstack([rectangle, zero]),
            np.hstack([zero, rectangle]),
            np.hstack([rectangle[:, 1:], zero, rectangle[:, :1]]),
        ]
    )
    hull = Mesh(vertices / np.linalg.norm(vertices[0]), np.empty((0, 3), dtype=np.int64)).hull
    return Mesh(hull.vertices / np.linalg.norm(hull.vertices, axis=1, keepdims=True), hull.faces)


def _subdivided(sphere: Mesh) -> Mesh:
    """Each triangle cut in four at its edges' midpoints, which are moved out to the sphere."""
    faces = sphere.faces
    edges: IntArray = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    distinct, inverse = np.unique(edges, axis=0, return_inverse=True)
    middle = sphere.vertices[distinct].sum(axis=1)
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    ab, bc, ca = (inverse.reshape(-1, 3) + len(sphere.vertices)).T
    a, b, c = faces.T
    quarters = np.stack([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]])
    return Mesh(np.vstack([sphere.vertices, middle]), quarters.transpose(2, 0, 1).reshape(-1, 3))
