"""A dataset written shape by shape is the dataset that is written at once."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from regolith_studio.dataset import streaming
from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import CoarseningRecord, Provenance
from regolith_studio.dataset.folder_io import read_dataset, write_dataset
from regolith_studio.dataset.streaming import StoredShape, stored_shape, write_stored
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import DatasetError

from .example import entry

STORY = Provenance(
    description='A set with "quotes" and a µ.',
    coarsening=CoarseningRecord("exact", 20, 3, weights={"volume": 1.0}),
)
PAIRS = [entry(seed) for seed in range(3)]


def shapes() -> Iterator[StoredShape]:
    return (stored_shape(*pair) for pair in PAIRS)


def content(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*.*")}


def test_that_both_ways_of_writing_leave_the_same_bytes(tmp_path: Path) -> None:
    write_dataset(tmp_path / "whole", build_dataset(PAIRS, name="a set", provenance=STORY))
    write_stored(tmp_path / "stream", shapes, 3, name="a set", provenance=STORY)
    assert content(tmp_path / "stream") == content(tmp_path / "whole")
    assert validate_dataset(tmp_path / "stream") == []
    assert len(read_dataset(tmp_path / "stream")) == 3


def test_that_a_shape_that_breaks_the_schema_leaves_the_folder_as_it_was(tmp_path: Path) -> None:
    write_stored(tmp_path / "set", shapes, 3, name="a set", provenance=STORY)
    before = content(tmp_path / "set")

    def broken() -> Iterator[StoredShape]:
        for shape in shapes():
            yield replace(shape, record={**shape.record, "n_members": 0})

    with pytest.raises(DatasetError, match=r"grain-0, n_members"):
        write_stored(tmp_path / "set", broken, 3, name="a set", provenance=STORY)
    assert content(tmp_path / "set") == before
    assert [path.name for path in tmp_path.iterdir()] == ["set"]


def test_that_a_dataset_that_could_not_be_read_again_is_not_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(streaming, "MAX_DOCUMENT_BYTES", 5_000)
    with pytest.raises(DatasetError, match="too large to be read"):
        write_stored(tmp_path / "set", shapes, 3, name="a set", provenance=STORY)
    assert not (tmp_path / "set").exists()


def test_that_nothing_makes_no_dataset(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="at least one"):
        write_stored(tmp_path / "set", list, 0, name="a set", provenance=STORY)
