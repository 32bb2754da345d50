"""Rapier as an engine, against theory: friction, restitution, a column; and that it repeats itself."""

import io
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rapier3d")

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem import engine_process
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.engine import SimulationResult
from regolith_studio.dem.engine_process import run_task
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.engines.rapier.simulation import RapierSolver, inner_parallel_body
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.dem.lifting_cylinder import N_WALLS, LiftingSettings, SubstepSettings
from regolith_studio.dem.run_io import read_run, snapshot_files
from regolith_studio.dem.separation import overlap_depths
from regolith_studio.dem.snapshot import EngineState, Snapshot, read_particle_state
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.repose_jobs import ReposeRequest, repose_steps

TEST = LiftingCylinderTest(mass=0.003, lift_speed=0.15)
SHORT = {"rest_energy": 4e-3, "rest_time": 1.0, "snapshots": 20}


def quick(key: str) -> LiftingSettings:
    """Settings of a short run."""
    settings: LiftingSettings = replace(engine_named(key).Settings(), **SHORT, time_step=0.04)
    return settings


def solver_of(boxes: Dataset, n: int = 10, **values: Any) -> RapierSolver:
    """Boxes in a world, with the values of Table 1 or 2."""
    known = LiftingCylinderTest.__dataclass_fields__
    test = replace(TEST, **{key: value for key, value in values.items() if key in known})
    contact = replace(
        ContactParameters(), **{key: value for key, value in values.items() if key not in known}
    )
    return RapierSolver(prepare(boxes, ReposeCase(test, contact, n_particles=n, seed=2)), SubstepSettings())


def place(solver: RapierSolver, points: FloatArray) -> None:
    """Put the particles there, unturned."""
    for body, point in zip(solver.particles, points.tolist(), strict=True):
        body.translation = point
        body.rotation = (0.0, 0.0, 0.0, 1.0)


def half_heights(solver: RapierSolver) -> FloatArray:
    prepared = solver.prepared
    half = np.array([shape[:, 2].max() for shape in prepared.shapes])[prepared.class_index]
    return np.asarray(half * prepared.scales / prepared.mean_diameter)


def test_that_rapier_fills_with_half_the_friction_of_particles_and_all_of_wall_and_plate(
    boxes: Dataset,
) -> None:
    """A wall or the plate multiplies its coefficient by that of the particle."""
    solver = solver_of(boxes, static_friction=0.6, wall_friction=0.3, plate_friction=0.9)
    for phase, share in (("fill", 0.5), ("settle", 1.0)):
        solver.begin(phase)
        bodies = (solver.particles[0], solver.cylinder, solver.plate)
        own, wall, plate = (solver.world.colliders[body.colliders[-1]].friction for body in bodies)
        assert (own, own * wall, own * plate) == pytest.approx((0.6 * share, 0.3, 0.9))


def test_that_nothing_is_faster_than_a_fall_from_the_top_of_the_filling_while_the_cylinder_rises(
    boxes: Dataset,
) -> None:
    solver = solver_of(boxes, n=30)
    solver.begin("lift")
    solver.particles[-1].linvel = (0.0, 0.0, 50.0)
    solver.advance(0.01, 1)
    speed = solver.particles[-1].linvel.z * solver.unit_length / solver.unit_time
    height = solver.prepared.fill_height
    assert speed == pytest.approx(np.sqrt(2.0 * TEST.gravity * height), rel=0.02)


def test_that_a_column_of_boxes_stands(boxes: Dataset) -> None:
    solver = solver_of(boxes, n=20)
    half = half_heights(solver)
    tops = np.cumsum(2 * half)
    place(solver, np.column_stack([np.zeros(20), np.zeros(20), tops - half]))
    solver.begin("rest")
    solver.advance(0.05, 2000)
    assert np.abs(solver.points[:, :2]).max() < 0.02
    assert solver.points[-1, 2] == pytest.approx(tops[-1] - half[-1], rel=3e-3)


def test_that_no_particle_gets_between_the_boxes_of_the_wall(boxes: Dataset) -> None:
    """Balls thrown at the corners of the ring."""
    case = ReposeCase(TEST, n_particles=N_WALLS, shapes="spheres")
    solver = RapierSolver(prepare(boxes, case), SubstepSettings())
    radius = 0.01 / solver.prepared.mean_diameter
    angle = 2 * np.pi * (np.arange(N_WALLS) + 0.5) / N_WALLS
    out = np.column_stack([np.cos(angle), np.sin(angle)])
    heights = 0.6 + 1.3 * (np.arange(N_WALLS) % 4)
    place(solver, np.column_stack([(radius - 0.7) * out, heights]))
    for body, way in zip(solver.particles, out.tolist(), strict=True):
        body.linvel = (5.0 * way[0], 5.0 * way[1], 0.0)
    solver.begin("settle")
    for _ in range(40):
        solver.advance(0.025, 1)
        reach = np.hypot(*solver.points[:, :2].T) + solver.prepared.diameters / solver.unit_length / 2
        assert reach.max() < radius / np.cos(np.pi / N_WALLS) + 0.05


def test_that_facets_of_the_core_lie_a_radius_within_those_of_the_polyhedron() -> None:
    cube = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1.0, 1)])
    core = inner_parallel_body(cube, 0.1)
    assert np.unique(np.round(np.abs(core), 12)).tolist() == [0.9]
    assert len(core) == 8


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_that_polyhedra_with_sharp_edges_overlap_little_in_a_heap(boxes: Dataset, seed: int) -> None:
    """Corners stand out of the rounded bodies that are simulated: by 0.018 with edges of 0.02 diameters."""
    prepared = prepare(boxes, ReposeCase(TEST, n_particles=60, seed=seed))
    heap, _ = finish(engine_named("rapier").simulate(prepared, quick("rapier")))
    assert overlap_depths(prepared, heap.particles).max() < 0.01 * prepared.mean_diameter


