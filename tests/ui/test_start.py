"""The program as it is started: splash, window, end."""

import os
import subprocess
import sys

from regolith_studio.ui.start import make_splash

START = """
import sys
from regolith_studio.ui import start
heavy = {"numba", "scipy", "pyvista", "matplotlib"} & set(sys.modules)
assert not heavy, heavy
from regolith_studio.ui.application import IGNORED_FILES
from regolith_studio.ui.asked_modules import load_when_asked
load_when_asked(IGNORED_FILES)  # as the start does before it loads the window
import regolith_studio.ui.app as app
heavy = {"scipy.stats", "skimage", "sklearn", "h5py", "dask", "matplotlib.figure"} & set(sys.modules)
assert not heavy, heavy
import gc
from PySide6.QtCore import QTimer
seen, aside, loaded = [], [], set()
def welcome(window):
    seen.append(window.isVisible())
    loaded.update(sys.modules)
    aside.append(gc.get_freeze_count())
    window.go("sample")
    QTimer.singleShot(app.ASIDE + 500, window, lambda: (aside.append(gc.get_freeze_count()), window.close()))
app.welcome = welcome
code = start.run()
assert gc.isenabled() and gc.get_freeze_count() > 100_000, gc.get_freeze_count()
assert aside[1] > aside[0] + 1_000, f"what a page is made of is not set aside: {aside}"
assert seen == [True], seen
import linecache
read = {name.split(".")[0] for name, module in sys.modules.items()
        if getattr(module, "__file__", None) in linecache.cache}
assert not read & {"pyvista", "pyqtgraph", "matplotlib"}, f"sources are kept in memory: {read}"
assert not {"mypy", "matplotlib.figure", "matplotlib.pyplot"} & set(sys.modules)
early = {"numpy.f2py.crackfortran", "pooch.core", "tqdm", "scipy.optimize._minimize"} & loaded
early |= {"scipy.ndimage._filters"} & loaded
assert not early, f"loaded and never asked for: {early}"
from matplotlib.figure import Figure
from pyvista import Chart2D, ChartMPL
from pyvista.plotting.colors import get_cycler
assert len(get_cycler("matplotlib")) == 10
figure = Figure()
figure.add_subplot().plot([1, 2], [3, 4])
assert ChartMPL(figure).size == (1, 1) and Chart2D().line([1, 2], [3, 4]).x.tolist() == [1, 2]
import numpy, pooch
assert callable(numpy.f2py.get_include) and callable(pooch.retrieve)
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
from regolith_studio.ui import app, start
def stuck():
    yield Started("a step without an end", 1)
    time.sleep(100.0)
def welcome(window):
    window.session.run("stuck", "stuck", Job(stuck, ()), lambda _result: None)
    window.preferences.window = {}
    time.sleep(0.3)
    window.close()
    print("closed", flush=True)
app.welcome = welcome
from regolith_studio.ui import main_window
main_window.may_close = lambda *_: True
start.run()
"""


def test_that_the_process_ends_soon_after_its_window_whatever_runs(tmp_path):
    surroundings = os.environ | {"QT_QPA_PLATFORM": "offscreen", "REGOLITH_STUDIO_CONFIG": str(tmp_path)}
    ended = subprocess.run(
        [sys.executable, "-c", STUCK], env=surroundings, capture_output=True, text=True, timeout=90
    )
    assert ended.returncode == 0, ended.stderr
    assert "Traceback" not in ended.stderr
    assert (tmp_path / "preferences.json").exists()


def test_that_the_splash_shows_mark_and_name(shown):
    splash = shown(make_splash())
    image = splash.pixmap().toImage()
    colours = {image.pixel(x, y) for x in range(0, image.width(), 7) for y in range(0, image.height(), 7)}
    assert len(colours) > 5
