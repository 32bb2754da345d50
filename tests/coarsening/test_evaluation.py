"""The compiled loss against Eq. 9 written out from the public descriptors."""

import numpy as np
import pytest

from regolith_studio.coarsening.core import box_flush
from regolith_studio.coarsening.core.box import Solid
from regolith_studio.coarsening.core.box_flush import box_on_facets
from regolith_studio.coarsening.core.evaluate import least_extents
from regolith_studio.coarsening.core.intersection import edges_of, intersect
from regolith_studio.coarsening.core.measures import facets_of
from regolith_studio.coarsening.decimated_hull import quadric_half_spaces
from regolith_studio.coarsening.evaluation import LossFunction
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.oriented_box import minimum_volume_box
from tests.geometry.solids import rough_stone


def planes_of(target: Target, n_facets: int) -> HalfSpaces:
    """Planes of the decimated hull with its ties broken."""
    planes = quadric_half_spaces(target, n_facets)
    return HalfSpaces(
        planes.normals, planes.offsets * (1 + 1e-6 * np.random.default_rng(0).random(len(planes)))
    )


@pytest.mark.parametrize("seed", range(4))
def test_that_the_loss_is_the_weighted_sum_of_the_public_errors(seed: int) -> None:
    target = Target.of(rough_stone(seed))
    planes = planes_of(target, 20)
    weights = LossWeights.of(**{key: 0.5 + k for k, key in enumerate((*LOSS_KEYS, "jaccard_distance"))})
    found = describe(ConvexPolyhedron.from_half_spaces(planes))
    wanted = sum(
        weights[key] * abs(found[key] - target.descriptors[key]) / target.descriptors[key]
        for key in LOSS_KEYS
    )
    wanted += weights["jaccard_distance"] * target.jaccard_distance(planes)
    loss = LossFunction(target, weights)
    evaluation = loss(planes.normals, planes.offsets)
    assert evaluation is not None
    assert evaluation.loss == pytest.approx(wanted, rel=5e-3)
    assert loss.value(planes.normals, planes.offsets) == pytest.approx(evaluation.loss, rel=1e-12)


def test_that_half_spaces_that_bound_nothing_have_an_infinite_loss() -> None:
    loss = LossFunction(Target.of(rough_stone(0)), LossWeights.from_preset("all"))
    assert loss.value(np.eye(3), np.ones(3)) == np.inf
    assert loss(np.eye(3), np.ones(3)) is None


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("n_facets", [6, 20, 60])
def test_that_the_quick_box_is_the_least_with_a_side_on_a_facet(n_facets: int, seed: int) -> None:
    target = Target.of(rough_stone(seed))
    planes = planes_of(target, n_facets)
    normals, offsets = np.array(planes.normals), np.array(planes.offsets)
    _, vertices, triples = intersect(normals, offsets)
    edges = edges_of(triples, len(offsets))
    areas, _ = facets_of(normals, offsets, vertices, edges)
    least = np.inf
    for axis in normals[areas > 0.0]:
        across = np.cross(vertices[edges[:, 1]] - vertices[edges[:, 0]], axis)
        across /= np.linalg.norm(across, axis=1)[:, None]
        along = np.cross(axis, across)
        area = np.ptp(vertices @ across.T, axis=0) * np.ptp(vertices @ along.T, axis=0)
        least = min(least, float(area.min() * np.ptp(vertices @ axis)))
    quick = np.prod(box_on_facets(Solid(vertices, normals, areas, edges)))
    assert quick == pytest.approx(least, rel=1e-9)
    weights = LossWeights.from_preset("descriptors")
    on_facets = LossFunction(target, weights, on_facets=True)(normals, offsets)
    exact = LossFunction(target, weights)(normals, offsets)
    assert on_facets is not None
    assert exact is not None
    assert on_facets.errors["volume"] == exact.errors["volume"]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("n_facets", [6, 12, 20, 60])
def test_that_the_least_box_is_the_public_one(n_facets: int, seed: int) -> None:
    target = Target.of(rough_stone(seed))
    planes = planes_of(target, n_facets)
    # a corner is cut so little that some edges are too short to have a direction
    solid = ConvexPolyhedron.from_half_spaces(planes)
    corner = solid.vertices[seed]
    normal = corner / np.linalg.norm(corner)
    reach = float((solid.vertices @ normal).max())
    normals = np.vstack([planes.normals, normal])
    offsets = np.append(planes.offsets, reach - 1e-10)
    _, vertices, triples = intersect(normals, offsets)
    edges = edges_of(triples, len(offsets))
    sides = np.ascontiguousarray(edges[:, [2, 3, 0, 1]].T)
    extents = least_extents(normals, np.ascontiguousarray(vertices.T), sides)
    assert np.sort(extents) == pytest.approx(np.sort(minimum_volume_box(solid).extents), rel=1e-7)


def test_that_the_compiled_quick_box_is_its_python_reference() -> None:
    target = Target.of(rough_stone(1))
    planes = planes_of(target, 12)
    normals, offsets = np.array(planes.normals), np.array(planes.offsets)
    _, vertices, triples = intersect(normals, offsets)
    edges = edges_of(triples, len(offsets))
    areas, _ = facets_of(normals, offsets, vertices, edges)
    desk = np.zeros((box_flush.DESK, box_flush.room_for(len(normals), len(vertices))))
    desk[box_flush.NORMALS : box_flush.NORMALS + 3, : len(normals)] = normals.T
    desk[box_flush.AREAS, : len(normals)] = areas
    desk[box_flush.POINTS : box_flush.POINTS + 3, : len(vertices)] = vertices.T
    sides = np.zeros((box_flush.EDGES, len(edges)), np.int64)
    sides[[box_flush.FROM, box_flush.TO, box_flush.ONE, box_flush.OTHER]] = edges.T
    other, marks = desk.copy(), sides.copy()
    axis = tuple(normals[3].tolist())
    box_flush.bounded(desk, len(normals), len(vertices))
    box_flush.bounded.py_func(other, len(normals), len(vertices))
    box_flush.looked_up(axis, desk, sides, len(normals))
    box_flush.looked_up.py_func(axis, other, marks, len(normals))
    scale = box_flush.project(axis, desk, len(vertices))
    assert box_flush.project.py_func(axis, other, len(vertices)) == scale
    count = box_flush.rim_of(desk, sides, len(normals), len(edges))
    assert box_flush.rim_of.py_func(other, marks, len(normals), len(edges)) == count
    for rows in (desk, other):
        rows[box_flush.VOLUME] = np.inf
    least = box_flush.least_on_rim(count, desk, 1.0, scale)
    with np.errstate(invalid="ignore"):
        assert box_flush.least_on_rim.py_func(count, other, 1.0, scale) == least
    assert np.array_equal(desk, other, equal_nan=True)
