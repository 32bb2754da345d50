"""The angle that ``repose run`` wrote against that of ``repose measure`` on its files.

    python -m benchmarks.repose_one_answer RUN...

For each folder of a run: ``repose.json``, ``final.npz`` and the same positions as a CSV table. Exits with 1
where they differ.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dem.run_io import read_run
from regolith_studio.dem.snapshot import read_particle_state


def main(run: Path) -> bool:
    """Print one line for a run; whether all answers are equal."""
    final = run / "final.npz"
    pile = read_particle_state(final)
    with tempfile.TemporaryDirectory() as place:
        table = Path(place) / "pile.csv"
        rows = np.column_stack([pile.points, pile.diameters])
        np.savetxt(table, rows, delimiter=",", header="x,y,z,diameter", comments="", fmt="%.17g")
        found = [read_run(run).document["measurement"], measured(final), measured(table)]
    answers = [(each["angle_deg"], *each["interval_deg"]) for each in found]
    equal = len(set(answers)) == 1
    for angle, low, high in answers if not equal else answers[:1]:
        print(f"{run.name}: {angle:.6f} ({low:.3f} to {high:.3f})", end="  ")
    print("equal" if equal else "differ", flush=True)
    return equal


def measured(path: Path) -> dict[str, Any]:
    """What ``regolith-studio repose measure`` prints as JSON."""
    command = [sys.executable, "-m", "regolith_studio", "repose", "measure", str(path), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return dict(json.loads(done.stdout))


if __name__ == "__main__":
    answers = [main(Path(folder)) for folder in sys.argv[1:]]
    sys.exit(not all(answers))
