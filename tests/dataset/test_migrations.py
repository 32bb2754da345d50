"""Datasets of older schema versions are read, and written in the present one."""

import json
import shutil
from pathlib import Path

import pytest

from regolith_studio.dataset.folder import read_dataset, write_dataset
from regolith_studio.dataset.migrations import STEPS
from regolith_studio.dataset.reading import dataset_hash
from regolith_studio.dataset.schema import SCHEMA_VERSION
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import DatasetError

OLD = Path(__file__).with_name("old_versions")


def test_that_there_is_a_step_from_every_older_version_and_a_dataset_of_each() -> None:
    assert sorted(STEPS) == list(range(1, SCHEMA_VERSION))
    assert sorted(path.name for path in OLD.iterdir()) == [str(version) for version in STEPS]


@pytest.mark.parametrize("version", sorted(STEPS))
def test_that_an_old_dataset_is_sound_and_is_written_as_a_new_one(version: int, tmp_path: Path) -> None:
    old = OLD / str(version)
    assert json.loads((old / "dataset.json").read_text())["schema_version"] == version
    before = dataset_hash(old)
    assert validate_dataset(old) == []
    dataset = read_dataset(old)
    assert [one.name for one in dataset.representatives] == ["grain-1", "grain-2"]
    assert dataset.weights.tolist() == [0.75, 0.25]
    assert dataset.provenance.representation is None
    assert dataset.provenance.coarsening.n_facets == 6
    new = write_dataset(tmp_path / "new", dataset)
    assert json.loads((new / "dataset.json").read_text())["schema_version"] == SCHEMA_VERSION
    assert validate_dataset(new) == []
    assert dataset_hash(old) == before


def test_that_an_old_document_is_checked_as_strictly_as_a_new_one(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(OLD / "1", tmp_path / "set"))
    document = json.loads((folder / "dataset.json").read_text())
    for change in ({"extra": 1}, {"metadata": 5}, {"weighting": "mass"}, {"schema_version": True}):
        (folder / "dataset.json").write_text(json.dumps(document | change))
        with pytest.raises(DatasetError):
            read_dataset(folder)
    smuggled = document | {"metadata": document["metadata"] | {"representation": {"n_particles": 0}}}
    (folder / "dataset.json").write_text(json.dumps(smuggled))
    with pytest.raises(DatasetError, match="representation"):
        read_dataset(folder)
