"""Samples of synthetic particles, and one of real ones."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.harmonics.coefficients import degrees, orders
from regolith_studio.harmonics.io import from_complex_rows
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.protocol import FittedModel
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


def _quick_fit(key: str, sample: Sample, l_max: int) -> FittedModel:
    """A model that compares few surfaces: what holds for every draw holds for its draws."""
    model = MODELS[key]
    few = {"n_candidates": 4} if key == "recombined" else {}
    return model.fit(sample, model.Settings(l_max=l_max, **few))


@pytest.fixture(scope="session")
def quick_fit() -> Callable[[str, Sample, int], FittedModel]:
    """``quick_fit(key, sample, l_max)``."""
    return _quick_fit


class _FittedModels(dict[str, FittedModel]):
    """Models by key, fitted when they are first looked up."""

    def __missing__(self, key: str) -> FittedModel:
        self[key] = _quick_fit(key, _rough_sample(60, 6), 4)
        return self[key]


@pytest.fixture(scope="session")
def fitted() -> dict[str, FittedModel]:
    """Each model fitted once to 60 rough particles, at l_max = 4."""
    return _FittedModels()


@pytest.fixture(scope="session")
def cement(real_data: Callable[[str], Path]) -> Sample:
    """300 real particles at l_max 20, from their complex coefficients."""
    with np.load(real_data("cement140/coefficients.npz")) as stored:
        table, names = stored["anm"][::11, :441], stored["name"][::11]
    degree, order = degrees(441), orders(441)
    particles = [from_complex_rows(np.column_stack([degree, order, row.real, row.imag])) for row in table]
    return Sample.of(particles, [str(name) for name in names])
