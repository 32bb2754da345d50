"""The program as it is started: splash, window, end."""

import os
import subprocess
import sys

import pytest

START = """
import sys
from regolith_studio.ui import startup
heavy = {"numba", "scipy", "pyvista", "matplotlib"} & set(sys.modules)
assert not heavy, heavy
import regolith_studio.ui.main_window
heavy = {"scipy.stats", "skimage", "sklearn", "h5py", "dask"} & set(sys.modules)
assert not heavy, heavy
import gc
seen = []
def show_recovery_and_tour(window):
    seen.append(window.isVisible())
    window.close()
startup.show_recovery_and_tour = show_recovery_and_tour
code = startup.run()
assert gc.isenabled() and gc.get_freeze_count() > 100_000, gc.get_freeze_count()
assert seen == [True], seen
sys.exit(code)
"""


def test_that_the_program_starts_with_a_light_import_and_ends_with_its_window(tmp_path):
    surroundings = os.environ | {"QT_QPA_PLATFORM": "offscreen", "REGOLITH_STUDIO_CONFIG": str(tmp_path)}
    ended = subprocess.run(
        [sys.executable, "-c", START], env=surroundings, capture_output=True, text=True, timeout=170
    )
    assert ended.returncode == 0, ended.stderr
    assert "Traceback" not in ended.stderr
    assert (tmp_path / "preferences.json").exists()


STUCK = """
import time
from regolith_studio.jobs.events import Job, Started
from regolith_studio.ui import main_window, startup
def stuck():
    yield Started("a step without an end", 1)
    time.sleep(100.0)
def show_recovery_and_tour(window):
    window.session.run("stuck", "stuck", Job(stuck, ()), lambda _result: None)
    window.preferences.window = {}
    time.sleep(0.3)
    window.close()
    print("closed", flush=True)
startup.show_recovery_and_tour = show_recovery_and_tour
main_window.may_close = lambda *_: True
startup.run()
"""


@pytest.mark.slow
def test_that_the_process_ends_soon_after_its_window_whatever_runs(tmp_path):
    surroundings = os.environ | {"QT_QPA_PLATFORM": "offscreen", "REGOLITH_STUDIO_CONFIG": str(tmp_path)}
    ended = subprocess.run(
        [sys.executable, "-c", STUCK], env=surroundings, capture_output=True, text=True, timeout=90
    )
    assert ended.returncode == 0, ended.stderr
    assert "Traceback" not in ended.stderr
    assert (tmp_path / "preferences.json").exists()
