"""Angle of repose of compounds and of one convex polyhedron for each particle (docs/repose_results.md).

    python -m benchmarks.compound_heaps RUNS [RESULT.json] [SEEDS] [ENGINE]

The two agglutinates that ship, 40 facets, both methods; 500 particles on MuJoCo or another engine, the same
seeds for both, so that classes, sizes and the order of filling are equal. Datasets and runs that are in the
folder RUNS already are read and not made again. The result is written anew after every pair of runs.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import t

from regolith_studio.dem.run_io import FINAL, read_run
from regolith_studio.resources import resource

METHODS, FACETS, PARTICLES = ("exact", "compound"), 40, 500
NAMES = ("agglutinate-1", "agglutinate-2")


def main(runs: Path, result: Path | None, n_seeds: int, engine: str) -> None:
    """Make what is missing and print a line for each pair of runs, and the mean difference."""
    for method in METHODS:
        if not (runs / method).is_dir():
            meshes = [resource("samples", "particles", f"{name}.stl") for name in NAMES]
            how = ["--method", method, "--facets", FACETS, "--unit", "um"]
            call("dataset", "build", *meshes, "-o", runs / method, *how)
    rows: list[dict[str, Any]] = []
    for seed in range(1, n_seeds + 1):
        rows += [row(runs, method, seed, engine) for method in METHODS]
        summary = summary_of(rows)
        print(rows[-2], rows[-1], summary, sep="\n", flush=True)
        if result is not None:
            content = {"summary": summary, "runs": rows}
            result.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def call(*words: object) -> None:
    """A command of the program."""
    subprocess.run([sys.executable, "-m", "regolith_studio", *map(str, words)], check=True)


def row(runs: Path, method: str, seed: int, engine: str) -> dict[str, Any]:
    """One run, made or gone on with where it is not complete."""
    folder = runs / f"{method}-{seed}"
    if not (folder / FINAL).is_file():
        how = ["-n", PARTICLES, "--seed", seed, "--engine", engine, "--overwrite"]
        call("repose", "run", runs / method, "-o", folder, *how)
    document = read_run(folder).document
    checks, measured = document["checks"], document["measurement"]
    return {
        "method": method,
        "seed": seed,
        "angle_deg": None if measured is None else round(measured["angle_deg"], 2),
        "interval_deg": None if measured is None else [round(each, 2) for each in measured["interval_deg"]],
        "solid_fraction": round(checks["solid_fraction"], 4),
        "at_rest": checks["at_rest"],
        "max_overlap": round(checks["max_overlap"], 4),
        "problems": checks["problems"],
    }


def summary_of(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Means with Student's 95 % intervals over the seeds; differences are those of pairs of one seed."""
    values = {
        key: {
            method: np.array([each[key] for each in rows if each["method"] == method], dtype=np.float64)
            for method in METHODS
        }
        for key in ("angle_deg", "solid_fraction")
    }
    return {
        key: {method: interval(each) for method, each in found.items()}
        | {"difference": interval(found["compound"] - found["exact"])}
        for key, found in values.items()
    }


def interval(values: "np.ndarray[tuple[int], np.dtype[np.float64]]") -> dict[str, Any]:
    """Mean, half width of its 95 % interval (``None`` for one value) and number of values that are there."""
    good = values[np.isfinite(values)]
    n = len(good)
    half = float(t.ppf(0.975, n - 1) * good.std(ddof=1) / np.sqrt(n)) if n > 1 else None
    return {
        "mean": round(float(good.mean()), 4) if n else None,
        "half_width": None if half is None else round(half, 4),
        "n": n,
    }


if __name__ == "__main__":
    main(
        Path(sys.argv[1]),
        Path(sys.argv[2]) if len(sys.argv) > 2 else None,
        int(sys.argv[3]) if len(sys.argv) > 3 else 5,
        sys.argv[4] if len(sys.argv) > 4 else "mujoco",
    )