def test_that_overlaps_are_those_of_the_places_and_not_of_the_last_step(boxes: Dataset) -> None:
    """Two particles a tenth of a diameter into each other, and one as far into the plate."""
    solver = solver_of(boxes)
    half = half_heights(solver)
    points = np.column_stack([5.0 * np.arange(10.0), np.zeros(10), half + 1.0])
    points[1] = points[0] + (0.0, 0.0, half[:2].sum() - 0.1)
    points[2, 2] = half[2] - 0.1
    place(solver, points)
    assert solver.overlaps() == pytest.approx([0.1, 0.1], abs=1e-5)


def finish(steps: Generator[Snapshot, None, SimulationResult]) -> tuple[SimulationResult, list[EngineState]]:
    """The result, and the state of every third snapshot."""
    states = []
    while True:
        try:
            snapshot = next(steps)
        except StopIteration as end:
            return end.value, states
        if len(states) < 8 and snapshot.state is not None:
            states.append(snapshot.state())


@pytest.mark.parametrize("key", ["mujoco", "rapier"])
def test_that_a_run_goes_on_from_any_state_as_if_it_had_not_been_interrupted(
    boxes: Dataset, key: str
) -> None:
    prepared = prepare(boxes, ReposeCase(TEST, n_particles=40, seed=1))
    engine = engine_named(key)
    whole, states = finish(engine.simulate(prepared, quick(key)))
    for state in (states[3], states[-1]):
        rest, _ = finish(engine.resume(prepared, quick(key), state))  # type: ignore[attr-defined]
        assert rest.particles.points.tobytes() == whole.particles.points.tobytes()
        assert (rest.checks, rest.steps, rest.notes) == (whole.checks, whole.steps, whole.notes)


def test_that_equal_seeds_give_equal_bytes_with_any_number_of_threads(
    boxes: Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    prepared = prepare(boxes, ReposeCase(TEST, n_particles=60, seed=1))
    found = set()
    for threads in ("1", "1", "2", "3"):
        monkeypatch.setenv("RAYON_NUM_THREADS", threads)
        result, _ = finish(engine_named("rapier").simulate(prepared, quick("rapier")))
        found.add(result.particles.points.tobytes() + result.particles.orientations.tobytes())
        assert "Equal seeds give equal bytes" in result.notes[-1]
    assert len(found) == 1


class Killed(BaseException):
    """In place of a signal."""


@pytest.mark.slow
@pytest.mark.parametrize("key", ["mujoco", "rapier"])
def test_that_a_killed_run_goes_on_and_ends_as_one_that_was_not(
    boxes_folder: Path, tmp_path: Path, key: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    request = ReposeRequest(
        ReposeCase(TEST, n_particles=40, seed=1), key, quick(key), EvaluationSettings(min_particles=40)
    )
    for _ in repose_steps(boxes_folder, tmp_path / "whole", request):
        pass
    kill_after_states(boxes_folder, tmp_path / "killed", request, 5, monkeypatch)
    (stage,) = tmp_path.glob(".killed*")
    (stage / ".engine-of-the-killed").mkdir()
    written = {path.name for path in snapshot_files(stage)}
    for path in snapshot_files(stage)[:2]:
        path.write_bytes(b"was here")  # a run from the beginning would write it again
    for _ in repose_steps(boxes_folder, tmp_path / "killed", request):
        pass
    assert sorted(path.name for path in tmp_path.iterdir()) == ["killed", "whole"]
    assert snapshot_files(tmp_path / "killed")[0].read_bytes() == b"was here"
    for name in ("repose.json", "final.npz", "shapes.npz"):
        assert (tmp_path / "killed" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    inside = [{path.name for path in (tmp_path / name).iterdir()} for name in ("killed", "whole")]
    assert inside[0] == inside[1]
    assert written < {path.name for path in snapshot_files(tmp_path / "killed")}
    first, second = (snapshot_files(tmp_path / name)[-1] for name in ("killed", "whole"))
    assert read_particle_state(first).time == read_particle_state(second).time


@pytest.mark.slow
def test_that_what_another_run_left_is_not_gone_on_from(
    boxes_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    request = ReposeRequest(
        ReposeCase(TEST, n_particles=40, seed=1),
        "rapier",
        quick("rapier"),
        EvaluationSettings(min_particles=40),
    )
    kill_after_states(boxes_folder, tmp_path / "run", request, 5, monkeypatch)
    other = replace(request, case=replace(request.case, seed=2))
    for name in ("run", "fresh"):
        for _ in repose_steps(boxes_folder, tmp_path / name, other):
            pass
    assert read_run(tmp_path / "run").document == read_run(tmp_path / "fresh").document
    names = [[path.name for path in snapshot_files(tmp_path / name)] for name in ("run", "fresh")]
    assert names[0] == names[1]


def kill_after_states(
    dataset: Path, folder: Path, request: ReposeRequest, states: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a killed run leaves, its states saved at every snapshot."""
    from regolith_studio.dataset.folder_io import dataset_hash, read_dataset

    class Pipe(io.BytesIO):
        written = 0

        def flush(self) -> None:
            self.written += 1
            if self.written > states + 1:
                raise Killed

    monkeypatch.setattr(engine_process, "STATE_INTERVAL", -1.0)
    stage = folder.with_name(f".{folder.name}.unfinished.regolith-new")
    (stage / "snapshots").mkdir(parents=True)
    prepared: PreparedCase = prepare(read_dataset(dataset), request.case, dataset_hash(dataset))
    with pytest.raises(Killed):
        run_task(Pipe(), request.engine, prepared, request.settings, stage)
    assert (stage / "state.zip").exists()
