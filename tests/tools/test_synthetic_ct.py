"""The synthetic scan: its labels are the truth of its grey values."""

import numpy as np
import pytest
from scipy import ndimage

from tools.make_samples.synthetic_ct import ScanRecipe, SyntheticScan, grain_coverage, synthetic_scan

SMALL = ScanRecipe(shape=(56, 64, 60), n_grains=6, diameter=(15.0, 12.0, 19.0), minerals=(150.0,))


@pytest.fixture(scope="module")
def scan() -> SyntheticScan:
    return synthetic_scan(SMALL, 1)


@pytest.mark.slow
def test_that_every_grain_is_one_connected_body(scan: SyntheticScan) -> None:
    for label in range(1, 7):
        _, bodies = ndimage.label(scan.labels.array == label)
        assert bodies == 1


def test_that_a_ball_covers_its_volume_to_half_a_per_cent() -> None:
    for diameter in (15.3, 24.0, 30.0):
        coverage = grain_coverage(lambda directions: np.ones(len(directions)), diameter)
        assert coverage.sum() == pytest.approx(np.pi / 6 * diameter**3, rel=5e-3)
        assert coverage.min() == 0.0
        assert coverage.max() == 1.0


def test_that_brightness_tells_grains_from_resin(scan: SyntheticScan) -> None:
    core = ndimage.binary_erosion(scan.labels.array > 0, iterations=3)
    resin = ~ndimage.binary_dilation(scan.labels.array > 0, iterations=3)
    grey = scan.grey.array.astype(float)
    cupping = 1 - SMALL.cupping / 2
    assert grey[core].mean() == pytest.approx(150 * cupping, rel=0.06)
    assert grey[resin].mean() == pytest.approx(SMALL.resin * cupping, rel=0.06)
    assert grey[resin].std() == pytest.approx(SMALL.noise, rel=0.15)


@pytest.mark.slow
def test_that_half_brightness_lies_at_the_grains_surface() -> None:
    clean = ScanRecipe(**{**SMALL.__dict__, "noise": 0.0, "rings": 0.0, "cupping": 0.0})
    again = synthetic_scan(clean, 1)
    bright = again.grey.array > (150 + SMALL.resin) / 2
    wrong = bright != (again.labels.array > 0)
    assert wrong.sum() < 0.05 * (again.labels.array > 0).sum()
