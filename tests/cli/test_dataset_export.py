"""``dataset sample``, ``export`` and ``formats``."""

import csv
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.cli.entry import run
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import Exporter
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.folder_io import dataset_hash, read_dataset
from regolith_studio.jobs import dataset_jobs
from regolith_studio.session.recipe import Exports


@pytest.fixture(scope="module")
def folder(grains: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("library") / "set"
    assert run(["dataset", "build", str(grains), "-o", str(made), "--method", "quadric"]) == 0
    return made


def test_that_a_sample_is_a_table_and_the_same_for_the_same_seed(
    command, folder: Path, tmp_path: Path
) -> None:
    result = command("dataset", "sample", folder, "-n", 500, "--seed", 4)
    assert result.code == 0
    rows = list(csv.DictReader(io.StringIO(result.out)))
    assert len(rows) == 500
    assert {row["name"] for row in rows} == {"grain-a", "grain-b", "grain-c"}
    sizes = {one.name: float(one.sizes.quantile(0.5)) for one in read_dataset(folder).representatives}
    for row in rows:
        assert float(row["diameter_um"]) == sizes[row["name"]]
        assert np.linalg.norm([float(row[key]) for key in ("qw", "qx", "qy", "qz")]) == pytest.approx(1.0)
    again = command("dataset", "sample", folder, "-n", 500, "--seed", 4, "-o", tmp_path / "drawn.csv")
    assert again.code == 0
    assert (tmp_path / "drawn.csv").read_text() == result.out
    assert command("dataset", "sample", folder, "-n", 500, "--seed", 5).out != result.out
    assert command("dataset", "sample", folder, "-n", 2, "--json").json[0]["class"] in (0, 1, 2)


def test_that_an_export_leaves_one_folder_a_format_that_names_the_dataset(
    command, folder: Path, tmp_path: Path
) -> None:
    result = command("dataset", "export", folder, "--to", "rocky, hoomd", "-o", tmp_path / "out", "--json")
    assert result.code == 0
    assert [one["key"] for one in result.json] == ["rocky", "hoomd"]
    for one in result.json:
        record = json.loads((Path(one["folder"]) / "export.json").read_text())
        assert record["dataset_sha256"] == dataset_hash(folder)
        assert set(one["files"]) == {
            path.relative_to(one["folder"]).as_posix() for path in files(one["folder"])
        }
    assert all(lost in result.err for lost in EXPORTERS["hoomd"].loses)


def test_that_formats_that_change_shapes_are_refused_unless_that_is_allowed(
    command, folder: Path, tmp_path: Path
) -> None:
    refused = command("dataset", "export", folder, "--to", "all", "-o", tmp_path / "out", "--particles", 8)
    assert refused.code == 1
    assert "cannot hold the shapes as they are" in refused.err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_that_all_formats_are_written_when_changed_shapes_are_allowed(
    command, folder: Path, tmp_path: Path
) -> None:
    asked = ("dataset", "export", folder, "--to", "all", "-o", tmp_path / "out", "--particles", 8)
    assert command(*asked, "--lossy").code == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == set(EXPORTERS)


def test_that_a_stop_between_two_formats_leaves_all_formats_as_they_were(
    command, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A signal between two formats had left one of the new dataset beside one of the earlier."""
    asked = ("dataset", "export", folder, "--to", "rocky,gltf", "-o", tmp_path / "out", "--particles")
    assert command(*asked, 9).code == 0
    before = {path: path.read_bytes() for path in files(tmp_path / "out")}

    prepare = dataset_jobs.prepared_export

    def prepare_one(dataset: Dataset, exporter: Exporter, *rest: Any, **options: Any) -> Any:
        if exporter.key == "gltf":
            raise KeyboardInterrupt
        return prepare(dataset, exporter, *rest, **options)

    monkeypatch.setattr(dataset_jobs, "prepared_export", prepare_one)
    assert command(*asked, 8).code == 130
    assert {path: path.read_bytes() for path in files(tmp_path / "out")} == before


def test_that_particles_keep_their_sizes_where_no_coarse_graining_is_named(
    command, folder: Path, tmp_path: Path
) -> None:
    """The command line and recipes had enlarged them tenfold, the window had not."""
    assert command("dataset", "export", folder, "--to", "rocky", "-o", tmp_path / "out").code == 0
    case = json.loads((tmp_path / "out" / "rocky" / "case.json").read_text())
    assert case["coarse_graining_factor"] == Exports(targets=["rocky"]).coarse_graining_factor == 1.0


def test_that_settings_reach_the_files(command, folder: Path, tmp_path: Path) -> None:
    result = command(
        "dataset", "export", folder, "--to", "rocky", "-o", tmp_path / "out",
        "--coarse-graining", 5,
        "--set", "density=2900", "--set", "mass=0.01", "--set", "gravity=1.62",
    )  # fmt: skip
    assert result.code == 0
    case = json.loads((tmp_path / "out" / "rocky" / "case.json").read_text())
    assert case["coarse_graining_factor"] == 5.0
    assert case["contact"]["density"] == 2900
    assert sum(one["mass"] for one in case["particles"]) == pytest.approx(0.01)
    assert case["test"]["gravity"] == 1.62


@pytest.mark.parametrize(
    ("extra", "code", "word"),
    [
        (("--to", "fluent"), 2, "There is no format 'fluent'"),
        (("--to", ","), 2, "No format was chosen"),
        (("--to", "rocky", "--set", "colour=1"), 2, "no setting 'colour'"),
        (("--to", "rocky", "--coarse-graining", "0"), 2, "--coarse-graining"),
    ],
)
def test_that_bad_use_is_told_in_a_sentence(command, folder: Path, tmp_path: Path, extra, code, word) -> None:
    result = command("dataset", "export", folder, "-o", tmp_path / "out", *extra)
    assert result.code == code
    assert word in " ".join(result.err.replace("│", " ").split())
    assert not (tmp_path / "out").exists()


def test_that_a_folder_without_a_dataset_is_one_sentence(command, tmp_path: Path) -> None:
    for action in (
        ("export", tmp_path, "--to", "rocky", "-o", tmp_path / "out"),
        ("sample", tmp_path, "-n", 3),
    ):
        result = command("dataset", *action)
        assert result.code == 1
        assert len(result.err.strip().splitlines()) == 1


def test_that_formats_are_listed_with_what_they_lose(command) -> None:
    result = command("dataset", "formats")
    assert result.code == 0
    for exporter in EXPORTERS.values():
        assert all(text in result.out for text in (exporter.label, *exporter.carries, *exporter.loses))
    assert [one["key"] for one in command("dataset", "formats", "--json").json] == list(EXPORTERS)


def files(folder: str) -> list[Path]:
    return [path for path in Path(folder).rglob("*") if path.is_file()]
