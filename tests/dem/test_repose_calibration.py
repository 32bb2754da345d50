"""Calibration of friction with heaps: resumed from its folder, stopped with the result so far."""

import itertools
import json
import shutil
from collections.abc import Callable, Generator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.cli.entry import run
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dataset.parameters import DrumRotation
from regolith_studio.dem.case import ReposeCase
from regolith_studio.dem.engine import SimulationResult
from regolith_studio.dem.run_io import case_document, find_runs
from regolith_studio.dem.snapshot import Snapshot
from regolith_studio.errors import InputError
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.jobs import repose_calibration, repose_jobs
from regolith_studio.jobs.events import Started, Steps
from regolith_studio.jobs.repose_calibration import ReposeCalibrationRequest, calibration_steps
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.steps import result_of
from regolith_studio.studies.figures import repose as figures
from regolith_studio.studies.repose_calibration import angle_target, calibration_document, drum_target
from tests.dem.cone_engine import cone_engine, tree, true_angle, write_figure

N = 300
Command = Callable[..., int]


@pytest.fixture
def calibrated(boxes_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Command:
    """The command, on an engine that needs no time."""
    monkeypatch.setattr(repose_jobs, "run_engine", cone_engine)
    monkeypatch.setattr(figures, "write_figure", write_figure)

    def calibrate(*words: str, place: str = "found") -> int:
        request = ["repose", "calibrate", str(boxes_folder), "-o", str(tmp_path / place), "-n", str(N)]
        return run([*request, *words])

    return calibrate


def result(folder: Path) -> dict[str, Any]:
    return dict(json.loads((folder / "calibration.json").read_text("utf-8")))


def test_that_the_friction_of_known_heaps_is_found(calibrated: Command, tmp_path: Path) -> None:
    assert calibrated("--angle", f"{true_angle(0.6)}", "--angle-error", "0.5", "--runs", "6") == 0
    found = result(tmp_path / "found")
    (friction,) = found["parameters"]
    assert friction["interval"][0] < 0.6 < friction["interval"][1]
    assert friction["relative_width"] == pytest.approx(np.ptp(friction["interval"]) / (0.9 * 1.15))
    assert found["effective_points"] < 0.5 * found["n_points"]
    assert np.ptp(friction["interval"]) < 0.5 * np.ptp(friction["intervals_after_each_run"][0])
    assert len(friction["intervals_after_each_run"]) == 7
    names = [each.folder.name for each in find_runs(tmp_path / "found")]
    assert names == [f"run_0{k}" for k in range(1, 7)]
    assert found["warnings"] == []


@pytest.mark.slow
def test_that_a_stopped_calibration_has_its_result_so_far_and_ends_with_the_same_bytes(
    calibrated: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ("--angle", "25", "--runs", "3")
    assert calibrated(*words, place="whole") == 0
    begun: list[object] = []

    def engine(*task: Any) -> Steps:
        begun.append(task)
        if len(begun) == 3:
            raise KeyboardInterrupt
        return (yield from cone_engine(*task))

    monkeypatch.setattr(repose_jobs, "run_engine", engine)
    assert calibrated(*words) == 130
    assert result(tmp_path / "found")["n_runs"] == 2
    assert calibrated(*words) == 0
    assert len(begun) == 4
    assert tree(tmp_path / "found") == tree(tmp_path / "whole")


def test_that_runs_are_data_for_another_wanted_angle(
    calibrated: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert calibrated("--angle", "25", "--runs", "2") == 0
    first = result(tmp_path / "found")["parameters"][0]["best"]
    monkeypatch.setattr(repose_jobs, "run_engine", None)  # no run is made
    assert calibrated("--angle", "28", "--runs", "2") == 0
    assert result(tmp_path / "found")["parameters"][0]["best"] > first


@pytest.mark.parametrize("other", [("--seed", "7"), ("--test", "lift_speed=0.02")])
def test_that_runs_of_another_case_are_no_data(
    calibrated: Command, capsys: pytest.CaptureFixture[str], other: tuple[str, ...]
) -> None:
    assert calibrated("--angle", "25", "--runs", "1") == 0
    assert calibrated("--angle", "25", "--runs", "1", *other) == 1
    assert "another dataset, engine, case or seed (run_01); choose another folder" in capsys.readouterr().err


def test_that_runs_without_an_angle_give_no_value(
    calibrated: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A layer has no angle: the middle of the range is no result."""

    def layer_engine(*arguments: Any) -> Generator[Snapshot, None, SimulationResult]:
        run = yield from cone_engine(*arguments)
        flat = run.particles.points * (1.0, 1.0, 0.05)
        return replace(run, particles=replace(run.particles, points=flat))

    monkeypatch.setattr(repose_jobs, "run_engine", layer_engine)
    assert calibrated("--angle", "30", "--runs", "2") == 0
    found = result(tmp_path / "found")
    assert (found["n_runs"], found["n_usable_runs"]) == (2, 0)
    assert found["parameters"][0]["best"] is None
    assert found["parameters"][0]["interval"] is None
    assert found["parameters"][0]["density"] is None
    assert found["effective_points"] == pytest.approx(found["n_points"], rel=0.01)
    printed = capsys.readouterr()
    assert "No run can be used" in printed.err
    assert "% interval" not in printed.out


@pytest.mark.slow
def test_that_an_angle_out_of_reach_is_said(calibrated: Command, capsys: pytest.CaptureFixture[str]) -> None:
    assert calibrated("--angle", "60", "--runs", "4") == 0
    assert "No values in the range give the wanted results" in capsys.readouterr().err


@pytest.mark.slow
def test_that_a_bulk_density_is_a_second_result(calibrated: Command, tmp_path: Path) -> None:
    """Of the density 3075 kg/m^3 in Table 1 and a solid fraction of .55."""
    density = ("--bulk-density", f"{3075 * 0.55}", "--bulk-density-error", "5")
    assert calibrated("--angle", f"{true_angle(0.5)}", *density, "--runs", "4") == 0
    found = result(tmp_path / "found")
    assert [each["name"] for each in found["targets"]] == ["angle", "bulk_density"]
    assert found["parameters"][0]["best"] == pytest.approx(0.5, abs=0.05)


@pytest.fixture
def truncated_folder(boxes: Dataset, tmp_path: Path) -> Path:
    """A dataset of cubes whose eight corners are cut off."""
    normals = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) / np.sqrt(3)
    sides = np.concatenate([np.eye(3), -np.eye(3), normals])
    cut = HalfSpaces(sides, np.concatenate([np.full(6, 0.5), np.full(8, 0.7)]))
    cut = cut.scaled(ConvexPolyhedron.from_half_spaces(cut).volume ** (-1 / 3))
    only = replace(boxes.representatives[0], weight=1.0, shape=ConvexPolyhedron.from_half_spaces(cut))
    return write_dataset(tmp_path / "truncated", replace(boxes, representatives=(only,)))


@pytest.mark.slow
def test_that_with_several_datasets_the_dataset_is_a_parameter(
    calibrated: Command,
    boxes_folder: Path,
    truncated_folder: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    words = (str(truncated_folder), "--angle", "25", "--runs", "3")
    assert calibrated(*words) == 0
    found = result(tmp_path / "found")
    _, dataset = found["parameters"]
    assert dataset["choices"] == [boxes_folder.name, "truncated"]
    last = dataset["probabilities_after_each_run"][-1]
    assert sum(last.values()) == pytest.approx(1.0)
    assert 0.9 < dataset["relative_width"] < 1.0  # so alike that three runs do not tell them apart
    assert (dataset["informed"], dataset["best"], dataset["probabilities"]) == (False, None, None)
    assert len(dataset["probabilities_after_each_run"]) == 4
    assert {run["dataset"] for run in found["runs"]} == {boxes_folder.name, "truncated"}
    printed = capsys.readouterr()
    assert "(probabilities: " not in printed.out
    assert "The runs say next to nothing of dataset" in printed.err
    before = tree(tmp_path / "found")
    assert calibrated(*words) == 0
    assert tree(tmp_path / "found") == before


def test_that_datasets_of_a_calibration_differ(
    calibrated: Command, boxes_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert calibrated(str(boxes_folder), "--angle", "25") == 2
    assert f"Two datasets have the name {boxes_folder.name}" in capsys.readouterr().err
    copy = shutil.copytree(boxes_folder, tmp_path / "copy")
    assert calibrated(str(copy), "--angle", "25") != 0
    assert f"{boxes_folder.name} and copy are the same dataset" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--parameter", "static_friction=1"), "KEY=LOW,HIGH"),
        (("--parameter", "static_friction=1,0.2"), "from a lower to a higher value"),
        (("--parameter", "static_friction=-1,1"), "must lie between"),
        (("--parameter", "shapes=1,2"), "cannot be calibrated"),
        (("--parameter", "stickiness=1,2"), "cannot be varied"),
        (("--parameter", "static_friction=a,b"), "KEY=LOW,HIGH"),
        (("--parameter", "static_friction"), "KEY=LOW,HIGH"),
        (("--parameter", "gravity=1,2", "--parameter", "gravity=1,3"), "gravity is given twice"),
    ],
)
def test_that_ranges_of_parameters_are_checked_before_any_run(
    calibrated: Command,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    words: tuple[str, ...],
    sentence: str,
) -> None:
    assert calibrated("--angle", "25", *words) == 2
    assert sentence in " ".join(capsys.readouterr().err.replace("│", " ").split())
    assert not (tmp_path / "found").exists()


def test_that_the_figure_shows_every_parameter(calibrated: Command, tmp_path: Path) -> None:
    words = ("--parameter", "static_friction=0.1,1", "--parameter", "rolling_friction=0,0.3")
    assert calibrated("--angle", "25", "--runs", "1", *words) == 0
    static, rolling = result(tmp_path / "found")["parameters"]
    assert (static["name"], rolling["name"]) == ("static_friction", "rolling_friction")
    assert static["informed"] is (static["relative_width"] <= 0.9) is (static["density"] is not None)
    assert (tmp_path / "found" / "calibration.png").is_file()


def test_that_two_angles_find_two_parameters_and_are_data_afterwards(
    boxes_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Angles that are linear in friction and rolling resistance, each in its own way."""
    places = []

    def simulated(_dataset: Path, place: Path, request: ReposeRequest) -> Steps:
        yield Started("")
        places.append(place.name)
        contact, turned = request.case.contact, request.case.drum is not None
        weights = (20.0, 30.0) if turned else (30.0, 10.0)
        angle = 10.0 + weights[0] * contact.static_friction + weights[1] * contact.rolling_friction
        return {
            "state": "finished",
            "case": case_document(request.case),
            "measurement": {"status": "drum" if turned else "pile", "angle_deg": angle},
        }

    monkeypatch.setattr(repose_calibration, "simulate_study_run", simulated)
    monkeypatch.setattr(repose_calibration, "write_calibration", lambda *_: [])
    targets = (angle_target(10.0 + 18.0 + 3.0, 0.5), drum_target(10.0 + 12.0 + 9.0, 0.5))  # at 0.6 and 0.3
    ranges = {"static_friction": (0.2, 1.0), "rolling_friction": (0.0, 0.6)}
    base = ReposeRequest(ReposeCase(n_particles=N), engine="box3d")
    wanted = ReposeCalibrationRequest((boxes_folder,), ranges, targets, base, 12, DrumRotation())
    done = result_of(calibration_steps(wanted, tmp_path / "found"))
    assert places[:4] == ["run_01", "run_01_drum", "run_02", "run_02_drum"]
    friction, rolling = calibration_document(done)["parameters"]
    assert friction["interval"][0] < 0.6 < friction["interval"][1]
    assert rolling["interval"][0] < 0.3 < rolling["interval"][1]
    assert np.ptp(rolling["interval"]) < 0.3
    with pytest.raises(InputError, match="no rotating drum"):
        replace(wanted, request=replace(base, engine="mujoco"))
