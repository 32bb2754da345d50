"""Filling, angle of repose and cost of the same particles on several engines: docs/repose_engines.md.

    python -m benchmarks.repose_engines DATASET RUNS RESULT.json [ENGINES] [PARTICLES] [SEEDS]

Lists have commas between; by default MuJoCo and LAMMPS, 300 particles, seeds 1 to 3. Runs that are in the
folder RUNS already are read and not done again; their cost is in a file beside each.
"""

import json
import resource
import subprocess
import sys
from pathlib import Path
from typing import Any

from regolith_studio.dem.run_io import DOCUMENT, read_run


def main(
    dataset: Path, runs: Path, result: Path, engines: list[str], particles: list[int], seeds: list[int]
) -> None:
    """Print a line a run, and write them all."""
    rows = []
    for engine, n, seed in ((engine, n, seed) for engine in engines for n in particles for seed in seeds):
        folder = runs / f"{engine}-{n}-{seed}"
        cost = runs / f"{folder.name}.json"
        if not (folder / DOCUMENT).is_file():
            words = ["repose", "run", dataset, "-o", folder, "-n", n, "--engine", engine, "--seed", seed]
            cost.write_text(json.dumps(cost_of([sys.executable, "-m", "regolith_studio", *map(str, words)])))
        rows.append({"engine": engine, "particles": n, "seed": seed} | summary(read_run(folder).document))
        rows[-1] |= json.loads(cost.read_text()) if cost.is_file() else {}
        print(rows[-1], flush=True)
    result.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def cost_of(command: list[str]) -> dict[str, float]:
    """Processor time of a command with its children, and the largest memory of one of all so far."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"processor_s": round(seconds, 1), "memory_mb": round(after.ru_maxrss / 1024)}


def summary(document: dict[str, Any]) -> dict[str, Any]:
    """Numbers of a run for the tables."""
    checks, measured = document["checks"], document["measurement"]
    angle, interval = measured.get("angle_deg"), measured.get("interval_deg")
    return {
        "fill_height_cm": round(100 * checks["fill_height"], 2),
        "solid_fraction": round(checks["solid_fraction"], 3),
        "angle_deg": None if angle is None else round(angle, 2),
        "interval_deg": None if interval is None else [round(each, 2) for each in interval],
        "max_overlap": round(checks["max_overlap"], 4),
        "problems": checks["problems"],
        "steps": document["run"]["steps"],
        "notes": document["run"]["notes"],
    }


if __name__ == "__main__":
    lists = [word.split(",") for word in sys.argv[4:]]
    chosen, counts, numbers = (*lists, *(["mujoco", "lammps"], ["300"], ["1", "2", "3"])[len(lists) :])
    main(*map(Path, sys.argv[1:4]), chosen, [int(each) for each in counts], [int(each) for each in numbers])
