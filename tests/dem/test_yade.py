"""YADE as an engine: what it is told, what becomes of its states and its crashes; and the program itself."""

import itertools
import json
import os
import shutil
import stat
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem.case import ReposeCase, prepare
from regolith_studio.dem.engine import SimulationResult
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.engines.yade.program import YadeSettings, command, find_yade
from regolith_studio.dem.engines.yade.simulation import LENGTH, TIME, WEIGHT, input_document
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.dem.snapshot import Snapshot
from regolith_studio.errors import InputError, RegolithError
from tests.tolerance import relative

ENGINE = engine_named("yade")
SMALL = ReposeCase(LiftingCylinderTest(mass=0.003, lift_speed=0.3), n_particles=20, seed=2)
PRETENDER = '''#!{python}
"""Writes states as YADE's script does, and dies as a crash would."""
import json, os, pathlib, signal, sys
folder = pathlib.Path(sys.argv[-1])
order = json.loads((folder / "input.json").read_text())
rows = [[*p["place"], *p["turn"], *p["velocity"], *p["spin"]] for p in order["particles"]]
phases = ["fill", "settle", "lift", "rest", "rest"]
for number in range(order["number"], 5):
    if number in {crashes} and number > order["number"]:
        os.kill(os.getpid(), signal.SIGSEGV)
    state = dict(phase=phases[number], time=number * 0.1, rim=0.0, kinetic=0.0, potential=0.0, steps=10,
                 last=number == 4, at_rest=True, particles=rows)
    (folder / "new").write_text(json.dumps(state))
    (folder / "new").replace(folder / f"state.{{number:06d}}.json")
'''


