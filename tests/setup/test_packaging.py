"""Source archive and wheel can be built and installed, hold what the program reads, and run anywhere."""

import json
import os
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import venv
import zipfile
from itertools import chain
from pathlib import Path

import pytest
import trimesh

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def files_below(folder: Path) -> set[str]:
    return {
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def shipped() -> set[str]:
    """Resources of an installation: those of the checkout, the guide, and the results for its tables."""
    folders = {"guide": ROOT / "docs", "results": ROOT / "benchmarks" / "results"}
    below = {f"{inside}/{name}" for inside, folder in folders.items() for name in files_below(folder)}
    return files_below(ROOT / "resources") | below


def run(*command: str | Path, folder: Path) -> str:
    """What a command prints that finds the program only where it is installed."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The source archive, unpacked far from the checkout; nothing is fetched for it."""
    pytest.importorskip("hatchling", reason="hatchling, which builds the package, is not installed")
    folder = tmp_path_factory.mktemp("source")
    run(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", folder, folder=ROOT)
    (archive,) = folder.glob("*.tar.gz")
    with tarfile.open(archive) as content:
        content.extractall(folder, filter="data")
    return folder / archive.name.removesuffix(".tar.gz")


@pytest.fixture(scope="module")
def wheel(source: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    build = (sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation")
    run(*build, "-w", folder, source, folder=folder)
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


@pytest.mark.slow
def test_that_the_source_archive_holds_the_checkout_but_for_the_files_of_its_services(source: Path) -> None:
    if not (ROOT / ".git").exists():
        pytest.skip("this is not a checkout")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    tracked = {name for name in listed.decode().split("\0") if name and (ROOT / name).is_file()}
    services = {name for name in tracked if name.startswith((".ci/", ".github/", ".pre-commit"))}
    assert files_below(source) == tracked - services | {"PKG-INFO"}


@pytest.mark.slow
def test_that_the_metadata_hold_the_licence_and_its_text(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (metadata,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        (licence,) = (name for name in archive.namelist() if name.endswith("/licenses/LICENSE"))
        lines = archive.read(metadata).decode().splitlines()
        assert archive.read(licence) == (ROOT / "LICENSE").read_bytes()
    assert "License-Expression: BSD-3-Clause" in lines


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


@pytest.mark.slow
def test_that_the_installed_program_measures_a_mesh_in_another_folder(
    installed: Path, tmp_path: Path
) -> None:
    trimesh.creation.box((1.0, 2.0, 3.0)).export(tmp_path / "box.stl")
    said = run(installed / "regolith-studio", "describe", "box.stl", "--json", folder=tmp_path)
    assert json.loads(said)[0]["volume"] == pytest.approx(6.0, rel=1e-6)
