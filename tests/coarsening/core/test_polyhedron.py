"""Intersection of half-spaces, measures and their derivatives."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, HalfspaceIntersection

from regolith_studio.coarsening.core.intersection import FINE, UNBOUNDED, edges_of, intersect
from regolith_studio.coarsening.core.measures import area_charge, facets_of, volume_charge, volume_of
from regolith_studio.coarsening.core.planes import carried, gradient_of, levers_of, moved, tangents_of
from regolith_studio.geometry.arrays import FloatArray


def random_planes(n: int, seed: int) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(n, 3))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True), rng.uniform(0.8, 1.2, n)


def volume_and_area(normals: FloatArray, offsets: FloatArray) -> tuple[float, float]:
    status, vertices, triples = intersect(normals, offsets)
    assert status == FINE
    area, _ = facets_of(normals, offsets, vertices, edges_of(triples, len(offsets)))
    return volume_of(offsets, area), float(area.sum())


CUBE = np.vstack([np.eye(3), -np.eye(3)])


def test_that_six_planes_at_distance_one_enclose_volume_eight() -> None:
    assert volume_and_area(CUBE, np.ones(6)) == pytest.approx((8.0, 24.0), rel=1e-14)


@pytest.mark.parametrize("n", [12, 20, 60, 200])
def test_that_volume_and_area_are_those_of_qhull(n: int) -> None:
    for seed in range(4):
        normals, offsets = random_planes(n, seed)
        hull = ConvexHull(HalfspaceIntersection(np.c_[normals, -offsets], np.zeros(3)).intersections)
        assert volume_and_area(normals, offsets) == pytest.approx((hull.volume, hull.area), rel=1e-11)


def test_that_vertices_satisfy_eulers_formula_and_lie_in_their_planes() -> None:
    normals, offsets = random_planes(40, 5)
    _, vertices, triples = intersect(normals, offsets)
    facets = np.unique(triples)
    assert len(vertices) == 2 * len(facets) - 4
    for vertex, planes in zip(vertices, triples, strict=True):
        assert normals[planes] @ vertex == pytest.approx(offsets[planes], abs=1e-13)
    assert (vertices @ normals.T <= offsets + 1e-12).all()


def test_that_an_open_cone_is_unbounded() -> None:
    assert intersect(CUBE[:5], np.ones(5))[0] == UNBOUNDED


def test_that_a_plane_outside_of_everything_bounds_no_facet() -> None:
    normals, offsets = np.vstack([CUBE, [[0.6, 0.8, 0.0]]]), np.append(np.ones(6), 2.0)
    _, vertices, triples = intersect(normals, offsets)
    area, _ = facets_of(normals, offsets, vertices, edges_of(triples, 7))
    assert area[6] == 0.0
    assert area[:6] == pytest.approx(4.0)


@pytest.mark.parametrize("seed", range(6))
def test_that_planes_that_tie_bound_the_polyhedron_of_qhull_or_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(50):
        normals = rng.integers(-1, 2, size=(rng.integers(6, 30), 3)).astype(float)
        normals[~normals.any(axis=1)] = [0.0, 0.0, 1.0]
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        offsets = rng.choice([0.8, 1.0, 1.1], len(normals))
        status, vertices, triples = intersect(normals, offsets)
        if status != FINE:
            assert len(vertices) == len(triples) == 0
            continue
        hull = ConvexHull(HalfspaceIntersection(np.c_[normals, -offsets], np.zeros(3)).intersections)
        assert volume_and_area(normals, offsets) == pytest.approx((hull.volume, hull.area), rel=1e-9)


def test_that_the_compiled_kernel_is_its_python_reference() -> None:
    normals, offsets = random_planes(15, 2)
    for mine, reference in zip(intersect(normals, offsets), intersect.py_func(normals, offsets), strict=True):
        assert np.allclose(mine, reference, atol=1e-13)


def test_that_the_derivatives_are_those_of_finite_differences() -> None:
    rng = np.random.default_rng(0)
    normals, offsets = random_planes(20, 1)
    _, vertices, triples = intersect(normals, offsets)
    edges = edges_of(triples, 20)
    area, centroid = facets_of(normals, offsets, vertices, edges)
    pivots = centroid + 0.02 * rng.normal(size=centroid.shape)
    frames, levers = tangents_of(normals), levers_of(area, 0.1)
    gradients = [
        gradient_of(volume_charge(area, centroid, pivots), frames, levers),
        gradient_of(area_charge(normals, vertices, edges, pivots), frames, levers),
    ]
    for _ in range(5):
        step = 1e-6 * rng.normal(size=60)
        ahead = volume_and_area(*moved(normals, pivots, offsets, frames, levers, step))
        behind = volume_and_area(*moved(normals, pivots, offsets, frames, levers, -step))
        for value, other, gradient in zip(ahead, behind, gradients, strict=True):
            assert (value - other) / 2 == pytest.approx(gradient @ step, rel=1e-5, abs=1e-12)


def test_that_carried_tangents_stay_orthonormal() -> None:
    normals, _ = random_planes(10, 1)
    turned, _ = random_planes(10, 2)
    frames = carried(tangents_of(normals), turned)
    triads = np.concatenate([turned[:, None], frames], axis=1)
    assert np.allclose(triads @ triads.transpose(0, 2, 1), np.eye(3), atol=1e-12)
