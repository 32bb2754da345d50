"""Run LAMMPS and read its snapshots."""

import subprocess
import tempfile
from collections.abc import Generator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import MASS, RunChecks, SimulationResult, check_run, measure_filling
from regolith_studio.dem.engines.lammps.program import LammpsSettings, command
from regolith_studio.dem.engines.lammps.script import (
    Clumps,
    Schedule,
    bodies_file,
    clumps_of,
    data_file,
    schedule,
    script,
    stiffness,
)
from regolith_studio.dem.initial_packing import enclosing_radii
from regolith_studio.dem.lifting_cylinder import LiftingSettings, Units
from regolith_studio.dem.snapshot import ParticleState, Snapshot, progress_message
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.io.child_process import printed_lines, running_program, written_files

_LOST_ATOMS_ERRORS = ("missing on proc", "Lost atoms", "Out of range atoms", "Non-numeric", "too far outside")
"""Error messages of LAMMPS for particles that moved too far in one step."""
MAX_SPEED = 2.0
"""Largest speed of a particle, in that of a fall from the top of the column."""
REST_ENERGY = LiftingSettings.rest_energy
NEAR = 0.05
"""Mean diameters between spheres of bodies that belong to one heap."""


class FlewApartError(RegolithError):
    """Particles moved faster or further than they can; a smaller step may help."""


@dataclass(frozen=True, eq=False)
class _State:
    """All bodies at one time: to go on from.

    - ``time``: in sqrt(d/g).
    - ``points``, ``turns``: centres, shape (n, 3), and rotations.
    - ``motion``: velocity and angular momentum, shape (n, 6).
    """

    time: float
    points: FloatArray
    turns: Rotation
    motion: FloatArray


@dataclass(eq=False)
class _Run:
    prepared: PreparedCase
    settings: LammpsSettings
    clumps: Clumps
    plan: Schedule
    top: float
    states: list[_State]
    first: Rotation | None = None
    last: ParticleState | None = None
    fill: tuple[float, float] = (0.0, 0.0)
    potential: dict[int, float] = field(default_factory=dict)
    kinetic: dict[int, float] = field(default_factory=dict)
    energy_gain: float = 0.0
    restarts: list[float] = field(default_factory=list)
    steps: int = 0
    units: Units = field(init=False)

    def __post_init__(self) -> None:
        self.units = Units.of(self.prepared)

    @property
    def step_share(self) -> float:
        """Of the steps as they are now, in Rayleigh's time."""
        return float(self.settings.step_share * 0.5 ** len(self.restarts))


def simulate(prepared: PreparedCase, settings: LammpsSettings) -> Generator[Snapshot, None, SimulationResult]:
    """Write the input, run the program, read its snapshots; go on from the last where particles fly apart.

    Raises RegolithError if LAMMPS ends before its time, with its own last error, or particles fly apart too
    often.
    """
    clumps = clumps_of(prepared, settings.spheres, settings.max_error)
    length = prepared.mean_diameter
    top = float((clumps.centres[:, 2] + enclosing_radii(prepared) / length).max()) + 2.0
    begin = _State(0.0, clumps.centres, clumps.turns, np.zeros((len(prepared), 6)))
    run = _Run(prepared, settings, clumps, schedule(prepared, settings, top), top, [begin])
    with tempfile.TemporaryDirectory(prefix="regolith-lammps-") as name:
        while True:
            folder = Path(name) / f"attempt-{len(run.restarts)}"
            folder.mkdir()
            known = len(run.states)
            try:
                yield from _attempt(run, folder)
                break
            except FlewApartError:
                if len(run.restarts) == settings.restarts:
                    raise
                _go_back(run, stuck=len(run.states) == known)
    assert run.last is not None
    steps, simulated = run.steps + run.plan.steps, run.plan.total * run.units.time
    return SimulationResult(run.last, _checks(run), steps, simulated, _notes(run))


def _attempt(run: _Run, folder: Path) -> Generator[Snapshot, None, None]:
    """One process of LAMMPS from the last state on."""
    length, state = run.prepared.mean_diameter, run.states[-1]
    radius = run.prepared.case.test.diameter / 2 / length
    run.clumps = replace(run.clumps, centres=state.points, turns=state.turns)
    run.first = None
    (folder / "clumps.data").write_text(data_file(run.clumps, 12.0 * radius, run.top))
    (folder / "bodies.txt").write_text(bodies_file(run.clumps, state.motion))
    text = script(run.prepared, run.settings, run.plan, radius, run.top, run.clumps.extent)
    (folder / "in.repose").write_text(text)
    words, environment = command()
    words = [*words, "-in", "in.repose", "-log", "log.lammps"]
    try:
        with running_program(words, environment, folder) as child:
            yield from _follow(run, child, folder)
    finally:
        _note_energies(run, folder)
    if child.returncode or run.last is None:
        raise early_end(printed_lines(folder), run.step_share)


