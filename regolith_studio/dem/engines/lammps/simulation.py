"""Run LAMMPS and read its snapshots."""

import subprocess
import tempfile
import time
from collections.abc import Generator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, SimulationResult
from regolith_studio.dem.engines.lammps.clumps import Clumps, clumps_of
from regolith_studio.dem.engines.lammps.program import LammpsSettings, command
from regolith_studio.dem.engines.lammps.script import (
    Schedule,
    bodies_file,
    data_file,
    schedule,
    script,
    stiffness,
)
from regolith_studio.dem.initial_packing import enclosing_radii
from regolith_studio.dem.run_checks import check_run, measure_filling
from regolith_studio.dem.snapshot import ParticleState, Snapshot
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray, IntArray

_LOST_ATOMS_ERRORS = ("missing on proc", "Lost atoms", "Out of range atoms", "Non-numeric", "too far outside")
"""Error messages of LAMMPS for particles that moved too far in one step."""
POLL_INTERVAL = 0.1
"""Seconds between two checks for a new snapshot."""
REST_ENERGY = 1e-3
"""Mean kinetic energy in m g d at which a heap is at rest."""


@dataclass(eq=False)
class _Run:
    prepared: PreparedCase
    clumps: Clumps
    plan: Schedule
    first: Rotation | None = None
    last: ParticleState | None = None
    fill: tuple[float, float] = (0.0, 0.0)
    potential: dict[int, float] = field(default_factory=dict)

    @property
    def units(self) -> tuple[float, float]:
        """Metres and seconds of the solver's units."""
        length = self.prepared.mean_diameter
        return length, float(np.sqrt(length / self.prepared.case.test.gravity))


