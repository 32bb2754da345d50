"""Run YADE and read its states; after a crash continue from the last state."""

import json
import re
import tempfile
from collections.abc import Generator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, SimulationResult
from regolith_studio.dem.engines.yade.input_files import LENGTH, YadeState, input_document, read_yade_state
from regolith_studio.dem.engines.yade.program import YadeSettings, command
from regolith_studio.dem.external_program import printed_lines, running_program, written_files
from regolith_studio.dem.lifting_cylinder import expected_duration
from regolith_studio.dem.run_checks import check_run, measure_filling
from regolith_studio.dem.separation import overlap_depths
from regolith_studio.dem.snapshot import ParticleState, Snapshot, progress_message
from regolith_studio.errors import RegolithError


@dataclass(eq=False)
class _Run:
    prepared: PreparedCase
    settings: YadeSettings
    duration: float
    states: list[YadeState] = field(default_factory=list)
    particles: ParticleState | None = None
    fill: tuple[float, float] = (0.0, 0.0)
    crashes: int = 0
    earlier_steps: int = 0

    @property
    def second(self) -> float:
        """Seconds in a unit of time."""
        return float(np.sqrt(self.prepared.mean_diameter / self.prepared.case.test.gravity))

    @property
    def last(self) -> YadeState | None:
        return self.states[-1] if self.states else None


def simulate(prepared: PreparedCase, settings: YadeSettings) -> Generator[Snapshot, None, SimulationResult]:
    """Write the input, run YADE, read its states; after a crash continue from the last one.

    Raises
    ------
    RegolithError
        If YADE crashes more often than allowed, or ends before its time for another reason.
    """
    run = _Run(prepared, settings, expected_duration(prepared))
    with tempfile.TemporaryDirectory(prefix="regolith-yade-") as name:
        folder = Path(name)
        while run.last is None or not run.last.last:
            code = yield from _attempt(run, folder)
            if run.last is not None and run.last.last:
                break
            _handle_crash(run, code, folder)
    assert run.last is not None
    assert run.particles is not None
    steps = run.earlier_steps + run.last.steps
    return SimulationResult(run.particles, _checks(run), steps, run.last.time * run.second, _notes(run))


def _attempt(run: _Run, folder: Path) -> Generator[Snapshot, None, int]:
    """One process of YADE's, from the last state on; its exit code."""
    plan = input_document(run.prepared, run.settings, run.duration, run.last)
    (folder / "input.json").write_text(json.dumps(plan), encoding="utf-8")
    words, environment = command(folder)
    with running_program(words, environment, folder) as child:
        states = written_files(child, lambda number: folder / f"state.{number:06d}.json", int(plan["number"]))
        for _, path in states:
            yield _snapshot(run, read_yade_state(path, len(run.prepared)))
            path.unlink()
    return int(child.returncode)


def _handle_crash(run: _Run, code: int, folder: Path) -> None:
    """Count a crash; raise if there were too many, before the first state, or if YADE reported an error.

    Raises
    ------
    RegolithError
        With YADE's own last words where it said any.
    """
    run.crashes += 1
    errors = [line.strip() for line in printed_lines(folder) if re.search("Error|ERROR|FATAL", line)]
    how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
    if code >= 0 and errors:
        raise RegolithError(f"YADE {how}: {errors[-1][:200]}")
    if run.last is None:
        raise RegolithError(f"YADE {how} before its first step.")
    if run.crashes > run.settings.restarts:
        raise RegolithError(
            f"YADE {how}, after {run.settings.restarts} restarts; the last snapshot is kept "
            f"({run.last.time * run.second:.2f} s)."
        )
    run.earlier_steps += run.last.steps


def _snapshot(run: _Run, state: YadeState) -> Snapshot:
    run.states.append(state)
    length = run.prepared.mean_diameter
    run.particles = ParticleState(
        points=state.rows[:, :3] / LENGTH * length,
        diameters=run.prepared.diameters,
        orientations=state.rows[:, 3:7],
        class_index=run.prepared.class_index,
        time=state.time * run.second,
        wall=float("inf") if state.phase == "rest" else state.rim * length,
        phase=state.phase,
    )
    if state.phase in ("fill", "settle"):
        run.fill = measure_filling(run.prepared, run.particles)
    share = min(0.99, state.time / run.duration)
    return Snapshot(run.particles, share, progress_message(state.phase, run.particles.time))


def _notes(run: _Run) -> tuple[str, ...]:
    law = (
        "YADE's force grows with the overlapping volume, and its friction has no memory: the angle is "
        "qualitative."
    )
    if not run.crashes:
        return (law,)
    times = "once" if run.crashes == 1 else f"{run.crashes} times"
    return law, f"YADE crashed {times} and went on from its last snapshot."


def _energy_gain(states: list[YadeState]) -> float:
    """Largest rise of motion and height between two states of one phase without moving walls or falls."""
    gain = 0.0
    for before, after in pairwise(states):
        if before.phase == after.phase and after.phase in ("settle", "rest"):
            gain = max(gain, after.kinetic + after.potential - before.kinetic - before.potential)
    return gain


def _checks(run: _Run) -> RunChecks:
    assert run.last is not None
    assert run.particles is not None
    length = run.prepared.mean_diameter
    return check_run(
        run.particles.points[:, 2] / length,
        overlap_depths(run.prepared, run.particles) / length,
        energy_gain=_energy_gain(run.states),
        kinetic_energy=run.last.kinetic,
        at_rest=run.last.at_rest,
        filling=run.fill,
    )
