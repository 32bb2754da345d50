"""``check``, ``warm-up``, ``install-desktop``, ``forget``: the program on this machine."""

import json
import os
import platform
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Annotated, Any

import typer

from regolith_studio.cli.options import Json
from regolith_studio.cli.terminal import print_json, print_result, run_with_progress
from regolith_studio.version import __version__


def check(json: Json = False) -> None:
    """Print versions, OpenGL renderer, display, available DEM engines and missing requirements."""
    report = examine_machine()
    code = 1 if unusable(report) else 0
    if json:
        print_json(report)
        raise typer.Exit(code)
    for title, content in report.items():
        typer.echo(title)
        lines = content.items() if isinstance(content, dict) else [("", each) for each in content]
        for key, value in lines:
            typer.echo(f"  {key:<24}{value}" if key else f"  {value}")
        if not content:
            typer.echo("  nothing")
    raise typer.Exit(code)


DEBIAN = (
    "libgl1 libegl1 libglx-mesa0 libglib2.0-0 libdbus-1-3 libfontconfig1 libx11-xcb1 libxkbcommon-x11-0 "
    "libxcb-cursor0 libxcb-icccm4 libxcb-keysyms1 libxcb-shape0 libxcb-randr0 libxcb-sync1 libxcb-xfixes0 "
    "libxcb-xkb1 libxcursor1"
)
FEDORA = (
    "libglvnd-glx libglvnd-egl mesa-dri-drivers glib2 dbus-libs fontconfig libX11-xcb libxkbcommon-x11 "
    "xcb-util-cursor xcb-util-wm xcb-util-keysyms libxcb libXcursor"
)
LIBRARIES = ("PySide6.QtWidgets", "PySide6.QtOpenGLWidgets", "vtkmodules.all", "mujoco", "pyshtools", "h5py")
"""Parts of other packages that are linked with libraries of the system."""


def library_sentence(error: ImportError) -> str | None:
    """What to install where a library of the system is missing; ``None`` for other errors."""
    name, marker, _ = str(error).partition(": cannot open shared object file")
    if not marker:
        return None
    return (
        f"The library {name} of the system is missing. Debian and Ubuntu have what the window needs with "
        f"apt-get install {DEBIAN}; Fedora with dnf install {FEDORA}."
    )


_TIMEOUT = 60
_OPENGL_QUESTION = """
import json, os, sys
os.environ.setdefault("PYVISTA_OFF_SCREEN", "true")
import pyvista
from regolith_studio.scene import plotter_setup
plotter_setup.choose_off_screen_window()
plotter = pyvista.Plotter(off_screen=True, window_size=[64, 64])
plotter.add_mesh(pyvista.Sphere())
plotter.screenshot(return_img=True)
lines = plotter.render_window.ReportCapabilities().splitlines()
found = dict(line.split(":", 1) for line in lines if line.startswith("OpenGL") and ":" in line)
answer = {key: value.strip() for key, value in found.items()}
answer["window"] = type(plotter.render_window).__name__
plotter.close()
print(json.dumps(answer))
"""
_DISPLAY_QUESTION = """
import json, sys
from PySide6.QtGui import QGuiApplication
application = QGuiApplication(sys.argv[:1])
screen = application.primaryScreen()
size = screen.size()
print(json.dumps({
    "platform": application.platformName(),
    "screen": f"{size.width()} x {size.height()}",
    "scale": screen.devicePixelRatio(),
}))
"""
_KINDS_QUESTION = """
import json
from regolith_studio.cli.check import _engines, _plugin_problems
print(json.dumps({"engines": _engines(), "problems": _plugin_problems()}))
"""


