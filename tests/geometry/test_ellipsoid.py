"""Ellipsoids against closed forms."""

import numpy as np
import pytest

from regolith_studio.geometry import Mesh
from regolith_studio.geometry.directions import icosphere
from regolith_studio.geometry.ellipsoid import ellipsoid_area, equal_ellipsoid
from tests.geometry.solids import cuboid, rotation


def test_that_a_ball_has_the_area_of_the_closed_form() -> None:
    assert ellipsoid_area(np.full(3, 2.0)) == pytest.approx(16.0 * np.pi)


def test_that_a_spheroid_has_the_area_of_the_closed_form() -> None:
    eccentricity = np.sqrt(1.0 - 0.25)
    prolate = 2.0 * np.pi * (1.0 + 2.0 * np.arcsin(eccentricity) / eccentricity)
    assert ellipsoid_area(np.array([2.0, 1.0, 1.0])) == pytest.approx(prolate)


def test_that_an_ellipsoid_finds_itself() -> None:
    sphere = icosphere(4)
    mesh = Mesh(sphere.vertices * [3.0, 2.0, 1.0] @ rotation(1).T + 7.0, sphere.faces)
    assert equal_ellipsoid(mesh) == pytest.approx([3.0, 2.0, 1.0], rel=2e-3)
    assert ellipsoid_area(np.array([3.0, 2.0, 1.0])) == pytest.approx(mesh.surface_area, rel=3e-3)


def test_that_the_ellipsoid_of_a_cuboid_keeps_volume_and_proportions() -> None:
    axes = equal_ellipsoid(cuboid(4.0, 2.0, 1.0))
    assert axes[:2] / axes[2] == pytest.approx([4.0, 2.0])
    assert 4.0 / 3.0 * np.pi * np.prod(axes) == pytest.approx(8.0)
