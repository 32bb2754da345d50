"""Filling and angle of repose of the same particles on MuJoCo and LAMMPS, as a table of docs/repose.md.

    python -m benchmarks.repose_engines DATASET RUNS [RESULT.json]

300 particles, seeds 1 to 3; runs that are in the folder RUNS already are read and not done again.
"""

import json
import subprocess
import sys
from pathlib import Path

from regolith_studio.dem.run_io import DOCUMENT, read_run

ENGINES, SEEDS, PARTICLES = ("mujoco", "lammps"), (1, 2, 3), 300


def main(dataset: Path, runs: Path, result: Path | None) -> None:
    """Print a line a run, and write them all."""
    rows = []
    for engine in ENGINES:
        for seed in SEEDS:
            folder = runs / f"{engine}-{seed}"
            if not (folder / DOCUMENT).is_file():
                words = ["repose", "run", dataset, "-o", folder, "-n", PARTICLES, "--engine", engine]
                words += ["--seed", seed]
                subprocess.run([sys.executable, "-m", "regolith_studio", *map(str, words)], check=True)
            document = read_run(folder).document
            checks, measured = document["checks"], document["measurement"]
            rows.append(
                {
                    "engine": engine,
                    "seed": seed,
                    "fill_height_cm": round(100 * checks["fill_height"], 2),
                    "solid_fraction": round(checks["solid_fraction"], 3),
                    "angle_deg": round(measured["angle_deg"], 2),
                    "interval_deg": [round(each, 2) for each in measured["interval_deg"]],
                    "steps": document["run"]["steps"],
                    "notes": document["run"]["notes"],
                }
            )
            print(rows[-1], flush=True)
    if result is not None:
        result.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:3]), Path(sys.argv[3]) if len(sys.argv) > 3 else None)