def examine_machine() -> dict[str, Any]:
    """Versions, machine, OpenGL, display, DEM engines, and sentences about what is missing."""
    libraries = _libraries()
    missing = [f"{name} cannot be loaded: {state}" for name, state in libraries.items() if state != "loads"]
    if any("cannot open shared object" in each for each in missing):
        missing.append(f"Debian and Ubuntu: apt-get install {DEBIAN}")
        missing.append(f"Fedora: dnf install {FEDORA}")
    opengl = _ask_child(_OPENGL_QUESTION)
    if "problem" in opengl:
        missing.append(f"Three-dimensional pictures cannot be drawn: {opengl['problem']}")
    display = _display()
    if "problem" in display:
        missing.append(f"The window cannot open: {display['problem']}")
    packages = _packages()
    missing += [f"The package {name} is not installed." for name, state in packages.items() if not state]
    kinds = _ask_child(_KINDS_QUESTION)
    missing += kinds.get("problems", ())
    if "problem" in kinds:
        missing.append(f"DEM engines and other kinds cannot be listed: {kinds['problem']}")
    return {
        "program": {"regolith-studio": __version__, "python": platform.python_version()},
        "packages": {name: state or "missing" for name, state in packages.items()},
        "machine": {"system": platform.platform(), "cores": os.cpu_count(), "executable": sys.executable},
        "libraries": libraries,
        "opengl": opengl,
        "display": display,
        "engines": kinds.get("engines", {}),
        "missing": missing,
    }


def unusable(report: dict[str, Any]) -> bool:
    """Whether something that the window needs is missing, but for a display: another session may have one."""
    loads = all(state == "loads" for state in report["libraries"].values())
    return not loads or "problem" in report["opengl"] or "missing" in report["packages"].values()


def _libraries() -> dict[str, str]:
    """``loads``, or why not, of :data:`LIBRARIES`, each in a process of its own, which may crash."""
    questions = [f"import {name}; print('{{}}')" for name in LIBRARIES]
    with ThreadPoolExecutor(len(questions)) as threads:
        answers = list(threads.map(_ask_child, questions))
    return {name: answer.get("problem", "loads") for name, answer in zip(LIBRARIES, answers, strict=True)}


def _engines() -> dict[str, str]:
    """Versions of the engines that can simulate the angle of repose, or why one cannot be used."""
    from regolith_studio.dem.engines import engine_rows

    return {row["key"]: row["problem"] or row["version"] for row in engine_rows()}


def _plugin_problems() -> tuple[str, ...]:
    """What other packages offer and cannot be used, but for pages, which need Qt."""
    from regolith_studio.coarsening.methods import METHODS
    from regolith_studio.dataset.exporters import EXPORTERS
    from regolith_studio.dem.engines import ENGINES
    from regolith_studio.readers.formats import MESH_FORMATS
    from regolith_studio.readers.position_formats import POSITION_FORMATS
    from regolith_studio.readers.volume_formats import VOLUME_FORMATS
    from regolith_studio.registry import plugin_problems
    from regolith_studio.shape_models.models import MODELS

    for kinds in (METHODS, EXPORTERS, ENGINES, MODELS, MESH_FORMATS, POSITION_FORMATS, VOLUME_FORMATS):
        len(kinds)
    return plugin_problems()


def _packages() -> dict[str, str | None]:
    """Versions of what the program is built on; ``None`` where one is missing."""
    try:
        wanted = [line for line in requires("regolith-studio") or [] if "extra ==" not in line]
    except PackageNotFoundError:
        wanted = ["numpy", "scipy", "numba", "trimesh", "pyshtools", "pyvista", "PySide6-Essentials"]
    return {name: _version(name) for name in sorted({_name(line) for line in wanted}, key=str.lower)}


def _name(requirement: str) -> str:
    for at, character in enumerate(requirement):
        if not (character.isalnum() or character in "-_."):
            return requirement[:at]
    return requirement


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _display() -> dict[str, Any]:
    """What Qt finds; on Linux it aborts the process without a display, so that is looked at before."""
    named = {key: os.environ[key] for key in ("DISPLAY", "WAYLAND_DISPLAY") if os.environ.get(key)}
    if sys.platform.startswith("linux") and not named:
        return {"problem": "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)."}
    return named | _ask_child(_DISPLAY_QUESTION)


def _ask_child(question: str) -> dict[str, Any]:
    """The JSON that a child process prints in answer, or ``problem`` with one sentence."""
    try:
        child = subprocess.run(
            [sys.executable, "-c", question], capture_output=True, text=True, timeout=_TIMEOUT, check=False
        )
    except subprocess.TimeoutExpired:
        return {"problem": f"no answer came within {_TIMEOUT} s."}
    if child.returncode < 0:
        return {"problem": f"the attempt ended with signal {-child.returncode}."}
    lines = child.stdout.strip().splitlines()
    if child.returncode or not lines:
        reason = (child.stderr.strip().splitlines() or ["no reason was given"])[-1]
        return {"problem": f"{reason}."}
    answer: dict[str, Any] = json.loads(lines[-1])
    return answer


