"""The angle that ``repose run`` writes against that of ``repose measure`` on its files.

    python -m benchmarks.repose_one_answer DATASET [PARTICLES]

One run on MuJoCo for each friction; its ``final.npz`` and the same positions as a CSV table are measured.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.dem.snapshot import read_particle_state

FRICTIONS = (0.2, 0.9)
SEED = 11


def main(dataset: Path, n: int) -> None:
    """Print one line a friction."""
    with tempfile.TemporaryDirectory() as place:
        for friction in FRICTIONS:
            folder = Path(place) / f"friction{friction}"
            options = ["-n", str(n), "--seed", str(SEED), "--contact", f"static_friction={friction}"]
            document = answer("run", dataset, "-o", folder, *options)
            pile = read_particle_state(folder / "final.npz")
            table = folder / "pile.csv"
            rows = np.column_stack([pile.points, pile.diameters])
            np.savetxt(table, rows, delimiter=",", header="x,y,z,diameter", comments="", fmt="%.17g")
            found = {"run": document["measurement"]}
            found |= {path.name: answer("measure", path) for path in (table, folder / "final.npz")}
            print(f"friction {friction}, {n} particles:", end="")
            for name, each in found.items():
                low, high = each["interval_deg"]
                print(f"  {name} {each['angle_deg']:.6f} [{low:.3f}, {high:.3f}]", end="")
            print(flush=True)


def answer(*arguments: object) -> dict[str, Any]:
    """What ``regolith-studio repose`` prints as JSON."""
    command = [sys.executable, "-m", "regolith_studio", "repose", *map(str, arguments), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return dict(json.loads(done.stdout))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 400)
