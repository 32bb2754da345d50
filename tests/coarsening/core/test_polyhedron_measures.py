"""Intersection of half-spaces, measures and their derivatives."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, HalfspaceIntersection

from regolith_studio.coarsening.core.intersection import FINE, UNBOUNDED, fill_vertices, workspace_for
from regolith_studio.coarsening.core.polyhedron_measures import (
    add_surface_charges,
    add_volume_charges,
    fill_gradient,
    fill_moved,
    fill_tilt_scales,
    measure_polyhedron,
    polyhedron_of,
    tangents_of,
)
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from tests.filling import filled


def random_planes(n: int, seed: int) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(n, 3))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True), rng.uniform(0.8, 1.2, n)


def volume_and_area(normals: FloatArray, offsets: FloatArray) -> tuple[float, float]:
    shape = measure_polyhedron(normals, offsets)
    assert shape.status == FINE
    assert shape.areas.sum() == pytest.approx(shape.surface_area, rel=1e-14)
    return shape.volume, shape.surface_area


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
    _, _, _, vertices, triples, edges, *_ = measure_polyhedron(normals, offsets)
    facets = np.unique(triples)
    assert len(edges) == 3 * len(facets) - 6
    assert len(vertices) == 2 * len(facets) - 4
    for vertex, planes in zip(vertices, triples, strict=True):
        assert normals[planes] @ vertex == pytest.approx(offsets[planes], abs=1e-13)
    assert (vertices @ normals.T <= offsets + 1e-12).all()


def test_that_an_open_cone_is_unbounded() -> None:
    assert measure_polyhedron(CUBE[:5], np.ones(5)).status == UNBOUNDED


def test_that_a_plane_outside_of_everything_bounds_no_facet() -> None:
    normals, offsets = np.vstack([CUBE, [[0.6, 0.8, 0.0]]]), np.append(np.ones(6), 2.0)
    shape = measure_polyhedron(normals, offsets)
    assert shape.areas == pytest.approx([4.0] * 6 + [0.0])
    assert shape.centroids == pytest.approx(np.vstack([CUBE, [[1.2, 1.6, 0.0]]]))


@pytest.mark.parametrize("seed", range(6))
def test_that_planes_that_tie_bound_the_polyhedron_of_qhull_or_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(50):
        normals = rng.integers(-1, 2, size=(rng.integers(6, 30), 3)).astype(float)
        normals[~normals.any(axis=1)] = [0.0, 0.0, 1.0]
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        offsets = rng.choice([0.8, 1.0, 1.1], len(normals))
        shape = measure_polyhedron(normals, offsets)
        if shape.status != FINE:
            assert len(shape.vertices) == len(shape.triples) == 0
            continue
        hull = ConvexHull(HalfspaceIntersection(np.c_[normals, -offsets], np.zeros(3)).intersections)
        assert volume_and_area(normals, offsets) == pytest.approx((hull.volume, hull.area), rel=1e-9)


def test_that_the_compiled_kernel_is_its_python_reference() -> None:
    normals, offsets = random_planes(15, 2)
    empty = np.empty((30, 3)), np.empty((30, 3), dtype=np.int64)
    ours, reference = (
        filled(kernel, (normals, offsets, 50.0, workspace_for(15)), *empty)
        for kernel in (fill_vertices, fill_vertices.py_func)  # type: ignore[attr-defined]
    )
    assert np.allclose(ours[0][:26], reference[0][:26], atol=1e-13)
    assert (ours[1][:26] == reference[1][:26]).all()


def test_that_the_derivatives_are_those_of_finite_differences() -> None:
    rng = np.random.default_rng(0)
    normals, offsets = random_planes(20, 1)
    shape = measure_polyhedron(normals, offsets)
    tangents, pivots = tangents_of(normals), shape.centroids
    scales, _ = filled(fill_tilt_scales, (shape.areas,), np.empty(20))
    assert scales == pytest.approx(np.maximum(np.sqrt(shape.areas / np.pi), 0.08), rel=1e-14)
    arguments = normals, shape.vertices, shape.edges, pivots, 1.0
    charges = [
        filled(add_volume_charges, (shape.areas, 1.0), np.zeros((20, 4)))[0],
        filled(add_surface_charges, arguments, np.zeros((20, 4)))[0],
    ]
    gradients = [filled(fill_gradient, (each, tangents, scales), np.empty(60))[0] for each in charges]
    for _ in range(5):
        step, planes = 1e-6 * rng.normal(size=60), (normals, pivots, offsets, tangents, scales)
        ahead, behind = (
            volume_and_area(*filled(fill_moved, (*planes, way * step), normals, offsets, tangents)[:2])
            for way in (1.0, -1.0)
        )
        for value, other, gradient in zip(ahead, behind, gradients, strict=True):
            assert (value - other) / 2 == pytest.approx(gradient @ step, rel=1e-5, abs=1e-12)


def test_that_tangents_stay_orthonormal_after_a_step() -> None:
    normals, offsets = random_planes(10, 1)
    step = np.random.default_rng(2).normal(size=30)
    pivots, tangents = normals * offsets[:, None], tangents_of(normals)
    planes = normals, pivots, offsets, tangents, np.full(10, 0.5), step
    turned, _, carried, _ = filled(fill_moved, planes, normals, offsets, tangents)
    triads = np.concatenate([turned[:, None], carried], axis=1)
    assert np.allclose(triads @ triads.transpose(0, 2, 1), np.eye(3), atol=1e-12)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_that_the_polyhedron_is_that_of_qhull(scale: float) -> None:
    rng = np.random.default_rng(2)
    half_spaces = HalfSpaces(rng.normal(size=(30, 3)), scale * rng.uniform(0.8, 1.6, 30))
    mine, qhull = polyhedron_of(half_spaces), ConvexPolyhedron.from_half_spaces(half_spaces)
    assert (mine.n_facets, mine.n_vertices) == (qhull.n_facets, qhull.n_vertices)
    assert mine.volume == pytest.approx(qhull.volume, rel=1e-12)
    assert mine.facet_areas == pytest.approx(qhull.facet_areas, rel=1e-9)
    assert (mine.facet_areas > 0).all()


def test_that_planes_on_one_side_bound_nothing() -> None:
    with pytest.raises(GeometryError, match="unbounded"):
        polyhedron_of(HalfSpaces(np.vstack([np.eye(3), [[0.1, 0.2, 0.97]]]), np.ones(4)))
