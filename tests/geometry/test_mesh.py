"""Meshes: closed forms, invariance, and values that never change."""

import pickle

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.errors import GeometryError
from regolith_studio.geometry import Mesh
from tests.geometry.solids import cloud, cuboid, folded_stone, rotation, rough_stone, tetrahedron


def test_that_a_cuboid_has_the_measures_of_the_closed_form() -> None:
    mesh = cuboid(3.0, 2.0, 1.0).moved(shift=(10.0, -20.0, 30.0))
    assert mesh.volume == pytest.approx(6.0)
    assert mesh.surface_area == pytest.approx(22.0)
    assert mesh.centroid == pytest.approx([10.0, -20.0, 30.0])
    assert mesh.inertia == pytest.approx(np.diag([2.5, 5.0, 6.5]), abs=1e-9)
    assert mesh.bounds == pytest.approx(np.array([[8.5, -21.0, 29.5], [11.5, -19.0, 30.5]]))


def test_that_a_regular_tetrahedron_has_the_measures_of_the_closed_form() -> None:
    mesh = tetrahedron(2.0)
    assert mesh.volume == pytest.approx(8.0 / (6.0 * np.sqrt(2.0)))
    assert mesh.surface_area == pytest.approx(4.0 * np.sqrt(3.0))
    assert mesh.inertia == pytest.approx(mesh.volume * 4.0 / 20.0 * np.eye(3), abs=1e-12)


def test_that_volume_and_centroid_agree_with_monte_carlo() -> None:
    stone = rough_stone(4, level=2)
    hull = ConvexHull(stone.hull.vertices)
    points = np.random.default_rng(0).uniform(*stone.hull.bounds, (200_000, 3))
    inside = (points @ hull.equations[:, :3].T + hull.equations[:, 3] <= 0.0).all(axis=1)
    box = np.prod(np.ptp(stone.hull.bounds, axis=0))
    assert stone.hull.volume == pytest.approx(inside.mean() * box, rel=0.01)
    assert stone.hull.centroid == pytest.approx(points[inside].mean(axis=0), abs=0.01)


@pytest.mark.parametrize("many", [10, 10**9], ids=["sorted", "as given"])
@pytest.mark.parametrize("seed", range(4))
def test_that_the_hull_agrees_with_scipy_and_faces_outwards(
    seed: int, many: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("regolith_studio.geometry.mesh.MANY_VERTICES", many)
    stone = folded_stone(seed)
    other = ConvexHull(stone.vertices)
    assert stone.hull.volume == pytest.approx(other.volume, rel=1e-12)
    assert stone.hull.surface_area == pytest.approx(other.area, rel=1e-12)
    middle = stone.hull.triangles.mean(axis=1) - stone.hull.centroid
    assert (np.einsum("ij,ij->i", middle, stone.hull.face_area_vectors) > 0.0).all()


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1e12])
def test_that_the_hull_does_not_depend_on_the_unit(scale: float) -> None:
    stone = rough_stone(2, level=2)
    hull = stone.moved(scale=scale).hull
    assert len(hull.faces) == len(stone.hull.faces)
    assert hull.volume / scale**3 == pytest.approx(stone.hull.volume, rel=1e-12)


def test_that_moving_shifts_then_turns_then_scales() -> None:
    turn = rotation(3)
    mesh = cuboid(1.0, 2.0, 3.0)
    moved = mesh.moved(shift=(1.0, 2.0, 3.0), rotation=turn, scale=2.0)
    assert moved.vertices == pytest.approx(2.0 * (mesh.vertices + np.array([1.0, 2.0, 3.0])) @ turn.T)
    assert moved.centroid == pytest.approx(2.0 * turn @ [1.0, 2.0, 3.0])
    assert moved.volume == pytest.approx(8.0 * mesh.volume)


def test_that_a_normalised_mesh_has_volume_one_about_the_origin() -> None:
    unit = rough_stone(5).moved(shift=(100.0, 0.0, 0.0), scale=1e-6).normalised()
    assert unit.volume == pytest.approx(1.0, rel=1e-12)
    assert unit.centroid == pytest.approx(np.zeros(3), abs=1e-9)
    with pytest.raises(GeometryError, match="no volume"):
        cloud(np.eye(3)).normalised()


def test_that_pickling_keeps_values_hash_and_locks() -> None:
    mesh = rough_stone(1, level=1)
    again = pickle.loads(pickle.dumps(mesh))
    assert again.content_hash == mesh.content_hash
    assert not again.vertices.flags.writeable
    assert not again.faces.flags.writeable


@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        (np.zeros((3, 2)), np.zeros((1, 3)), r"vertices must have shape \(n, 3\), got \(3, 2\)"),
        (np.zeros((3, 3)), np.zeros((1, 4)), r"faces must have shape \(n, 3\), got \(1, 4\)"),
        (np.full((3, 3), np.nan), np.zeros((1, 3)), "finite"),
        (np.zeros((3, 3)), np.full((1, 3), 0.5), "whole numbers"),
        (np.zeros((3, 3)), np.full((1, 3), 3), "index 3 vertices"),
        (np.zeros((3, 3)), np.full((1, 3), -1), "index 3 vertices"),
    ],
)
def test_that_arrays_that_make_no_mesh_are_refused(
    vertices: np.ndarray, faces: np.ndarray, words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        Mesh(vertices, faces)


def test_that_flat_clouds_have_no_hull() -> None:
    with pytest.raises(GeometryError, match="one plane"):
        cloud(np.random.default_rng(0).normal(size=(9, 3)) * [1.0, 1.0, 0.0]).hull  # noqa: B018
