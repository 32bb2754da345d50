"""Shapes with closed forms."""

from collections.abc import Callable

import numpy as np
import pytest

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients, degrees


def _ellipsoid(a: float, b: float, c: float, level: int = 3) -> Mesh:
    sphere = icosphere(level)
    return Mesh(sphere.vertices * [a, b, c], sphere.faces)


def _torus(big: float, small: float, n: int = 48) -> Mesh:
    """A torus about the z axis with n x n/2 quadrilaterals, each cut in two."""
    m = n // 2
    around, along = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    phi, psi = 2 * np.pi * around / n, 2 * np.pi * along / m
    ring = big + small * np.cos(psi)
    vertices = np.stack([ring * np.cos(phi), ring * np.sin(phi), small * np.sin(psi)], axis=-1)
    here, east = around * m + along, (around + 1) % n * m + along
    up, both = around * m + (along + 1) % m, (around + 1) % n * m + (along + 1) % m
    faces = np.stack([np.stack([here, east, both], -1), np.stack([here, both, up], -1)], axis=2)
    return Mesh(vertices.reshape(-1, 3), faces.reshape(-1, 3))


def _prism(outline: list[tuple[float, float]], triangles: list[tuple[int, int, int]], height: float) -> Mesh:
    """A polygon (counter-clockwise) with its triangulation, pulled up along z."""
    n = len(outline)
    flat = np.array(outline, dtype=float)
    vertices = np.vstack([np.column_stack([flat, np.full(n, z)]) for z in (0.0, height)])
    top = np.array(triangles) + n
    bottom = np.array(triangles)[:, ::-1]
    here = np.arange(n)
    after = (here + 1) % n
    sides = [np.column_stack([here, after, after + n]), np.column_stack([here, after + n, here + n])]
    return Mesh(vertices, np.vstack([bottom, top, *sides]))


def _rough(l_max: int, seed: int = 0, strength: float = 0.15) -> ShCoefficients:
    """A random star-shaped particle of mean radius about 1 with amplitudes that fall like (l + 1)^-2."""
    rng = np.random.default_rng(seed)
    values = rng.normal(size=(l_max + 1) ** 2) * strength * (degrees((l_max + 1) ** 2) + 1.0) ** -2
    values[0] = np.sqrt(4 * np.pi)
    return ShCoefficients(values)


@pytest.fixture(scope="session")
def ellipsoid() -> Callable[..., Mesh]:
    """``ellipsoid(a, b, c, level=3)``."""
    return _ellipsoid


@pytest.fixture(scope="session")
def torus() -> Callable[..., Mesh]:
    """``torus(big, small, n=48)``: radius of the ring and of the tube."""
    return _torus


@pytest.fixture(scope="session")
def prism() -> Callable[..., Mesh]:
    """``prism(outline, triangles, height)``."""
    return _prism


@pytest.fixture(scope="session")
def bracket() -> Mesh:
    """An L of unit thickness: the cells x or y in 0..1 of the square 0..3, z in 0..1; volume 5."""
    outline = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
    return _prism(outline, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)], 1.0)


@pytest.fixture(scope="session")
def rough() -> Callable[..., ShCoefficients]:
    """``rough(l_max, seed=0, strength=0.15)``: a random band-limited particle."""
    return _rough
