"""Bias of the angle of repose, and how often its 95 % interval holds the truth, on heaps of known angle.

    python -m benchmarks.repose_intervals [HEAPS] [FIRST_SEED] [RESULT.json]

One line for each kind of heap and number of grains: HEAPS of each of four angles (20 to 40 degrees).
Hyperbolic heaps have two: against the asymptotes, and against the hyperbola itself between the cuts.
"""

import json
import sys
from multiprocessing import Pool
from pathlib import Path

import numpy as np

from benchmarks.heaps import KINDS, SOLID_FRACTION, Array, heap
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.dem.evaluation.section import NotAPileError

ANGLES = (20, 27, 34, 40)
GRAINS = (150, 200, 300, 1000, 5000)

Case = tuple[str, int, int, int]


def measured(case: Case) -> Array:
    """Error of the angle and ends of the interval less the truth; nan where no angle is found."""
    kind, n, angle, seed = case
    try:
        found = measure_repose(*heap(angle, n, seed, KINDS[kind]))
    except NotAPileError:
        return np.full(3, np.nan)
    return np.array([found.angle, *found.interval]) - angle


def main(heaps: int, seed: int, result: str) -> None:
    """Print a table, and write its rows."""
    rows: list[str] = []
    print("| heaps | grains | bias | spread | half width | covered, % | refused |")
    print("| --- " * 7 + "|")
    with Pool() as pool:
        for n in GRAINS:
            every = []
            for kind in KINDS:
                cases = [(kind, n, angle, seed + k) for angle in ANGLES for k in range(heaps)]
                every.append(np.array(pool.map(measured, cases)))
                rows.append(line(kind, n, every[-1]))
                print(rows[-1], flush=True)
                if KINDS[kind].blunt:
                    flank = np.repeat([flank_angle(angle, n, KINDS[kind].blunt) for angle in ANGLES], heaps)
                    rows.append(
                        line(
                            "the same, of its flank",
                            n,
                            every[-1] - (flank - np.repeat(ANGLES, heaps))[:, None],
                        )
                    )
                    print(rows[-1], flush=True)
            rows.append(line("all", n, np.concatenate(every)))
            print(rows[-1], flush=True)
    if result:
        found = {"heaps": heaps, "first_seed": seed, "rows": rows}
        Path(result).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


def flank_angle(angle: float, n: int, blunt: float) -> float:
    """Of the least-squares line through a hyperbola of `n` grains where that line lies between the cuts, in
    degrees; the cuts are those of the evaluation."""
    settings, slope = EvaluationSettings(), np.tan(np.radians(angle))
    radius = (n / (2 * SOLID_FRACTION * slope)) ** (1 / 3)  # of a cone of grains of diameter 1
    run = np.linspace(0.0, 1.0, 10_001)
    height = slope * (1.0 - np.hypot(run, blunt))
    low = max(settings.cut_bottom * height[0], settings.toe / radius)
    fitted = height
    for _ in range(6):
        used = (fitted >= low) & (fitted < (1.0 - settings.cut_top) * height[0])
        fall, top = np.polyfit(run[used], height[used], 1)
        fitted = fall * run + top
    return float(np.degrees(np.arctan(-fall)))


def line(name: str, n: int, found: Array) -> str:
    """A row of the table."""
    good = found[np.isfinite(found[:, 0])]
    covered = 100 * ((good[:, 1] <= 0) & (good[:, 2] >= 0)).mean()
    half = np.mean(good[:, 2] - good[:, 1]) / 2
    return (
        f"| {name} | {n:,} | {good[:, 0].mean():+.2f} | {good[:, 0].std():.2f} | {half:.2f} "
        f"| {covered:.0f} | {len(found) - len(good)} |"
    )


if __name__ == "__main__":
    words = [*sys.argv[1:], *("8", "9000", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2])
