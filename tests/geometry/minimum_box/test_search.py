"""Curves of boxes flush with two edges, and the bounds along them, against plain arithmetic."""

import numpy as np
import pytest

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.minimum_box.edge_pair import (
    Curve,
    all_positive,
    argmin_ratio,
    curve_between,
    denominator,
    factors_of,
    frame_on,
    is_above_limit,
    numerator,
    value,
)
from regolith_studio.geometry.minimum_box.hull_topology import (
    Facets,
    arcs_of,
    extreme_vertices,
    facet_excluded,
    facets_of_hull,
    min_third_extent,
    span_near,
    span_table,
)
from regolith_studio.geometry.oriented_box import minimum_volume_box
from regolith_studio.geometry.sphere_points import icosphere
from tests.geometry.solids import random_polyhedron


def unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.linalg.norm(vector))


def random_curve(seed: int) -> tuple[Curve, FloatArray, FloatArray]:
    """A curve about two random edges, and their directions."""
    rng = np.random.default_rng(seed)
    edge_a, edge_b = unit(rng.normal(size=3)), unit(rng.normal(size=3))
    start = unit(np.cross(edge_a, rng.normal(size=3)))
    angle = rng.uniform(0.05, 0.5)
    end = np.cos(angle) * start + np.sin(angle) * np.cross(edge_a, start)
    ends = [unit(np.cross(edge_b, each)) for each in (start, end)]
    frames = [tuple(v.tolist()) for v in (edge_a, edge_b, start, ends[0], end, ends[1])]
    return curve_between(*frames), edge_a, edge_b


def closed_facets(hull: Mesh) -> Facets:
    facets = facets_of_hull(hull.vertices, hull.faces)
    assert facets is not None
    return facets


def on(points: FloatArray) -> FloatArray:
    return np.ascontiguousarray(points.T)


@pytest.mark.parametrize("seed", range(20))
def test_that_every_frame_on_a_curve_is_flush_with_both_edges(seed: int) -> None:
    curve, edge_a, edge_b = random_curve(seed)
    for x in np.linspace(curve.low, curve.high, 7):
        frame = np.array(frame_on(curve, x))
        assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
        assert abs(frame[0] @ edge_a) + abs(frame[1] @ edge_b) < 1e-12


@pytest.mark.parametrize("seed", range(20))
def test_that_the_ratio_of_the_quartics_is_the_product_of_three_distances(seed: int) -> None:
    curve, _, _ = random_curve(seed)
    spans = np.random.default_rng(seed).normal(size=(3, 3))
    factors = factors_of(curve, *(tuple(span.tolist()) for span in spans), curve.low)
    for x in np.linspace(curve.low, curve.high, 7):
        distances = [axis @ span for axis, span in zip(np.array(frame_on(curve, x)), spans, strict=True)]
        ratio = value(numerator(factors), x) / value(denominator(curve), x)
        assert abs(ratio) == pytest.approx(abs(np.prod(distances)), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("seed", range(60))
def test_that_what_is_proven_is_true_on_a_fine_grid(seed: int) -> None:
    rng = np.random.default_rng(seed)
    curve, _, _ = random_curve(seed)
    spans = (tuple(v) for v in np.array(frame_on(curve, 0.0)) + 0.3 * rng.normal(size=(3, 3)))
    factors, x = factors_of(curve, *spans, 0.0), np.linspace(curve.low, curve.high, 500)
    top, bottom = numerator(factors), denominator(curve)
    ratio = value.py_func(top, x) / value.py_func(bottom, x)  # type: ignore[attr-defined]
    limit = float(ratio.min() * rng.uniform(0.8, 1.2))
    if all_positive(factors, curve.low, curve.high):
        assert ratio.min() > 0.0
        assert not is_above_limit(top, bottom, limit, curve.low, curve.high) or ratio.min() >= limit
        assert not is_above_limit(top, bottom, 1.001 * ratio.min(), curve.low, curve.high)
        assert is_above_limit(top, bottom, 0.0, curve.low, curve.high)
        best = argmin_ratio(top, bottom, curve.low, curve.high)
        at = value(top, best) / value(bottom, best)
        assert at == pytest.approx(ratio.min(), rel=1e-4)


@pytest.mark.parametrize("seed", range(5))
def test_that_no_span_of_the_table_is_longer_than_the_solid_is_wide(seed: int) -> None:
    points = random_polyhedron(seed, 20).vertices
    table = span_table(on(points))
    for direction in np.random.default_rng(seed).normal(size=(200, 3)):
        way = unit(direction)
        top, bottom = extreme_vertices(on(points), tuple(way))
        width = np.ptp(points @ way)
        assert way @ (points[top] - points[bottom]) == pytest.approx(width, rel=1e-14)
        assert 0.9 * width < abs(way @ np.array(span_near(table, tuple(way)))) <= width * (1 + 1e-14)


@pytest.mark.slow
def test_that_a_fine_ball_has_a_box_within_a_thousandth_whichever_way_it_is_turned() -> None:
    """Its edges cannot all be asked; the box of the sphere itself has the volume 8."""
    ball, (spin, _) = icosphere(5).vertices, np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    volumes = [minimum_volume_box(Mesh(points, icosphere(5).faces)).volume for points in (ball, ball @ spin)]
    assert volumes == pytest.approx([volumes[0]] * 2, rel=1e-3)
    assert 7.98 < min(volumes) <= max(volumes) < 8.0


def test_that_no_box_is_narrower_than_the_bound_on_its_third_side() -> None:
    ball = icosphere(2)
    solid = Mesh(
        ball.vertices * (1.0, 0.8, 0.6) + 0.05 * np.sin(7.0 * ball.vertices[:, ::-1]), ball.faces
    ).hull
    facets = closed_facets(solid)
    arcs, table, rng = arcs_of(facets), span_table(facets.points), np.random.default_rng(8)
    useful = 0
    for i, k in rng.integers(len(arcs), size=(4000, 2)):
        bound = min_third_extent(arcs, table, i, k)
        if bound <= 0.0:
            continue
        for share in rng.random((4, 1)):
            ends = facets.normals[facets.edges[i, 2:]]
            a = share * ends[0] + (1.0 - share) * ends[1]
            # where the plane normal to a meets the other arc
            three, four = facets.normals[facets.edges[k, 2:]] @ a
            if three * four > 0.0:
                continue
            b = facets.normals[facets.edges[k, 2]] * four - facets.normals[facets.edges[k, 3]] * three
            c = np.cross(a, b) / np.linalg.norm(a) / np.linalg.norm(b)
            assert np.ptp(c @ facets.points) >= bound * (1.0 - 1e-12)
            useful += 1
    assert useful > 100


def test_that_a_facet_on_which_nothing_is_said_to_stand_bears_no_smaller_box() -> None:
    hull = random_polyhedron(1, 20).hull
    solid = closed_facets(hull)
    table, turns = span_table(solid.points), np.linspace(0.0, np.pi / 2, 401)
    said = 0
    for axis in solid.normals:
        first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        first /= np.linalg.norm(first)
        second, height = np.cross(axis, first), float(np.ptp(axis @ solid.points))
        b = np.outer(np.cos(turns), first) + np.outer(np.sin(turns), second)
        c = np.cross(axis, b)
        least = height * (np.ptp(b @ solid.points, axis=1) * np.ptp(c @ solid.points, axis=1)).min()
        for share in (0.8, 0.9, 0.95):
            said += facet_excluded(table, tuple(axis), height, share * least)
        assert not facet_excluded(table, tuple(axis), height, 1.0001 * least)
    assert said > 10
