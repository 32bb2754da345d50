"""How many heaps without a single angle are refused: docs/repose_evaluation.md.

    python -m benchmarks.repose_refusals [HEAPS] [FIRST_SEED] [RESULT.json]

Domes and exponential heaps as high as so many shares of their radius, beside cones of 30 degrees.
"""

import json
import sys
from pathlib import Path
from typing import Any

from benchmarks.heaps import HeapKind, heap, surface_of_revolution
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.evaluation.section import NotAPileError

CURVES = {"dome, 0.45": ("dome", 0.45), "dome, 0.7": ("dome", 0.7), "exponential, 1": ("exponential", 1.0)}
GRAINS = (300, 1000, 3000)
RADIUS = 10.0


def main(heaps: int, seed: int, result: str) -> None:
    """Print a line for each curve and number of grains, and write them all."""
    rows: list[dict[str, Any]] = []
    for name in (*CURVES, "cone"):
        for n in GRAINS:
            refused = [outcome(name, n, seed + k) for k in range(heaps)]
            rows.append({"heap": name, "grains": n, "heaps": heaps, "refused": sum(refused)})
            print(rows[-1], flush=True)
    if result:
        Path(result).write_text(
            json.dumps({"first_seed": seed, "rows": rows}, indent=1) + "\n", encoding="utf-8"
        )


def outcome(name: str, n: int, seed: int) -> bool:
    """Whether this heap is refused."""
    if name == "cone":
        points, diameters = heap(30.0, n, seed, HeapKind())
    else:
        curve, height = CURVES[name]
        points, diameters = surface_of_revolution(n, seed, height * RADIUS, RADIUS, curve)
    try:
        measure_repose(points, diameters)
    except NotAPileError:
        return True
    return False


if __name__ == "__main__":
    words = [*sys.argv[1:], *("4", "9400", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2])
