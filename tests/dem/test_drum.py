"""Rotating drum: surfaces of known slope, series of known avalanches, walls that turn, a whole run."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.cli.entry import run as run_command
from regolith_studio.dataset.parameters import DRUM, DrumRotation, LiftingCylinderTest, rpm_of
from regolith_studio.dem.case import ReposeCase, prepare
from regolith_studio.dem.drum_angle import avalanches, block_bootstrap, measure_drum, surface_slope
from regolith_studio.dem.engines import ENGINES, engine_named
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.lifting_cylinder import LiftingRun, engine_state, resume_lifting, simulate_lifting
from regolith_studio.dem.rotating_drum import TURNING, DrumSolver
from regolith_studio.dem.snapshot import TURN, ParticleState
from regolith_studio.dem.verification.bodies import cuboid, scene
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.steps import result_of

DRUM_ENGINES = [key for key, engine in ENGINES.items() if engine.capabilities.drum and engine.find().there]


def bed(degrees: float, seed: int, radius: float = 10.0, depth: float = 8.0) -> tuple[FloatArray, FloatArray]:
    """Grains of a random packing in a drum below a plane of this slope: centres and diameters."""
    random = np.random.default_rng(seed)
    lattice = np.stack(np.meshgrid(*[np.arange(-12.0, 12.0, 0.95)] * 3, indexing="ij"), axis=-1).reshape(
        -1, 3
    )
    points = lattice + random.uniform(-0.45, 0.45, lattice.shape)
    sizes = random.lognormal(0.0, 0.15, len(points))
    inside = (np.hypot(points[:, 0], points[:, 2]) < radius - sizes / 2) & (np.abs(points[:, 1]) < depth / 2)
    below = points[:, 2] < np.tan(np.radians(degrees)) * points[:, 0] - 1.0 - sizes / 2
    kept = inside & below
    return points[kept] + (0.0, 0.0, radius), sizes[kept]


@pytest.mark.parametrize("degrees", [-10.0, 0.0, 20.0, 35.0, 50.0])
def test_that_the_slope_of_a_bed_is_found_also_with_flying_grains(degrees: float) -> None:
    found = []
    for seed in range(8):
        points, sizes = bed(degrees, seed)
        flying = np.random.default_rng(seed).uniform((-6.0, -4.0, 14.0), (6.0, 4.0, 18.0), (6, 3))
        with_flying = np.concatenate([points, flying]), np.concatenate([sizes, np.ones(6)])
        found.append([surface_slope(points, sizes, 10.0)[0], surface_slope(*with_flying, 10.0)[0]])
    mean, scatter = np.mean(found, axis=0), np.std(found, axis=0)
    assert np.abs(mean - degrees).max() < 1.0
    assert scatter.max() < 2.0


def test_that_a_bed_of_few_grains_has_no_surface() -> None:
    points, sizes = bed(30.0, 0, radius=2.0)
    with pytest.raises(NotAPileError) as refusal:
        surface_slope(points, sizes, 2.0)
    assert refusal.value.status == "no surface"


@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_that_upper_and_lower_angle_of_a_saw_tooth_are_found(noise: float) -> None:
    """The angle rises from 32 to 38 degrees in twelve moments and falls in two."""
    tooth = np.concatenate([np.linspace(32.0, 38.0, 13), [35.0]])
    angles = np.tile(tooth, 12) + noise * np.random.default_rng(0).normal(size=14 * 12)
    maxima, minima = avalanches(angles)
    assert (len(maxima), len(minima)) == (12, 11)
    assert maxima.mean() == pytest.approx(38.0, abs=0.01 + 1.5 * noise)
    assert minima.mean() == pytest.approx(32.0, abs=0.01 + 1.5 * noise)


def test_that_noise_alone_has_no_avalanches() -> None:
    maxima, minima = avalanches(30.0 + np.random.default_rng(1).normal(size=300))
    assert len(maxima) + len(minima) <= 30
    assert len(avalanches(np.full(50, 30.0))[0]) == 0


def test_that_the_interval_of_a_correlated_series_holds_its_mean_as_often_as_it_says() -> None:
    """Autoregressive series with a coefficient of 0.8: independent resampling would hold it in half."""
    random, held = np.random.default_rng(2), 0
    for _ in range(100):
        series = np.zeros(300)
        for k, push in enumerate(random.normal(size=299)):
            series[k + 1] = 0.8 * series[k] + push
        low, high = block_bootstrap(series)
        held += low <= 0.0 <= high
    assert held >= 85


def test_that_a_froude_number_is_that_of_its_speed() -> None:
    test = LiftingCylinderTest(diameter=0.1, gravity=1.62)
    assert DrumRotation(rpm_of(0.02, test)).froude(test) == pytest.approx(0.02)
    assert rpm_of(1.0, test) == pytest.approx(60 / (2 * np.pi) * np.sqrt(1.62 / 0.05))


@pytest.mark.parametrize("engine", DRUM_ENGINES)
@pytest.mark.parametrize("friction", [0.3, 0.8])
def test_that_blocks_on_the_turning_wall_slip_at_its_angle_of_friction(engine: str, friction: float) -> None:
    """They are carried up and slide back: on a smooth wall they would stay at arctan mu."""
    prepared = scene([cuboid(2, 2, 1)], friction, 3)
    drum, test = DrumRotation(rpm=60.0), replace(DRUM, height=0.02, wall_friction=friction)
    prepared = replace(prepared, case=replace(prepared.case, test=test, drum=drum))
    settings = engine_named(engine).Settings()
    solver = engine_named(engine).solver(prepared, settings)
    assert isinstance(solver, DrumSolver)
    run = LiftingRun(prepared, settings, solver, TURNING)
    places = np.array([[0.0, -19.5, z] for z in (4.0, 10.0, 16.0)])
    solver.place(places, np.tile([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0], (3, 1)))
    solver.begin(TURN)
    run.phase, run.end = TURN, solver.time + TURNING.longest(run, TURN)
    TURNING.move_walls(run)
    solver.advance(0.05, 600)
    angles = []
    for _ in range(60):
        solver.advance(0.05, 20)
        x, y = solver.points[:, :2].T
        angles.append(np.degrees(np.arctan2(x, -y)))
    assert np.mean(angles) == pytest.approx(np.degrees(np.arctan(friction)), abs=6.0)


def test_that_a_drum_runs_measures_and_says_what_it_was(boxes_folder: Path, tmp_path: Path, capsys) -> None:
    command = f"repose drum {boxes_folder} -o {tmp_path / 'drum'} --particles 150 --froude 0.02"
    assert (
        run_command(
            f"{command} --turns 0.2 --moments 40 --seed 3 --measured 40 --measured-error 2 --json".split()
        )
        == 0
    )
    document = json.loads(capsys.readouterr().out)
    compared, (low, high) = document["measured"], document["measurement"]["interval_deg"]
    assert compared["difference_deg"] == pytest.approx(document["measurement"]["angle_deg"] - 40.0)
    half = np.hypot((high - low) / 2, 1.96 * 2.0)
    assert np.ptp(compared["interval_deg"]) == pytest.approx(2 * half, rel=1e-3)
    measured = document["measurement"]
    assert measured["status"] == "drum"
    assert measured["froude"] == pytest.approx(0.02)
    low, high = measured["interval_deg"]
    assert 15.0 < low <= measured["angle_deg"] <= high < 70.0
    assert len(measured["angles_deg"]) == pytest.approx(40, abs=4)
    assert document["checks"]["particles_out"] == 150
    assert document["case"]["drum"]["turns"] == 0.2


def test_that_a_drum_goes_on_from_its_state(boxes) -> None:
    drum = DrumRotation(rpm=120.0, turns=0.1, moments=20)
    prepared = prepare(boxes, ReposeCase.in_drum(drum, n_particles=60))
    engine = engine_named("rapier")
    settings = engine.Settings()
    run = LiftingRun(prepared, settings, engine.solver(prepared, settings), TURNING)
    steps, state = simulate_lifting(run), None
    while True:
        try:
            moment = next(steps)
        except StopIteration as end:
            first = end.value
            break
        if state is None and moment.particles.phase == TURN:
            state = engine_state(run)
    again = LiftingRun(prepared, settings, engine.solver(prepared, settings), TURNING)
    assert state is not None
    second = result_of(resume_lifting(again, state))
    assert np.abs(second.particles.points - first.particles.points).max() < 1e-9


def test_that_too_few_moments_are_refused(boxes) -> None:
    prepared = prepare(boxes, ReposeCase.in_drum(DrumRotation(), n_particles=60))
    points, sizes = bed(30.0, 1)
    none = np.zeros(len(points), dtype=np.int64)
    state = ParticleState(points, sizes, np.tile([1.0, 0, 0, 0], (len(points), 1)), none, phase=TURN)
    with pytest.raises(NotAPileError) as refusal:
        measure_drum(prepared, [state] * 3)
    assert refusal.value.status == "too few moments"
