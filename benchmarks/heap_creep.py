"""How much heaps at rest creep on Rapier: docs/repose_rapier.md.

    python -m benchmarks.heap_creep RESULT.json RUN...

Each heap of 1,000 on Rapier is simulated for 100 sqrt(d/g) more, with the solver's own contact softness and
with that of this program, and with half the step. Rows: angle and median way of a particle after 25 and 100.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import rapier3d as rapier

from benchmarks.deep_contacts import particles_of, put
from regolith_studio.dataset.parameters import ContactParameters
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.engines.rapier.settings import RapierSettings
from regolith_studio.dem.engines.rapier.simulation import RapierSolver
from regolith_studio.dem.run_io import FINAL, read_run
from regolith_studio.dem.snapshot import read_particle_state

TIMES = (25.0, 100.0)
HALF = RapierSettings(time_step=RapierSettings.time_step / 2, iterations=RapierSettings.iterations // 2)


def own_softness(solver: RapierSolver) -> None:
    """Contacts as soft as the solver makes them by itself."""
    numerics, plain = solver.world.integration_parameters, rapier.IntegrationParameters()
    numerics.contact_softness = plain.contact_softness
    numerics.static_contact_softness = plain.static_contact_softness


VARIANTS: dict[str, tuple[RapierSettings, Callable[[RapierSolver], None]]] = {
    "default": (RapierSettings(), lambda _: None),
    "the solver's own softness": (RapierSettings(), own_softness),
    "half the step": (HALF, lambda _: None),
}


def main(result: Path, runs: list[Path]) -> None:
    """Print a line a heap and variant, and write them all."""
    rows: list[dict[str, Any]] = []
    for run in runs:
        for name, (settings, change) in VARIANTS.items():
            rows.append({"run": run.name, "variant": name} | crept(run, settings, change))
            print(rows[-1], flush=True)
    result.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def crept(run: Path, settings: RapierSettings, change: Callable[[RapierSolver], None]) -> dict[str, Any]:
    """Angles before and after, and the median way of a particle in mean diameters."""
    contact = ContactParameters(**read_run(run).document["case"]["contact"])
    heap = read_particle_state(run / FINAL)
    prepared = particles_of(run, heap, contact)
    start = heap.points / prepared.mean_diameter
    solver = RapierSolver(prepared, settings)
    change(solver)
    put(solver, start, heap.orientations)
    solver.begin("rest")
    angles, ways = [measure_repose(heap.points, heap.diameters, base=0.0).angle], []
    for time in TIMES:
        solver.advance(settings.time_step, round((time - solver.time) / settings.time_step))
        points = solver.points
        angles.append(measure_repose(points * prepared.mean_diameter, heap.diameters, base=0.0).angle)
        ways.append(float(np.median(np.linalg.norm(points - start, axis=1))))
    energy = solver.energies()[1] / solver.n
    return {
        "angles_deg": [round(each, 2) for each in angles],
        "median_ways": [round(each, 4) for each in ways],
        "kinetic_energy": float(f"{energy:.1e}"),
    }


if __name__ == "__main__":
    main(Path(sys.argv[1]), [Path(each) for each in sys.argv[2:]])
