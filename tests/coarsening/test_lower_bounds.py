"""What no polyhedron can do better."""

import numpy as np
import pytest

from regolith_studio.coarsening.lower_bounds import (
    attainable_errors,
    bounds_in_force,
    max_sphericity,
    min_facets,
    sphericity_reason,
)
from regolith_studio.coarsening.weights import LossWeights

SHAPE = {"volume": 0.8, "convex_hull_volume": 1.0, "sphericity": 0.9}


def test_that_the_platonic_solids_attain_goldbergs_bound() -> None:
    tetrahedron = np.pi ** (1 / 3) * (6 * np.sqrt(2) / 12) ** (2 / 3) / np.sqrt(3)
    cube = (np.pi / 6) ** (1 / 3)
    golden = (1 + 5**0.5) / 2
    dodecahedron = np.pi ** (1 / 3) * (6 * (15 + 7 * 5**0.5) / 4) ** (2 / 3) / (3 * np.sqrt(25 + 10 * 5**0.5))
    assert golden > 1
    assert max_sphericity(4) == pytest.approx(tetrahedron)
    assert max_sphericity(6) == pytest.approx(cube)
    assert max_sphericity(12) == pytest.approx(dodecahedron)


def test_that_the_fewest_faces_are_the_first_whose_bound_reaches() -> None:
    n = min_facets(0.957)
    assert n is not None
    assert max_sphericity(n) >= 0.957 > max_sphericity(n - 1)
    assert min_facets(0.999999999) is None


def test_that_an_impossible_sphericity_is_explained_with_numbers() -> None:
    assert sphericity_reason(0.957, 20) == (
        f"Sphericity 0.957 needs at least {min_facets(0.957)} facets; with 20 the most is 0.948."
    )
    assert sphericity_reason(0.9, 20) is None
    close = sphericity_reason(max_sphericity(20) + 1e-5, 20)
    assert close is not None
    assert close.startswith("Sphericity 0.94772 needs at least 21 facets; with 20 the most is 0.94771.")


def test_that_volume_and_hull_cannot_both_be_met() -> None:
    both = attainable_errors(SHAPE, 20, LossWeights.from_preset("all"))
    assert both["volume"] == 0.0
    assert both["convex_hull_volume"] == pytest.approx(0.2)
    hull = attainable_errors(SHAPE, 20, LossWeights.of(convex_hull_volume=1, volume=0.1))
    assert hull["convex_hull_volume"] == 0.0
    assert hull["volume"] == pytest.approx(0.25)


@pytest.mark.parametrize("volume", [0.5, 0.8, 0.87, 0.999, 1.0, 1.1])
@pytest.mark.parametrize("of_hull", [1.0, 3.0])
def test_that_no_convex_polyhedron_is_better_than_a_bound_in_force(volume: float, of_hull: float) -> None:
    weights = LossWeights.of(volume=1.0, convex_hull_volume=of_hull)
    errors = {"volume": abs(volume / 0.8 - 1.0), "convex_hull_volume": abs(volume - 1.0)}
    held = bounds_in_force(attainable_errors(SHAPE, 20, weights), errors)
    for key, error in errors.items():
        assert error >= held[key] - 1e-12


@pytest.mark.parametrize(("of_volume", "of_hull"), [(1, 1), (1, 3), (2, 1), (0, 1)])
def test_that_the_bounds_sum_to_the_least_loss_of_all_volumes(of_volume: float, of_hull: float) -> None:
    volumes = np.linspace(0.5, 1.5, 200_001)
    losses = of_volume * abs(volumes - 0.8) / 0.8 + of_hull * abs(volumes - 1.0)
    weights = LossWeights.of(volume=of_volume, convex_hull_volume=of_hull)
    bounds = attainable_errors(SHAPE, 20, weights)
    assert sum(weights[key] * bound for key, bound in bounds.items()) == pytest.approx(losses.min(), abs=1e-5)


def test_that_the_bound_of_the_hull_is_in_force_where_the_volume_is_exact() -> None:
    bounds = attainable_errors(SHAPE, 20, LossWeights.from_preset("all"))
    assert bounds_in_force(bounds, {"volume": 1e-7, "convex_hull_volume": 0.2}) == bounds
