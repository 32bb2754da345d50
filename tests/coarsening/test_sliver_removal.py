"""Small facets are made larger: the derivative of facet areas, and that nothing is lost by it."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, HalfspaceIntersection

from benchmarks.independent import measured
from regolith_studio.coarsening.coarsen import coarsen, coarsening_steps
from regolith_studio.coarsening.core.plane_coordinates import fill_gradient, moved_planes, tangents_of
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron
from regolith_studio.coarsening.exact import multi_start
from regolith_studio.coarsening.exact.sliver_removal import add_area_charges, has_small_facets
from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere
from tests.filling import filled


def areas_by_scipy(normals: FloatArray, offsets: FloatArray) -> FloatArray:
    """Facet areas from triangles of scipy's hull of the corners."""
    corners = HalfspaceIntersection(np.c_[normals, -offsets], np.zeros(3)).intersections
    hull = ConvexHull(corners)
    areas = np.zeros(len(offsets))
    for triangle, plane in zip(hull.simplices, hull.equations, strict=True):
        p, q, r = corners[triangle]
        areas[np.argmax(normals @ plane[:3])] += np.linalg.norm(np.cross(q - p, r - p)) / 2
    return areas


def pebble(seed: int) -> Mesh:
    ball, rng = icosphere(4), np.random.default_rng(seed)
    waves = np.sin(ball.vertices @ rng.normal(size=(3, 6)) * 2.5 + rng.uniform(0, 6, 6)) @ rng.normal(size=6)
    return Mesh(ball.vertices * np.exp(0.14 * waves)[:, None] * [1.4, 1.0, 0.8], ball.faces)


@pytest.mark.parametrize("seed", range(3))
def test_that_facet_areas_change_as_differences_by_scipy(seed: int) -> None:
    rng = np.random.default_rng(seed)
    normals = fibonacci_directions(14) + 0.2 * rng.normal(size=(14, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = rng.uniform(0.9, 1.1, 14)
    gains, step = rng.normal(size=14), 1e-6 * rng.normal(size=42)
    shape = measure_polyhedron(normals, offsets)
    tangents, scales, pivots = tangents_of(normals), np.full(14, 0.4), shape.centroids
    np.testing.assert_allclose(shape.areas, areas_by_scipy(normals, offsets), atol=1e-9)
    arguments = normals, shape.vertices, shape.edges, pivots, gains
    charge, plain = (
        filled(f, arguments, np.zeros((14, 4)))[0] for f in (add_area_charges, add_area_charges.py_func)
    )
    ahead, behind = (
        areas_by_scipy(*moved_planes(normals, pivots, offsets, tangents, scales, way * step)[:2])
        for way in (1.0, -1.0)
    )
    gradient, _ = filled(fill_gradient, (charge, tangents, scales), np.empty(42))
    assert 2.0 * gradient @ step == pytest.approx(gains @ (ahead - behind), rel=1e-4)
    np.testing.assert_allclose(charge, plain, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("n_facets", [35, pytest.param(50, marks=pytest.mark.slow)])
@pytest.mark.slow
def test_that_small_facets_grow_and_nothing_is_lost(n_facets: int, monkeypatch: pytest.MonkeyPatch) -> None:
    small = {True: [], False: []}
    for seed in range(6):
        target = Target.of(pebble(seed))
        found = {}
        for evens in (True, False):
            monkeypatch.setattr(
                multi_start, "has_small_facets", has_small_facets if evens else lambda *_: False
            )
            found[evens] = coarsen(target, n_facets)
            planes = target.in_unit_frame(found[evens].half_spaces)
            areas = areas_by_scipy(planes.normals, planes.offsets)
            small[evens].append(float(np.mean(areas < 0.01 * areas.mean())))
        even = found[True]
        assert (even.n_facets, even.reason) == (n_facets, None)
        assert even.jaccard_distance <= found[False].jaccard_distance + 2e-3
        planes = target.in_unit_frame(even.half_spaces)
        values = measured(planes.normals, planes.offsets, 2.0)
        for key in ("volume", "sphericity", "min_diameter", "max_diameter"):
            assert values[key] == pytest.approx(target.descriptors[key], rel=1e-6)
    # Two of six keep theirs: the overlap would fall too much.
    assert sum(small[True]) < 0.6 * sum(small[False])


def test_that_the_polyhedron_with_larger_facets_is_the_last_step(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    target = Target.of(pebble(2))
    told, result = steps_of(target, 35)
    monkeypatch.setattr(multi_start, "has_small_facets", lambda *_: False)
    plain, small = steps_of(target, 35)
    assert len(told) == len(plain) + 1
    assert result.loss_history[:-1] == small.loss_history
    assert result.loss_history[-1] == pytest.approx(result.loss, abs=1e-3)
    assert told[-1].polyhedron is not None
    np.testing.assert_allclose(told[-1].polyhedron.half_spaces.offsets, result.half_spaces.offsets, rtol=1e-9)


def steps_of(target: Target, n_facets: int) -> tuple[list[CoarseningProgress], CoarseningResult]:
    steps, told = coarsening_steps(target, n_facets), []
    while True:
        try:
            told.append(next(steps))
        except StopIteration as end:
            return told, end.value
