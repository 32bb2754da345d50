"""Angle of repose over the number of facets and over what is kept of the particles (docs/repose_results.md).

    python -m benchmarks.shape_heaps RUNS RESULT.json [SEEDS] [PARTICLES] [COARSENINGS]

Rapier, friction 0.8, the twelve shipped particles; by default 20 seeds, 1,000 particles and all coarsenings
(names with commas between). Datasets and runs that are in the folder RUNS already are kept. Two runs at a
time, of one thread each.
"""

import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from regolith_studio.dem.run_io import DOCUMENT, read_run
from regolith_studio.resources import resource

COARSENINGS = {
    "8": ["--facets", "8"],
    "12": ["--facets", "12"],
    "20": ["--facets", "20"],
    "40": ["--facets", "40"],
    "60": ["--facets", "60"],
    "20 by quadrics": ["--facets", "20", "--method", "quadric"],
    "20 with overlap": ["--facets", "20", "--preset", "overlap"],
}
"""Options of each. The last two keep no descriptor: quadrics alone, and the largest overlap."""


def main(runs: Path, result: Path, n_seeds: int, n_particles: int, chosen: list[str]) -> None:
    """Make what is missing, write a row a run, and print the mean of each coarsening with its interval."""
    cases = [(name, seed) for name in chosen for seed in range(1, n_seeds + 1)]
    for name in chosen:
        if not (dataset := runs / name).is_dir():
            command("dataset", "build", resource("samples", "particles"), "-o", dataset, *COARSENINGS[name])
    with ThreadPoolExecutor(2) as pool:
        rows = list(pool.map(lambda case: row(runs, n_particles, *case), cases))
    result.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    for name in chosen:
        angles = [each["angle_deg"] for each in rows if each["coarsening"] == name and each["angle_deg"]]
        half = stats.t.ppf(0.975, len(angles) - 1) * stats.sem(angles)
        print(f"{name}: {np.mean(angles):.2f} +- {half:.2f}, {len(angles)} heaps")


def row(runs: Path, n_particles: int, name: str, seed: int) -> dict[str, Any]:
    """The numbers of one run."""
    folder = runs / f"{name}-{n_particles}-{seed}"
    if not (folder / DOCUMENT).is_file():
        how = ["-n", n_particles, "--engine", "rapier", "--seed", seed, "--jobs", "1"]
        command("repose", "run", runs / name, "-o", folder, *how)
    document = read_run(folder).document
    measured, packing = document["measurement"], document["packing"]["heap"] or {}
    return {
        "coarsening": name,
        "particles": n_particles,
        "seed": seed,
        "angle_deg": rounded(measured["angle_deg"], 2),
        "interval_deg": [rounded(each, 2) for each in measured.get("interval_deg") or []],
        "solid_fraction": rounded(document["checks"]["solid_fraction"], 4),
        "coordination_number": rounded(packing.get("coordination_number"), 3),
        "problems": document["checks"]["problems"],
    }


def rounded(value: float | None, digits: int) -> float | None:
    """A number of a row, where there is one."""
    return None if value is None else round(value, digits)


def command(*words: object) -> None:
    """Run the program."""
    subprocess.run([sys.executable, "-m", "regolith_studio", *map(str, words)], check=True)


if __name__ == "__main__":
    given = dict(enumerate(sys.argv))
    names = given[5].split(",") if 5 in given else list(COARSENINGS)
    main(Path(sys.argv[1]), Path(sys.argv[2]), int(given.get(3, 20)), int(given.get(4, 1000)), names)
