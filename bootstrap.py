#!/usr/bin/env python3
"""Set up Regolith Studio in this checkout, once, and start it.

python3 bootstrap.py                 opens the window
python3 bootstrap.py test [ARGS]     runs the tests on all cores; ARGS go to pytest
python3 bootstrap.py demo -o DIR     runs the whole chain on the shipped sample, without a screen
python3 bootstrap.py COMMAND ...     runs any other command of the program (describe, coarsen, check, ...)
python3 bootstrap.py setup           sets up everything that work on the program needs, starts nothing

--no-system   leaves the packages of the operating system alone; without python3-venv, pip or uv installs

The first call installs missing system libraries (on Debian and Ubuntu), makes the folder .venv with the
versions of constraints.txt. pip's own configuration is respected.
"""

import contextlib
import ctypes
import hashlib
import importlib.util
import os
import re
import select
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

# Standard library only; it parses on old Pythons too, so that they can say that they are old.

OLDEST_PYTHON = (3, 11)
ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
STAMP = VENV / "regolith-studio.stamp"
UNFINISHED = VENV / "regolith-studio.unfinished"
NO_SYSTEM = "--no-system"
DISPLAY_WAIT = 30.0
# One process for each core, at most four; the tests of one file stay in one process.
PARALLEL = ("-n", "logical", "--maxprocesses", "4", "--dist", "loadfile")
SCREEN = "1920x1200x24"

# Debian's name, and the shared objects that it must bring (any one of the alternatives joined by |).
LIBRARIES = (
    ("libgl1", "libGL.so.1"),
    ("libegl1", "libEGL.so.1"),
    ("libglx-mesa0", "libGLX_mesa.so.0|libGLX_nvidia.so.0"),  # brings libgl1-mesa-dri
    ("libglib2.0-0", "libglib-2.0.so.0"),
    ("libglib2.0-0", "libgthread-2.0.so.0"),
    ("libdbus-1-3", "libdbus-1.so.3"),
    ("libfontconfig1", "libfontconfig.so.1"),
    ("libx11-xcb1", "libX11-xcb.so.1"),
    ("libxkbcommon-x11-0", "libxkbcommon-x11.so.0"),
    ("libxcb-cursor0", "libxcb-cursor.so.0"),
    ("libxcb-icccm4", "libxcb-icccm.so.4"),
    ("libxcb-keysyms1", "libxcb-keysyms.so.1"),
    ("libxcb-shape0", "libxcb-shape.so.0"),
    ("libxcb-randr0", "libxcb-randr.so.0"),
    ("libxcb-sync1", "libxcb-sync.so.1"),
    ("libxcb-xfixes0", "libxcb-xfixes.so.0"),
    ("libxcb-xkb1", "libxcb-xkb.so.1"),
    ("libxcursor1", "libXcursor.so.1"),
)
FONT_FOLDERS = ("/usr/share/fonts", "/usr/local/share/fonts", "~/.local/share/fonts", "~/.fonts")


class SetupStopped(Exception):
    """Setting up cannot go on; the message is one sentence for the user."""


def say(line: str) -> None:
    """One line about what happens, on the error stream: what the program prints stays clean."""
    print("bootstrap: " + line, file=sys.stderr, flush=True)


# what the operating system has


def library_loads(soname: str) -> bool:
    """Whether the dynamic linker finds a shared object and everything that it needs itself."""
    try:
        ctypes.CDLL(soname)
    except OSError:
        return False
    return True


def has_font() -> bool:
    """Whether any scalable font is installed; without one Qt draws boxes."""
    for folder in FONT_FOLDERS:
        for _, _, names in os.walk(os.path.expanduser(folder)):  # noqa: PTH111
            if any(name.lower().endswith((".ttf", ".otf", ".ttc", ".pfb")) for name in names):
                return True
    return False


def missing_from_system(needs_xvfb: bool) -> "list[tuple[str, str]]":
    """What this Linux lacks, as pairs of Debian's package and what is missed; empty on other systems."""
    if not sys.platform.startswith("linux"):
        return []
    missing = [
        (package, sonames.split("|")[0])
        for package, sonames in LIBRARIES
        if not any(library_loads(soname) for soname in sonames.split("|"))
    ]
    if not has_font():
        missing.append(("fonts-dejavu-core", "a font"))
    if needs_xvfb and not shutil.which("Xvfb"):
        missing.append(("xvfb", "Xvfb"))
    importlib.invalidate_caches()
    if not VENV.exists() and not has_ensurepip():
        missing.append(("python3-venv", "ensurepip"))
    return missing


