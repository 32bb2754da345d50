"""Response surfaces: recovered polynomials, honest intervals, refusals."""

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.studies.repose import (
    ResponseSurface,
    fit_repose_surface,
    fit_response_surface,
    runs_from,
)

from .test_repose_means import document

GRID = np.stack(np.meshgrid(np.linspace(1.0, 2.0, 4), np.linspace(0.6, 0.9, 3)), axis=-1).reshape(-1, 2)
"""Aspect ratios and sphericities."""
NAMES = ("aspect_ratio", "sphericity")


def test_that_a_quadratic_without_noise_is_found_again() -> None:
    def curved(x: np.ndarray) -> np.ndarray:
        return 20 + 5 * x[:, 0] - 12 * x[:, 1] + 3 * x[:, 0] * x[:, 1] - 2 * x[:, 0] ** 2

    found = fit_response_surface(NAMES, GRID, curved(GRID))
    assert found.is_quadratic
    other = np.array([[1.3, 0.71], [1.9, 0.88]])
    mean, half = found.predict(other)
    assert mean == pytest.approx(curved(other))
    assert half == pytest.approx([0.0, 0.0], abs=1e-9)


def test_that_few_points_make_a_linear_surface_whose_effects_are_slope_times_range() -> None:
    found = fit_response_surface(NAMES, GRID[:6], 30 + 4 * GRID[:6, 0] - 10 * GRID[:6, 1])
    assert not found.is_quadratic
    change, _ = found.effects()
    assert change == pytest.approx([4.0 * np.ptp(GRID[:6, 0]), -10.0 * np.ptp(GRID[:6, 1])])


def test_that_intervals_of_95_percent_cover_the_true_angle_in_95_of_100_cases() -> None:
    """Heaps with a noise of 1.7 degrees; 400 cases, so that 95 is known to within two."""
    rng, place, truth = np.random.default_rng(0), np.array([[1.5, 0.75]]), 25 + 6 * 1.5 - 8 * 0.75
    covered = 0
    for _ in range(400):
        angles = 25 + 6 * GRID[:, 0] - 8 * GRID[:, 1] + 1.7 * rng.normal(size=len(GRID))
        mean, half = fit_response_surface(NAMES, GRID, angles).predict(place)
        covered += bool(abs(mean[0] - truth) <= half[0])
    assert 0.93 <= covered / 400 <= 0.97


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (GRID[:3], "needs results at 4 different points or more, got 3"),
        (np.column_stack([GRID[:, 0], 2 * GRID[:, 0]]), "do not vary independently"),
        (np.column_stack([GRID[:, 0], np.full(len(GRID), 0.7)]), "do not vary independently"),
    ],
)
def test_that_results_which_determine_no_surface_are_refused(values: np.ndarray, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        fit_response_surface(NAMES, values, np.zeros(len(values)))


def test_that_heaps_of_one_dataset_count_as_one_result() -> None:
    """Seven datasets, with one heap each or three of the same angle."""
    rng = np.random.default_rng(3)
    statistics = {f"set-{k}": values for k, values in enumerate(GRID[:7])}
    angles = {name: 20.0 + 3.0 * rng.normal() for name in statistics}

    def surface(repeats: int) -> ResponseSurface:
        rows = [
            ("dataset", name, f"{name}-{seed}", document(seed, angle))
            for name, angle in angles.items()
            for seed in range(repeats)
        ]
        return fit_repose_surface(runs_from(rows), statistics, NAMES).surface

    change, half = surface(1).effects()
    assert surface(3).effects()[0] == pytest.approx(change)
    assert surface(3).effects()[1] == pytest.approx(half)
