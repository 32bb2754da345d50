"""The Jaccard distance: closed forms and Monte Carlo."""

import numpy as np
import pytest

from regolith_studio.errors import GeometryError
from regolith_studio.geometry import ConvexPolyhedron, HalfSpaces, Mesh
from regolith_studio.geometry.ray_casting import jaccard_distance
from regolith_studio.geometry.sphere_points import icosphere
from tests.geometry.solids import cuboid, folded_stone, rotation, winding_numbers

CUBE = np.vstack([np.eye(3), -np.eye(3)])


@pytest.mark.parametrize("half", [0.3, 0.5, 0.8])
def test_that_concentric_cubes_differ_by_the_ratio_of_their_volumes(half: float) -> None:
    ratio = min((2 * half) ** 3, (2 * half) ** -3)
    distance = jaccard_distance(cuboid(1.0, 1.0, 1.0), HalfSpaces(CUBE, np.full(6, half)))
    assert distance == pytest.approx(1.0 - ratio, abs=1e-12)


def test_that_a_cube_in_a_ball_has_the_known_distance() -> None:
    ball = icosphere(5)
    cube = HalfSpaces(CUBE, np.full(6, 0.5))
    assert jaccard_distance(ball, cube) == pytest.approx(1.0 - 3.0 / (4.0 * np.pi), abs=5e-4)


def test_that_crossed_cuboids_share_their_middle() -> None:
    long, wide = cuboid(3.0, 1.0, 1.0), HalfSpaces(CUBE, [0.5, 1.5, 0.5, 0.5, 1.5, 0.5])
    assert jaccard_distance(long, wide, n_rays=64_000) == pytest.approx(1.0 - 1.0 / 5.0, abs=2e-4)


def test_that_a_polyhedron_is_at_distance_zero_from_itself() -> None:
    planes = HalfSpaces(CUBE @ rotation(1), [1.0, 2.0, 1.5, 1.0, 0.5, 1.5])
    solid = ConvexPolyhedron.from_half_spaces(planes)
    assert jaccard_distance(solid.mesh, solid) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_that_a_stone_that_is_not_star_shaped_agrees_with_monte_carlo(seed: int) -> None:
    stone = folded_stone(seed, level=2)
    planes = HalfSpaces(CUBE @ rotation(seed), [0.9, 0.7, 0.6, 0.8, 0.7, 0.6])
    rng = np.random.default_rng(seed)
    low, high = np.minimum(stone.bounds[0], -1.4), np.maximum(stone.bounds[1], 1.4)
    points = rng.uniform(low, high, (20_000, 3))
    in_stone = winding_numbers(stone, points) > 0.5
    in_planes = (points @ planes.normals.T <= planes.offsets).all(axis=1)
    wanted = 1.0 - np.sum(in_stone & in_planes) / np.sum(in_stone | in_planes)
    assert jaccard_distance(stone, planes) == pytest.approx(wanted, abs=0.012)


def test_that_disjoint_solids_are_at_distance_one() -> None:
    far = cuboid(1.0, 1.0, 1.0).moved(shift=(9.0, 0.0, 0.0))
    assert jaccard_distance(far, HalfSpaces(CUBE, np.ones(6))) == pytest.approx(1.0, abs=1e-12)


def test_that_the_distance_does_not_depend_on_the_unit() -> None:
    stone, planes = folded_stone(1), HalfSpaces(CUBE, np.full(6, 0.7))
    tiny = jaccard_distance(stone.moved(scale=1e-9), planes.scaled(1e-9))
    assert tiny == pytest.approx(jaccard_distance(stone, planes), rel=1e-12)


def test_that_solids_without_volume_are_refused() -> None:
    with pytest.raises(GeometryError, match="unbounded"):
        jaccard_distance(cuboid(1.0, 1.0, 1.0), HalfSpaces(CUBE[:5], np.ones(5)))
    with pytest.raises(GeometryError, match="no volume"):
        jaccard_distance(Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]])), HalfSpaces(CUBE, np.ones(6)))
