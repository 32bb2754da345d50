"""Where results go: refused in one sentence before the work, and what a full disk says."""

import errno
from pathlib import Path

import pytest

from regolith_studio.cli.entry import run
from regolith_studio.jobs.events import Failed, Job, Steps
from regolith_studio.jobs.runners.run_job import run_job

COMMANDS = (
    "coarsen MESH",
    "fit MESH",
    "gallery MESH",
    "generate ma165 -n 2",
    "extract MESH",
    "run RECIPE",
    "demo",
    "study lmax MESH",
    "study coarsening MESH",
    "study population MESH",
    "study facets MESH",
    "study tradeoff MESH",
    "study sensitivity MESH",
    "study solids MESH",
    "dataset build MESH",
    "dataset export MESH --to rocky",
    "dataset sample MESH -n 2",
    "repose run MESH",
    "repose study MESH",
    "repose measure MESH",
)


@pytest.mark.parametrize("words", COMMANDS)
def test_that_a_place_that_cannot_be_written_is_one_sentence_before_anything_is_read(
    command, grains: Path, tmp_path: Path, words: str
) -> None:
    (tmp_path / "taken").write_text("mine")
    names = {"MESH": grains / "grain-a.stl", "RECIPE": tmp_path / "recipe.json"}
    (tmp_path / "recipe.json").write_text("{}")
    wish = [names.get(word, word) for word in words.split()]
    said = command(*wish, "-o", tmp_path / "taken" / "inside")
    assert said.code == 1
    assert said.err.strip() == f"{tmp_path / 'taken'} is a file; name a folder for the results."
    assert sorted(path.name for path in tmp_path.iterdir()) == ["recipe.json", "taken"]


def test_that_a_place_without_permission_is_one_sentence(
    command, grains: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("os.access", lambda *_: False)
    said = command("coarsen", grains, "-o", tmp_path / "a" / "b")
    assert said.code == 1
    assert said.err.strip() == f"The folder {tmp_path} cannot be written (Permission denied)."


def test_that_a_file_is_not_written_over_a_folder(command, grains: Path, tmp_path: Path) -> None:
    said = command("fit", grains, "-o", tmp_path)
    assert said.code == 1
    assert said.err.strip() == f"{tmp_path} is a folder; name a file."


def test_that_a_full_disk_is_a_sentence_of_the_system(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> Steps:
        raise OSError(errno.ENOSPC, "No space left on device", "out/a.stl")

    sentence = "Cannot access out/a.stl: the disk is full."
    monkeypatch.setattr("regolith_studio.cli.commands.app", full)
    assert run(["describe"]) == 1
    assert capsys.readouterr().err == f"{sentence}\n"
    ending = run_job(Job(full), lambda _step: None, lambda: False)
    assert isinstance(ending, Failed)
    assert ending.sentence == sentence
