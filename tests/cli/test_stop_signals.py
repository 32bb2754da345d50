"""A command that is told to stop ends within two seconds, whatever it waits for."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from regolith_studio.cli.entry import STOP_SECONDS

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 60.0

STUCK = """
import subprocess, sys, threading, time
from pathlib import Path
from regolith_studio import __main__ as program
from regolith_studio.io.atomic import hidden_folder, staged_file
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.executor import Executor
from tests.jobs.small_jobs import sleep_without_steps

folder = Path(sys.argv[1])

def run(words):
    executor = Executor(2)
    results = executor.results([Job(sleep_without_steps, (str(folder / name),)) for name in ("one", "two")])
    with hidden_folder(folder / "out" / "result") as stage, staged_file(folder / "table.csv") as table:
        (stage / "half").write_text("x")
        while not ((folder / "one").exists() and (folder / "two").exists()):
            next(results)
        (folder / "ready").touch()
        {waits}

program.run, sys.argv = run, ["regolith-studio", "fit"]
program.main()
"""
WAITS = {
    "does not notice": "while True:\n            try:\n                time.sleep(60)\n"
    "            except BaseException:\n                pass",
    "waits for a thread": "try:\n            time.sleep(60)\n        finally:\n"
    "            thread = threading.Thread(target=time.sleep, args=(60,))\n            thread.start()\n"
    "            thread.join()",
    "leaves a thread": "threading.Thread(target=time.sleep, args=(60,)).start()\n        time.sleep(60)",
    "waits for a program": "try:\n            time.sleep(60)\n        finally:\n"
    "            subprocess.run(['sleep', '3'])",
    "ends by itself": "time.sleep(60)",
    "is slow to take apart": "sys.slow = type('S', (), {'__del__': lambda _, wait=time.sleep: wait(60)})()\n"
    "        time.sleep(60)",
}


def wait_until(path: Path, child: "subprocess.Popen[str]") -> None:
    end = time.monotonic() + PATIENCE
    while not path.exists():
        assert child.poll() is None, child.communicate()
        assert time.monotonic() < end
        time.sleep(0.02)


def start(code: str, folder: Path) -> "subprocess.Popen[str]":
    child = subprocess.Popen(
        [sys.executable, "-c", code, str(folder)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    wait_until(folder / "ready", child)
    return child


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
@pytest.mark.parametrize(
    ("waits", "name", "code"),
    [
        pytest.param("waits for a thread", "SIGTERM", 143, marks=pytest.mark.slow),
        pytest.param("does not notice", "SIGHUP", 129, marks=pytest.mark.slow),
        pytest.param("leaves a thread", "SIGINT", 130, marks=pytest.mark.slow),
        pytest.param("waits for a program", "SIGINT", 130, marks=pytest.mark.slow),
        pytest.param("ends by itself", "SIGINT", 130, marks=pytest.mark.slow),
        pytest.param("is slow to take apart", "SIGINT", 130, marks=pytest.mark.slow),
    ],
)
def test_that_a_command_that_waits_for_something_ends_two_seconds_after_a_signal(
    tmp_path: Path, waits: str, name: str, code: int
) -> None:
    child = start(STUCK.replace("{waits}", WAITS[waits]), tmp_path)
    family = psutil.Process(child.pid).children(recursive=True)
    assert len(family) >= 2
    begun = time.monotonic()
    number = getattr(signal, name)
    (os.kill if name == "SIGTERM" else os.killpg)(child.pid, number)  # a terminal signals all processes
    _, said = child.communicate(timeout=PATIENCE)
    _, alive = psutil.wait_procs(family, timeout=PATIENCE)
    seconds = time.monotonic() - begun
    assert (child.returncode, said) == (code, "Stopped.\n")
    assert not alive
    assert seconds < max(2.0, os.getloadavg()[0]) + STOP_SECONDS
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one", "ready", "two"]


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
@pytest.mark.slow
def test_that_a_second_signal_does_not_disturb_the_tidying_up(tmp_path: Path) -> None:
    code = (
        "import os, signal, sys, time\n"
        "from pathlib import Path\n"
        "from regolith_studio import __main__ as program\n"
        "def run(words):\n"
        "    try:\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "        time.sleep(60)\n"
        "    finally:\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "        os.kill(os.getpid(), signal.SIGTERM)\n"
        "        Path(sys.argv[0]).touch()\n"
        "program.run, sys.argv = run, [sys.argv[1], 'fit']\n"
        "program.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "tidied")], cwd=ROOT, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (130, "Stopped.\n")
    assert (tmp_path / "tidied").exists()


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
@pytest.mark.slow
def test_that_the_processes_of_a_killed_command_end_in_the_middle_of_a_step(tmp_path: Path) -> None:
    child = start(STUCK.replace("{waits}", WAITS["ends by itself"]), tmp_path)
    family = psutil.Process(child.pid).children(recursive=True)
    child.kill()
    child.communicate(timeout=PATIENCE)
    _, alive = psutil.wait_procs(family, timeout=PATIENCE / 4)
    assert not alive


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the cache's folder and the display are those of Linux")
@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["warm-up"], "SIGINT"),
        (["warm-up"], "SIGTERM"),
        (["describe", "sample:all"], "SIGINT"),
        ([], "SIGINT"),
    ],
)
def test_that_nothing_goes_on_compiling_after_a_command_or_the_window_was_interrupted(
    tmp_path: Path, words: list[str], name: str
) -> None:
    if not words and not os.environ.get("DISPLAY"):
        pytest.skip("The window needs a display.")
    places = {"NUMBA_CACHE_DIR": str(tmp_path / "code"), "REGOLITH_STUDIO_CONFIG": str(tmp_path / "config")}
    with (tmp_path / "said").open("w") as said:
        child = subprocess.Popen(
            [sys.executable, "-m", "regolith_studio", *words],
            cwd=ROOT,
            env={**os.environ, **places},
            stdout=said,
            stderr=said,
            start_new_session=True,
        )
    family, end = list[psutil.Process](), time.monotonic() + 2 * PATIENCE
    while not any("compile_kernels" in " ".join(each.cmdline()) for each in family):
        assert child.poll() is None
        assert time.monotonic() < end
        time.sleep(0.1)
        family = psutil.Process(child.pid).children(recursive=True)
    while not list(tmp_path.rglob("*.nbc")):  # it has begun
        assert time.monotonic() < end
        time.sleep(0.1)
    os.killpg(child.pid, getattr(signal, name))
    begun = time.monotonic()
    child.wait(PATIENCE)
    _, alive = psutil.wait_procs(family, timeout=PATIENCE)
    assert not alive
    assert time.monotonic() - begun < max(3.0, os.getloadavg()[0]) + STOP_SECONDS
    assert "Traceback" not in (tmp_path / "said").read_text()


INTERRUPT = "os.kill(os.getpid(), signal.SIGINT)"


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
@pytest.mark.parametrize(
    ("moment", "code"),
    [
        (f"QTimer.singleShot(0, lambda: {INTERRUPT}); app.processEvents()", -signal.SIGINT),
        (f"close_on_interrupt(app); {INTERRUPT}", 0),
        (f"close_on_interrupt(app); threading.Timer(0.3, lambda: {INTERRUPT}).start()", 0),
    ],
    ids=["in a slot before it is built", "before its loop", "while it is idle"],
)
def test_that_an_interruption_ends_the_window_whenever_it_comes(moment: str, code: int) -> None:
    """Qt drops exceptions of slots, and a request to quit before its loop has begun."""
    program = (
        "import os, signal, sys, threading\n"
        "from PySide6.QtCore import QTimer\n"
        "from PySide6.QtWidgets import QApplication\n"
        "from regolith_studio import __main__ as program\n"
        "from regolith_studio.ui.startup import close_on_interrupt\n"
        "def run(words):\n"
        "    app = QApplication([])\n"
        f"    {moment}\n"
        "    return app.exec()\n"
        "program.run, sys.argv = run, ['regolith-studio']\n"
        "program.main()\n"
    )
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, env=environment, capture_output=True, timeout=PATIENCE
    )
    assert (done.returncode, done.stderr) == (code, b"")


SWALLOWED = """
import os, signal, sys
from regolith_studio import __main__ as program
from regolith_studio.errors import GeometryError
from regolith_studio.harmonics import fit_options
complete = fit_options.FitOptions.fit

