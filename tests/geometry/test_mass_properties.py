"""Volume, area and the ellipsoid of equal inertia against closed forms."""

import numpy as np
import pytest

from regolith_studio.geometry import Mesh
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import ellipsoid_area, equal_ellipsoid, volume_and_area
from regolith_studio.geometry.sphere_points import icosphere
from tests.geometry.solids import cuboid, folded_stone, rotation


def ellipsoid_of(mesh: Mesh) -> FloatArray:
    return equal_ellipsoid(mesh.normalised().inertia, mesh.volume)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_that_volume_and_area_are_those_of_the_mesh(scale: float) -> None:
    stone = folded_stone(1).moved(shift=(5.0, -7.0, 3.0), scale=scale)
    assert volume_and_area(stone.vertices, stone.faces) == pytest.approx(
        (stone.volume, stone.surface_area), rel=1e-12
    )


def test_that_a_cuboid_has_the_closed_form_and_nothing_has_nothing() -> None:
    box = cuboid(3.0, 2.0, 1.0)
    assert volume_and_area(box.vertices, box.faces) == pytest.approx((6.0, 22.0), rel=1e-14)
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 3)))
    assert volume_and_area(empty.vertices, empty.faces) == (0.0, 0.0)


def test_that_a_ball_has_the_area_of_the_closed_form() -> None:
    assert ellipsoid_area(np.full(3, 2.0)) == pytest.approx(16.0 * np.pi)


def test_that_a_spheroid_has_the_area_of_the_closed_form() -> None:
    eccentricity = np.sqrt(1.0 - 0.25)
    prolate = 2.0 * np.pi * (1.0 + 2.0 * np.arcsin(eccentricity) / eccentricity)
    assert ellipsoid_area(np.array([2.0, 1.0, 1.0])) == pytest.approx(prolate)


def test_that_an_ellipsoid_finds_itself() -> None:
    sphere = icosphere(4)
    mesh = Mesh(sphere.vertices * [3.0, 2.0, 1.0] @ rotation(1).T + 7.0, sphere.faces)
    assert ellipsoid_of(mesh) == pytest.approx([3.0, 2.0, 1.0], rel=2e-3)
    assert ellipsoid_area(np.array([3.0, 2.0, 1.0])) == pytest.approx(mesh.surface_area, rel=3e-3)


def test_that_the_ellipsoid_of_a_cuboid_keeps_volume_and_proportions() -> None:
    axes = ellipsoid_of(cuboid(4.0, 2.0, 1.0))
    assert axes[:2] / axes[2] == pytest.approx([4.0, 2.0])
    assert 4.0 / 3.0 * np.pi * np.prod(axes) == pytest.approx(8.0)
