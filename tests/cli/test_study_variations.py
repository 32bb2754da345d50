"""``study facets``, ``tradeoff``, ``sensitivity`` and the rows of ``study coarsening``."""

from pathlib import Path

import pytest

from regolith_studio.io.triangles import stl_bytes
from tests.coarsening.compound.unions import dumbbell
from tests.files import csv_rows

ONE = ("--target", "particle", "--json")


def test_that_errors_against_faces_are_written(command, grains: Path, tmp_path: Path) -> None:
    result = command(
        "study", "facets", grains, "-o", tmp_path / "s", "--facets", "10,30", "--method", "quadric", *ONE
    )
    assert result.code == 0, result.err
    assert set(result.json["files"]) >= {f"facets.{end}" for end in ("csv", "json", "png", "svg")}
    rows = csv_rows(tmp_path / "s" / "facets.csv")
    volume = [float(row["rmsre [%]"]) for row in rows if row["descriptor"] == "volume"]
    assert volume[0] > volume[1] > 0  # fewer faces, larger error


@pytest.mark.slow
def test_that_the_trade_off_begins_with_the_best_overlap(command, grains: Path, tmp_path: Path) -> None:
    result = command("study", "tradeoff", grains / "grain-a.stl", "-o", tmp_path / "s", "--facets", 30, *ONE)
    assert result.code == 0, result.err
    rows = csv_rows(tmp_path / "s" / "tradeoff.csv")
    distance = [float(row["jaccard_distance [%]"]) for row in rows]
    error = [float(row["mean_rmsre [%]"]) for row in rows]
    assert rows[0]["row"] == "Overlap only"
    assert distance[0] <= distance[-1]
    assert error[-1] < error[0] / 2


def test_that_one_weight_at_a_time_is_changed(command, grains: Path, tmp_path: Path) -> None:
    chosen = ("--weight", "volume=1", "--weight", "jaccard_distance=1", "--method", "annealing")
    quick = ("--set", "iterations=5", "--facets", 12, "--factors", "0,2")
    result = command(
        "study", "sensitivity", grains / "grain-a.stl", "-o", tmp_path / "s", *chosen, *quick, *ONE
    )
    assert result.code == 0, result.err
    changes = [row["change"] for row in csv_rows(tmp_path / "s" / "sensitivity.csv")]
    assert list(dict.fromkeys(changes)) == ["Overlap × 0", "Overlap × 2", "Volume × 0", "Volume × 2"]


def test_that_the_polyhedra_of_each_loss_are_drawn(command, grains: Path, tmp_path: Path) -> None:
    losses = ("--loss", "quadric", "--loss", "only_volume")
    result = command("study", "solids", grains, "-o", tmp_path / "s", "--facets", 12, *losses, *ONE)
    assert result.code == 0, result.err
    assert set(result.json["files"]) == {f"solids.{end}" for end in ("csv", "json", "png", "svg")}
    rows = csv_rows(tmp_path / "s" / "solids.csv")
    assert [row["name"] for row in rows] == ["grain-a", "grain-b", "grain-c"] * 2
    assert all(float(row["volume [%]"]) < 1e-4 for row in rows[3:])
    assert not (tmp_path / "s" / "journal").exists()


def test_that_any_losses_can_be_the_rows_of_figure_8(command, grains: Path, tmp_path: Path) -> None:
    losses = ("--loss", "only_volume", "--loss", "chosen", "--weight", "sphericity=1")
    result = command(
        "study", "coarsening", grains / "grain-a.stl", "-o", tmp_path / "s", "--facets", 30, *losses, *ONE
    )
    assert result.code == 0, result.err
    rows = csv_rows(tmp_path / "s" / "coarsening_rmsre.csv")
    met = {(row["row"], row["descriptor"]): float(row["rmsre [%]"]) < 1e-4 for row in rows}
    assert met[("Volume only", "volume")]
    assert not met[("Volume only", "sphericity")]
    assert met[("Chosen weights", "sphericity")]


@pytest.mark.slow
@pytest.mark.parametrize("study", ["coarsening", "tradeoff", "solids"])
def test_that_a_compound_is_a_row_of_its_own(command, study: str, tmp_path: Path) -> None:
    """Beside convex polyhedra, which cannot keep the hull of a particle with a waist."""
    (tmp_path / "waist.stl").write_bytes(stl_bytes(dumbbell().triangles, "test"))
    loss = () if study == "tradeoff" else ("--loss", "all")
    options = ("--facets", 24, "--compound", "--target", "particle")
    result = command("study", study, tmp_path / "waist.stl", "-o", tmp_path / "s", *loss, *options)
    assert result.code == 0, result.err
    table = {"coarsening": "coarsening_rmsre.csv"}.get(study, f"{study}.csv")
    rows = csv_rows(tmp_path / "s" / table)
    if study == "coarsening":
        rows = [row for row in rows if row["descriptor"] == "convex_hull_volume"]
    column = "rmsre [%]" if study == "coarsening" else "convex_hull_volume [%]"
    errors = {row["row"]: float(row[column]) for row in rows}
    assert errors.pop("Compound of convex parts") < 1e-4
    assert min(errors.values()) > 1.0
    assert len(errors) == (8 if study == "tradeoff" else 1)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (("facets", "--facets", "12,many"), "numbers with commas"),
        (("facets", "--facets", "3,12"), "from 5 to 500, got 3"),
        (("tradeoff", "--method", "quadric"), "A baseline has no loss"),
        (("tradeoff", "--preset", "overlap"), "at least one descriptor"),
        (("sensitivity", "--factors", "-1"), "0 or a positive number"),
        (("sensitivity", "--box", "round"), "must be one of exact, trimesh"),
        (("coarsening", "--loss", "beauty"), "no loss called 'beauty'"),
    ],
)
def test_that_bad_use_is_one_sentence(command, grains: Path, tmp_path: Path, wrong, sentence) -> None:
    name, *options = wrong
    result = command("study", name, grains, "-o", tmp_path / "s", *options)
    assert result.code == 2
    assert sentence in " ".join(result.err.replace("│", " ").split())
    assert not (tmp_path / "s").exists()
