"""Find and start the program YADE; it is never loaded into this process (GPL)."""

import os
import re
import shutil
from functools import cache
from pathlib import Path

from regolith_studio.dem.engine import Availability
from regolith_studio.resources import resource

MISSING = "YADE is not installed; install the package yade of your Linux distribution."
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
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    return None if found is None else Path(found)


@cache
def _version(program: Path) -> str:
    """From the head of the start script, which names it; starting YADE would take a second."""
    try:
        with program.open(encoding="utf-8", errors="replace") as file:
            found = VERSION.search(file.read(20_000))
    except OSError:
        found = None
    return found.group(1) if found else "on the path"