def simulate(prepared: PreparedCase, settings: LammpsSettings) -> Generator[Snapshot, None, SimulationResult]:
    """Write the input, run the program, read its snapshots.

    Raises
    ------
    RegolithError
        If LAMMPS ends before its time, with its own last error.
    """
    clumps = clumps_of(prepared, settings.spheres)
    length = prepared.mean_diameter
    top = float((clumps.centres[:, 2] + enclosing_radii(prepared) / length).max()) + 2.0
    radius = prepared.case.test.diameter / 2 / length
    run = _Run(prepared, clumps, schedule(prepared, settings, top))
    with tempfile.TemporaryDirectory(prefix="regolith-lammps-") as name:
        folder = Path(name)
        (folder / "clumps.data").write_text(data_file(clumps, 12.0 * radius, top))
        (folder / "bodies.txt").write_text(bodies_file(clumps))
        (folder / "in.repose").write_text(script(prepared, settings, run.plan, radius, top))
        words, environment = command()
        with (folder / "output.txt").open("wb") as output:
            child = subprocess.Popen(
                [*words, "-in", "in.repose", "-log", "log.lammps"],
                cwd=folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        try:
            yield from _follow(run, child, folder)
        finally:
            child.kill()
            child.wait()
        if child.returncode or run.last is None:
            words_said = (folder / "output.txt").read_text(errors="replace")
            raise RegolithError(last_words(words_said, settings.step_share))
        energies = kinetic_energies((folder / "log.lammps").read_text(errors="replace"))
    _, second = run.units
    notes = (_fit_in_words(clumps), _softness_in_words(prepared, settings))
    return SimulationResult(run.last, _checks(run, energies), run.plan.steps, run.plan.total * second, notes)


def _fit_in_words(clumps: Clumps) -> str:
    """Errors of the spheres as spheres; the bodies move with the polyhedra's mass and inertia."""

    def span(values: list[float]) -> str:
        return f"{100 * min(values):.0f} to {100 * max(values):.0f} %"

    errors = [shape.errors for shape in clumps.shapes]
    return (
        f"The spheres fill {span([1 + each.volume for each in errors])} of the polyhedra's volume and have "
        f"{span([1 + each.area for each in errors])} of their area; their own moments of inertia would be up "
        f"to {100 * max(each.inertia for each in errors):.0f} % off, so mass, centre and inertia are set to "
        "those of the polyhedra."
    )


def _softness_in_words(prepared: PreparedCase, settings: LammpsSettings) -> str:
    contact, test = prepared.case.contact, prepared.case.test
    scale = contact.density * test.gravity * prepared.mean_diameter
    simulated = stiffness(prepared, settings) * scale
    return f"Young's modulus was {simulated:.2g} Pa instead of {contact.youngs_modulus:.2g} Pa."


def _follow(run: _Run, child: "subprocess.Popen[bytes]", folder: Path) -> Generator[Snapshot, None, None]:
    """Moments as LAMMPS writes them; a file is whole when the next one is there or LAMMPS has ended."""
    step = 0
    while True:
        ended = child.poll() is not None
        while (folder / f"body.{step}.dump").exists():
            following = (folder / f"body.{step + run.plan.picture}.dump").exists()
            if not (following or ended):
                break
            yield _snapshot(run, folder / f"body.{step}.dump", step)
            step += run.plan.picture
        if ended:
            return
        time.sleep(POLL_INTERVAL)


def _snapshot(run: _Run, path: Path, step: int) -> Snapshot:
    length, second = run.units
    rows = read_bodies(path)
    turns = Rotation.from_quat(rows[:, 4:8], scalar_first=True)
    if run.first is None:
        run.first = turns  # principal axes of LAMMPS, of which only the change counts
    turned = turns * run.first.inv() * run.clumps.turns
    particles = ParticleState(
        points=rows[:, 1:4] * length,
        diameters=run.prepared.diameters,
        orientations=turned.as_quat(scalar_first=True),
        class_index=run.prepared.class_index,
        time=step * run.plan.step * second,
        wall=run.plan.rim(step) * length,
        phase=run.plan.phase(step),
    )
    if particles.phase in ("fill", "settle"):
        run.fill = measure_filling(run.prepared, particles)
    run.last = particles
    run.potential[step] = float(run.clumps.scales**3 @ rows[:, 3])
    return Snapshot(
        particles, min(0.99, step / run.plan.steps), f"{particles.phase}, {particles.time:.2f} s simulated"
    )


def read_bodies(path: Path) -> FloatArray:
    """Rows of a dump of bodies: number, x, y, z, quaternion, in the order of the numbers.

    Raises
    ------
    RegolithError
        If bodies are missing.
    """
    lines = path.read_text().splitlines()
    count = int(lines[3])
    rows = (
        np.array([line.split() for line in lines[-count:]], dtype=np.float64) if count else np.empty((0, 8))
    )
    rows = rows[np.argsort(rows[:, 0])]
    if len(rows) == 0 or not np.array_equal(rows[:, 0], np.arange(1, len(rows) + 1)):
        raise RegolithError("LAMMPS lost particles; take a smaller step (step_share).")
    return rows


def kinetic_energies(log: str) -> dict[int, float]:
    """Kinetic energy of all bodies at each step of a log: rows of step, motion, rotation."""
    found = {}
    for line in log.splitlines():
        words = line.split()
        if len(words) == 3 and words[0].isdigit():
            try:
                found[int(words[0])] = float(words[1]) + float(words[2])
            except ValueError:
                continue  # a sentence that begins with a number
    return found


def last_words(output: str, step_share: float) -> str:
    """Why LAMMPS has ended before its time, by its own first error."""
    lines = output.splitlines()
    errors = [line for line in lines if "ERROR" in line] or lines[-1:] or ["it said nothing"]
    own = errors[0].strip()
    if any(sign in own for sign in _LOST_ATOMS_ERRORS):
        return (
            f"The particles flew apart; take a smaller step than {step_share:g} of Rayleigh's time "
            f"(step_share). LAMMPS said: {own}"
        )
    return f"LAMMPS ended before its time: {own}"


def _energy_gain(run: _Run, kinetic: dict[int, float]) -> float:
    """Largest rise of motion and height between two pictures, in m g d a particle.

    Only where no wall moves and nothing falls fast: what contacts store for a moment is not in the sum.
    """
    gain, before = 0.0, float("inf")
    for step, potential in run.potential.items():
        if run.plan.phase(step) in ("fill", "lift"):
            before = float("inf")
        elif step in kinetic:
            total = (kinetic[step] + potential) / len(run.prepared)
            gain, before = max(gain, total - before), total
    return gain


def _checks(run: _Run, energies: dict[int, float]) -> RunChecks:
    assert run.last is not None
    length, _ = run.units
    points = run.last.points / length
    turns = Rotation.from_quat(run.last.orientations, scalar_first=True)
    overlaps = _overlaps(*run.clumps.atoms(points, turns))
    kinetic = energies[max(energies)] / len(points) if energies else float("inf")
    return check_run(
        points[:, 2],
        overlaps,
        energy_gain=_energy_gain(run, energies),
        kinetic_energy=kinetic,
        at_rest=bool(kinetic < REST_ENERGY),
        filling=run.fill,
    )


def _overlaps(body: IntArray, places: FloatArray, radius: FloatArray) -> FloatArray:
    """Depths by which spheres of different bodies overlap, in mean diameters."""
    pairs = cKDTree(places).query_pairs(2.0 * float(radius.max()), output_type="ndarray")
    pairs = pairs[body[pairs[:, 0]] != body[pairs[:, 1]]]
    apart = np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1)
    depth = radius[pairs].sum(axis=1) - apart
    return np.asarray(depth[depth > 0.0])
