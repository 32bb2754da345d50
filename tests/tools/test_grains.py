"""Synthetic grains: closed, of the size asked, of the shape promised, and the same each time."""

import numpy as np
import pytest

from tools.make_samples.grains import (
    even_sphere,
)
from tools.make_samples.samples import GRAINS, SampleGrain


def directed_edges(mesh) -> tuple[np.ndarray, np.ndarray]:
    edges = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    return edges, edges[:, ::-1]


def assert_closed(mesh) -> None:
    there, back = directed_edges(mesh)
    assert len(np.unique(there, axis=0)) == len(there)
    assert np.array_equal(np.unique(there, axis=0), np.unique(back, axis=0))


@pytest.mark.parametrize("grain", GRAINS, ids=lambda grain: grain.name)
@pytest.mark.slow
def test_that_every_shipped_grain_is_closed_outward_and_of_the_stated_size(grain: SampleGrain) -> None:
    mesh = grain.mesh()
    assert_closed(mesh)
    assert len(mesh.vertices) - len(mesh.faces) / 2 == 2
    assert mesh.volume == pytest.approx(np.pi / 6 * grain.recipe.diameter**3, rel=1e-9)
    assert np.abs(mesh.centroid).max() < 1e-9 * grain.recipe.diameter
    assert 2000 <= len(mesh.faces) <= 6000
    assert 40 <= grain.recipe.diameter <= 150


@pytest.mark.slow
def test_that_the_kinds_can_be_told_apart_by_their_moments() -> None:
    ratios = {}
    for grain in GRAINS:
        principal = np.linalg.eigvalsh(grain.mesh().inertia)
        second = np.sqrt(principal.sum() / 2 - principal)  # standard deviations, longest first
        ratios.setdefault(grain.kind, []).append((second[0] / second[1], second[2] / second[1]))
    assert all(long > 1.8 for long, _ in ratios["elongated"])
    assert all(thin < 0.5 for _, thin in ratios["flat"])
    assert all(long < 1.3 and thin > 0.9 for long, thin in ratios["bead"])


@pytest.mark.slow
def test_that_agglutinates_are_not_star_shaped_and_far_from_convex() -> None:
    for grain in GRAINS:
        if grain.kind != "agglutinate":
            continue
        mesh = grain.mesh()
        assert mesh.volume / mesh.hull.volume < 0.8
        facing = np.einsum("ij,ij->i", mesh.face_area_vectors, mesh.triangles.mean(axis=1))
        assert mesh.face_areas[facing < 0].sum() > 0.02 * mesh.surface_area


def test_that_the_even_sphere_has_the_volume_and_faces_of_a_ball() -> None:
    sphere = even_sphere(1000)
    assert len(sphere.faces) == 1996
    assert_closed(sphere)
    assert sphere.volume == pytest.approx(4 * np.pi / 3, rel=0.01)
