"""Whether calibrations with simulated heaps find a friction that is hidden from them: docs/calibration.md.

    python -m benchmarks.blind_calibration DATASET RUNS RESULT.json [SET] [ENGINE]

Frictions are drawn from equal parts of the range, one a case. The wanted angle of a case is the mean of
HEAPS heaps of 1,000 particles of that friction, of those that have an angle; its standard error is the
standard deviation of heaps about their means, from all cases, over the square root of their number. The
calibration has N_RUNS heaps of other seeds. Runs that are in the folder RUNS already are kept. Each SET (0
by default) has its own frictions and seeds, needs its own folder, and joins the others in RESULT. Two runs
at a time, of one thread each.
"""

import json
import subprocess
import sys
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dem.run_io import DOCUMENT, read_run

LOW, HIGH, SEED = 0.05, 1.2, 7
CASES, HEAPS, N_RUNS = 10, 4, 8
PARTS = (LOW, 0.4, 0.8, HIGH)


def main(dataset: Path, runs: Path, result: Path, number_of_set: int, engine: str) -> None:
    """Print a line a case, and write them all."""
    parts = np.arange(CASES) + np.random.default_rng(SEED + number_of_set).random(CASES)
    frictions = (LOW + (HIGH - LOW) * parts / CASES).round(3).tolist()
    common = ["-n", 1000, "--engine", engine, "--jobs", 1]

    def angle(case: tuple[float, int]) -> float:
        friction, k = case
        return angle_of(
            dataset, runs / f"heap_{friction}_{k}", friction, 1000 * (number_of_set + 1) + k, common
        )

    with ThreadPoolExecutor(2) as pool:
        angles = np.array(list(pool.map(angle, product(frictions, range(HEAPS))))).reshape(CASES, HEAPS)
        spread = np.sqrt(np.nanvar(angles, axis=1, ddof=1).mean())
        errors = spread / np.sqrt(np.isfinite(angles).sum(axis=1))

        def calibration(number: int) -> dict[str, Any]:
            folder = runs / f"calibration_{number}"
            wanted, error = float(np.nanmean(angles[number])), float(errors[number])
            goal = ["--angle", f"{wanted:.2f}", "--angle-error", f"{error:.2f}"]
            seed = 100 * number_of_set + 10 * number
            call("calibrate", dataset, "-o", folder, *goal, "--runs", N_RUNS, "--seed", seed, *common)
            return row(folder, frictions[number], wanted, error)

        rows = list(pool.map(calibration, range(CASES)))
    for each in rows:
        print(each)
    found = [[None if np.isnan(each) else round(each, 2) for each in some] for some in angles.tolist()]
    sets = json.loads(result.read_text("utf-8"))["sets"] if result.exists() else {}
    sets[str(number_of_set)] = {"angles_deg": found, "calibrations": rows}
    content = {"sets": sets, "by_friction": {"rows": by_friction(sets)}}
    result.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def by_friction(sets: Mapping[str, Any]) -> dict[str, list[float]]:
    """Calibrations with a value in parts of the range: how many, how many intervals hold it, mean width."""
    done = [case for each in sets.values() for case in each["calibrations"]]
    rows = {}
    for low, high in pairwise(PARTS):
        part = [case for case in done if low <= case["friction"] < high and case["interval"]]
        width = float(np.mean([case["width"] for case in part]))
        rows[f"{low} to {high}"] = [len(part), sum(case["covered"] for case in part), round(width, 2)]
    return rows


def row(folder: Path, friction: float, wanted: float, error: float) -> dict[str, Any]:
    """The numbers of one calibration."""
    found = json.loads((folder / "calibration.json").read_text("utf-8"))["parameters"][0]
    interval = found["interval"] or []
    return {
        "friction": friction,
        "wanted_deg": round(wanted, 2),
        "error_deg": round(error, 2),
        "interval": [round(end, 3) for end in interval],
        "covered": bool(interval) and interval[0] <= friction <= interval[1],
        "width": round(found["relative_width"], 3),
    }


def angle_of(dataset: Path, folder: Path, friction: float, seed: int, common: list[Any]) -> float:
    """Angle of a heap, made where it is not there; NaN for a heap that has none."""
    if not (folder / DOCUMENT).is_file():
        call(
            "run", dataset, "-o", folder, "--contact", f"static_friction={friction}", "--seed", seed, *common
        )
    angle = read_run(folder).document["measurement"]["angle_deg"]
    return float("nan" if angle is None else angle)


def call(*words: object) -> None:
    """A command of `repose`."""
    subprocess.run([sys.executable, "-m", "regolith_studio", "repose", *map(str, words)], check=True)


if __name__ == "__main__":
    given = dict(enumerate(sys.argv))
    main(Path(given[1]), Path(given[2]), Path(given[3]), int(given.get(4, 0)), given.get(5, "rapier"))
