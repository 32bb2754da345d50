"""Run YADE and read its states; after a crash continue from the last state.

YADE decides by absolute lengths what touches and what coincides (2e-11 m and 3e-10 m), so the solver's mean
diameter is always 2 mm: smaller grains would spend more time in touches that it cannot resolve, and larger
ones would have less exact overlaps. Density and gravity are 3,000 kg/m3 and 9.81 m/s2; the test is free of
units but for these.
"""

import json
import re
import tempfile
from collections.abc import Generator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, SimulationResult, check_run, lowest_corners, measure_filling
from regolith_studio.dem.engines.yade.program import YadeSettings, command
from regolith_studio.dem.initial_packing import enclosing_radii, loose_column
from regolith_studio.dem.lifting_cylinder import expected_duration
from regolith_studio.dem.separation import overlap_depths
from regolith_studio.dem.snapshot import ParticleState, Snapshot, progress_message
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.child_process import printed_lines, running_program, written_files

LENGTH, DENSITY, GRAVITY = 2e-3, 3000.0, 9.81
TIME = float(np.sqrt(LENGTH / GRAVITY))
WEIGHT = DENSITY * np.pi / 6 * LENGTH**3 * GRAVITY
"""Of a mean particle, in the solver's newtons."""
LOOK = 0.25
"""Between two looks, in sqrt(d/g)."""
CONTACT_AREA = 0.5
"""Of the smallest particle on a flat neighbour, over its diameter squared."""
RETRY_STEP_FACTOR = 0.97
"""Factor on the time step after a crash, so that the same contact does not recur."""
SHEAR = 0.2
"""YADE multiplies the stiffness by it for shear: far above what is stable, so that friction is Coulomb's at
once whichever way a contact slides (its law keeps one shear force for all contacts, not one for each)."""


@dataclass(frozen=True, eq=False)
class YadeState:
    """One state written by YADE, in mean diameters and sqrt(d/g); energies in m g d.

    - ``number``, ``phase``, ``time``, ``rim``, ``steps``: which snapshot it is, and where the test stands.
    - ``kinetic``, ``potential``: mean energies of a particle.
    - ``last``, ``at_rest``: whether the test is over, and whether it ended at rest.
    - ``rows``: place, turn (w, x, y, z), velocity and spin of each particle in the solver's units, shape (n,
      13).
    """

    number: int
    phase: str
    time: float
    rim: float
    steps: int
    kinetic: float
    potential: float
    last: bool
    at_rest: bool
    rows: FloatArray


def input_document(
    prepared: PreparedCase, settings: YadeSettings, duration: float, after: YadeState | None
) -> dict[str, Any]:
    """Content of the input file: from the initial state, or from the last state before a crash.

    ``duration``: expected, in sqrt(d/g); sets the interval of the snapshots. ``after``: the last state of a
    resumed run.
    """
    case = prepared.case
    contact, test = case.contact, case.test
    speed = test.lift_speed / np.sqrt(test.gravity * prepared.mean_diameter)
    top = float((loose_column(prepared).points[:, 2] + enclosing_radii(prepared)).max())
    height = top / prepared.mean_diameter + 2.0
    return {
        "density": DENSITY,
        "gravity": GRAVITY,
        "young": young_modulus(settings),
        "poisson": SHEAR,
        "friction": contact.static_friction,
        "wall_friction": test.wall_friction,
        "plate_friction": test.plate_friction,
        "damping": settings.damping,
        "time_step": time_step(prepared, settings) * (1.0 if after is None else RETRY_STEP_FACTOR),
        "skin": 0.02 * LENGTH,
        "shapes": [shape.tolist() for shape in prepared.shapes],
        "particles": _particles(prepared, after),
        "tube": {
            "radius": test.diameter / 2 / prepared.mean_diameter * LENGTH,
            "height": height * LENGTH,
            "thickness": 2.0 * LENGTH,
            "n_segments": settings.n_segments,
        },
        "number": 0 if after is None else after.number + 1,
        "phase": "fill" if after is None else after.phase,
        "time": 0.0 if after is None else after.time * TIME,
        "rim": 0.0 if after is None else after.rim * LENGTH,
        "plan": {
            "look": LOOK * TIME,
            "picture": duration / settings.snapshots * TIME,
            "max_fill_speed": settings.max_fill_speed * LENGTH / TIME,
            "rest_energy": settings.rest_energy * WEIGHT * LENGTH,
            "rest_time": settings.rest_time * TIME,
            "max_fill_time": (10.0 + 1.5 * height / settings.max_fill_speed) * TIME,
            "max_rest_time": settings.max_rest_time * TIME,
            "max_lift_time": (2.0 * height / speed + 10.0) * TIME,
            "lift_speed": float(speed) * LENGTH / TIME,
            "reach": float(enclosing_radii(prepared).max() / prepared.mean_diameter + 0.5) * LENGTH,
        },
    }


def young_modulus(settings: YadeSettings) -> float:
    """YADE's stiffness of a material; two equal ones are springs in a row."""
    return float(2 * settings.stiffness * WEIGHT / LENGTH**3)


def time_step(prepared: PreparedCase, settings: YadeSettings) -> float:
    """In the solver's seconds: a share of 1/omega of the smallest particle on a flat neighbour."""
    smallest = float(prepared.diameters.min()) / prepared.mean_diameter * LENGTH
    stiffness = young_modulus(settings) / 2 * CONTACT_AREA * smallest**2
    return float(settings.step_share * np.sqrt(DENSITY * np.pi / 6 * smallest**3 / stiffness))


def _particles(prepared: PreparedCase, after: YadeState | None) -> list[dict[str, Any]]:
    if after is None:
        column = loose_column(prepared)
        places = column.points / prepared.mean_diameter * LENGTH
        rows = np.hstack([places, column.orientations, np.zeros((len(prepared), 6))])
    else:
        rows = after.rows
    scales = (prepared.scales / prepared.mean_diameter * LENGTH).tolist()
    return [
        {
            "shape": kind,
            "scale": scale,
            "place": row[:3],
            "turn": row[3:7],
            "velocity": row[7:10],
            "spin": row[10:],
        }
        for kind, scale, row in zip(prepared.class_index.tolist(), scales, rows.tolist(), strict=True)
    ]


def read_yade_state(path: Path, count: int) -> YadeState:
    """A state that YADE wrote.

    Raises RegolithError if particles were lost on the way.
    """
    document = json.loads(path.read_text("utf-8"))
    rows = np.asarray(document["particles"], dtype=np.float64)
    if rows.shape != (count, 13) or not np.isfinite(rows).all():
        raise RegolithError("YADE lost particles; take a smaller step (step_share).")
    energy = WEIGHT * LENGTH
    return YadeState(
        number=int(path.stem.split(".")[1]),
        phase=document["phase"],
        time=document["time"] / TIME,
        rim=document["rim"] / LENGTH,
        steps=int(document["steps"]),
        kinetic=document["kinetic"] / energy,
        potential=document["potential"] / energy,
        last=bool(document["last"]),
        at_rest=bool(document["at_rest"]),
        rows=rows,
    )


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

    Raises RegolithError if YADE crashes more often than allowed, or ends before its time for another reason.
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
    """Count a crash; raise if there were too many, before the first state, or if YADE reported an error."""
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
        lowest=lowest_corners(run.prepared, run.particles) / length,
    )