def fit(*arguments, **options):
    try:
        os.kill(os.getpid(), signal.SIGTERM)
    except KeyboardInterrupt:
        raise GeometryError("The surface is flat.") from None
    return complete(*arguments, **options)

fit_options.FitOptions.fit = fit
sys.argv = ["regolith-studio", *sys.argv[1:]]
program.main()
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
@pytest.mark.slow
def test_that_an_interruption_that_a_library_swallows_is_no_failed_particle(
    grains: Path, tmp_path: Path
) -> None:
    recipe = {"inputs": [str(grains)], "method": "quadric", "level": 2, "l_max": 4, "n_facets": 12}
    (tmp_path / "recipe.json").write_text(json.dumps(recipe | {"outputs": {"fits": True}}))
    run = [str(tmp_path / "recipe.json"), "-o", str(tmp_path / "out"), "--jobs", "1"]
    for words in (["fit", str(grains), "-o", str(tmp_path / "fit.json")], ["run", *run]):
        done = subprocess.run(
            [sys.executable, "-c", SWALLOWED, *words], cwd=ROOT, capture_output=True, text=True
        )
        assert (done.returncode, done.stderr) == (143, "Stopped.\n"), words
    assert not (tmp_path / "fit.json").exists()
    again = [sys.executable, "-m", "regolith_studio", "run", *run, "--resume"]
    assert subprocess.run(again, cwd=ROOT, capture_output=True, text=True).returncode == 0
    assert not (tmp_path / "out" / "failed.csv").exists()


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
@pytest.mark.slow
def test_that_an_interruption_is_no_mistake_of_a_library_and_leaves_no_lock(tmp_path: Path) -> None:
    """Matplotlib makes a ValueError of one; one that came while leftovers were looked for left the lock."""
    code = (
        "import os, signal, sys\n"
        "from pathlib import Path\n"
        "from regolith_studio import __main__ as program\n"
        "from regolith_studio.cli import commands\n"
        "from regolith_studio.io import output_lock\n"
        "def look(place):\n"
        "    os.kill(os.getpid(), signal.SIGTERM)\n"
        "    return []\n"
        "def fit(words, prog_name):\n"
        "    try:\n"
        "        with output_lock.output_lock(Path(words[1])):\n"
        "            pass\n"
        "    except KeyboardInterrupt:\n"
        "        raise ValueError('Invalid affine transformation matrix') from None\n"
        "output_lock.leftovers, commands.app = look, fit\n"
        "sys.argv = ['regolith-studio', 'fit', sys.argv[1]]\n"
        "from regolith_studio.io import atomic\n"
        "program.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "out")], cwd=ROOT, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (143, "Stopped.\n")
    assert list(tmp_path.iterdir()) == []
