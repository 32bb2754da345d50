"""A study of the angle of repose is one result: replaced as a whole, resumed from its journal."""

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.cli.entry import run
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.case import PreparedCase, ReposeCase
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.dem.run_io import find_runs
from regolith_studio.dem.verification.bodies import cuboid
from regolith_studio.jobs import repose_jobs
from regolith_studio.jobs.events import Partial
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.jobs.repose_study import ReposeVariant, study_repose
from regolith_studio.studies.figures import repose as figures
from tests.dem.cone_engine import cone_engine, engine_of_cones, write_figure

SMALL = "-n 40 --measure min_particles=40 --test mass=0.003"
RUNS = ["static_friction_0.2_seed0", "static_friction_0.8_seed0"]


@pytest.fixture
def words(boxes_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A study on an engine that needs no time, but for what varies."""
    monkeypatch.setattr(repose_jobs, "run_engine", cone_engine)
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
        return (yield from cone_engine(*task))  # type: ignore[arg-type]

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


@pytest.mark.slow
@pytest.mark.parametrize("where", ["--jobs 2", "--jobs 2 --runner dask"])
def test_that_runs_at_the_same_time_give_the_bytes_of_runs_one_after_the_other(
    boxes_folder: Path, tmp_path: Path, where: str
) -> None:
    words = ["repose", "study", str(boxes_folder), "--vary", "static_friction=0.2,0.8", *SMALL.split()]
    for name, how in (("one", ""), ("two", where)):
        assert run([*words, "-o", str(tmp_path / name), *how.split()]) == 0
    found = [
        {
            path.relative_to(tmp_path / name): path.read_bytes()
            for path in (tmp_path / name).rglob("*")
            if path.is_file() and path.name not in ("times.json", "repose_study.sha256")
        }
        for name in ("one", "two")
    ]
    assert found[0] == found[1]
    assert len(found[0]) > 20


@pytest.mark.slow
def test_that_a_study_whose_runs_are_stopped_at_the_same_time_goes_on(
    boxes_folder: Path, tmp_path: Path
) -> None:
    """One of two runs is finished when the study is closed; the finished one is not run again."""
    study = tmp_path / "study"
    case = ReposeCase(LiftingCylinderTest(mass=0.003), n_particles=40)
    few = EvaluationSettings(min_particles=40)
    rows = [
        ReposeVariant("shapes", n, boxes_folder, ReposeRequest(replace(case, n_particles=n), evaluation=few))
        for n in (40, 600)
    ]
    steps = study_repose(rows, study, executor=2)
    for step in steps:
        if isinstance(step, Partial) and step.value.runs:
            break
    steps.close()
    assert runs(study / "journal" / "repose_study") == ["shapes_40_seed0", "shapes_600_seed0"]
    states = [run.document["state"] for run in find_runs(study / "journal" / "repose_study")]
    assert states == ["finished", "stopped"]
    again = study_repose(rows, study, executor=2)
    known = next(step for step in again if isinstance(step, Partial))
    again.close()
    assert [each.folder for each in known.value.runs] == ["shapes_40_seed0"]


@pytest.mark.parametrize("command", ["study", "calibrate --angle 30"])
def test_that_results_are_not_written_into_the_folder_of_a_dataset(
    boxes_folder: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    before = names(boxes_folder)
    assert run(["repose", *command.split(), str(boxes_folder), "-o", str(boxes_folder)]) == 2
    assert "is the folder of a dataset" in " ".join(capsys.readouterr().err.split())
    assert names(boxes_folder) == before


def test_that_a_study_of_other_values_keeps_the_runs_of_an_earlier_one(
    words: list[str], tmp_path: Path
) -> None:
    study = tmp_path / "study"
    assert run([*words, "--vary", "static_friction=0.2"]) == 0
    assert run([*words, "--vary", "static_friction=0.8"]) == 0
    assert runs(study) == RUNS
    assert [row.split(",")[1] for row in (study / "repose_study.csv").read_text().splitlines()[1:]] == ["0.8"]


def test_that_datasets_of_one_name_are_refused_before_any_run(
    words: list[str], boxes_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    again = shutil.copytree(boxes_folder, tmp_path / "elsewhere" / boxes_folder.name)
    assert run([*words, str(again)]) == 1
    assert "datasets different names" in " ".join(capsys.readouterr().err.split())
    assert not (tmp_path / "study").exists()


def test_that_a_study_is_written_beside_files_of_others(words: list[str], tmp_path: Path) -> None:
    study = tmp_path / "study"
    study.mkdir()
    (study / "thesis.txt").write_text("important")
    for friction in ("0.2", "0.8"):
        assert run([*words, "--vary", f"static_friction={friction}"]) == 0
    assert (study / "thesis.txt").read_text() == "important"
    assert runs(study) == RUNS
    assert not (study / "journal").exists()


def angle_by_aspect_ratio(prepared: PreparedCase) -> float:
    """20 degrees, and 5 more for every 1 of the aspect ratio of the cuboids."""
    extents = np.ptp(prepared.shapes[0], axis=0)
    return float(20 + 5 * extents.max() / extents.min())


def dataset_of_cuboids(folder: Path, aspect_ratio: float, boxes: Dataset) -> str:
    shape = cuboid(aspect_ratio, 1.0, 1.0)
    only = replace(boxes.representatives[0], weight=1.0, shape=shape)
    return str(write_dataset(folder / f"box{aspect_ratio}", replace(boxes, representatives=(only,))))


def test_that_angles_of_datasets_give_a_surface_over_their_aspect_ratios(
    boxes: Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(repose_jobs, "run_engine", engine_of_cones(angle_by_aspect_ratio))
    monkeypatch.setattr(figures, "write_figure", write_figure)
    folders = [dataset_of_cuboids(tmp_path / "data", ratio, boxes) for ratio in (1.0, 1.5, 2.0)]
    study = tmp_path / "study"
    words = ["repose", "study", *folders, "-o", str(study), "-n", "300", "--against", "aspect_ratio"]
    assert run(words) == 0
    (effect,) = json.loads((study / "response_surface_terms.json").read_text("utf-8"))["effects"]
    assert (effect["mean"], effect["range"]) == pytest.approx((1.5, 1.0))
    assert effect["change_over_range_deg"] == pytest.approx(5.0, abs=2.0)
    assert (study / "response_surface.png").is_file()
    assert "aspect_ratio" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ("aspect_ratio", "needs results at 3 different points or more, got 1"),
        ("volume", "There is no shape statistic 'volume'"),
    ],
)
def test_that_a_surface_is_refused_before_any_run(
    words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], keys: str, sentence: str
) -> None:
    assert run([*words, "--against", keys]) == 2
    assert sentence in " ".join(capsys.readouterr().err.replace("│", " ").split())
    assert not (tmp_path / "study").exists()
