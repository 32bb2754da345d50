"""Overlaps of heaps while they form and at rest, and what the deepest contacts carry: docs/repose_rapier.md.

    python -m benchmarks.deep_contacts RESULT.json DEPTH RUN...

For each run: how many contacts of the settled filling, of every fourth snapshot while the cylinder rises and
of the heap at rest are deep. Of runs on Rapier also the heap without both particles of every contact deeper
than DEPTH (in mean diameters), settled again, beside the same heap with no particle taken, and with as many
that are chosen at random. Unfinished runs are taken for runs on Rapier, and have depths only.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import rapier3d as rapier

from regolith_studio.dataset.parameters import ContactParameters
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.case import PreparedCase, ReposeCase
from regolith_studio.dem.engines.rapier.settings import RapierSettings
from regolith_studio.dem.engines.rapier.simulation import (
    PLATE_WIDTH,
    ROUNDING,
    UNIT_DIAMETER,
    RapierSolver,
    inner_parallel_body,
)
from regolith_studio.dem.heap_packing import measure_packing
from regolith_studio.dem.initial_packing import enclosing_radii
from regolith_studio.dem.run_checks import DEEP_OVERLAP
from regolith_studio.dem.run_io import FINAL, read_run, read_shapes, snapshot_files
from regolith_studio.dem.separation import near_pairs, separations
from regolith_studio.dem.snapshot import ParticleState, read_particle_state
from regolith_studio.geometry.arrays import FloatArray, IntArray

SETTLE = 10.0
"""Simulated time in sqrt(d/g)."""
DRAWS = 2
UNFINISHED: dict[str, Any] = {"engine": {"key": "rapier"}}


def main(result: Path, depth: float, runs: list[Path]) -> None:
    """Print a line for each phase of a run and each heap, and write them all anew after each run."""
    phases: list[dict[str, Any]] = []
    heaps: list[dict[str, Any]] = []
    for run in runs:
        finished = (run / FINAL).is_file()
        document = read_run(run).document if finished else UNFINISHED
        about = {"run": run.name, "engine": document["engine"]["key"]}
        for phase, states in states_of(run).items():
            found = [contacts(particles_of(run, state), state, about["engine"]) for state in states]
            about["particles"] = len(states[0])
            phases.append(about | {"phase": phase} | worst([depths for depths, _ in found]))
            print(phases[-1], flush=True)
        if finished and about["engine"] == "rapier":
            contact = ContactParameters(**document["case"]["contact"])
            (heap,), ((depths, pairs),) = states, found
            for name, which in choices(len(heap), np.unique(pairs[depths > depth])).items():
                rest = without(particles_of(run, heap, contact), heap, which)
                heaps.append(about | {"taken": name} | rest)
                print(heaps[-1], flush=True)
        content = {"depth": depth, "phases": phases, "heaps": heaps}
        result.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def states_of(run: Path) -> dict[str, list[ParticleState]]:
    """The settled filling, some states while the cylinder rises, and the heap at rest, as far as they are."""
    states = [read_particle_state(path) for path in snapshot_files(run)]
    found = {
        "settle": [state for state in states if state.phase == "settle"][-1:],
        "lift": [state for state in states if state.phase == "lift"][::4],
        "rest": [read_particle_state(run / FINAL)] if (run / FINAL).is_file() else [],
    }
    return {phase: chosen for phase, chosen in found.items() if chosen}


def particles_of(run: Path, state: ParticleState, contact: ContactParameters | None = None) -> PreparedCase:
    """The particles of a run."""
    case = ReposeCase(n_particles=len(state), contact=contact or ContactParameters())
    shapes = tuple(parts[0] for parts in read_shapes(run))
    return PreparedCase(case, shapes, state.class_index, state.diameters, 1.0)


def worst(depths: list[FloatArray]) -> dict[str, Any]:
    """Largest share of deep contacts and depth of one of several states, and means of the others."""
    return {
        "states": len(depths),
        "contacts": round(float(np.mean([len(each) for each in depths]))),
        "deep_share": round(max(float((each > DEEP_OVERLAP).mean()) for each in depths), 5),
        "depth_99": round(max(float(np.quantile(each, 0.99)) for each in depths), 4),
        "max": round(max(float(each.max()) for each in depths), 4),
        "mean": round(float(np.mean([each.mean() for each in depths])), 5),
    }


def choices(n: int, deep: IntArray) -> dict[str, IntArray]:
    """Which particles are taken."""
    chance = np.random.default_rng(0)
    drawn = {f"random {k}": chance.choice(n, len(deep), replace=False) for k in range(DRAWS)}
    return {"none": deep[:0]} | ({"deep": deep} | drawn if len(deep) else {})


def contacts(prepared: PreparedCase, state: ParticleState, engine: str) -> tuple[FloatArray, IntArray]:
    """Depths of the particles that overlap in mean diameters, shape (m,), and which, shape (m, 2)."""
    rounding, pairs = 0.0, near_pairs(state.points, enclosing_radii(prepared))
    if engine == "rapier":
        rounding = ROUNDING
        cores = tuple(inner_parallel_body(shape, ROUNDING * UNIT_DIAMETER) for shape in prepared.shapes)
        prepared = replace(prepared, shapes=cores)
    depths = -separations(prepared, state, pairs, rounding=rounding)
    return depths[depths > 0.0] / prepared.mean_diameter, pairs[depths > 0.0]


def without(prepared: PreparedCase, heap: ParticleState, taken: IntArray) -> dict[str, Any]:
    """Angle and packing of a heap without these particles, which are put on the plate far away."""
    settings = RapierSettings()
    solver = RapierSolver(prepared, settings)
    points = heap.points / prepared.mean_diameter
    far = 0.9 * PLATE_WIDTH * prepared.case.test.diameter / prepared.mean_diameter / 2
    points[taken] = np.column_stack(
        [np.full(len(taken), far), 3.0 * np.arange(len(taken)), np.ones(len(taken))]
    )
    put(solver, points, heap.orientations)
    solver.begin("rest")
    solver.advance(settings.time_step, round(SETTLE / settings.time_step))
    kept = np.setdiff1d(np.arange(len(heap)), taken)
    places = solver.points * prepared.mean_diameter
    measured = measure_repose(places[kept], heap.diameters[kept], base=0.0)
    rest = ParticleState(places, heap.diameters, solver.orientations, heap.class_index)
    packing = measure_packing(prepared, rest, measured)
    moved = np.linalg.norm(places[kept] - heap.points[kept], axis=1) / prepared.mean_diameter
    return {
        "n_taken": len(taken),
        "angle_deg": round(measured.angle, 2),
        "solid_fraction": None if packing is None else round(packing.solid_fraction, 4),
        "coordination_number": None if packing is None else round(packing.coordination_number, 3),
        "moved_by_more_than_a_tenth": int((moved > 0.1).sum()),
    }


def put(solver: RapierSolver, points: FloatArray, orientations: FloatArray) -> None:
    """Put the particles of a solver there, at rest; points in mean diameters."""
    for body, place, turn in zip(solver.particles, points.tolist(), orientations.tolist(), strict=True):
        body.translation = place
        body.rotation = rapier.Rotation3(*turn)


if __name__ == "__main__":
    main(Path(sys.argv[1]), float(sys.argv[2]), [Path(each) for each in sys.argv[3:]])
