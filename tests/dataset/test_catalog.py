"""A folder of datasets, exports and results, and what came from what."""

import json
from pathlib import Path

import pytest

from regolith_studio.dataset.catalog import provenance_tree, scan_catalog
from regolith_studio.dataset.export import prepared_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.folder_io import dataset_hash, write_dataset
from regolith_studio.errors import DatasetError


@pytest.fixture
def library(tmp_path: Path, make_dataset) -> Path:
    """Two datasets; of the first an export and a result, of one that is not here another."""
    root = tmp_path / "library"
    for name, first in (("mare", 0), ("highland", 10)):
        write_dataset(root / "sets" / name, make_dataset(2, first=first, name=name))
    digest = dataset_hash(root / "sets" / "mare")
    for name, count, key, source in (("hoomd", 2, "hoomd", digest), ("planes", 1, "half-spaces", "f" * 64)):
        folder = root / "out" / name
        with prepared_export(make_dataset(count), EXPORTERS[key], folder, dataset_hash=source) as finish:
            finish()
    run = {
        "format": "regolith-studio-repose",
        "state": "finished",
        "dataset": {"name": "mare", "sha256": digest},
        "engine": {"label": "MuJoCo"},
        "measurement": {"angle_deg": 38.25},
    }
    (root / "runs" / "a").mkdir(parents=True)
    (root / "runs" / "a" / "repose.json").write_text(json.dumps(run))
    (root / ".hidden").mkdir()
    write_dataset(root / ".hidden" / "x", make_dataset(1))
    return root


def test_that_all_kinds_are_found_with_what_is_worth_knowing(library: Path) -> None:
    entries = {entry.folder.relative_to(library).as_posix(): entry for entry in scan_catalog(library)}
    assert sorted(entries) == ["out/hoomd", "out/planes", "runs/a", "sets/highland", "sets/mare"]
    mare = entries["sets/mare"]
    assert (mare.kind, mare.name) == ("dataset", "mare")
    assert mare.detail.startswith("2 shapes of ")
    assert mare.sha256 == dataset_hash(library / "sets" / "mare")
    assert mare.mesh.volume == pytest.approx(1.0)
    assert "Drew polyhedra." in mare.facts["Steps"]
    assert mare.facts["Sources"] == "grain.stl"
    assert entries["runs/a"].name == "38.2° angle of repose of mare"
    assert not any(entry.problem for entry in entries.values())


def test_that_results_hang_below_the_dataset_that_they_came_from(library: Path) -> None:
    tree = {
        parent.name: sorted(child.kind for child in children)
        for parent, children in provenance_tree(scan_catalog(library))
    }
    assert tree == {"mare": ["export", "result"], "highland": [], "test set for half-spaces": []}


def test_that_a_copy_of_a_dataset_does_not_take_its_results_twice(library: Path, make_dataset) -> None:
    write_dataset(library / "sets" / "copy", make_dataset(2, name="mare"))
    children = [len(below) for entry, below in provenance_tree(scan_catalog(library)) if entry.name == "mare"]
    assert sorted(children) == [0, 2]


def test_that_a_filter_takes_every_word_from_anywhere(library: Path) -> None:
    found = list(scan_catalog(library))
    assert [entry.folder.name for entry in found if entry.matches("HIGH")] == ["highland"]
    assert [entry.folder.name for entry in found if entry.matches("angle mujoco")] == ["a"]
    assert all(entry.matches("") for entry in found)
    assert not any(entry.matches("venus") for entry in found)


@pytest.mark.parametrize("name", ["dataset.json", "export.json", "repose.json"])
@pytest.mark.parametrize(
    "text",
    [
        "",
        "{}",
        "[]",
        '{"format": "regolith-studio-repose"}',
        "\x00",
        '{"format": "regolith-studio-export", "loses": 3}',
    ],
)
def test_that_what_is_broken_is_listed_with_a_sentence(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / "x").mkdir()
    (tmp_path / "x" / name).write_text(text)
    (entry,) = scan_catalog(tmp_path)
    assert entry.problem
    assert "\n" not in entry.problem
    assert provenance_tree([entry]) == [(entry, [])]


def test_that_bytes_which_are_no_text_are_listed_too(tmp_path: Path) -> None:
    (tmp_path / "export.json").write_bytes(b"\xff\xfe\x00")
    (entry,) = scan_catalog(tmp_path)
    assert entry.problem


def test_that_folders_deep_down_are_left_alone_and_a_missing_one_is_told(
    tmp_path: Path, make_dataset
) -> None:
    write_dataset(tmp_path / "a/b/c/d/e", make_dataset(1))
    assert list(scan_catalog(tmp_path)) == []
    with pytest.raises(DatasetError, match="is not a folder"):
        list(scan_catalog(tmp_path / "nowhere"))