def display_answers() -> bool:
    """Whether there is a screen for a window. A DISPLAY on this machine is asked, others are believed."""
    if not sys.platform.startswith("linux"):
        return True
    display = os.environ.get("DISPLAY", "")
    local = re.match(r"^(?:unix)?:(\d+)(?:\.\d+)?$", display)
    if not local:
        return bool(display)
    return any(_accepts(start + "/tmp/.X11-unix/X" + local.group(1)) for start in ("", "\0"))


def _accepts(address: str) -> bool:
    with contextlib.closing(socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)) as connection:
        connection.settimeout(2.0)
        try:
            connection.connect(address)
        except OSError:
            return False
        return True


# Debian packages


def known_packages() -> "set[str]":
    """Names of all packages that apt has heard of."""
    answer = subprocess.run(["apt-cache", "pkgnames"], stdout=subprocess.PIPE, check=False)
    return set(answer.stdout.decode("utf-8", "replace").split())


def names_here(packages: "list[str]", known: "set[str]") -> "list[str]":
    """The same packages as this release calls them: newer ones say libglib2.0-0t64."""
    return [name + "t64" if name not in known and name + "t64" in known else name for name in packages]


def privilege() -> "list[str] | None":
    """What to put before apt-get; None if this user may not install packages."""
    if os.geteuid() == 0:
        return []
    if not shutil.which("sudo"):
        return None
    if sys.stdin is not None and sys.stdin.isatty():
        return ["sudo"]
    asked = subprocess.call(["sudo", "-n", "true"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return ["sudo", "-n"] if asked == 0 else None


def apt_get(prefix: "list[str]", *words: str) -> bool:
    """Run apt-get quietly; what it said is shown only if it failed."""
    command = [*prefix, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-q", *words]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode:
        sys.stderr.write(done.stdout.decode("utf-8", "replace"))
    return done.returncode == 0


def install_packages(packages: "list[str]", prefix: "list[str]") -> bool:
    """Install Debian packages; apt's lists are fetched if they lack a name or turn out to be old."""
    options = ("install", "-y", "--no-install-recommends")
    say("installing with " + " ".join([*prefix, "apt-get install"]) + ": " + " ".join(packages))
    known = known_packages()
    if all(name in known or name + "t64" in known for name in packages):
        if apt_get(prefix, *options, *names_here(packages, known)):
            return True
        say("that failed; fetching apt's lists anew and trying again")
    apt_get(prefix, "update")
    return apt_get(prefix, *options, *names_here(packages, known_packages()))


def provide_system_packages(needs_xvfb: bool, leave_alone: bool) -> None:
    """Name what the operating system lacks, and install it where that is possible and wanted.

    Raises
    ------
    SetupStopped
        If something is missing and this user, or this system, cannot install it.
    """
    missing = missing_from_system(needs_xvfb)
    if not missing:
        return
    say("missing: " + ", ".join(what + " (" + package + ")" for package, what in missing))
    packages = list(dict.fromkeys(package for package, _ in missing))
    if leave_alone:
        return
    if not shutil.which("apt-get"):
        raise SetupStopped(
            "Install what is missing with this system's package manager (in brackets: Debian's names), "
            "or go on without it: python3 bootstrap.py " + NO_SYSTEM + "."
        )
    prefix = privilege()
    if prefix is None or not install_packages(packages, prefix):
        raise SetupStopped(
            "Ask an administrator to run `apt-get install " + " ".join(packages) + "`, "
            "or go on without it: python3 bootstrap.py " + NO_SYSTEM + "."
        )
    for _, what in missing_from_system(needs_xvfb):
        say("still missing, going on without: " + what)


# the virtual environment


def venv_python(venv: Path = VENV, windows: bool = os.name == "nt") -> Path:
    """The interpreter inside a virtual environment."""
    return venv / "Scripts" / "python.exe" if windows else venv / "bin" / "python"


def fingerprint(root: Path = ROOT) -> str:
    """Changes when the installation has to be renewed: other pins, another Python, a moved folder."""
    digest = hashlib.sha256()
    for part in ((root / "pyproject.toml").read_bytes(), (root / "constraints.txt").read_bytes()):
        digest.update(hashlib.sha256(part).digest())
    digest.update(("%d.%d %s" % (sys.version_info[0], sys.version_info[1], root)).encode())  # noqa: UP031
    return digest.hexdigest()


def read_stamp() -> "tuple[str, str]":
    """Fingerprint and extra ("" or "test") of what is installed; empty if nothing was finished."""
    if UNFINISHED.exists() or not venv_python().exists() or not STAMP.exists():
        return "", ""
    found, _, extra = STAMP.read_text(encoding="utf-8").strip().partition(" ")
    return found, extra


def is_ready(extra: str) -> bool:
    """Whether .venv holds what is asked for."""
    found, installed = read_stamp()
    return found == fingerprint() and extra in ("", installed)


def usable_venv() -> bool:
    """Whether .venv runs this version of Python from this folder; a moved or half-made one does not."""
    if UNFINISHED.exists() or not venv_python().exists():
        return False
    question = "import sys; print('%d.%d' % sys.version_info[:2], sys.prefix)"
    if has_ensurepip():
        question = "import pip; " + question
    answer = subprocess.run(
        [str(venv_python()), "-c", question], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False
    )
    wanted = "%d.%d %s" % (sys.version_info[0], sys.version_info[1], VENV)  # noqa: UP031
    return answer.stdout.decode("utf-8", "replace").strip() == wanted


def make_venv() -> None:
    """Make .venv from nothing; a mark inside tells later calls if this one was interrupted."""
    say("making the virtual environment .venv")
    if VENV.exists():
        shutil.rmtree(str(VENV))
    VENV.mkdir()
    UNFINISHED.touch()
    base = getattr(sys, "_base_executable", None) or sys.executable
    without_pip = [] if has_ensurepip() else ["--without-pip"]
    if subprocess.call([base, "-m", "venv", *without_pip, str(VENV)]):
        raise SetupStopped("Python could not make a virtual environment; on Debian it needs python3-venv.")


def has_ensurepip() -> bool:
    """Whether this Python can put pip into a virtual environment; Debian's needs python3-venv."""
    return importlib.util.find_spec("ensurepip") is not None


def installer() -> "list[str]":
    """Command that installs into .venv: by its pip, else by the pip of this Python or by uv.

    Raises
    ------
    SetupStopped
        If there is none of them.
    """
    pip = ["install", "--quiet", "--prefer-binary", "--no-input", "--disable-pip-version-check"]
    if not sys.dont_write_bytecode:
        pip.append("--no-compile")  # half of pip's time goes into modules that nobody imports
    if has_ensurepip():
        return [str(venv_python()), "-m", "pip", *pip]
    if importlib.util.find_spec("pip") is not None:
        return [sys.executable, "-m", "pip", "--python", str(venv_python()), *pip]
    if shutil.which("uv"):
        return ["uv", "pip", "install", "--quiet", "--python", str(venv_python())]
    raise SetupStopped(
        "Nothing here can install Python packages: install python3-venv, or python3-pip, or uv "
        "(the last two need no administrator), and run this again."
    )


def set_up(extra: str) -> None:
    """Bring .venv to the state that pyproject.toml and constraints.txt describe.

    Raises
    ------
    SetupStopped
        If the environment cannot be made or the packages cannot be fetched.
    """
    if is_ready(extra):
        return
    started = time.monotonic()
    extra = extra or read_stamp()[1]
    install = installer()
    if not usable_venv():
        make_venv()
    UNFINISHED.touch()
    size = "2.6" if extra else "1.8"
    say("installing the Python packages into .venv (" + size + " GB on disk, about a minute)")
    target = ".[" + extra + "]" if extra else "."
    command = [*install, "-c", "constraints.txt", "-e", target]
    failed = subprocess.call(command, cwd=str(ROOT), env=dict(os.environ, PIP_USER="0"))
    UNFINISHED.unlink()  # pip undoes what it could not finish; only an interruption leaves the mark
    if failed:
        raise SetupStopped(
            ("uv" if install[0] == "uv" else "pip")
            + " could not install the packages; run this again when it can reach them."
        )
    STAMP.write_text(fingerprint() + " " + extra + "\n", encoding="utf-8")
    say("set up in %.0f s" % (time.monotonic() - started))


# starting the program


@contextlib.contextmanager
def virtual_display():  # type: ignore[no-untyped-def]
    """A screen in memory: yields the name of a free display, served by Xvfb until the block ends."""
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", SCREEN, "-nolisten", "tcp", "-noreset"]
    try:
        server = subprocess.Popen(
            command,
            pass_fds=(writing,),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,  # Ctrl-C is for the program, not for its screen
        )
    except OSError:
        raise SetupStopped("There is no display, and Xvfb (Debian package xvfb) is not installed.") from None
    finally:
        os.close(writing)
    try:
        ready, _, _ = select.select([reading], [], [], DISPLAY_WAIT)
        number = os.read(reading, 16).decode().strip() if ready else ""
        if not number:
            raise SetupStopped("Xvfb did not start, so there is no screen; try `Xvfb :99` by hand.")
        yield ":" + number
    finally:
        os.close(reading)
        server.terminate()
        server.wait()


def run_program(command: "list[str]", environment: "dict[str, str]", folder: str) -> int:
    """Run to the end as a child; Ctrl-C is the child's business, other signals are handed on."""
    child = subprocess.Popen(command, env=environment, cwd=folder)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), lambda number, _frame: child.send_signal(number))
    code = child.wait()
    return code if code >= 0 else 128 - code


def start(words: "list[str]") -> int:
    """Start the tests or the program with these words, on a screen in memory if there is no other."""
    testing = words[:1] == ["test"]
    module = ["pytest", *parallel(words[1:]), *words[1:]] if testing else ["regolith_studio", *words]
    command = [str(venv_python()), "-m", *module]
    folder = str(ROOT) if testing else str(Path.cwd())
    environment = dict(os.environ)
    environment.setdefault("OPENBLAS_NUM_THREADS", "1")
    if testing:  # else each process, and each child of theirs, compiles all sources once more
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
    if draws_in_memory(words):
        with virtual_display() as display:
            environment.pop("WAYLAND_DISPLAY", None)
            return run_program(command, dict(environment, DISPLAY=display), folder)
    if words[:1] == ["demo"] and not display_answers():
        environment.pop("DISPLAY", None)  # so that VTK draws by EGL or OSMesa and asks no X server
    if os.name == "nt":
        return run_program(command, environment, folder)
    os.chdir(folder)
    return os.execve(command[0], command, environment)  # never returns


def parallel(words: "list[str]") -> "tuple[str, ...]":
    """Options of pytest that share the tests out to processes; none where single files are named."""
    return () if any(".py" in word for word in words) else PARALLEL


def draws_in_memory(words: "list[str]") -> bool:
    """Whether these words need a screen, may use one in memory, and there is no other."""
    return words[:1] == ["test"] and not display_answers()


def run(words: "list[str]", leave_system: bool) -> int:
    """Set up what is missing and start what is asked for; returns the exit code."""
    wants_window = not words or words[0] == "open"
    if wants_window and not display_answers() and not os.environ.get("WAYLAND_DISPLAY"):
        raise SetupStopped(
            "There is no display to open the window on (DISPLAY is not set, or nothing answers there); "
            "`python3 bootstrap.py demo -o out` shows the whole chain without a screen."
        )
    provide_system_packages(draws_in_memory(words) or words == ["setup"], leave_system)
    set_up("test" if words[:1] in (["test"], ["setup"]) else "")
    return 0 if words == ["setup"] else start(words)


def main(arguments: "list[str]") -> int:
    """What a user types, to an exit code."""
    if sys.version_info < OLDEST_PYTHON:
        here = ".".join(str(number) for number in sys.version_info[:3])
        print("Regolith Studio needs Python 3.11 or newer; this is Python " + here + ".", file=sys.stderr)
        return 1
    words = [word for word in arguments if word != NO_SYSTEM]
    if words[:1] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    try:
        return run(words, leave_system=NO_SYSTEM in arguments)
    except SetupStopped as stop:
        print(stop, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
