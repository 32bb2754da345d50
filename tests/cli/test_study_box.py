"""``study coarsening --box``: the paper's heuristic box on demand, to compare numbers."""

import csv
from pathlib import Path

import pytest

ASKING = (
    "All descriptors",
    "Volume, surface area, aspect ratio",
    "Aspect ratio and overlap",
    "All descriptors and overlap",
)


@pytest.mark.parametrize(("box", "met"), [("exact", True), ("trimesh", False)])
@pytest.mark.slow
def test_that_only_the_exact_box_is_kept_to_rounding(command, grains: Path, tmp_path: Path, box, met) -> None:
    """In all rows that ask for the aspect ratio: of some polyhedra both boxes are the same by chance."""
    result = command(
        "study", "coarsening", grains / "grain-b.stl", "-o", tmp_path, "--target", "particle",
        "--facets", 12, "--box", box, "--json",
    )  # fmt: skip
    assert result.code == 0
    with (tmp_path / "coarsening_rmsre.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["descriptor"] == "aspect_ratio"]
    errors = [float(row["rmsre [%]"]) for row in rows if row["row"] in ASKING]
    assert len(errors) == len(ASKING)
    assert (max(errors) < 1e-4) == met
