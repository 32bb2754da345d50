"""Samples of synthetic particles, and one of real ones."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.harmonics.coefficients import degrees, orders
from regolith_studio.harmonics.io import from_complex_rows
from regolith_studio.shape_models.sample import Sample


def _rough_sample(n: int = 60, l_max: int = 6, seed: int = 0, spread: float = 0.3) -> Sample:
    """Log-normal sizes about 10 um and amplitudes of the order that real grains have."""
    rng = np.random.default_rng(seed)
    degree = degrees((l_max + 1) ** 2)
    rows = rng.normal(size=(n, (l_max + 1) ** 2)) * 0.25 * np.maximum(degree, 1.0) ** -2
    rows[:, 0] = np.sqrt(4 * np.pi)
    return Sample(rows * 10 * np.exp(spread * rng.normal(size=(n, 1))))


@pytest.fixture(scope="session")
def rough_sample() -> Callable[..., Sample]:
    """``rough_sample(n=60, l_max=6, seed=0, spread=0.3)``."""
    return _rough_sample


@pytest.fixture(scope="session")
def cement(real_data: Callable[[str], Path]) -> Sample:
    """300 real particles at l_max 20, from their complex coefficients."""
    with np.load(real_data("cement140/coefficients.npz")) as stored:
        table, names = stored["anm"][::11, :441], stored["name"][::11]
    degree, order = degrees(441), orders(441)
    particles = [from_complex_rows(np.column_stack([degree, order, row.real, row.imag])) for row in table]
    return Sample.of(particles, [str(name) for name in names])
