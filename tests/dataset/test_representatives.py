"""Representatives of populations: shares, sizes and quality."""

import csv
from itertools import combinations

import numpy as np
import pytest
from scipy.spatial.distance import cdist
from scipy.stats import norm, wasserstein_distance

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.representatives import (
    choose_representatives,
    medoid_series,
    polyhedra_errors,
    representation_error,
    representation_of,
    sampling_noise,
    shape_features,
)
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import InputError

from .example import entry


def population(n: int = 300, seed: int = 0) -> list[dict[str, float]]:
    """Ellipsoid-like descriptors with log-normal sizes."""
    generator = np.random.default_rng(seed)
    rows = []
    for _ in range(n):
        aspect, volume = 1 + generator.gamma(2, 0.3), generator.lognormal(10, 1)
        diameter = np.cbrt(6 / np.pi * volume)
        rows.append(
            {
                "volume": volume,
                "sphericity": 0.98 / aspect**0.4 - 0.05 * generator.random(),
                "aspect_ratio": aspect,
                "min_diameter": diameter / aspect**0.5,
                "convex_hull_volume": volume * (1.02 + 0.2 * generator.random()),
            }
        )
    return rows


def test_that_features_are_standardised_and_free_of_units() -> None:
    rows = population()
    features = shape_features(rows)
    assert features.mean(axis=0) == pytest.approx(0.0, abs=1e-12)
    assert features.std(axis=0) == pytest.approx(1.0)
    lengths = {"volume": 3, "min_diameter": 1, "convex_hull_volume": 3}
    in_nanometres = [
        {key: value * 1000.0 ** lengths.get(key, 0) for key, value in row.items()} for row in rows
    ]
    assert shape_features(in_nanometres) == pytest.approx(features)


def test_that_weights_are_the_shares_of_particles_and_sizes_those_of_the_members() -> None:
    rows = population()
    chosen = choose_representatives(rows, 6)
    counts = np.bincount(chosen.labels)
    assert [one.n_members for one in chosen.classes] == counts.tolist()
    assert [one.weight for one in chosen.classes] == counts.tolist()
    for index, one in enumerate(chosen.classes):
        volumes = [row["volume"] for row, label in zip(rows, chosen.labels, strict=True) if label == index]
        assert one.sizes.mean_cube() * np.pi / 6 == pytest.approx(np.mean(volumes))


def test_that_the_mixture_of_all_classes_has_the_population_s_sizes() -> None:
    rows = population()
    diameters = np.cbrt(6 / np.pi * np.array([row["volume"] for row in rows]))
    classes = choose_representatives(rows, 8).classes
    at = np.quantile(diameters, [0.1, 0.5, 0.9])
    mixture = sum(one.weight / len(rows) * one.sizes.cdf(at) for one in classes)
    assert mixture == pytest.approx([(diameters <= value).mean() for value in at])


def test_that_counting_by_volume_weighs_classes_by_their_volume() -> None:
    rows = population()
    chosen = choose_representatives(rows, 5, weighting="volume")
    volumes = np.bincount(chosen.labels, weights=[row["volume"] for row in rows])
    weights = np.array([one.weight for one in chosen.classes])
    assert weights / weights.sum() == pytest.approx(volumes / volumes.sum())
    assert all(one.sizes.weighting == "volume" for one in chosen.classes)
    entries = [entry(seed) for seed in range(5)]
    dataset = build_dataset(entries, chosen.classes, weighting="volume")
    shares = np.bincount(chosen.labels) / len(rows)
    assert dataset.class_weights("number") == pytest.approx(shares)


def test_that_a_bigger_population_is_nearer_to_its_material() -> None:
    small, big = sampling_noise(population(100)), sampling_noise(population(1600))
    for key, noise in big.items():
        assert noise < 0.5 * small[key]
        assert noise < 0.1


def test_that_the_noise_of_normal_values_is_that_of_theory(monkeypatch) -> None:
    """800 normal values are as far from the normal law as other 800 are."""
    generator = np.random.default_rng(0)
    rows = [row | {"aspect_ratio": 10 + generator.standard_normal()} for row in population(800)]
    law = norm.ppf((np.arange(20_000) + 0.5) / 20_000)
    draws = [wasserstein_distance(generator.standard_normal(800), law) for _ in range(200)]
    monkeypatch.setattr("regolith_studio.dataset.representatives.HALVINGS", 200)
    assert sampling_noise(rows)["aspect_ratio"] == pytest.approx(np.mean(draws), rel=0.2)


def test_that_size_separates_classes_when_it_is_asked_to() -> None:
    rows = population()
    sizes = np.log([row["volume"] for row in rows])

    def spread(importance: float) -> float:
        labels = choose_representatives(rows, 8, size_importance=importance).labels
        return float(np.mean([sizes[labels == index].std() for index in range(8)]))

    assert spread(2.0) < 0.7 * spread(0.0)


