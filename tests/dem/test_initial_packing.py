"""The column of particles at the start of a simulation."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, cKDTree
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.initial_packing import enclosing_radii, loose_column
from regolith_studio.geometry.arrays import FloatArray

WIDE = LiftingCylinderTest(diameter=0.04, height=0.2)


def placed_parts(prepared: PreparedCase) -> list[list[FloatArray]]:
    """Vertices of the convex parts of every particle in the column, in metres."""
    column = loose_column(prepared)
    turns = Rotation.from_quat(column.orientations, scalar_first=True)
    shapes, scales = prepared.part_vertices, prepared.scales
    return [
        [turns[k].apply(scales[k] * part) + column.points[k] for part in shapes[kind]]
        for k, kind in enumerate(prepared.class_index)
    ]


def common_radius(first: FloatArray, second: FloatArray) -> float:
    """Of the largest ball in both hulls, by a linear programme; at most 0 where no volume is in both."""
    planes = np.concatenate([ConvexHull(each).equations for each in (first, second)])
    cost, sides = np.array([0.0, 0.0, 0.0, -1.0]), np.column_stack([planes[:, :3], np.ones(len(planes))])
    found = linprog(cost, sides, -planes[:, 3], bounds=(None, None))
    assert found.x is not None
    return float(found.x[3])


@pytest.mark.parametrize("data", ["boxes", "elbows"])
def test_that_no_two_particles_of_the_column_overlap(data: str, request: pytest.FixtureRequest) -> None:
    prepared = prepare(request.getfixturevalue(data), ReposeCase(n_particles=60, test=WIDE, seed=3))
    parts = placed_parts(prepared)
    column, reach = loose_column(prepared), enclosing_radii(prepared)
    pairs = cKDTree(column.points).query_pairs(2 * reach.max(), output_type="ndarray")
    near = np.linalg.norm(column.points[pairs[:, 0]] - column.points[pairs[:, 1]], axis=1)
    pairs = pairs[near < reach[pairs].sum(axis=1)]
    assert len(pairs) > 60
    depths = [common_radius(one, two) for i, j in pairs for one in parts[i] for two in parts[j]]
    assert max(depths) < 1e-9 * prepared.mean_diameter


def test_that_all_particles_of_the_column_are_in_the_cylinder_and_above_the_plate(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=300, seed=1))
    corners = np.concatenate([corner for parts in placed_parts(prepared) for corner in parts])
    assert np.hypot(corners[:, 0], corners[:, 1]).max() < prepared.case.test.diameter / 2
    assert corners[:, 2].min() >= 0.0


def test_that_the_column_of_a_test_is_less_than_three_times_as_high_as_its_filling(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=1000, seed=1))
    assert loose_column(prepared).points[:, 2].max() < 3.0 * prepared.fill_height


def test_that_spheres_of_the_column_are_apart(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(n_particles=400, shapes="spheres", seed=1))
    points, diameters = loose_column(prepared).points, prepared.diameters
    pairs = cKDTree(points).query_pairs(diameters.max(), output_type="ndarray")
    apart = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    assert (apart - diameters[pairs].mean(axis=1)).min() > 0.0
    assert (points[:, 2] - diameters / 2).min() >= 0.0


def test_that_particles_that_are_longer_than_the_cylinder_is_wide_get_a_place(boxes: Dataset) -> None:
    """A simulation then pushes them upright."""
    prepared = prepare(boxes, ReposeCase(n_particles=60))
    needles = replace(prepared, shapes=tuple(shape * [20.0, 1.0, 1.0] for shape in prepared.shapes))
    assert enclosing_radii(needles).max() > prepared.case.test.diameter / 2
    points = loose_column(needles).points
    assert np.hypot(points[:, 0], points[:, 1]).max() < prepared.case.test.diameter / 2


def test_that_equal_seeds_give_equal_columns_and_others_do_not(boxes: Dataset) -> None:
    first, again, other = (
        loose_column(prepare(boxes, ReposeCase(n_particles=50, seed=seed))).points for seed in (1, 1, 2)
    )
    assert (first == again).all()
    assert not np.isclose(first, other).all()
