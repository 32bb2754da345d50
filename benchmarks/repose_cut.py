"""How much the lower cut changes the angle of repose of rough heaps, by their number of grains.

python -m benchmarks.repose_cut [FIRST_SEED]
python -m benchmarks.repose_cut RUN...          # simulated heaps: folders of runs
"""

import sys
from pathlib import Path

import numpy as np

from benchmarks.heaps import KINDS, heap
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.evaluation.settings import EvaluationSettings, NotAPileError
from regolith_studio.dem.snapshot import read_particle_state

ROUGH = ("equal, noisy", "sizes, noise and loose grains")
ANGLES, GRAINS, HEAPS = (22, 28, 34), (300, 600, 1000, 2000), 3
TOES = (0.5, 0.75, 1.0, 1.5, 2.0, 2.5)
"""Lower cuts of simulated heaps, in mean diameters."""


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


def simulated(run: Path) -> None:
    """Print the angle of a simulated heap over the lower cut, and the default's interval."""
    heap = read_particle_state(run / "final.npz")
    usual = measure_repose(heap.points, heap.diameters)
    low, high = usual.interval
    print(f"{run.name}: {usual.angle:.1f} ({low:.1f} to {high:.1f}), shift {usual.cut_shift:.2f}", end="")
    for toe in TOES:
        try:
            cut = measure_repose(heap.points, heap.diameters, EvaluationSettings(toe=toe, cut_bottom=0.0))
            print(f"; {toe:g} d {cut.angle:.1f}", end="")
        except NotAPileError:
            print(f"; {toe:g} d refused", end="")
    print()


if __name__ == "__main__":
    given = sys.argv[1:]
    if given and not given[0].isdigit():
        for folder in given:
            simulated(Path(folder))
    else:
        main(int(given[0]) if given else 9500)