@pytest.fixture
def pretender(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Puts a program on the path that calls itself yade and crashes before these states."""

    def put(*crashes: int) -> None:
        path = tmp_path / "yade"
        path.write_text(PRETENDER.format(python=sys.executable, crashes=list(crashes)))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")

    return put


def outcome(
    case: ReposeCase, boxes: Dataset, settings: YadeSettings
) -> tuple[list[Snapshot], SimulationResult]:
    steps, moments = ENGINE.simulate(prepare(boxes, case), settings), []
    while True:
        try:
            moments.append(next(steps))
        except StopIteration as end:
            return moments, end.value


def test_that_the_input_is_the_case_in_the_solver_s_units(boxes: Dataset) -> None:
    prepared, settings = prepare(boxes, SMALL), YadeSettings()
    document = input_document(prepared, settings, 60.0, None)
    volumes = np.array([one["scale"] ** 3 for one in document["particles"]])
    assert (6 * volumes / np.pi) ** (1 / 3) == pytest.approx(
        prepared.diameters / prepared.mean_diameter * LENGTH
    )
    assert document["tube"]["radius"] / LENGTH == pytest.approx(0.01 / prepared.mean_diameter)
    froude = document["plan"]["lift_speed"] ** 2 / (document["gravity"] * LENGTH)
    assert froude == pytest.approx(0.3**2 / (9.81 * prepared.mean_diameter))
    # a mean particle's weight on a flat contact of half its size squared sinks in by 1/2,500 of its size
    depth = WEIGHT / (document["young"] / 2 * 0.5 * LENGTH**2)
    assert depth / LENGTH == pytest.approx(1 / (0.5 * settings.stiffness))
    smallest = volumes.min() * 3000
    swing = np.sqrt(smallest / (document["young"] / 2 * 0.5 * (6 / np.pi * volumes.min()) ** (2 / 3)))
    assert document["time_step"] == pytest.approx(0.35 * swing)
    assert json.loads(json.dumps(document)) == document


def test_that_states_become_moments_in_si(boxes: Dataset, pretender) -> None:
    pretender()
    moments, ending = outcome(SMALL, boxes, YadeSettings())
    prepared = prepare(boxes, SMALL)
    column = loose_column(prepared)
    assert [moment.particles.phase for moment in moments] == ["fill", "settle", "lift", "rest", "rest"]
    assert moments[0].particles.points == pytest.approx(column.points)
    assert moments[0].particles.orientations == pytest.approx(column.orientations)
    second = np.sqrt(prepared.mean_diameter / 9.81)
    assert ending.simulated_time == pytest.approx(0.4 / TIME * second)
    assert ending.checks.particles_out == 20
    assert ending.checks.max_overlap == 0.0


def test_that_a_crash_is_answered_from_the_last_state(boxes: Dataset, pretender) -> None:
    pretender(2, 4)
    moments, ending = outcome(SMALL, boxes, YadeSettings())
    assert [moment.particles.phase for moment in moments] == ["fill", "settle", "lift", "rest", "rest"]
    assert "YADE crashed 2 times and went on from its last snapshot." in ending.notes


def test_that_too_many_crashes_are_one_sentence(boxes: Dataset, pretender) -> None:
    pretender(2, 4)
    with pytest.raises(RegolithError, match="signal 11, after 1 restarts; the last snapshot is kept"):
        outcome(SMALL, boxes, YadeSettings(restarts=1))
    pretender(0, 1)
    with pytest.raises(RegolithError, match="last snapshot is kept"):
        outcome(SMALL, boxes, YadeSettings(restarts=0))


@pytest.mark.parametrize(
    ("case", "word"),
    [
        (replace(SMALL, shapes="spheres"), "with polyhedra"),
        (replace(SMALL, cohesion="given"), "no cohesion"),
        (replace(SMALL, contact=ContactParameters(rolling_friction=0.1)), "no rolling resistance"),
    ],
)
def test_that_what_the_law_does_not_know_is_refused(boxes: Dataset, case: ReposeCase, word: str) -> None:
    with pytest.raises(InputError, match=word):
        ENGINE.simulate(prepare(boxes, case), YadeSettings())


def test_that_a_missing_program_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    assert "not installed" in find_yade().problem


needs_yade = pytest.mark.skipif(shutil.which("yade") is None, reason="YADE is not installed")


@needs_yade
def test_that_yade_begins_where_it_is_told(boxes: Dataset) -> None:
    assert ENGINE.find().version.startswith("20")
    steps = ENGINE.simulate(prepare(boxes, SMALL), YadeSettings(snapshots=2000))
    first, second = next(steps), next(steps)
    steps.close()
    column = loose_column(prepare(boxes, SMALL))
    drop = column.points[:, 2] - first.particles.points[:, 2]
    assert first.particles.points[:, :2] == pytest.approx(
        column.points[:, :2], abs=1e-4 * column.diameters.max()
    )
    assert drop.min() >= 0.0
    turned = np.abs((first.particles.orientations * column.orientations).sum(axis=1))
    assert np.quantile(turned, 0.2) == pytest.approx(1.0, abs=1e-6)
    assert second.particles.points[:, 2].mean() < first.particles.points[:, 2].mean()


@needs_yade
def test_that_a_turned_box_spins_in_yade_with_its_own_moments(tmp_path: Path, boxes: Dataset) -> None:
    """A box of 4 x 1 x .5 mm without weight keeps the energy of its spin, w I w / 2 in closed form."""
    edges, spin = np.array([4e-3, 1e-3, 0.5e-3]), np.array([3.0, -7.0, 11.0])
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * edges
    turn = Rotation.from_rotvec(0.7 * np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0))
    document = input_document(prepare(boxes, SMALL), YadeSettings(), 60.0, None)
    document |= {"shapes": [(corners / 1e-3).tolist()], "gravity": 0.0, "damping": 0.0, "time_step": 1e-5}
    document["particles"] = [
        {
            "shape": 0,
            "scale": 1e-3,
            "place": [0.0, 0.0, 5 * LENGTH],
            "turn": turn.as_quat(scalar_first=True).tolist(),
            "velocity": [0.0, 0.0, 0.0],
            "spin": spin.tolist(),
        }
    ]
    document["plan"] |= {"look": 1e-3, "rest_energy": 1.0, "rest_time": 0.0}
    (tmp_path / "input.json").write_text(json.dumps(document))
    words, environment = command(tmp_path)
    subprocess.run(words, env=environment, cwd=tmp_path, check=True, capture_output=True, timeout=250)
    mass = document["density"] * edges.prod()
    moments = mass / 12 * ((edges**2).sum() - edges**2)
    energy = 0.5 * (moments * turn.inv().apply(spin) ** 2).sum()
    first = json.loads((tmp_path / "state.000000.json").read_text())
    assert first["kinetic"] == relative(energy, 1e-4)
    assert first["particles"][0][:3] == pytest.approx([0.0, 0.0, 5 * LENGTH], abs=1e-12)


@needs_yade
@pytest.mark.slow
def test_that_yade_fills_lifts_and_comes_to_rest(boxes: Dataset) -> None:
    moments, ending = outcome(SMALL, boxes, YadeSettings(stiffness=3e3, snapshots=20))
    assert ending.checks.particles_out == 20
    assert ending.checks.at_rest
    assert ending.checks.energy_gain < 0.05
    filled = [moment.particles for moment in moments if moment.particles.phase in ("fill", "settle")]
    assert max(np.hypot(*pile.points[:, :2].T).max() for pile in filled) < SMALL.test.diameter / 2
    assert ending.particles.points[:, 2].max() < moments[0].particles.points[:, 2].max() / 2
    assert list(dict.fromkeys(moment.particles.phase for moment in moments)) == [
        "fill",
        "settle",
        "lift",
        "rest",
    ]
