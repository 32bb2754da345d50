"""Writes positions.csv from a finished simulation in ANSYS Rocky (2024 R2 to 2026 R1).

Written by Regolith Studio. Open the simulated project in Rocky, then
Tools > Script Editor > open this file > Run (set FOLDER first if it is not found).
Measure the pile with

    regolith-studio repose measure positions.csv

or on the page "Angle of repose" (Page > Measure positions).
"""

import csv
import json
from pathlib import Path

FOLDER = None
"""The folder of case.json; found by itself where the script knows its own place."""
STEP = None
"""Number of the time step; the last one if not given."""


def main(application):
    """Centres and equivalent diameters of all particles in metres; `application` is Rocky's ``app``."""
    folder = Path(FOLDER).resolve() if FOLDER else _own_folder()
    particles = application.GetStudy().GetParticles()
    step = STEP if STEP is not None else len(particles.GetCurve("Particles Count").GetY()) - 1
    rows = [(one.x, one.y, one.z, one.size) for one in particles.IterParticles(time_step=step)]
    enlarged = enlargement(max((row[3] for row in rows), default=0.0), folder)
    with (folder / "positions.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("x [m]", "y [m]", "z [m]", "diameter [m]"))
        writer.writerows((x, y, z, size * enlarged) for x, y, z, size in rows)


def enlargement(largest, folder):
    """The coarse-graining factor if Rocky tells sizes without it, else 1: the nearer of the two to case.json.

    The reference does not say which; the largest size that was asked for decides.
    """
    case = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    asked = max(diameter for record in case["particles"] for diameter, _ in record["sizes"])
    factor = case["coarse_graining_factor"]
    return factor if largest * largest < asked * asked * factor else 1.0


def _own_folder():
    try:
        return Path(__file__).resolve().parent
    except NameError:
        return Path.cwd()


if __name__ == "__main__" or "app" in globals():
    main(globals()["app"])
