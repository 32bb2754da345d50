"""Solids whose measures are known."""

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.errors import GeometryError
from regolith_studio.geometry import ConvexPolyhedron, HalfSpaces, Mesh
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.sphere_points import icosphere


def cuboid(*edges: float) -> Mesh:
    """An axis-aligned cuboid about the origin."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    return cloud(corners * np.asarray(edges)).hull


def tetrahedron(edge: float = 1.0) -> Mesh:
    """A regular tetrahedron about the origin."""
    corners = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])
    return cloud(corners * edge / np.sqrt(8.0)).hull


def cloud(points: FloatArray) -> Mesh:
    """Points without faces."""
    return Mesh(points, np.empty((0, 3), dtype=np.int64))


def rotation(seed: int) -> FloatArray:
    """A random rotation matrix."""
    return np.asarray(Rotation.random(rng=seed).as_matrix())


def random_polyhedron(seed: int, n_facets: int = 20, stretch: float = 0.0) -> Mesh:
    """A random bounded polyhedron; `stretch` spreads the logarithms of its three scales."""
    rng = np.random.default_rng(seed)
    scales = np.exp(stretch * rng.normal(size=3))
    while True:
        planes = HalfSpaces(rng.normal(size=(n_facets, 3)), rng.uniform(0.7, 1.3, n_facets))
        try:
            mesh = ConvexPolyhedron.from_half_spaces(planes).mesh
        except GeometryError:
            continue
        return Mesh(mesh.vertices * scales, mesh.faces)


def rough_stone(seed: int, level: int = 3, roughness: float = 0.2) -> Mesh:
    """A star-shaped stone: every vertex of an icosphere at a random radius."""
    rng = np.random.default_rng(seed)
    sphere = icosphere(level)
    radius = 1.0 + roughness * rng.uniform(-1.0, 1.0, len(sphere.vertices))
    return Mesh(sphere.vertices * radius[:, None] * [1.0, 0.8, 0.6], sphere.faces)


def folded_stone(seed: int, level: int = 3) -> Mesh:
    """A closed stone that is not star-shaped: a rough one bent by a shear that oscillates."""
    stone = rough_stone(seed, level, roughness=0.05)
    x, y, z = stone.vertices.T
    return Mesh(np.column_stack([x + 0.6 * np.sin(5.0 * z), y + 0.3 * np.cos(4.0 * z), z]), stone.faces)


def winding_numbers(mesh: Mesh, points: FloatArray) -> FloatArray:
    """How often a mesh winds around each point, from solid angles (Van Oosterom and Strackee 1983)."""
    total = np.zeros(len(points))
    for triangle in mesh.triangles:
        a, b, c = (corner - points for corner in triangle)
        la, lb, lc = (np.linalg.norm(vector, axis=1) for vector in (a, b, c))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c))
        ab, bc, ca = (np.einsum("ij,ij->i", *pair) for pair in ((a, b), (b, c), (c, a)))
        total += 2.0 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
    return np.asarray(total / (4.0 * np.pi))


CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
FACES = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])
CUBE = Mesh(CORNERS, FACES)


def joined(*meshes):
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + offset for mesh, offset in zip(meshes, offsets, strict=False)]),
    )


def turned_round(mesh, rows=slice(None)):
    faces = mesh.faces.copy()
    faces[rows] = faces[rows, ::-1]
    return Mesh(mesh.vertices, faces)
