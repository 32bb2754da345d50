"""Numbers in docs/shape_model.md against the results of the benchmarks."""

import json
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "docs" / "shape_model.md").read_text("utf-8")
RESULTS: dict[str, Any] = json.loads((ROOT / "benchmarks/results/shape_models.json").read_text("utf-8"))
KEYS = ("r_eq", "A", "AR", "S", "V/CH")


def table_of(name: str) -> dict[str, list[float]]:
    """Numbers of the table of a sample, by the name of the row."""
    lines = GUIDE.partition(f"| {name} | " + " | ".join(KEYS))[2].partition("\n\n")[0].splitlines()[2:]
    rows = [[cell.strip(" `*") for cell in line.strip("|").split("|")] for line in lines]
    return {row[0]: [float(cell) for cell in row[1:] if cell] for row in rows}


@pytest.mark.parametrize("name", sorted(RESULTS))
def test_that_the_table_of_a_sample_has_the_results_of_its_benchmark(name: str) -> None:
    measured = RESULTS[name]["rows"]
    said = table_of(name)
    assert set(said) == set(measured)
    for row, numbers in said.items():
        assert numbers == pytest.approx(measured[row], abs=1e-9)


@pytest.mark.parametrize("name", sorted(RESULTS))
def test_that_the_default_model_lies_within_the_noise_of_halves(name: str) -> None:
    rows = RESULTS[name]["rows"]
    pairs = zip(rows["recombined"], rows["floor, 95th percentile"], strict=False)
    assert [key for key, (found, limit) in zip(KEYS, pairs, strict=False) if found > limit] == []
