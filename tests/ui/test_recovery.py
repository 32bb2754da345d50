"""A window that is killed without a word, and the one that comes after it."""

import os
import signal
import subprocess
import sys
import time

import pytest
from PySide6.QtWidgets import QMessageBox

from regolith_studio.session.project import read_project
from regolith_studio.ui.app import open_window
from regolith_studio.ui.projects import stale_autosaves

WORK = """
from regolith_studio.ui import projects
from regolith_studio.ui.application import make_application
app = make_application(["killed"])
from regolith_studio.ui.app import open_window
projects.AUTOSAVE_SECONDS = 0
window = open_window(views="image")
window.show()
window.session.topics.particles.connect(lambda: window.session.choose(n_faces=17, seed=4))
app.exec()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal")
def test_that_what_a_killed_window_knew_is_offered_and_brought_back(shown, preferences, wait, tmp_path):
    surroundings = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    killed = subprocess.Popen([sys.executable, "-c", WORK], env=surroundings, stderr=subprocess.DEVNULL)
    try:
        end = time.monotonic() + 150.0
        while not _holds(tmp_path / "config", 17):
            assert killed.poll() is None
            assert time.monotonic() < end
            time.sleep(0.05)
        assert stale_autosaves() == [], "the other window lives"
    finally:
        killed.send_signal(signal.SIGKILL)
        killed.wait(10)
    (left,) = stale_autosaves()
    window = shown(open_window(views="image", preferences=preferences))
    wait(lambda: window.session.particles)
    window.projects.offer_recovery()
    box = window.findChild(QMessageBox, "recovery")
    box.button(QMessageBox.StandardButton.Yes).click()
    assert (window.session.choices.n_faces, window.session.choices.seed) == (17, 4)
    wait(lambda: not left.exists())
    assert stale_autosaves() == []


def _holds(folder, n_faces):
    return any(read_project(path).recipe.n_faces == n_faces for path in folder.glob("autosave-*.regolith"))