def _go_back(run: _Run, *, stuck: bool) -> None:
    """To the last state, or the one before where an attempt came no further; halve the step."""
    if stuck and len(run.states) > 1:
        run.states.pop()
    run.restarts.append(run.states[-1].time)
    run.steps += round((run.states[-1].time - run.plan.start) / run.plan.step)
    run.plan = run.plan.restarted(run.states[-1].time)


def _notes(run: _Run) -> tuple[str, ...]:
    notes = (_fit_in_words(run.clumps), _softness_in_words(run.prepared, run.settings))
    if not run.restarts:
        return notes
    times = ", ".join(f"{each * run.units.time:.2f} s" for each in run.restarts)
    return (
        *notes,
        f"Particles flew apart; the run went on from its snapshots at {times} with steps half as long each "
        f"time, {run.step_share:g} of Rayleigh's time at the end.",
    )


def _fit_in_words(clumps: Clumps) -> str:
    """Errors of the spheres as spheres; the bodies move with the polyhedra's mass and inertia."""

    def span(values: list[float]) -> str:
        return f"{100 * min(values):.0f} to {100 * max(values):.0f} %"

    errors = [shape.errors for shape in clumps.shapes]
    return (
        "The spheres have the polyhedra's volume and "
        f"{span([1 + each.area for each in errors])} of their area; "
        f"{span([each.jaccard for each in errors])} of the volume of both together is not shared (Jaccard "
        "distance). Mass, centre and inertia are set to those of the polyhedra."
    )


def _softness_in_words(prepared: PreparedCase, settings: LammpsSettings) -> str:
    contact, test = prepared.case.contact, prepared.case.test
    scale = contact.density * test.gravity * prepared.mean_diameter
    simulated = stiffness(prepared, settings) * scale
    return f"Young's modulus was {simulated:.2g} Pa instead of {contact.youngs_modulus:.2g} Pa."


def _follow(run: _Run, child: "subprocess.Popen[bytes]", folder: Path) -> Generator[Snapshot, None, None]:
    """Snapshots as LAMMPS writes them; that of the beginning has been there where the run goes on."""
    picture = run.plan.picture
    for number, path in written_files(child, lambda number: folder / f"body.{number * picture}.dump"):
        snapshot = _snapshot(run, path, number * picture)
        if number or not run.restarts:
            yield snapshot


def _snapshot(run: _Run, path: Path, step: int) -> Snapshot:
    length, second = run.units.length, run.units.time
    rows = read_bodies(path)
    if np.linalg.norm(rows[:, 8:11], axis=1).max() > MAX_SPEED * np.sqrt(2.0 * run.top):
        raise FlewApartError(_flew_apart(run.step_share, "a particle is faster than any fall makes it"))
    turns = Rotation.from_quat(rows[:, 4:8], scalar_first=True)
    if run.first is None:
        run.first = turns  # principal axes of LAMMPS, of which only the change counts
    turned = turns * run.first.inv() * run.clumps.turns
    if step:
        run.states.append(_State(run.plan.time(step), rows[:, 1:4], turned, rows[:, 8:14]))
    particles = ParticleState(
        points=rows[:, 1:4] * length,
        diameters=run.prepared.diameters,
        orientations=turned.as_quat(scalar_first=True),
        class_index=run.prepared.class_index,
        time=run.plan.time(step) * second,
        wall=run.plan.rim(step) * length,
        phase=run.plan.phase(step),
    )
    if particles.phase in ("fill", "settle"):
        run.fill = measure_filling(run.prepared, particles)
    run.last = particles
    run.potential[step] = float(run.clumps.scales**3 @ rows[:, 3])
    return Snapshot(
        particles,
        min(0.99, run.plan.time(step) / run.plan.total),
        progress_message(particles.phase, particles.time),
    )