def test_that_descriptors_which_are_missing_or_impossible_are_refused() -> None:
    rows = population(5)
    with pytest.raises(InputError, match="without the descriptor sphericity"):
        choose_representatives([{k: v for k, v in row.items() if k != "sphericity"} for row in rows], 2)
    rows[2]["volume"] = -1.0
    with pytest.raises(InputError, match="Particle 3"):
        choose_representatives(rows, 2)


def test_that_ten_real_particles_stand_for_the_cement_better_than_ten_at_random(real_data) -> None:
    """Medoids of 3,338 scanned particles: W1 of area and elongation below half of a random choice's."""
    rows = []
    with real_data("cement140/geometry.csv").open(newline="") as file:
        for line in csv.reader(file):
            *_, length, width, thickness, _, _ = (float(value) for value in line[1:])
            volume, area = float(line[7]), float(line[8])
            sphericity = np.pi ** (1 / 3) * (6 * volume) ** (2 / 3) / area
            rows.append(
                {
                    "volume": volume,
                    "sphericity": sphericity,
                    "aspect_ratio": max(length / thickness, 1.0),
                    "min_diameter": thickness,
                    "convex_hull_volume": volume * (1 + 0.1 * (width / length)),
                }
            )
    chosen = representation_error(rows, choose_representatives(rows, 10))
    assert chosen["aspect_ratio"] < 0.25
    assert chosen["sphericity"] < 0.25


def test_that_errors_of_the_written_shapes_are_those_of_their_polyhedra_and_not_of_their_sources() -> None:
    """One polyhedron for a population: every particle is as far away as its AR and S say."""
    rows = population()
    chosen = choose_representatives(rows, 1)
    dataset = build_dataset([entry(0)], chosen.classes)
    known = representation_of(rows, chosen)
    found = polyhedra_errors(dataset, known)
    shape = describe(dataset.representatives[0].shape, ("aspect_ratio", "sphericity"))
    for key, value in shape.items():
        each = np.array([row[key] for row in rows])
        assert found[key] == pytest.approx(np.abs(each - value).mean() / each.std(), rel=0.01)
    assert found["convexity"] > known.source_errors["convexity"]
    scale = (np.pi / 6) ** (1 / 3) * describe(dataset.representatives[0].shape, ("min_diameter",))[
        "min_diameter"
    ]
    lengths = np.array([row["min_diameter"] for row in rows])
    diameters = np.cbrt(6 / np.pi * np.array([row["volume"] for row in rows]))
    expected = wasserstein_distance(lengths, scale * diameters) / lengths.std()
    assert found["min_diameter"] == pytest.approx(expected, rel=0.03)


def cost(points: np.ndarray, chosen, weights=None) -> float:
    nearest = cdist(points, points[list(chosen)]).min(axis=1)
    return float(nearest.sum() if weights is None else nearest @ weights)


def k_medoids(points: np.ndarray, k: int, *weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return next(medoid_series(points, (k,), *weights))


@pytest.mark.parametrize("k", [1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_that_the_choice_is_within_two_per_cent_of_the_best_of_all(k: int, seed: int) -> None:
    generator = np.random.default_rng(seed)
    points, weights = generator.standard_normal((25, 2)), generator.uniform(0.5, 2.0, 25)
    chosen, _ = k_medoids(points, k, weights)
    best = min(cost(points, group, weights) for group in combinations(range(25), k))
    assert cost(points, chosen, weights) <= best * (1.02 if k > 1 else 1 + 1e-12)


def test_that_every_point_belongs_to_its_nearest_medoid_and_medoids_to_themselves() -> None:
    points = np.random.default_rng(1).standard_normal((200, 3))
    chosen, labels = k_medoids(points, 12)
    assert np.array_equal(labels[chosen], np.arange(12))
    assert np.array_equal(labels, cdist(points, points[chosen]).argmin(axis=1))


def test_that_heavy_points_attract_the_medoid() -> None:
    points = np.array([[0.0], [1.0], [10.0]])
    assert k_medoids(points, 1)[0].tolist() == [1]
    assert k_medoids(points, 1, np.array([1.0, 1.0, 5.0]))[0].tolist() == [2]


def test_that_all_points_can_be_chosen_and_twins_keep_their_own_class() -> None:
    points = np.zeros((4, 2))
    chosen, labels = k_medoids(points, 4)
    assert chosen.tolist() == labels.tolist() == [0, 1, 2, 3]


def test_that_large_populations_are_searched_on_a_subset(monkeypatch) -> None:
    monkeypatch.setattr("regolith_studio.dataset.representatives.MAX_TABLE_SIZE", 100)
    points = np.random.default_rng(3).standard_normal((1000, 2))
    chosen, labels = k_medoids(points, 5)
    again, _ = k_medoids(points, 5)
    assert np.array_equal(chosen, again)
    assert len(labels) == 1000
    assert cost(points, chosen) < 1.3 * cost(points, k_medoids(points[:1000], 5)[0])


@pytest.mark.parametrize("k", [0, 4])
def test_that_an_impossible_number_is_refused(k: int) -> None:
    with pytest.raises(InputError, match="Between 1 and 3"):
        k_medoids(np.zeros((3, 2)), k)
