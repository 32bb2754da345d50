"""``study coarsening --box``: the paper's heuristic box on demand, to compare numbers."""

import csv
from pathlib import Path

import pytest


@pytest.mark.parametrize(("box", "met"), [("exact", True), ("trimesh", False)])
@pytest.mark.slow
def test_that_only_the_exact_box_is_kept_to_rounding(command, grains: Path, tmp_path: Path, box, met) -> None:
    result = command(
        "study", "coarsening", grains / "grain-a.stl", "-o", tmp_path, "--target", "particle",
        "--facets", 30, "--box", box, "--json",
    )  # fmt: skip
    assert result.code == 0
    with (tmp_path / "coarsening_rmsre.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if "min_diameter" in row.values()]
    assert rows
    least = min(float(value) for row in rows for key, value in row.items() if "rmsre" in key.lower())
    assert (least < 1e-6) == met


def test_that_an_unknown_box_is_bad_use(command, grains: Path, tmp_path: Path) -> None:
    result = command("study", "coarsening", grains, "-o", tmp_path, "--box", "round")
    assert result.code == 2
    assert "must be one of exact, trimesh" in result.err.replace("\n", " ")
