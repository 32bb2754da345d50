"""``describe``, ``coarsen`` and ``dataset build`` of an archive as libraries of simulants are."""

import json
import shutil
import zipfile
from pathlib import Path

import pytest

from regolith_studio.dataset.folder_io import dataset_hash, read_dataset
from regolith_studio.readers import archives
from tests.files import csv_rows


@pytest.fixture(scope="module")
def library(tmp_path_factory, grains: Path) -> Path:
    """The three ellipsoids in two fractions, one of them an archive, and an empty file."""
    folder = tmp_path_factory.mktemp("library")
    inner, path = folder / "75-300.zip", folder / "JSC.zip"
    with zipfile.ZipFile(inner, "w", zipfile.ZIP_DEFLATED) as fraction:
        for file in sorted(grains.glob("*.stl"))[:2]:
            fraction.write(file, file.name)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(inner, inner.name)
        for file in sorted(grains.glob("*.stl")):
            archive.write(file, f"75m/{file.name}")
        archive.writestr("75m/nothing.stl", b"")
    inner.unlink()
    return path


NAMES = ["grain-a", "grain-b", "75m_grain-a", "75m_grain-b", "grain-c"]


def test_that_an_archive_is_described_into_a_folder_and_resumed(command, library, grains, tmp_path):
    output = tmp_path / "out"
    result = command("describe", library, "-o", output, "--chords")
    assert result.code == 1
    reason = f"{library}/75m/nothing.stl is empty: it has no bytes at all."
    assert reason in result.err
    assert f"6 particles, 1 problem in {output}" in " ".join(result.out.split())
    table = csv_rows(output / "descriptors.csv")
    assert [row["name"] for row in table] == NAMES
    assert [row["group"] for row in table] == ["75-300"] * 2 + ["75m"] * 3
    plain = {each["name"]: each for each in command("describe", grains, "--json").json}
    for row in table:
        expected = plain[row["name"].removeprefix("75m_")]
        assert float(row["volume [um^3]"]) == pytest.approx(expected["volume"])
    assert float(table[0]["width [um]"]) == pytest.approx(40, rel=0.02)
    assert float(table[0]["thickness_over_width"]) == pytest.approx(15 / 20, rel=0.02)
    failed = csv_rows(output / "failed.csv")
    assert [(row["name"], row["reason"]) for row in failed] == [("nothing", reason)]
    again = command("describe", library, "-o", output, "--chords", "--resume", "--json")
    assert (again.json["particles"], again.code) == (0, 1)  # nothing was left to do


def test_that_a_large_archive_needs_a_folder(command, library, monkeypatch):
    monkeypatch.setattr("regolith_studio.cli.batch_options.MOST_IN_MEMORY", 5)
    result = command("describe", library)
    assert result.code == 2
    assert "JSC.zip holds 6 meshes, and at most 5 are read into memory" in " ".join(result.err.split())


def test_that_many_files_and_archives_in_a_folder_are_coarsened_one_by_one(
    command, library, grains, tmp_path, monkeypatch
):
    options = ("--method", "quadric", "--facets", "12")
    (tmp_path / "in").mkdir()
    shutil.copy(library, tmp_path / "in")
    command("coarsen", tmp_path / "in", "-o", tmp_path / "archives", *options)
    assert len(list((tmp_path / "archives" / "meshes").glob("*.stl"))) == 5
    monkeypatch.setattr("regolith_studio.cli.batch_options.MOST_IN_MEMORY", 2)
    command("coarsen", grains, "-o", tmp_path / "files", *options)
    assert (tmp_path / "files" / "meshes" / "grain-a.stl").is_file()


def test_that_a_cluster_needs_a_folder_too(command, library):
    assert "need a folder for the results" in command("describe", library, "--runner", "dask").err


def test_that_an_archive_is_coarsened_and_becomes_a_dataset_for_each_fraction(
    command, library, tmp_path, monkeypatch
):
    result = command("coarsen", library, "-o", tmp_path / "coarse", "--method", "quadric")
    assert result.code == 1
    assert {path.name for path in (tmp_path / "coarse" / "meshes").glob("*.stl")} == {
        f"{name}.stl" for name in NAMES
    }
    options = ("--by-group", "--method", "quadric", "--facets", "12")
    command("dataset", "build", library, "-o", tmp_path / "library", *options)
    manifest = json.loads((tmp_path / "library" / "dataset" / "manifest.json").read_text())
    assert [(each["group"], each["particles"]) for each in manifest["datasets"]] == [
        ("75-300", 2),
        ("75m", 3),
    ]
    for each in manifest["datasets"]:
        folder = tmp_path / "library" / "dataset" / each["folder"]
        assert dataset_hash(folder) == each["sha256"]
        assert len(read_dataset(folder)) == each["particles"]
    monkeypatch.setattr("regolith_studio.dataset.folder_io.MAX_DOCUMENT_BYTES", 7_000)
    large = command("dataset", "build", library, "-o", tmp_path / "large", *options)
    assert "4 particles of 12 facets is larger than can be read again" in large.err
    refused = command(
        "dataset", "build", library, "-o", tmp_path / "other", "--by-group", "--representatives", "2"
    )
    assert (refused.code, (tmp_path / "other").exists()) == (2, False)


def test_that_the_list_of_an_archive_is_made_once(library, monkeypatch):
    archives.archive_content(library)
    monkeypatch.setattr(archives, "shared_sandbox", None)
    assert len(archives.archive_content(library).members) == 6
