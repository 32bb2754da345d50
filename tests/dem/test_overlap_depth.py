"""How deep bodies stand in each other, against the hull of all differences of their points."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.engine import lowest_corners
from regolith_studio.dem.separation import near_pairs, overlap_depths, separations
from regolith_studio.dem.snapshot import ParticleState


def pair(boxes: Dataset) -> PreparedCase:
    """Ten particles, of which the tests look at two."""
    return prepare(boxes, ReposeCase(LiftingCylinderTest(mass=1e-4), n_particles=10, seed=1))


def placed(prepared: PreparedCase, points: np.ndarray, turns: Rotation) -> ParticleState:
    """The first two particles like this, the others far away."""
    far = np.arange(8)[:, None] * np.ones(3) + 10.0
    others = np.tile([1.0, 0, 0, 0], (8, 1))
    return ParticleState(
        np.vstack([points, far]),
        prepared.diameters,
        np.vstack([turns.as_quat(scalar_first=True), others]),
        prepared.class_index,
    )


def corners(prepared: PreparedCase, pile: ParticleState, k: int) -> np.ndarray:
    turn = Rotation.from_quat(pile.orientations[k], scalar_first=True)
    return turn.apply(prepared.shapes[prepared.class_index[k]] * prepared.scales[k]) + pile.points[k]


@pytest.mark.parametrize("seed", range(12))
def test_that_the_depth_is_the_way_out_of_the_hull_of_differences(boxes: Dataset, seed: int) -> None:
    prepared, chance = pair(boxes), np.random.default_rng(seed)
    size = prepared.scales[:2].mean()
    way = chance.normal(size=3)
    points = np.array([[0, 0, 0], 0.75 * size * way / np.linalg.norm(way)])
    pile = placed(prepared, points, Rotation.random(2, random_state=seed))
    one, other = corners(prepared, pile, 0), corners(prepared, pile, 1)
    differences = ConvexHull((one[:, None] - other[None]).reshape(-1, 3))
    expected = -differences.equations[:, 3].max()
    assert expected > 0.0
    assert overlap_depths(prepared, pile) == pytest.approx([expected], rel=1e-9)


def test_that_bodies_that_are_apart_have_no_depth(boxes: Dataset) -> None:
    prepared = pair(boxes)
    points = np.array([[0, 0, 0], [2.0 * prepared.scales.max(), 0, 0]])
    assert len(overlap_depths(prepared, placed(prepared, points, Rotation.identity(2)))) == 0


def test_that_rounded_boxes_overlap_by_both_radii_less_their_distance(boxes: Dataset) -> None:
    """Two boxes above each other, facet to facet, a twentieth of a diameter apart."""
    prepared = pair(boxes)
    halves = [prepared.shapes[prepared.class_index[k]][:, 2].max() * prepared.scales[k] for k in (0, 1)]
    gap = 0.05 * prepared.diameters[:2].mean()
    pile = placed(prepared, np.array([[0, 0, 0], [0, 0, sum(halves) + gap]]), Rotation.identity(2))
    assert len(overlap_depths(prepared, pile, 0.02)) == 0
    expected = 0.03 * prepared.diameters[:2].sum() - gap
    assert overlap_depths(prepared, pile, 0.03) == pytest.approx([expected])


def test_that_the_lowest_corner_is_the_lowest_of_all(boxes: Dataset) -> None:
    prepared = pair(boxes)
    pile = placed(prepared, np.array([[0, 0, 0.01], [0, 0, -0.02]]), Rotation.random(2, random_state=4))
    expected = [corners(prepared, pile, k)[:, 2].min() for k in range(10)]
    assert lowest_corners(prepared, pile) == pytest.approx(expected)


def rounded_stones(n: int) -> PreparedCase:
    """Hulls of few and of many points on a sphere, whose facets and edges differ in number."""
    chance = np.random.default_rng(1)
    shapes = []
    for count in (6, 12, 30):
        ways = chance.normal(size=(count, 3))
        hull = ConvexHull(ways / np.linalg.norm(ways, axis=1)[:, None])
        shapes.append(hull.points / hull.volume ** (1 / 3))
    return PreparedCase(
        ReposeCase(n_particles=n), tuple(shapes), np.arange(n) % 3, chance.uniform(0.6, 1.8, n), 1.0
    )


def test_that_separations_are_those_of_the_hull_of_differences_for_many_pairs_at_once() -> None:
    """Overlaps are its distance from the origin; of bodies that are apart it is at least the separation."""
    n = 60
    prepared = rounded_stones(n)
    points = np.random.default_rng(2).uniform(0.0, 2.8, (n, 3))
    turns = Rotation.random(n, random_state=3)
    pile = ParticleState(points, prepared.diameters, turns.as_quat(scalar_first=True), prepared.class_index)
    pairs = np.array([(a, b) for a in range(n) for b in range(a)])
    pairs = pairs[np.random.default_rng(4).choice(len(pairs), 120, replace=False)]
    found = separations(prepared, pile, pairs, limit=np.inf)
    facets = [
        ConvexHull((corners(prepared, pile, b)[:, None] - corners(prepared, pile, a)).reshape(-1, 3))
        for a, b in pairs
    ]
    expected = np.array([hull.equations[:, 3].max() for hull in facets])
    assert 30 < (expected < 0.0).sum() < 90
    assert found == pytest.approx(expected, abs=1e-7)


def test_that_near_pairs_are_those_whose_spheres_overlap() -> None:
    """A few large spheres among small ones, some of equal size."""
    chance = np.random.default_rng(5)
    points, reach = (
        chance.uniform(0.0, 6.0, (200, 3)),
        chance.choice([0.2, 0.21, 2.0], 200, p=[0.6, 0.38, 0.02]),
    )
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    expected = np.argwhere(np.triu(apart < reach[:, None] + reach[None], k=1))
    found = np.sort(near_pairs(points, reach), axis=1)
    assert len(found) == len(expected) > 100
    assert {*map(tuple, found.tolist())} == {*map(tuple, expected.tolist())}
