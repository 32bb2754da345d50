"""Meshes of all kinds that people have and programs write, drawn by number; some should be refused."""

from collections.abc import Callable

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere

NO_FACES = np.empty((0, 3), dtype=np.int64)


def odd_mesh(number: int) -> tuple[str, Mesh]:
    """Kind and mesh number `number`; kinds take turns."""
    kinds = list(KINDS)
    kind = kinds[number % len(kinds)]
    return kind, KINDS[kind](np.random.default_rng([number, 71]))


def convex(rng: np.random.Generator) -> Mesh:
    points = rng.normal(size=(int(rng.integers(5, 200)), 3)) * rng.uniform(0.3, 3.0, 3)
    return Mesh(points, NO_FACES).hull


def concave(rng: np.random.Generator) -> Mesh:
    ball = icosphere(int(rng.integers(1, 4)))
    waves = np.sin(ball.vertices @ rng.normal(size=(3, 6)) * 2.5 + rng.uniform(0, 6, 6)) @ rng.normal(size=6)
    radii = np.exp(rng.uniform(0.02, 0.3) * waves)
    return Mesh(ball.vertices * radii[:, None] * rng.uniform(0.6, 1.6, 3), ball.faces)


def stretched(mesh: Mesh, scales: FloatArray) -> Mesh:
    return Mesh(mesh.vertices * scales, mesh.faces)


def thin(rng: np.random.Generator) -> Mesh:
    return stretched(concave(rng), np.array([1.0, 1.0, 10.0 ** rng.uniform(-3, -1)]))


def needle(rng: np.random.Generator) -> Mesh:
    return stretched(convex(rng), np.array([10.0 ** rng.uniform(1, 3), 1.0, 1.0]))


def flat(rng: np.random.Generator) -> Mesh:
    return stretched(convex(rng), np.array([1.0, 1.0, rng.choice([0.0, 1e-15, 1e-12, 1e-9, 1e-6])]))


def scaled(rng: np.random.Generator) -> Mesh:
    mesh = concave(rng)
    return Mesh(mesh.vertices * 10.0 ** rng.uniform(-9, 9), mesh.faces)


def turned_and_far(rng: np.random.Generator) -> Mesh:
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return concave(rng).moved(rotation=rotation * np.linalg.det(rotation), shift=rng.normal(size=3) * 1e4)


def broken(rng: np.random.Generator) -> Mesh:
    mesh = concave(rng)
    keep = rng.random(len(mesh.faces)) > rng.choice([0.01, 0.2])
    keep[0] = False
    return Mesh(mesh.vertices, mesh.faces[keep])


def self_intersecting(rng: np.random.Generator) -> Mesh:
    one, other = concave(rng), concave(rng)
    if rng.random() < 0.5:
        noise = rng.uniform(0.1, 1.0) * rng.normal(size=one.vertices.shape)
        return Mesh(one.vertices + noise, one.faces)
    vertices = np.vstack([one.vertices, other.vertices + rng.normal(size=3) * rng.choice([0.3, 1.0, 4.0])])
    return Mesh(vertices, np.vstack([one.faces, other.faces + len(one.vertices)]))


def tiny(rng: np.random.Generator) -> Mesh:
    signs = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    corners = (
        rng.normal(size=(4, 3)),
        rng.normal(size=(5, 3)),
        signs * rng.uniform(0.2, 2.0, 3),
        np.vstack([np.eye(3), -np.eye(3)]),
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]], dtype=float),
    )[int(rng.integers(5))]
    return Mesh(corners, NO_FACES).hull


def ring(rng: np.random.Generator) -> Mesh:
    """A torus: its centroid is in the hole."""
    around, across = int(rng.integers(6, 24)), int(rng.integers(4, 12))
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b, thick = 2 * np.pi * u / around, 2 * np.pi * v / across, rng.uniform(0.1, 0.9)
    out = 1.0 + thick * np.cos(b)
    points = np.stack([out * np.cos(a), out * np.sin(a), thick * np.sin(b)], axis=-1).reshape(-1, 3)
    corner = np.stack([u, u + 1, u + 1, u]) % around * across + np.stack([v, v, v + 1, v + 1]) % across
    p, q, r, s = corner.reshape(4, -1)
    return Mesh(points, np.vstack([np.stack([p, q, r], axis=1), np.stack([p, r, s], axis=1)]))


def bent(rng: np.random.Generator) -> Mesh:
    """A boomerang: not star-shaped about its centroid."""
    ball = icosphere(3)
    x, y, z = (ball.vertices * (3.0, 0.5, 0.5)).T
    bend = rng.uniform(0.2, 1.2)
    return Mesh(np.stack([x * np.cos(bend * x / 3), y + bend * x**2 / 3, z], axis=1), ball.faces)


def untidy(rng: np.random.Generator) -> Mesh:
    """Inside out, vertices doubled, triangles without area, vertices that no triangle uses."""
    mesh = concave(rng)
    vertices = np.vstack([mesh.triangles.reshape(-1, 3), rng.normal(size=(3, 3))])
    faces = np.arange(3 * len(mesh.faces)).reshape(-1, 3)
    if rng.random() < 0.5:
        faces = faces[:, ::-1]
    return Mesh(vertices, np.vstack([faces, [[0, 0, 1], [2, 2, 2]]]))


KINDS: dict[str, Callable[[np.random.Generator], Mesh]] = {
    "convex": convex,
    "concave": concave,
    "thin": thin,
    "needle": needle,
    "flat": flat,
    "scaled": scaled,
    "turned and far": turned_and_far,
    "broken": broken,
    "self-intersecting": self_intersecting,
    "tiny": tiny,
    "ring": ring,
    "bent": bent,
    "untidy": untidy,
}