def read_bodies(path: Path) -> FloatArray:
    """Rows of a dump of bodies: number, x, y, z, quaternion, velocity, angular momentum; by their numbers.

    Raises FlewApartError if bodies are missing.
    """
    lines = path.read_text().splitlines()
    count = int(lines[3])
    rows = (
        np.array([line.split() for line in lines[-count:]], dtype=np.float64) if count else np.empty((0, 14))
    )
    rows = rows[np.argsort(rows[:, 0])]
    if len(rows) == 0 or not np.array_equal(rows[:, 0], np.arange(1, len(rows) + 1)):
        raise FlewApartError("LAMMPS lost particles; take a smaller step (step_share).")
    return rows


def kinetic_energies(log: str) -> dict[int, float]:
    """Kinetic energy of all bodies at each step of a log: rows of step, motion, rotation."""
    energies = {}
    for line in log.splitlines():
        words = line.split()
        if len(words) == 3 and words[0].isdigit():
            try:
                energies[int(words[0])] = float(words[1]) + float(words[2])
            except ValueError:
                continue  # a sentence that begins with a number
    return energies


def early_end(lines: list[str], step_share: float) -> RegolithError:
    """Why LAMMPS has ended before its time, by its own first error."""
    errors = [line for line in lines if "ERROR" in line] or lines[-1:] or ["it said nothing"]
    own = errors[0].strip()
    if any(sign in own for sign in _LOST_ATOMS_ERRORS):
        return FlewApartError(_flew_apart(step_share, f"LAMMPS reports: {own}"))
    return RegolithError(f"LAMMPS ended early: {own}")


def _flew_apart(step_share: float, sign: str) -> str:
    return (
        f"The particles flew apart; take a smaller step than {step_share:g} of Rayleigh's time (step_share): "
        f"{sign}."
    )


def _note_energies(run: _Run, folder: Path) -> None:
    """Largest rise of motion and height between two snapshots of an attempt, in m g d a particle.

    Only where no wall moves and nothing falls fast: what contacts store for a moment is not in the sum.
    """
    log = folder / "log.lammps"
    run.kinetic = kinetic_energies(log.read_text(errors="replace")) if log.is_file() else {}
    before = float("inf")
    for step, potential in run.potential.items():
        if run.plan.phase(step) in ("fill", "lift"):
            before = float("inf")
        elif step in run.kinetic:
            total = (run.kinetic[step] + potential) / (MASS * len(run.prepared))
            run.energy_gain, before = max(run.energy_gain, total - before), total
    run.potential.clear()


def _checks(run: _Run) -> RunChecks:
    assert run.last is not None
    points = run.last.points / run.units.length
    turns = Rotation.from_quat(run.last.orientations, scalar_first=True)
    body, places, radius = run.clumps.atoms(points, turns)
    bodies, depths = _neighbours(body, places, radius)
    lowest = np.full(len(points), np.inf)
    np.minimum.at(lowest, body, places[:, 2] - radius)
    heap = np.unique(bodies)
    kinetic = float(_kinetic_energies(run.clumps, run.states[-1])[heap].sum()) / (MASS * len(points))
    return check_run(
        points[:, 2],
        depths[depths > 0.0],
        energy_gain=run.energy_gain,
        kinetic_energy=kinetic,
        at_rest=bool(kinetic < REST_ENERGY),
        filling=run.fill,
        lowest=lowest,
    )


def _kinetic_energies(clumps: Clumps, state: _State) -> FloatArray:
    """Of motion and rotation of each body, shape (n,)."""
    velocity, momentum = state.motion[:, :3], state.motion[:, 3:]
    inertias = replace(clumps, turns=state.turns).inertias()
    rotation = np.einsum("ni,ni->n", momentum, np.linalg.solve(inertias, momentum[:, :, None])[:, :, 0])
    return np.asarray(0.5 * (clumps.scales**3 * (velocity**2).sum(axis=1) + rotation))


def _neighbours(body: IntArray, places: FloatArray, radius: FloatArray) -> tuple[IntArray, FloatArray]:
    """Pairs of bodies whose spheres are nearer than :data:`NEAR`, shape (m, 2), and the depths to which these
    overlap in mean diameters, negative where they do not, shape (m,).

    A clump without rolling resistance that has left the heap can roll on for ever: it has no neighbour.
    """
    pairs = cKDTree(places).query_pairs(2.0 * float(radius.max()) + NEAR, output_type="ndarray")
    pairs = pairs[body[pairs[:, 0]] != body[pairs[:, 1]]]
    apart = np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1)
    depth = np.asarray(radius[pairs].sum(axis=1) - apart)
    near = depth > -NEAR
    return body[pairs[near]], depth[near]
