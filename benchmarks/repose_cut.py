"""How much the lower cut changes the angle of repose of rough heaps, by their number of grains.

python -m benchmarks.repose_cut [FIRST_SEED]
"""

import sys

import numpy as np

from benchmarks.heaps import KINDS, heap
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.evaluation.settings import NotAPileError

ROUGH = ("equal, noisy", "sizes, noise and loose grains")
ANGLES, GRAINS, HEAPS = (22, 28, 34), (300, 600, 1000, 2000), 3


def main(seed: int) -> None:
    """Print a line a number of grains: median and largest change when the cut is a third lower or higher."""
    for n in GRAINS:
        shifts = []
        for kind in ROUGH:
            for angle, k in ((angle, k) for angle in ANGLES for k in range(HEAPS)):
                try:
                    shifts.append(measure_repose(*heap(angle, n, seed + k, KINDS[kind])).cut_shift)
                except NotAPileError:
                    continue
        print(
            f"{n:5,} grains, {len(shifts)} heaps: {np.median(shifts):.2f}, at most {max(shifts):.2f} degrees"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 9500)
