"""Sentences of the guide about results and defaults, against the result files and the code."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.imaging.settings import CleaningSettings, SplittingSettings

ROOT = Path(__file__).parents[2]


def page(name: str) -> str:
    return " ".join((ROOT / "docs" / f"{name}.md").read_text("utf-8").split())


def results(name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((ROOT / f"benchmarks/results/{name}.json").read_text("utf-8"))
    return found


@pytest.mark.parametrize("population", ["cement", "ma165"])
@pytest.mark.parametrize("model", ["recombined", "hull_field", "sample_matched"])
def test_that_draws_with_all_degrees_lie_within_the_noise_of_the_halves(population: str, model: str) -> None:
    rows = results("shape_models")[population]["rows"]
    assert all(a <= b for a, b in zip(rows[model], rows["floor, 95th percentile"], strict=False))


def test_that_the_paper_s_shares_by_mass_are_those_by_number_times_the_cube_of_size() -> None:
    sizes = np.array([25.0, 37.0, 56.0, 84.0, 125.0])
    masses = np.array([85.5, 12.6, 1.7, 0.23, 0.03]) * sizes**3
    *first, last = [f"{share:.2g}" for share in 100 * masses / masses.sum()]
    assert f"are {', '.join(first)} and {last} % by mass" in page("dataset")


def test_that_the_page_on_scans_has_the_defaults_of_the_code() -> None:
    splitting = SplittingSettings()
    for sentence in (
        f"h is {splitting.h_maxima:g} voxels, or {100 * splitting.relative:g} % of the peak's height",
        f"fewer than {CleaningSettings().min_voxels} voxels are dropped",
    ):
        assert sentence in page("segmentation")
