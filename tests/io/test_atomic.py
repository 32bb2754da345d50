"""Outputs appear whole or not at all."""

import contextlib
import hashlib
import os
import shutil
from pathlib import Path

import pytest

from regolith_studio.errors import FileError
from regolith_studio.io import atomic
from regolith_studio.io.atomic import staged_folder, staged_together, write_bytes, write_files


def write_and_fail(folder: Path) -> None:
    with staged_folder(folder, "test") as stage:
        (stage / "half.txt").write_text("half")
        raise KeyboardInterrupt


def test_that_a_folder_appears_with_all_its_files(tmp_path: Path) -> None:
    with staged_folder(tmp_path / "new" / "place", "test") as stage:
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


def write(folder: Path, **files: str) -> None:
    with staged_folder(folder, "test") as stage:
        for name, text in files.items():
            (stage / name).write_text(text)


def test_that_fewer_files_replace_more_and_that_sha256sum_agrees(tmp_path: Path) -> None:
    write(tmp_path / "out", a="1", b="1", c="1")
    write(tmp_path / "out", a="2", document="a")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a", "document", "test.sha256"]
    expected = {name: hashlib.sha256(text).hexdigest() for name, text in (("a", b"2"), ("document", b"a"))}
    lines = (tmp_path / "out" / "test.sha256").read_text().splitlines()
    assert dict(reversed(line.split("  ")) for line in lines) == expected


def test_that_earlier_files_go_and_other_files_stay_in_a_folder_that_holds_both(tmp_path: Path) -> None:
    write(tmp_path / "out", a="1", b="1")
    (tmp_path / "out" / "thesis.txt").write_text("important")
    write(tmp_path / "out", a="2")
    found = {path.name: path.read_text() for path in (tmp_path / "out").iterdir()}
    assert found.pop("test.sha256")
    assert found == {"a": "2", "thesis.txt": "important"}


def test_that_a_folder_with_a_journal_is_replaced_in_one_step_and_keeps_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An interruption between two files would leave a mixed result."""

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    write(tmp_path / "out", a="1", b="1")
    (tmp_path / "out" / "journal" / "deep").mkdir(parents=True)
    (tmp_path / "out" / "journal" / "deep" / "study.sqlite").write_text("unfinished")
    monkeypatch.setattr(Path, "replace", interrupt)
    write(tmp_path / "out", a="2")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a", "journal", "test.sha256"]
    assert (tmp_path / "out" / "journal" / "deep" / "study.sqlite").read_text() == "unfinished"


def test_that_a_system_that_cannot_exchange_folders_keeps_the_journal_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(atomic, "swap_folders", lambda *_: False)
    write(tmp_path / "out", a="1")
    (tmp_path / "out" / "journal").mkdir()
    (tmp_path / "out" / "journal" / "study.sqlite").write_text("unfinished")
    write(tmp_path / "out", a="2")
    assert (tmp_path / "out" / "a").read_text() == "2"
    assert (tmp_path / "out" / "journal" / "study.sqlite").read_text() == "unfinished"
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_that_a_folder_whose_stage_was_removed_is_not_said_to_be_written(tmp_path: Path) -> None:
    def remove(folder: Path) -> None:
        with staged_folder(folder / "out", "test") as stage:
            (stage / "a.txt").write_text("a")
            shutil.rmtree(folder)

    (tmp_path / "place").mkdir()
    with pytest.raises(FileError, match="cannot be written"):
        remove(tmp_path / "place")
    with pytest.raises(FileError, match="cannot be written"):
        write_bytes(tmp_path / "place" / "a.txt", b"a")
    assert not (tmp_path / "place").exists()


def test_that_files_that_belong_together_are_all_replaced_or_none(tmp_path: Path) -> None:
    model, project = tmp_path / "model.json", tmp_path / "gone" / "project"
    model.write_text("old")
    for files in ({model: b"new", project: b"new"}, {project: b"new", model: b"new"}):
        with pytest.raises(FileError, match="project cannot be written"):
            write_files(files)
        assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"model.json": "old"}
    project.parent.mkdir()
    write_files(files)
    assert (model.read_text(), project.read_text()) == ("new", "new")


@pytest.mark.skipif(os.name == "nt", reason="permissions are a matter of POSIX")
def test_that_files_get_the_permissions_that_the_user_gives_to_all_files(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_bytes(tmp_path / "ours", b"")
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.parametrize("fails", [False, True])
def test_that_nothing_is_done_between_a_folder_and_its_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fails: bool
) -> None:
    """An earlier folder was removed in between, which takes milliseconds in which a signal left a mixture."""
    folder, file = tmp_path / "surfaces", tmp_path / "fit.json"

    def write(content: str) -> None:
        with staged_together(folder, "fit", file) as (stage, stream):
            (stage / "grain.stl").write_text(content)
            stream.write(content.encode())
            if fails and content == "new":
                raise KeyboardInterrupt

    write("old")
    removed: list[tuple[str, str]] = []
    remove = atomic.remove_quietly

    def look_and_remove(stage: Path) -> None:
        removed.append(((folder / "grain.stl").read_text(), file.read_text()))
        remove(stage)

    monkeypatch.setattr(atomic, "remove_quietly", look_and_remove)
    with pytest.raises(KeyboardInterrupt) if fails else contextlib.nullcontext():
        write("new")
    assert removed == [("old", "old") if fails else ("new", "new")]
    assert sorted(path.name for path in tmp_path.rglob("*")) == [
        *("fit.json", "fit.sha256", "grain.stl", "surfaces")
    ]


def test_that_a_file_within_the_folder_it_belongs_to_is_part_of_it(tmp_path: Path) -> None:
    for content in ("old", "new"):
        with staged_together(tmp_path / "out", "fit", tmp_path / "out" / "fit.json") as (stage, stream):
            (stage / "grain.stl").write_text(content)
            stream.write(content.encode())
    assert {path.name: path.read_text() for path in (tmp_path / "out").glob("*.[js]*")}.items() >= {
        ("fit.json", "new"),
        ("grain.stl", "new"),
    }
    assert "fit.json" in (tmp_path / "out" / "fit.sha256").read_text()


def test_that_a_folder_that_another_process_writes_into_is_removed_at_the_second_try(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, remove, tries = tmp_path / "stage", shutil.rmtree, []
    folder.mkdir()

    def too_late(path: Path, **options: bool) -> None:
        remove(path, **options)
        tries.append(path)
        if len(tries) == 1:  # as if written between the look at its files and its removal
            path.mkdir()
            (path / "particle.stl").write_bytes(b"late")

    monkeypatch.setattr(shutil, "rmtree", too_late)
    atomic.remove_quietly(folder)
    assert len(tries) == 2
    assert not folder.exists()
