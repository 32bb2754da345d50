"""Whole runs on MuJoCo, small enough for every day: finished, repeated, crashed, cancelled."""

import hashlib
import json
import shutil
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import psutil
import pytest

from regolith_studio.cli.entry import run
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.folder_io import dataset_hash, read_dataset
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import ReposeMeasurement
from regolith_studio.dem.case import ReposeCase, prepare
from regolith_studio.dem.engine import RunChecks, SimulationResult
from regolith_studio.dem.engine_process import EngineError
from regolith_studio.dem.engines import ENGINES
from regolith_studio.dem.engines.mujoco import ENGINE
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.dem.run_io import (
    filling_hash,
    find_runs,
    read_run,
    read_shapes,
    settled_filling,
    snapshot_files,
)
from regolith_studio.dem.snapshot import ParticleState, Snapshot, particle_state_bytes, read_particle_state
from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.events import Partial, Progress
from regolith_studio.jobs.repose_jobs import (
    ReposeRequest,
    check_prepared,
    measure_result,
    prepared_case,
    repose_steps,
)
from regolith_studio.jobs.repose_study import (
    ReposeStudyRequest,
    ReposeVariant,
    finished_run,
    run_repose_study,
    study_repose,
    values_in,
    with_value,
)
from regolith_studio.messages import Message
from tests.dem.packings import cone

TEST = LiftingCylinderTest(mass=0.003, lift_speed=0.15)
CASE = ReposeCase(TEST, n_particles=40, seed=1)
QUICK = MujocoSettings(time_step=0.04, iterations=15, rest_energy=4e-3, rest_time=1.0, snapshots=20)
ORDER = ReposeRequest(CASE, settings=QUICK, evaluation=EvaluationSettings(min_particles=40))
COMMAND = [
    "-n",
    "40",
    "--measure",
    "min_particles=40",
    "--seed",
    "1",
    "--test",
    "mass=0.003",
    "--test",
    "lift_speed=0.15",
]
COMMAND += [
    word for each in ("time_step=0.04", "iterations=15", "rest_energy=0.004") for word in ("--set", each)
]
COMMAND += ["--set", "rest_time=1", "--set", "snapshots=20"]


NO_ANGLE = ("layer", "no flanks")
"""What forty particles form: which of them depends on the last bits of the simulation."""


