"""Particles to coarsen."""

import numpy as np
import pytest

from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere


def bumpy(seed: int, level: int = 3, roughness: float = 0.2) -> Mesh:
    """A closed star-shaped particle: an ellipsoid with random bumps, away from the origin."""
    rng = np.random.default_rng(seed)
    sphere = icosphere(level)
    radius = np.ones(len(sphere.vertices))
    for _ in range(25):
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        radius += roughness * rng.normal() * np.exp(-14.0 * (1.0 - sphere.vertices @ direction))
    points = sphere.vertices * radius[:, None] * (1.3, 1.0, 0.8)
    return Mesh(points * 25.0 + (100.0, -40.0, 7.0), sphere.faces)


@pytest.fixture(scope="session")
def particle() -> Mesh:
    """A bumpy particle of about 50 units."""
    return bumpy(3)


@pytest.fixture(scope="session")
def target(particle: Mesh) -> Target:
    """The same, normalised and measured."""
    return Target.of(particle)
