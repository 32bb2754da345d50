"""k-medoids against exhaustive search, and on data whose clusters are known."""

from itertools import combinations

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from regolith_studio.dataset.k_medoids import k_medoids
from regolith_studio.errors import InputError


def cost(points: np.ndarray, chosen, weights=None) -> float:
    nearest = cdist(points, points[list(chosen)]).min(axis=1)
    return float(nearest.sum() if weights is None else nearest @ weights)


@pytest.mark.parametrize("k", [1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_that_the_choice_is_within_two_per_cent_of_the_best_of_all(k: int, seed: int) -> None:
    generator = np.random.default_rng(seed)
    points, weights = generator.standard_normal((25, 2)), generator.uniform(0.5, 2.0, 25)
    chosen, _ = k_medoids(points, k, weights)
    best = min(cost(points, group, weights) for group in combinations(range(25), k))
    assert cost(points, chosen, weights) <= best * (1.02 if k > 1 else 1 + 1e-12)


def test_that_separate_clusters_get_one_medoid_each() -> None:
    generator = np.random.default_rng(0)
    centres = np.array([[0, 0], [10, 0], [0, 10], [10, 10]])
    points = np.concatenate([centre + 0.5 * generator.standard_normal((30, 2)) for centre in centres])
    chosen, labels = k_medoids(points, 4)
    assert sorted(chosen // 30) == [0, 1, 2, 3]
    assert all(len(set(labels[30 * c : 30 * c + 30])) == 1 for c in range(4))


def test_that_every_point_belongs_to_its_nearest_medoid_and_medoids_to_themselves() -> None:
    points = np.random.default_rng(1).standard_normal((200, 3))
    chosen, labels = k_medoids(points, 12)
    assert np.array_equal(labels[chosen], np.arange(12))
    assert np.array_equal(labels, cdist(points, points[chosen]).argmin(axis=1))


def test_that_no_single_swap_improves_the_choice() -> None:
    points = np.random.default_rng(2).standard_normal((40, 2))
    chosen, _ = k_medoids(points, 5)
    total = cost(points, chosen)
    for out in range(5):
        for new in range(40):
            assert cost(points, [*np.delete(chosen, out), new]) >= total - 1e-9


def test_that_heavy_points_attract_the_medoid() -> None:
    points = np.array([[0.0], [1.0], [10.0]])
    assert k_medoids(points, 1)[0].tolist() == [1]
    assert k_medoids(points, 1, np.array([1.0, 1.0, 5.0]))[0].tolist() == [2]


def test_that_all_points_can_be_chosen_and_twins_keep_their_own_class() -> None:
    points = np.zeros((4, 2))
    chosen, labels = k_medoids(points, 4)
    assert chosen.tolist() == labels.tolist() == [0, 1, 2, 3]


def test_that_large_populations_are_searched_on_a_subset(monkeypatch) -> None:
    monkeypatch.setattr("regolith_studio.dataset.k_medoids.MAX_TABLE_SIZE", 100)
    points = np.random.default_rng(3).standard_normal((1000, 2))
    chosen, labels = k_medoids(points, 5, seed=4)
    again, _ = k_medoids(points, 5, seed=4)
    assert np.array_equal(chosen, again)
    assert len(labels) == 1000
    assert cost(points, chosen) < 1.3 * cost(points, k_medoids(points[:1000], 5)[0])


@pytest.mark.parametrize("k", [0, 4])
def test_that_an_impossible_number_is_refused(k: int) -> None:
    with pytest.raises(InputError, match="Between 1 and 3"):
        k_medoids(np.zeros((3, 2)), k)
