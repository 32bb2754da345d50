"""A study of the angle of repose is one result: replaced as a whole, resumed from its journal."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from regolith_studio.cli.entry import run
from regolith_studio.dem.run_io import find_runs
from regolith_studio.jobs import repose_jobs
from regolith_studio.studies.figures import repose as figures
from tests.dem.interrupted_study import SMALL, instant_engine, write_figure

ROOT = Path(__file__).resolve().parents[2]
RUNS = ["static_friction_0.2_seed0", "static_friction_0.8_seed0"]


@pytest.fixture
def words(boxes_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A study on an engine that needs no time, but for what varies."""
    monkeypatch.setattr(repose_jobs, "run_engine", instant_engine)
    monkeypatch.setattr(figures, "write_figure", write_figure)
    return ["repose", "study", str(boxes_folder), "-o", str(tmp_path / "study"), *SMALL.split()]


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def runs(folder: Path) -> list[str]:
    return [run.folder.name for run in find_runs(folder)]


def test_that_runs_of_a_stopped_study_wait_in_the_journal_for_the_others(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second value is interrupted first; then only that is run."""
    study, begun = tmp_path / "study", []

    def engine(*task: object) -> Iterator[object]:
        begun.append(task)
        if len(begun) == 2:
            raise KeyboardInterrupt
        return (yield from instant_engine(*task))  # type: ignore[arg-type]

    monkeypatch.setattr(repose_jobs, "run_engine", engine)
    both = [*words, "--vary", "static_friction=0.2,0.8"]
    assert run(both) == 130
    assert names(study) == ["journal"]
    assert runs(study / "journal" / "repose_study") == RUNS
    assert run(both) == 0
    assert len(begun) == 3
    files = [f"repose_study.{kind}" for kind in ("csv", "json", "png", "sha256", "svg")]
    assert names(study) == [*files, *RUNS]
    assert (study / RUNS[0] / "snapshots" / "000000.npz").is_file()


def test_that_a_study_of_other_values_keeps_the_runs_of_an_earlier_one(
    words: list[str], tmp_path: Path
) -> None:
    study = tmp_path / "study"
    assert run([*words, "--vary", "static_friction=0.2"]) == 0
    assert run([*words, "--vary", "static_friction=0.8"]) == 0
    assert runs(study) == RUNS
    assert [row.split(",")[1] for row in (study / "repose_study.csv").read_text().splitlines()[1:]] == ["0.8"]


def test_that_a_study_is_written_beside_files_of_others(words: list[str], tmp_path: Path) -> None:
    study = tmp_path / "study"
    study.mkdir()
    (study / "thesis.txt").write_text("important")
    for friction in ("0.2", "0.8"):
        assert run([*words, "--vary", f"static_friction={friction}"]) == 0
    assert (study / "thesis.txt").read_text() == "important"
    assert runs(study) == RUNS
    assert not (study / "journal").exists()


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="processes are forked")
def test_that_an_interrupted_study_leaves_the_earlier_one_or_the_new_one(tmp_path: Path) -> None:
    """One line of code in 25 that the study reaches, with and without a second interruption."""
    words = [sys.executable, "-m", "tests.dem.interrupted_study", str(tmp_path), "25"]
    ended = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=900, check=False)
    assert (ended.returncode, ended.stderr, ended.stdout) == (0, "", "")
