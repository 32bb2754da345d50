"""Locally minimal boxes and how they follow the planes."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.core.box import Solid, box_at, empty_touch, scratch_for
from regolith_studio.coarsening.core.box_change import contact_points, extent_forces
from regolith_studio.coarsening.core.box_search import DENSE_ANGLE, SAMPLE_ANGLE, likeness, local_boxes
from regolith_studio.coarsening.core.intersection import edges_of, intersect
from regolith_studio.coarsening.core.measures import facets_of, vertex_charge
from regolith_studio.coarsening.core.planes import gradient_of, levers_of, moved, tangents_of
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.oriented_box import minimum_volume_box

EVERYWHERE = np.empty((0, 3, 3))


def random_planes(n: int, seed: int) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(n, 3)) * (1.0, 1.4, 0.8)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True), rng.uniform(0.8, 1.2, n)


def solid_of(normals: FloatArray, offsets: FloatArray) -> tuple[Solid, FloatArray]:
    _, vertices, triples = intersect(normals, offsets)
    edges = edges_of(triples, len(offsets))
    area, _ = facets_of(normals, offsets, vertices, edges)
    return Solid(vertices, normals, area, edges), triples


@pytest.mark.parametrize("n", [10, 20, 50])
def test_that_the_least_box_is_the_exact_one(n: int) -> None:
    for seed in range(3):
        normals, offsets = random_planes(n, seed)
        boxes = local_boxes(solid_of(normals, offsets)[0], 0.02, DENSE_ANGLE, EVERYWHERE)
        exact = minimum_volume_box(ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, offsets)))
        assert boxes.volumes[0] == pytest.approx(exact.volume, rel=1e-6)
        assert np.sort(boxes.extents[0])[::-1] == pytest.approx(exact.extents, rel=1e-6)


def test_that_every_box_holds_all_vertices() -> None:
    normals, offsets = random_planes(20, 7)
    solid, _ = solid_of(normals, offsets)
    boxes = local_boxes(solid, 0.05, SAMPLE_ANGLE, EVERYWHERE)
    for frame, extents in zip(boxes.frames, boxes.extents, strict=True):
        along = solid.vertices @ frame.T
        assert np.ptp(along, axis=0) == pytest.approx(extents, rel=1e-6)


def test_that_looking_near_a_box_finds_it() -> None:
    normals, offsets = random_planes(20, 4)
    solid, _ = solid_of(normals, offsets)
    everywhere = local_boxes(solid, 0.05, SAMPLE_ANGLE, EVERYWHERE)
    near = local_boxes(solid, 0.05, SAMPLE_ANGLE, everywhere.frames[:1])
    assert near.volumes[0] == pytest.approx(everywhere.volumes[0], rel=1e-9)


@pytest.mark.parametrize("seed", range(10))
def test_that_the_box_on_an_axis_stands_on_the_least_rectangle_of_the_shadow(seed: int) -> None:
    solid, _ = solid_of(*random_planes(30, seed))
    axis = np.random.default_rng(seed).normal(size=3)
    axis /= np.linalg.norm(axis)
    frame = np.linalg.qr(np.column_stack([axis, np.eye(3)]))[0][:, 1:3]
    shadow = solid.vertices @ frame
    corners = shadow[ConvexHull(shadow).vertices]
    areas = []
    for side in np.roll(corners, -1, axis=0) - corners:
        way = side / np.linalg.norm(side)
        areas.append(np.ptp(corners @ way) * np.ptp(corners @ [-way[1], way[0]]))
    touch = empty_touch()
    volume = box_at(tuple(axis.tolist()), solid, np.inf, scratch_for(solid), touch)
    assert volume == pytest.approx(min(areas) * np.ptp(solid.vertices @ axis), rel=1e-12)
    assert np.ptp(solid.vertices @ touch.frame.T, axis=0) == pytest.approx(touch.extents, rel=1e-12)


def test_that_the_compiled_box_is_its_python_reference() -> None:
    solid, _ = solid_of(*random_planes(12, 3))
    axis = (0.36, 0.48, 0.8)
    one, two = empty_touch(), empty_touch()
    volume = box_at(axis, solid, np.inf, scratch_for(solid), one)
    assert box_at.py_func(axis, solid, np.inf, scratch_for(solid), two) == pytest.approx(volume, rel=1e-14)
    assert np.allclose(one.frame, two.frame)


@pytest.mark.parametrize("seed", range(8))
def test_that_the_edges_follow_the_planes_as_finite_differences_say(seed: int) -> None:
    normals, offsets = random_planes((12, 20)[seed % 2], seed)
    n = len(offsets)
    solid, triples = solid_of(normals, offsets)
    boxes = local_boxes(solid, 0.02, SAMPLE_ANGLE, EVERYWHERE)
    frames, levers = tangents_of(normals), levers_of(solid.areas, 0.1)
    _, pivots = facets_of(normals, offsets, solid.vertices, solid.edges)
    contact = boxes.contacts[0]
    forces = np.empty((3, 10, 3))
    points, axis = contact_points(solid.vertices, contact), tuple(boxes.frames[0, 0].tolist())
    extents = extent_forces(points, contact[0], axis, forces)
    step = 1e-6 * np.random.default_rng(seed).normal(size=3 * n)

    def edges_after(change: FloatArray) -> FloatArray:
        turned, shifted = moved(normals, pivots, offsets, frames, levers, change)
        then, _ = solid_of(turned, shifted)
        found = local_boxes(then, 0.02, SAMPLE_ANGLE, EVERYWHERE)
        alike = int(np.argmax([likeness(frame, boxes.frames[0]) for frame in found.frames]))
        settled = extent_forces(
            contact_points(then.vertices, found.contacts[alike]),
            found.contacts[alike, 0],
            tuple(found.frames[alike, 0].tolist()),
            np.empty((3, 10, 3)),
        )
        return np.log(np.sort(settled))

    change = (edges_after(step) - edges_after(-step)) / 2
    for k, rank in zip(np.argsort(extents), range(3), strict=True):
        charge = np.zeros((n, 4))
        for i in range(10):
            v = contact[1 + i]
            if v >= 0:
                vertex_charge(normals, triples[v], solid.vertices[v], forces[k, i].copy(), pivots, charge)
        assert gradient_of(charge, frames, levers) @ step == pytest.approx(change[rank], rel=2e-3, abs=1e-9)
