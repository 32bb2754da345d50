"""Requests for compounds: what cannot be met, and what was mended, each said in one sentence."""

import json
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.resources import resource
from tests.coarsening.compound.unions import dumbbell
from tests.dataset.example import elbow_entry

COMPOUND = ("--method", "compound", "--target", "particle")


@pytest.fixture(scope="module")
def waist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("meshes") / "waist.stl"
    path.write_bytes(stl_bytes(dumbbell().triangles, "test"))
    return path


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (("--set", "parts=1"), "The number of parts must be a whole number from 2 to 8, got 1."),
        (("--set", "parts=9"), "The number of parts must be a whole number from 2 to 8, got 9."),
        (("--set", "parts=2.5"), "parts of the method compound must be a whole number, got 2.5."),
        (("--set", "parts=many"), "parts of the method compound must be a whole number, got 'many'."),
        (("--set", "joint=glue"), "The parts either overlap or touch, got 'glue'."),
        (("--set", "joint=1"), "joint of the method compound must be a word, got 1."),
        (("--set", "level=slow"), "The level must be one of fast, best, got 'slow'."),
        (("--facets", "4"), "greater than or equal to 5"),
        (("--facets", "501"), "less than or equal to 500"),
    ],
)
def test_that_a_number_of_parts_or_facets_out_of_range_is_one_sentence(
    command, waist: Path, tmp_path: Path, wrong: tuple[str, ...], sentence: str
) -> None:
    result = command("coarsen", waist, "-o", tmp_path / "out", *COMPOUND, *wrong)
    assert result.code == 2
    assert sentence in result.err
    assert "Traceback" not in result.err
    assert not (tmp_path / "out").exists()


def test_that_open_and_self_crossing_meshes_are_refused_in_one_sentence_each(command, tmp_path: Path) -> None:
    mesh = dumbbell()
    (tmp_path / "open.stl").write_bytes(stl_bytes(mesh.triangles[40:], "test"))
    twice = np.vstack([mesh.vertices, mesh.moved(shift=(20.0, 0.0, 0.0)).vertices])
    crossing = Mesh(twice, np.vstack([mesh.faces, mesh.faces + len(mesh.vertices)]))
    (tmp_path / "crossing.stl").write_bytes(stl_bytes(crossing.triangles, "test"))
    result = command(
        "coarsen",
        tmp_path / "open.stl",
        tmp_path / "crossing.stl",
        "-o",
        tmp_path / "out",
        "--no-repair",
        *COMPOUND,
    )
    assert result.code == 1
    lines = {line.split(":")[0]: line for line in result.err.splitlines()}
    assert "The mesh is not closed" in lines["open"]
    assert "The mesh intersects itself" in lines["crossing"]
    assert not list((tmp_path / "out").glob("*.stl"))


@pytest.mark.slow
def test_that_a_request_that_needs_more_says_what_is_missed_and_what_may_help(
    command, waist: Path, tmp_path: Path
) -> None:
    result = command("coarsen", waist, "-o", tmp_path / "out", *COMPOUND, "--facets", 10)
    assert result.code == 0
    (line,) = [each for each in result.err.splitlines() if each.startswith("waist:")]
    assert (
        "No compound of 2 parts with 10 facets was found that meets all descriptors; this one misses" in line
    )
    assert line.endswith("More parts or facets, or a weight of 0 for a descriptor, may help.")


@pytest.mark.slow
def test_that_a_box_which_is_hardly_a_minimum_is_met_all_the_same(command, tmp_path: Path) -> None:
    """With this seed, one search for boxes stated edges that were off by 7e-7 of their lengths."""
    stone = resource("samples", "particles", "agglutinate-1.stl")
    out = tmp_path / "out"
    how = ("--method", "compound", "--target", "fit", "--l-max", 10, "--facets", 40, "--unit", "um")
    result = command("coarsen", stone, "-o", out, *how)
    assert "No compound" not in result.err
    (found,) = json.loads((out / "coarsening.json").read_text())["particles"]
    assert max(error for key, error in found["errors"].items() if key in LOSS_KEYS) < 1e-7


def test_that_repairs_of_a_mesh_are_said(command, tmp_path: Path) -> None:
    (tmp_path / "open.stl").write_bytes(stl_bytes(dumbbell().triangles[40:], "test"))
    result = command("coarsen", tmp_path / "open.stl", "-o", tmp_path / "out", "--method", "quadric")
    assert "open: It is not closed: " in result.err
    assert "open: Filled 4 holes " in result.err


def test_that_all_formats_are_those_that_can_hold_the_compounds_and_the_others_are_said(
    command, tmp_path: Path
) -> None:
    folder = write_dataset(tmp_path / "set", build_dataset([elbow_entry()], name="elbow"))
    out = tmp_path / "out"
    few = ("--particles", 2, "--set", "n_spheres=3")
    result = command("dataset", "export", folder, "--to", "all", "--lossy", *few, "-o", out)
    assert result.code == 0
    refusing = {"edem", "hoomd", "lammps"}
    assert {path.name for path in out.iterdir()} == set(EXPORTERS) - refusing
    said = [line for line in result.err.splitlines() if "is left out, since it cannot hold compounds" in line]
    assert sorted(said) == sorted(
        f"{EXPORTERS[key].label} is left out, since it cannot hold compounds: {EXPORTERS[key].convex_only}"
        for key in refusing
    )
    assert not any("EDEM" in line and "does not carry" in line for line in result.err.splitlines())


def test_that_a_dataset_says_what_was_repaired_and_what_its_shapes_miss(command, tmp_path: Path) -> None:
    (tmp_path / "open.stl").write_bytes(stl_bytes(dumbbell().triangles[40:], "test"))
    few = ("--facets", 9)
    result = command("dataset", "build", tmp_path / "open.stl", "-o", tmp_path / "set", *COMPOUND, *few)
    assert result.code == 0
    lines = result.err.splitlines()
    assert any(line.startswith("open: Filled 4 holes ") for line in lines)
    assert any(line.startswith("open: Two parts need 10 facets; with fewer the result is") for line in lines)
