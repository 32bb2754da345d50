"""`pip install .` gives the command regolith-studio, and the wheel holds what the program reads."""

import os
import subprocess
import sys
import sysconfig
import tomllib
import venv
import zipfile
from itertools import chain
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def files_below(folder: Path) -> set[str]:
    return {
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def shipped() -> set[str]:
    """Resources of an installation: those of the checkout, and the guide."""
    return files_below(ROOT / "resources") | {f"guide/{name}" for name in files_below(ROOT / "docs")}


def run(*command: str | Path, folder: Path) -> str:
    done = subprocess.run(
        [str(word) for word in command], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "-w", folder, ROOT, folder=folder)
    (made,) = folder.glob("*.whl")
    return made


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of commands of a clean environment with the wheel; it borrows the libraries from ours."""
    environment = tmp_path_factory.mktemp("installed") / "venv"
    venv.create(environment, with_pip=True)
    scripts = environment / ("Scripts" if os.name == "nt" else "bin")
    run(scripts / "python", "-m", "pip", "install", "--quiet", "--no-deps", wheel, folder=environment)
    own = run(
        scripts / "python", "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", folder=environment
    )
    (Path(own.strip()) / "borrowed.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    return scripts


def test_that_the_full_qt_is_not_asked_for() -> None:
    qt = [line for line in PROJECT["dependencies"] if line.lower().startswith("pyside6")]
    assert [line.split(">")[0] for line in qt] == ["PySide6-Essentials"]


def test_that_every_dependency_is_pinned() -> None:
    pins = {line.split("==")[0] for line in (ROOT / "constraints.txt").read_text().splitlines()}
    asked = [*PROJECT["dependencies"], *chain.from_iterable(PROJECT["optional-dependencies"].values())]
    names = {line.split(">")[0].split("[")[0].strip().lower() for line in asked}
    assert names - {PROJECT["name"]} <= pins


def test_that_the_guide_says_of_every_dependency_what_it_does_here() -> None:
    guide = (ROOT / "docs" / "installing.md").read_text(encoding="utf-8")
    rows = [
        line.split("|")[1] for line in guide.partition("## What is installed")[2].splitlines() if "|" in line
    ]
    explained = {name.strip() for row in rows for name in row.split(",")}
    assert {line.split(">")[0] for line in PROJECT["dependencies"]} <= explained


@pytest.mark.slow
def test_that_the_wheel_holds_the_package_and_its_resources_and_nothing_else(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        inside = {name for name in archive.namelist() if ".dist-info/" not in name}
    package = {f"regolith_studio/{name}" for name in files_below(ROOT / "regolith_studio")}
    resources = {f"regolith_studio/_resources/{name}" for name in shipped()}
    assert inside == package | resources


@pytest.mark.slow
def test_that_the_installed_program_reads_its_own_resources(installed: Path) -> None:
    code = "from regolith_studio.resources import resource_folder; print(resource_folder())"
    folder = Path(run(installed / "python", "-c", code, folder=installed).strip())
    assert folder.name == "_resources"
    assert folder.is_relative_to(installed.parent.resolve())
    assert files_below(folder) == shipped()


@pytest.mark.slow
def test_that_the_command_is_there_and_answers(installed: Path) -> None:
    assert "Usage" in run(installed / "regolith-studio", "--help", folder=installed)
