"""Shapes to draw."""

import numpy as np
import pytest

from regolith_studio.geometry import ConvexPolyhedron, HalfSpaces
from regolith_studio.geometry.sphere_points import icosphere


@pytest.fixture(scope="session")
def ball():
    """A sphere of radius 30."""
    return icosphere(3).moved(scale=30.0)


@pytest.fixture(scope="session")
def cube():
    """A cube of edge 40 about the origin: 6 facets, 12 edges, 12 triangles."""
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.full(6, 20.0)))
