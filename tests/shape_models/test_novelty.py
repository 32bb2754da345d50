"""Novelty over rotations: copies are found however they are turned."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.transform import rotated
from regolith_studio.shape_models.goodness_of_fit import distances_among, nearest_over_rotations
from regolith_studio.shape_models.inertia_ellipsoid import canonical
from regolith_studio.shape_models.sample import Sample


def turned(rows: np.ndarray, largest: float, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    spins = Rotation.from_rotvec(largest * rng.uniform(-1, 1, (len(rows), 3))).as_matrix()
    pairs = zip(rows, spins, strict=True)
    return np.stack([rotated(ShCoefficients(row), spin).values for row, spin in pairs])


def test_that_a_copy_turned_by_half_a_radian_is_found_as_its_own_parent(
    rough_sample: Callable[..., Sample],
) -> None:
    rows = canonical(rough_sample(40, 5).coefficients)
    distances, nearest = nearest_over_rotations(rows, turned(rows[:8], 0.4))
    assert nearest.tolist() == list(range(8))
    np.testing.assert_allclose(distances, 0.0, atol=1e-6)


def test_that_axes_that_change_places_do_not_make_a_copy_new(rough_sample: Callable[..., Sample]) -> None:
    rows = canonical(rough_sample(30, 4).coefficients)
    quarter = Rotation.from_euler("z", 90, degrees=True).as_matrix()
    copies = np.stack([rotated(ShCoefficients(row), quarter).values for row in rows[:5]])
    assert nearest_over_rotations(rows, copies)[0].max() < 1e-6


def test_that_others_of_the_same_kind_are_as_new_as_measured_ones_are_to_each_other(
    rough_sample: Callable[..., Sample],
) -> None:
    measured, others = (canonical(rough_sample(60, 4, seed).coefficients) for seed in (0, 1))
    unit = np.median(distances_among(measured, np.arange(0, 60, 2)))
    assert np.median(nearest_over_rotations(measured, others[:30])[0]) / unit == pytest.approx(1.0, abs=0.15)
