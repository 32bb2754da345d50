"""Where results go: refused in one sentence before the work, and what a full disk says."""

import errno
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from regolith_studio.cli.entry import run
from regolith_studio.jobs.events import Failed, Job, Steps
from regolith_studio.jobs.runners import run_job

COMMANDS = (
    "coarsen MESH",
    "fit MESH",
    "gallery MESH",
    "generate ma165 -n 2",
    "extract MESH",
    "run RECIPE",
    "demo",
    "report MESH",
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
    "repose calibrate MESH --angle 30",
    "repose measure MESH",
)


@pytest.mark.parametrize("words", COMMANDS)
def test_that_a_place_that_cannot_be_written_is_one_sentence_before_anything_is_read(
    command, grains: Path, tmp_path: Path, words: str
) -> None:
    (tmp_path / "taken").write_text("mine")
    names = {"MESH": grains / "grain-a.stl", "RECIPE": tmp_path / "recipe.json"}
    (tmp_path / "recipe.json").write_text("{}")
    request = [names.get(word, word) for word in words.split()]
    result = command(*request, "-o", tmp_path / "taken" / "inside")
    assert result.code == 1
    assert result.err.strip() == f"{tmp_path / 'taken'} is a file; name a folder for the results."
    assert sorted(path.name for path in tmp_path.iterdir()) == ["recipe.json", "taken"]


@pytest.mark.skipif(os.name == "nt", reason="Windows does not say what a file system allows")
@pytest.mark.parametrize(
    ("flags", "reason"),
    [(0, "you are not allowed to"), (getattr(os, "ST_RDONLY", 1), "the file system is read-only")],
)
def test_that_a_place_that_is_not_writable_is_one_sentence(
    command, grains: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, flags: int, reason: str
) -> None:
    monkeypatch.setattr("os.access", lambda *_: False)
    monkeypatch.setattr("os.statvfs", lambda _: SimpleNamespace(f_flag=flags))
    result = command("coarsen", grains, "-o", tmp_path / "a" / "b")
    assert result.code == 1
    assert result.err.strip() == f"The folder {tmp_path} cannot be written ({reason})."


def test_that_a_file_is_not_written_over_a_folder(command, grains: Path, tmp_path: Path) -> None:
    result = command("fit", grains, "-o", tmp_path)
    assert result.code == 1
    assert result.err.strip() == f"{tmp_path} is a folder; name a file."


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


def test_that_links_that_lead_nowhere_and_places_without_a_name_are_refused(
    command, grains: Path, tmp_path: Path
) -> None:
    (tmp_path / "circle").symlink_to("circle")
    (tmp_path / "dangling").symlink_to("nowhere")
    for name in ("circle", "dangling"):
        result = command("coarsen", grains, "-o", tmp_path / name)
        assert result.code == 1
        assert "is a link that leads nowhere; name a folder for the results." in result.err
    result = command("coarsen", grains, "-o", "")
    assert result.code == 2
    assert "got an empty name" in result.err


def test_that_a_model_that_cannot_be_saved_is_said_before_the_work(command, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("mine")
    result = command("generate", "ma165", "-o", tmp_path / "v", "--save-model", tmp_path / "taken" / "m")
    assert result.code == 1
    assert "is a file" in result.err
    assert not (tmp_path / "v").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")
def test_that_odd_names_cost_nothing(command, grains: Path, tmp_path: Path) -> None:
    """Not UTF-8, as long as a name can be, and with a code that changes the colour of a terminal."""
    odd = [b"lat\xff.stl", b"x" * 251 + b".stl", b"red\x1b[31m.stl"]
    place = tmp_path / "grains"
    place.mkdir()
    for name in odd:
        (place / os.fsdecode(name)).write_bytes((grains / "grain-a.stl").read_bytes())
    (place / os.fsdecode(b"no\x1bmesh\xff.stl")).write_text("no mesh")
    result = command(
        "fit", place, "-o", tmp_path / "fit", "--l-max", 2, "--surfaces", tmp_path / "s", "--json"
    )
    assert result.code == 1, result.err  # for the file that is no mesh
    assert len(result.json["particles"]) == 3
    names = {each["name"] for each in result.json["particles"]}
    assert names == {"lat_", "x" * 100, "red_[31m"}
    assert {path.stem for path in (tmp_path / "s").glob("*.stl")} == names
    described = command("describe", place, "--csv", tmp_path / "t.csv")
    assert described.code == 1
    assert "\x1b" not in described.out + described.err
    assert command("generate", tmp_path / "fit", "-o", tmp_path / "v", "-n", 1, "--level", 1).code in (0, 1)


def test_that_a_range_of_degrees_is_checked_before_it_is_expanded(
    command, grains: Path, tmp_path: Path
) -> None:
    for degrees in ("1-1000000000", "5-1", "-1", "0-31"):
        result = command("study", "lmax", grains, "-o", tmp_path / "s", "--degrees", degrees)
        assert result.code == 2, result.err
    assert not (tmp_path / "s").exists()