def warm_up(json: Json = False) -> None:
    """Compile fitting, measuring and coarsening ahead, so that the first use is as fast as the second."""
    from regolith_studio.errors import RegolithError
    from regolith_studio.jobs.compile_kernels import TASKS, compile_first, is_compiled

    run_with_progress(compile_first())
    if failed := [task for task in TASKS if not is_compiled(task)]:
        raise RegolithError(f"Not compiled: {', '.join(failed)}. It is compiled when it is first used.")
    print_result({"compiled": list(TASKS)}, f"Compiled: {', '.join(TASKS)}.", json)


FILES = {
    "applications/regolith-studio.desktop": ("desktop", "regolith-studio.desktop"),
    "icons/hicolor/scalable/apps/regolith-studio.svg": ("icons", "app.svg"),
    "mime/packages/regolith-studio.xml": ("desktop", "regolith-studio.xml"),
}
"""Place of each file below the data folder, and the shipped file."""
DATABASES = {"update-mime-database": "mime", "update-desktop-database": "applications"}
"""Programs that make the caches of a desktop, and the folders that they read."""


def install_desktop(
    remove: Annotated[bool, typer.Option("--remove", help="Remove what was installed.")] = False,
    json: Json = False,
) -> None:
    """Add the program to the menu of a Linux desktop, with icon and file types, for this user."""
    from regolith_studio.errors import FileError, MissingRequirement, os_error_reason

    if sys.platform in ("win32", "darwin"):
        raise MissingRequirement("Menu entries are made on desktops that follow freedesktop.org only.")
    paths = {data_folder() / place: parts for place, parts in FILES.items()}
    changed = [path for path in paths if path.exists()] if remove else list(paths)
    for path in changed:
        try:
            path.unlink() if remove else _install(path, paths[path])
        except OSError as error:
            raise FileError(f"{path} cannot be changed ({os_error_reason(error)}).") from error
    if changed:
        _update_databases()
    verb = "removed" if remove else "installed"
    print_result(
        {verb: list(map(str, changed))},
        "\n".join(f"{verb.capitalize()} {path}" for path in changed) or "There is nothing to remove.",
        json,
    )


def data_folder() -> Path:
    """``XDG_DATA_HOME``, which counts only if it is absolute, or its default."""
    named = Path(os.environ.get("XDG_DATA_HOME", ""))
    return named if named.is_absolute() else Path.home() / ".local" / "share"


def _install(path: Path, parts: tuple[str, ...]) -> None:
    from regolith_studio.io.atomic import write_bytes
    from regolith_studio.resources import resource

    content = resource(*parts).read_bytes()
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bytes(path, content.replace(b"@PYTHON@", _quoted(sys.executable).encode("utf-8")))


def _quoted(word: str) -> str:
    """A word of the key Exec, which is unescaped twice: as a string and as a quoted argument."""
    escaped = re.sub(r'(["`$\\])', r"\\\1", word).replace("\\", r"\\").replace("%", "%%")
    return f'"{escaped}"'


def _update_databases() -> None:
    """Make the caches of the desktop anew."""
    from regolith_studio.cli.terminal import print_errors

    for program, name in DATABASES.items():
        folder = data_folder() / name
        if path := shutil.which(program):
            subprocess.run([path, str(folder)], capture_output=True, check=False)
        else:
            print_errors(
                [f"{program} was not found: types of files count once `{program} {folder}` has run."]
            )


def forget(json: Json = False) -> None:
    """Remove preferences and compiled code; results, also those of the window, stay."""
    from regolith_studio.errors import FileError, os_error_reason
    from regolith_studio.geometry.kernels import compiled_code
    from regolith_studio.session.preferences import preferences_path

    there = [path for path in (preferences_path(), *compiled_code()) if path.exists()]
    for path in there:
        try:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        except OSError as error:
            raise FileError(f"{path} cannot be removed ({os_error_reason(error)}).") from error
    print_result(
        {"removed": list(map(str, there))},
        "\n".join(f"Removed {path}" for path in there) or "There is nothing to remove.",
        json,
    )
