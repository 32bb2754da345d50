"""YADE as a program: its settings, and how it is found and started; it is never loaded here (GPL)."""

import os
import re
import shutil
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from regolith_studio.dataset.parameters import check_limits
from regolith_studio.dem.engine import Availability
from regolith_studio.messages import N_
from regolith_studio.resources import resource


@dataclass(frozen=True)
class YadeSettings:
    """Numerics; times in sqrt(d/g).

    - ``stiffness``: force by overlapping volume, in m g / d^3.
    - ``step_share``: time step as a share of the time in which the smallest particle would swing on a flat
      contact.
    - ``damping``: YADE's local damping: the share by which every accelerating force is reduced.
    - ``n_segments``: number of flat segments of the cylinder.
    - ``max_fill_speed``: speed limit during filling, in sqrt(g d).
    - ``rest_energy``, ``rest_time``, ``max_rest_time``: mean kinetic energy of a particle in m g d below
      which a heap is at rest, the time for which it must stay below, and the maximum time of waiting for it.
    - ``restarts``: maximum number of restarts from the last snapshot after a crash of YADE.
    - ``snapshots``: number of snapshots of a run.

    Raises InputError if a value is out of its range.
    """

    stiffness: float = field(
        default=5e3, metadata={"label": N_("Stiffness, in m g / d³"), "minimum": 1e2, "maximum": 1e9}
    )
    step_share: float = field(
        default=0.35, metadata={"label": N_("Step, share of an oscillation"), "minimum": 0.01, "maximum": 0.5}
    )
    damping: float = field(default=0.4, metadata={"label": N_("Damping"), "minimum": 0.0, "maximum": 0.9})
    n_segments: int = field(
        default=24, metadata={"label": N_("Blocks of the cylinder"), "minimum": 8, "maximum": 96}
    )
    max_fill_speed: float = field(
        default=4.0, metadata={"label": N_("Filling speed"), "minimum": 0.1, "maximum": 100.0}
    )
    rest_energy: float = field(
        default=5e-3, metadata={"label": N_("Energy at rest"), "minimum": 1e-9, "maximum": 0.1, "decimals": 9}
    )
    rest_time: float = field(
        default=2.0, metadata={"label": N_("Time at rest"), "minimum": 0.1, "maximum": 1000.0}
    )
    max_rest_time: float = field(
        default=20.0, metadata={"label": N_("Maximum duration"), "minimum": 1.0, "maximum": 1e5}
    )
    restarts: int = field(default=20, metadata={"label": N_("Restarts"), "minimum": 0, "maximum": 1000})
    snapshots: int = field(default=60, metadata={"label": N_("Snapshots"), "minimum": 2, "maximum": 10_000})

    def __post_init__(self) -> None:
        check_limits(self, "YADE setting")


MISSING = N_("YADE is not installed; install the package yade of your Linux distribution.")
NAMES = ("yade", "yadedaily")
VERSION = re.compile(r"'(20\d\d\.\d+\w*)'")
_HIDDEN = ("LD_LIBRARY_PATH", "PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV", "DISPLAY", "WAYLAND_DISPLAY")
"""Environment variables that are hidden from YADE's own Python."""


def find_yade() -> Availability:
    """Whether YADE can be started, without starting it."""
    program = _program()
    return Availability(problem=MISSING) if program is None else Availability(_version(program))


def command(folder: Path) -> tuple[list[str], dict[str, str]]:
    """Command line and environment that run the test of `folder` on one core without a window."""
    script = str(resource("engines", "yade_repose.py"))
    words = [str(_program() or NAMES[0]), "-n", "-x", "-j1", script, str(folder)]
    kept = {name: value for name, value in os.environ.items() if name not in _HIDDEN}
    return words, kept | {"OMP_NUM_THREADS": "1"}


def _program() -> Path | None:
    program = next((path for name in NAMES if (path := shutil.which(name))), None)
    return None if program is None else Path(program)


@cache
def _version(program: Path) -> str:
    """From the head of the start script, which names it; starting YADE would take a second."""
    try:
        with program.open(encoding="utf-8", errors="replace") as file:
            match = VERSION.search(file.read(20_000))
    except OSError:
        match = None
    return match.group(1) if match else "on the path"
