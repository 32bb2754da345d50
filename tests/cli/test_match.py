"""``match`` of tables as they lie beside meshes of simulants, and of meshes."""

import csv
import zipfile
from pathlib import Path

import numpy as np
import pytest


def write(path: Path, axes: np.ndarray) -> Path:
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["Particle", "Length (um)", "Width (um)", "Thickness (um)"])
        writer.writerows([f"p{i}", *row] for i, row in enumerate(axes.tolist()))
    return path


def axes(rng: np.random.Generator, width: float, flat: float, n: int) -> np.ndarray:
    middle = width * np.exp(0.3 * rng.standard_normal(n))
    return np.column_stack([middle * 1.4, middle, middle * flat * np.exp(0.05 * rng.standard_normal(n))])


@pytest.fixture
def tables(tmp_path: Path) -> list[Path]:
    rng = np.random.default_rng(0)
    soil = np.concatenate([axes(rng, 50, 0.8, 300), axes(rng, 150, 0.6, 100)])
    named = {"soil": soil, "fine": axes(rng, 50, 0.8, 400), "coarse": axes(rng, 150, 0.6, 400)}
    return [write(tmp_path / f"{name}.csv", table) for name, table in named.items()]


def test_that_the_masses_of_the_nearest_mixture_are_said_in_grams(command, tables, tmp_path):
    result = command("match", *tables, "-o", tmp_path / "out", "--mass", "1000", "--json")
    assert result.code == 0
    fine, coarse, mixture = result.json["materials"]
    assert coarse["mass"] == pytest.approx(900, abs=40)
    assert fine["mass_low"] < 100 < fine["mass_high"]
    assert mixture["energy_in_floors"] < 1 < fine["energy_in_floors"]
    assert {path.name for path in (tmp_path / "out").iterdir()} >= {"match.csv", "match.png", "match.svg"}
    assert "Nearest by itself: fine.csv" in command("match", *tables).out


def test_that_a_target_out_of_reach_is_said(command, tables):
    assert "No mixture" not in command("match", *tables).out
    far = command("match", tables[2], tables[1])
    assert "No mixture of the candidates is as near to coarse.csv" in far.out
    assert "No mixture" in command("match", tables[2], tables[1], "--json").json["notes"][0]


def test_that_what_a_table_or_an_archive_lacks_is_said(command, tables, grains, tmp_path):
    with tables[1].open("a") as file:
        file.write("broken,1,,3\n")
    result = command("match", *tables)
    assert result.code == 0
    assert "fine.csv: Left out 1 row without positive numbers" in result.err
    with zipfile.ZipFile(tmp_path / "few.zip", "w") as archive:
        archive.write(grains / "grain-a.stl", "75m/a.stl")
        for number in range(25):
            archive.writestr(f"75m/b{number}.stl", b"")
    with zipfile.ZipFile(tmp_path / "both.zip", "w") as archive:
        for number in range(25):
            archive.writestr(f"75m/b{number}.stl", b"")
            archive.write(grains / f"grain-{'abc'[number % 3]}.stl", f"75m/a{number}.stl")
    few = command("match", tables[0], tmp_path / "few.zip")
    assert (few.code, few.err.count("\n")) == (1, 1)
    assert "few/75m has 1 particle; a comparison needs at least 20. 25 not read, the first:" in few.err
    assert "75m/b0.stl is empty" in few.err
    many = command("match", tables[0], tables[1], tmp_path / "both.zip", "--json")
    assert (many.code, many.err.count("\n"), len(many.json["problems"])) == (1, 22, 25)
    assert many.err.endswith("5 more problems, all with --json.\n")


def test_that_what_is_no_material_is_one_sentence(command, tables, tmp_path):
    missing = command("match", tables[0], tmp_path / "nothing.csv")
    assert (missing.code, missing.err.count("\n")) == (1, 1)
    assert command("match", tables[0], tables[1], "--weighting", "mass").code == 2
