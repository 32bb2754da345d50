"""Outputs appear whole or not at all."""

import os
from pathlib import Path

import pytest

from regolith_studio.errors import FileError
from regolith_studio.io.atomic import staged_folder, write_bytes


def write_and_fail(folder: Path) -> None:
    with staged_folder(folder) as stage:
        (stage / "half.txt").write_text("half")
        raise KeyboardInterrupt


def test_that_a_folder_appears_with_all_its_files(tmp_path: Path) -> None:
    with staged_folder(tmp_path / "new" / "place") as stage:
        (stage / "deep").mkdir()
        (stage / "deep" / "a.txt").write_text("a")
        assert not (tmp_path / "new" / "place").exists()
    assert (tmp_path / "new" / "place" / "deep" / "a.txt").read_text() == "a"
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["place"]


def test_that_an_interruption_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        write_and_fail(tmp_path / "place")
    assert list(tmp_path.iterdir()) == []


def test_that_an_interruption_leaves_what_was_there(tmp_path: Path) -> None:
    (tmp_path / "place").mkdir()
    (tmp_path / "place" / "half.txt").write_text("whole")
    with pytest.raises(KeyboardInterrupt):
        write_and_fail(tmp_path / "place")
    assert (tmp_path / "place" / "half.txt").read_text() == "whole"


def test_that_other_files_of_the_folder_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("important")
    with staged_folder(tmp_path) as stage:
        (stage / "a.txt").write_text("a")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.txt", "thesis.txt"]


def test_that_a_place_that_cannot_be_written_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileError, match="cannot be written"), staged_folder(tmp_path / "file" / "x"):
        pass
    with pytest.raises(FileError, match="cannot be written"):
        write_bytes(tmp_path / "file" / "x.json", b"")


@pytest.mark.skipif(os.name == "nt", reason="permissions are a matter of POSIX")
def test_that_files_get_the_permissions_that_the_user_gives_to_all_files(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_bytes(tmp_path / "ours", b"")
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "plain").stat().st_mode