@pytest.fixture(scope="module")
def finished(boxes_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "small"
    assert run(["repose", "run", str(boxes_folder), "-o", str(folder), *COMMAND]) == 0
    return folder


def test_that_a_run_leaves_everything_that_it_followed_from(finished: Path, boxes_folder: Path) -> None:
    document = read_run(finished).document
    assert document["state"] == "finished"
    assert document["dataset"]["sha256"] == dataset_hash(boxes_folder)
    assert document["engine"]["key"] == "mujoco"
    assert document["engine"]["version"]
    assert document["case"]["seed"] == 1
    assert document["case"]["test"]["mass"] == 0.003
    assert document["checks"]["particles_out"] == 40
    assert document["checks"]["max_overlap"] < 0.05
    assert document["checks"]["energy_gain"] < 0.05
    assert document["measurement"]["status"] in NO_ANGLE
    reason = document["measurement"]["reason"]
    assert isinstance(read_run(finished).message(reason), Message), "it can be translated"
    assert read_run(finished).message(reason) == reason
    assert "restitution" in document["not_given_in_the_paper"]


def test_that_a_run_and_a_measurement_of_its_file_are_one_answer(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Bricks lie flat, so that the plate cannot be told from the lowest particles."""
    points = 2e-3 * (cone(30, 400, 2) - [0.0, 0.0, 0.25])
    unturned, cubes = np.tile([1.0, 0, 0, 0], (400, 1)), np.zeros(400, dtype=int)
    pile = ParticleState(points, np.full(400, 2e-3), unturned, cubes)
    checks = RunChecks(400, 400, 0.0, 0.0, 0.0, 0.0, 0.0, True, 0.02, 0.55, 0.0)
    own = measure_result(SimulationResult(pile, checks, 1, 1.0), EvaluationSettings())
    assert isinstance(own, ReposeMeasurement)
    (tmp_path / "final.npz").write_bytes(particle_state_bytes(pile))
    assert run(["repose", "measure", str(tmp_path / "final.npz"), "--json"]) == 0
    measured = json.loads(capsys.readouterr().out)
    assert (measured["angle_deg"], *measured["interval_deg"]) == (own.angle, *own.interval)


def test_that_a_filled_cylinder_is_lifted_again_under_another_gravity(
    finished: Path, boxes_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["repose", "run", str(boxes_folder), "-o", str(tmp_path / "moon"), *COMMAND]
    again = [
        *command,
        "--filling",
        str(finished),
        "--test",
        "gravity=1.62",
        "--contact",
        "static_friction=0.7",
    ]
    assert run(again) == 0
    assert "filled with a friction of 0.8, not 0.7" in capsys.readouterr().err
    first, second = read_run(finished).document, read_run(tmp_path / "moon").document
    assert first["filling"] == {"sha256": None, "notes": []}
    filled = [
        state for state in map(read_particle_state, snapshot_files(finished)) if state.phase == "settle"
    ]
    begun = read_particle_state(snapshot_files(tmp_path / "moon")[0])
    assert begun.phase == "settle"
    np.testing.assert_allclose(begun.points, filled[-1].points, rtol=0.0, atol=1e-12)
    assert second["filling"]["notes"] == ["The cylinder was filled with a friction of 0.8, not 0.7."]
    assert second["filling"]["sha256"] == hashlib.sha256(particle_state_bytes(filled[-1])).hexdigest()
    assert second["run"]["steps"] < first["run"]["steps"]
    third = replace(with_value(ORDER, "static_friction", 0.7), filling=tmp_path / "moon")
    remembered = "moon: The cylinder was filled with a friction of 0.8, not 0.7."
    assert prepared_case(boxes_folder, third).filling_notes == (remembered,)


def test_that_a_filling_of_other_particles_is_refused_before_the_run(
    finished: Path, boxes_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["repose", "run", str(boxes_folder), "-o", str(tmp_path / "run"), *COMMAND]
    assert run([*command, "--filling", str(finished), "--seed", "2"]) == 1
    assert "filled with other particles" in capsys.readouterr().err
    assert run([*command, "--filling", str(tmp_path)]) == 1
    assert "holds no settled filling" in capsys.readouterr().err
    assert not (tmp_path / "run").exists()


@pytest.mark.slow
def test_that_a_study_lifts_one_filling_at_all_of_its_values(
    finished: Path, boxes_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The run of the first value is there already; what has another filling, or none, is no data."""
    study = shutil.copytree(finished, tmp_path / "study" / "static_friction_0.8_seed1").parent
    words = ["repose", "study", str(boxes_folder), "-o", str(study), "--vary", "static_friction=0.8,0.7"]
    assert run([*words, *COMMAND, "--same-filling"]) == 0
    assert "filled with a friction of 0.8, not 0.7" in capsys.readouterr().err
    second = study / "static_friction_0.7_seed1"
    document = read_run(second).document
    assert document["filling"]["sha256"] == filling_hash(settled_filling(finished))
    assert document["run"]["steps"] < read_run(finished).document["run"]["steps"]
    shared = replace(with_value(ORDER, "static_friction", 0.7), filling=finished)
    assert finished_run(second, boxes_folder, shared) == document
    assert finished_run(second, boxes_folder, replace(shared, filling=None)) is None
    assert finished_run(second, boxes_folder, replace(shared, filling=second)) is None


def test_that_the_snapshots_tell_the_whole_test(finished: Path) -> None:
    piles = [read_particle_state(path) for path in snapshot_files(finished)]
    assert [pile.time for pile in piles] == sorted(pile.time for pile in piles)
    assert piles[0].phase == "fill"
    assert {"fill", "lift"} <= {pile.phase for pile in piles}
    assert len(read_shapes(finished)) == 2
    lifted = [pile.wall for pile in piles if pile.phase == "lift"]
    assert lifted == sorted(lifted)
    final = read_particle_state(finished / "final.npz")
    assert final.points[:, 2].mean() < piles[0].points[:, 2].mean() / 2
    assert (final.points[:, 2] > 0.0).all()


def test_that_a_study_goes_on_where_it_was(finished: Path, boxes_folder: Path, tmp_path: Path) -> None:
    """The folder holds the run already, so nothing is simulated; a changed case would be."""
    shutil.copytree(finished, tmp_path / "static_friction_0.8_seed1")
    steps = run_repose_study(ReposeStudyRequest("static_friction", (0.8,), ORDER, boxes_folder), tmp_path)
    assert not [step for step in steps if isinstance(step, Progress) and "simulated" in step.message]
    files = {path.name for path in tmp_path.iterdir()}
    assert {f"repose_study.{kind}" for kind in ("csv", "json", "png", "svg")} < files
    other = with_value(ORDER, "static_friction", 0.1)
    fresh = study_repose([ReposeVariant("static_friction", 0.8, boxes_folder, other)], tmp_path)
    assert any(isinstance(step, Progress) and "simulated" in step.message for step in fresh)
    fresh.close()


@pytest.mark.slow
def test_that_shapes_are_varied_from_particles(tmp_path: Path) -> None:
    """A dataset a value, coarsened to it; the runs are not waited for."""
    ball = icosphere(2)
    particles = (Particle("ball", Mesh(40.0 * ball.vertices, ball.faces)),)
    coarsening = CoarseningRequest(LossWeights.of(), method="quadric", target="particle")
    few = EvaluationSettings(min_particles=20)
    order = replace(ORDER, case=replace(CASE, n_particles=20), evaluation=few)
    steps = run_repose_study(
        ReposeStudyRequest("n_facets", (8, 14), order, particles=particles, coarsening=coarsening), tmp_path
    )
    for step in steps:
        if isinstance(step, Progress) and "simulated" in step.message:
            break
    steps.close()
    journal = tmp_path / "journal" / "repose_study"
    built = [read_dataset(journal / "datasets" / f"n_facets-{n}").representatives[0].shape for n in (8, 14)]
    assert [shape.n_facets for shape in built] == [8, 14]


def test_that_values_are_read_as_their_key_has_them() -> None:
    assert values_in("n_facets", " 8, 20,8") == (8, 20)
    assert values_in("static_friction", "0.2, 1") == (0.2, 1.0)
    assert values_in("cohesion", "none,scaled") == ("none", "scaled")
    for key, text in (("n_facets", "8.5"), ("gravity", "moon")):
        with pytest.raises(InputError, match="commas"):
            values_in(key, text)
    assert with_value(ORDER, "gravity", "1.62").case.test.gravity == 1.62
    for key, value in (("colour", 1), ("gravity", "moon"), ("gravity", -1.0), ("cohesion", "glue")):
        with pytest.raises(InputError):
            with_value(ORDER, key, value)
    for request in (("static_friction", ()), ("static_friction", (0.2,)), ("n_facets", (8,))):
        with pytest.raises(InputError):
            ReposeStudyRequest(*request, ORDER)


def test_that_a_crash_of_the_engine_is_one_sentence_and_keeps_the_last_snapshot(
    boxes_folder: Path, tmp_path: Path
) -> None:
    steps = repose_steps(
        boxes_folder, tmp_path / "run", replace(ORDER, settings=replace(QUICK, snapshots=500))
    )
    _until_moment(steps)
    (victim,) = _workers()
    victim.kill()
    with pytest.raises(
        EngineError, match=r"MuJoCo was ended by signal 9; the last snapshot \(.* s\) is kept\."
    ):
        list(steps)
    assert read_run(tmp_path / "run").document["state"] == "failed"
    assert len(read_particle_state(snapshot_files(tmp_path / "run")[-1])) == 40


def test_that_a_cancelled_run_ends_its_process_and_says_so(boxes_folder: Path, tmp_path: Path) -> None:
    steps = repose_steps(boxes_folder, tmp_path / "run", ORDER)
    _until_moment(steps)
    (child,) = _workers()
    (stage,) = tmp_path.glob(".run.*.regolith-new")
    scratch = Path(child.environ()["TMPDIR"])
    assert scratch.parent == stage
    (scratch / "states").mkdir()  # as LAMMPS writes its own, and cannot remove when they are killed
    steps.close()
    assert not _workers()
    assert read_run(tmp_path / "run").document["state"] == "stopped"
    assert not list(tmp_path.rglob(".*"))
    assert [summary.angle for summary in find_runs(tmp_path)] == [None]


def test_that_a_folder_is_not_overwritten_unless_asked(boxes_folder: Path, tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(FileError, match=r"other files \(mine.txt\)"):
        list(repose_steps(boxes_folder, tmp_path, ORDER))
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "repose.json").write_text("{}")
    with pytest.raises(FileError, match="holds a run already"):
        list(repose_steps(boxes_folder, tmp_path / "run", ORDER))
    with pytest.raises(FileError, match="no result"):
        read_run(tmp_path / "run")


def test_that_a_stopped_run_replaces_no_finished_one(
    finished: Path, boxes_folder: Path, tmp_path: Path
) -> None:
    shutil.copytree(finished, tmp_path / "run")
    steps = repose_steps(boxes_folder, tmp_path / "run", replace(ORDER, overwrite=True))
    _until_moment(steps)
    steps.close()
    assert read_run(tmp_path / "run").document == read_run(finished).document
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


REFUSED = """
run --contact static_friction=-1 | 2 | must lie between
run --engine abacus | 2 | There is no engine 'abacus'; there are mujoco
run --set speed=3 | 2 | no setting of MuJoCo 'speed'
run --engine rapier --set time_step=1 | 2 | time_step must lie
run -n 12 --measure min_particles=10 | 1 | wider cylinder
run -n 120 --measure min_particles=150 | 1 | 120 particles are too few
run --bond 3 --cohesion given | 2 | either a Bond number or cohesion given
run --engine rapier --bond 3 | 1 | no cohesion; take one of the engines MuJoCo, Box3D, LAMMPS.
run --engine rapier --cohesion given | 1 | Rapier simulates no cohesion
run --engine rapier --contact rolling_friction=0.1 | 1 | Rapier simulates no rolling resistance
run --engine box3d --contact static_friction=0 | 1 | geometric mean of two frictions
study --engine rapier --vary rolling_friction=0,0.1 | 2 | Rapier simulates no rolling resistance
study --engine rapier --vary bond_number=0,1 | 2 | Rapier simulates no cohesion
study --vary static_friction | 2 | KEY=V1,V2
study --vary static_friction=-1 | 2 | must lie between
study --vary colour=red | 2 | cannot be varied
study --vary static_friction=,2 | 2 | KEY=V1,V2
study --vary n_particles=many | 2 | must be a number
study --vary n_particles=40,50 --same-filling | 1 | differ in n_particles have no filling in common
study --same-filling | 1 | differ in dataset have no filling in common
calibrate --angle 30 --engine rapier --parameter rolling_friction=0,1 | 2 | no rolling resistance
calibrate --angle 30 --engine mujoco --drum-angle 40 | 2 | MuJoCo simulates no rotating drum
drum --engine mujoco | 1 | MuJoCo simulates no rotating drum; take one of the engines Rapier, Box3D.
drum --rpm 5 --froude 0.1 | 2 | either --rpm or --froude
drum --test mass=0.002 | 1 | % of the drum
"""


@pytest.mark.parametrize("row", REFUSED.strip().splitlines())
def test_that_what_cannot_be_run_is_one_sentence_before_anything_runs(
    row: str, boxes_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words, code, sentence = row.split(" | ")
    name, *options = words.split()
    few = [] if name == "drum" or "min_particles" in words else ["--measure", "min_particles=40"]
    usual = [str(boxes_folder), "-o", str(tmp_path / "out"), "-n", "60", *few]
    assert run(["repose", name, *usual, *options]) == int(code)
    printed = " ".join(capsys.readouterr().err.replace("│", " ").split())
    assert sentence in printed
    assert "Traceback" not in printed
    assert not (tmp_path / "out").exists()


def test_that_shapes_which_an_engine_lacks_are_refused(boxes: Dataset, elbows: Dataset) -> None:
    convex, engine = (
        replace(ENGINE, capabilities=replace(ENGINE.capabilities, compounds="")),
        ENGINES["box3d"],
    )
    small = replace(CASE, n_particles=40)
    refused = "no compounds of convex parts .elbows.; take one of the engines MuJoCo, Rapier, Box3D, LAMMPS"
    with pytest.raises(InputError, match=refused):
        check_prepared(convex, prepare(elbows, small))
    check_prepared(convex, prepare(elbows, replace(small, shapes="spheres")))
    check_prepared(engine, prepare(elbows, small))
    with pytest.raises(InputError, match="convex particles only"):
        check_prepared(engine, prepare(elbows, replace(small, bond_number=1.0)))
    many = replace(prepare(boxes, small), shapes=(icosphere(2).vertices,) * 2)
    with pytest.raises(InputError, match="at most 44 facets"):
        check_prepared(engine, many)


def _workers() -> list[psutil.Process]:
    """Processes of engines that belong to this test."""
    return [
        each for each in psutil.Process().children() if "regolith_studio.dem.engine_process" in each.cmdline()
    ]


def _until_moment(steps: object) -> Snapshot:
    for step in steps:  # type: ignore[attr-defined]
        if isinstance(step, Partial):
            return step.value
    raise AssertionError("the run told no moment")


@pytest.mark.slow
def test_that_an_engine_does_not_outlive_a_program_that_was_killed(
    boxes_folder: Path, tmp_path: Path
) -> None:
    """Nobody is left to end it, so it must notice by itself."""
    command = [sys.executable, "-m", "regolith_studio", "repose", "run", str(boxes_folder), "-o"]
    parent = psutil.Popen([*command, str(tmp_path / "run"), *COMMAND, "--set", "time_step=0.001"])
    while not list(tmp_path.rglob("snapshots/*.npz")):
        assert parent.poll() is None
        time.sleep(0.05)
    workers = [each for each in parent.children() if "regolith_studio.dem.engine_process" in each.cmdline()]
    assert workers
    parent.kill()
    parent.wait()
    gone, alive = psutil.wait_procs(workers, timeout=30)
    assert gone
    assert not alive
