"""A window that is killed without a word, and the one that comes after it."""

import os
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog, QMessageBox

from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.segmentation.label_edits import LabelEdit
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.choices import Choices
from regolith_studio.session.project import Project, read_project
from regolith_studio.session.session import Session
from regolith_studio.ui.dialogs.help import TOUR_SEEN
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.pages.scan.corrections import CorrectionState
from regolith_studio.ui.project_files import CopyLock, autosave_path, stale_autosaves
from regolith_studio.ui.startup import FILLED_CHECK, open_window, show_recovery_and_tour

WORK = """
from regolith_studio.ui import project_files
from regolith_studio.ui.startup import make_application
app = make_application(["killed"])
from regolith_studio.ui.startup import open_window
project_files.AUTOSAVE_SECONDS = 0
window = open_window(views="image")
window.show()
window.session.events.particles.connect(lambda: window.session.choose(n_facets=17, seed=4))
app.exec()
"""
QUICK = "quadric"
"""A method without kernels that would have to be compiled."""


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal")
@pytest.mark.slow
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
    window.projects._timer.setInterval(0)
    wait(lambda: window.session.particles)
    window.projects.offer_recovery()
    box = window.findChild(QMessageBox, "recovery")
    box.button(QMessageBox.StandardButton.Yes).click()
    assert (window.session.choices.n_facets, window.session.choices.seed) == (17, 4)
    wait(lambda: not left.exists(), 170.0)
    assert stale_autosaves() == []


@pytest.fixture
def left(preferences):  # noqa: ARG001
    """What two windows have left that crashed one after the other: with 11 facets, then with 33."""
    made = []
    for number, n_facets in enumerate((11, 33)):
        path = autosave_path().with_name(f"autosave-{999999990 + number}.regolith")
        path.parent.mkdir(parents=True, exist_ok=True)
        Project.of(Session(InlineRunner(), Choices(n_facets=n_facets, method=QUICK))).save(path)
        os.utime(path, (1_000_000 + number, 1_000_000 + number))
        made.append(path)
    return made


def recovered(window, answer):
    """Offers what is left, and answers."""
    window.projects.offer_recovery()
    window.findChild(QMessageBox, "recovery").button(answer).click()


def test_that_what_is_brought_back_is_kept_until_there_is_a_newer_copy(shown, preferences, left, wait):
    older, newer = left
    window = shown(MainWindow(Session(InlineRunner(), Choices(method=QUICK)), preferences, "image"))
    recovered(window, QMessageBox.StandardButton.Yes)
    assert window.session.choices.n_facets == 33
    assert newer.exists(), "this window may crash before it has kept anything"
    assert stale_autosaves() == [older], "another window must not take it away"
    window.projects._timer.start(0)
    wait(lambda: not newer.exists())
    assert read_project(autosave_path()).recipe.n_facets == 33
    assert stale_autosaves() == [older], "nobody was asked about it"


@pytest.mark.usefixtures("left")
def test_that_a_recovery_is_offered_after_the_question_that_is_open(shown, preferences, wait):
    preferences.window = {TOUR_SEEN: True}
    window = shown(MainWindow(Session(InlineRunner(), Choices(method=QUICK)), preferences, "image"))
    unit = QDialog(window)
    unit.open()
    show_recovery_and_tour(window)
    QTest.qWait(2 * FILLED_CHECK)
    assert window.findChild(QMessageBox, "recovery") is None
    unit.close()
    wait(lambda: window.findChild(QMessageBox, "recovery") is not None)
    window.findChild(QMessageBox, "recovery").close()


def test_that_the_next_crash_is_offered_where_the_first_is_declined(shown, preferences, left):
    window = shown(MainWindow(Session(InlineRunner(), Choices(method=QUICK)), preferences, "image"))
    recovered(window, QMessageBox.StandardButton.No)
    assert [path.exists() for path in left] == [True, False]
    asked = [box for box in window.findChildren(QMessageBox, "recovery") if box.isVisible()]
    assert len(asked) == 1
    asked[0].button(QMessageBox.StandardButton.Yes).click()
    assert window.session.choices.n_facets == 11


@pytest.fixture
def moved(tmp_path):
    """A project whose only mesh is no longer where it was."""
    (tmp_path / "here").mkdir()
    ball = icosphere(2).moved(scale=20.0)
    (tmp_path / "here" / "grain.stl").write_bytes(stl_bytes(ball.vertices[ball.faces], "ball"))
    session = Session(InlineRunner(), Choices(method=QUICK, level=2, n_facets=33))
    session.open([tmp_path / "here" / "grain.stl"], "um")
    path = tmp_path / "plain.regolith"
    Project.of(session).save(path)
    session.close()
    (tmp_path / "here").rename(tmp_path / "there")
    return path


class LateRunner(InlineRunner):
    """Reads particles when the event loop is idle."""

    def submit(self, job, listener, queue=""):
        if queue != "load":
            return super().submit(job, listener, queue)
        QTimer.singleShot(0, lambda: InlineRunner.submit(self, job, listener, queue))
        return SimpleNamespace(cancel=lambda: None)


def test_that_a_project_whose_files_have_moved_is_not_open_and_loses_nothing(
    shown, preferences, moved, wait, tmp_path
):
    session = Session(LateRunner(), Choices(method=QUICK, level=2))
    window = shown(MainWindow(session, preferences, "image"))
    projects, before = window.projects, moved.read_bytes()
    window.session.adopt([Particle("ball", icosphere(1))])
    projects.open(moved)
    assert projects.path == moved
    wait(lambda: projects.path is None)
    said = window.toast.sentence.text()
    assert "grain.stl" in said
    assert said.endswith("plain.regolith is not open and stays as it is; move its files back to open it.")
    assert [each.id for each in window.session.particles] == ["ball"]
    window.session.adopt([Particle("other", icosphere(1))])
    assert moved.read_bytes() == before
    (tmp_path / "there").rename(tmp_path / "here")
    projects.open(moved)
    wait(lambda: projects._saved is not None)
    assert [each.id for each in window.session.particles] == ["grain"]
    assert projects.path == moved


def _holds(folder, n_facets):
    return any(read_project(path).recipe.n_facets == n_facets for path in folder.glob("autosave-*.regolith"))


def test_that_undo_acts_on_the_page_of_the_last_change_and_shows_it(shown, preferences):
    window = shown(MainWindow(Session(InlineRunner(), Choices(method=QUICK)), preferences, "image"))
    steps, undo, redo = window.commands.page_steps, *(window.menus.by_name[each] for each in ("undo", "redo"))
    dataset, repose = window.go("dataset"), window.go("repose")
    repose.setup.particles.setValue(500)
    steps.look(resting=True)
    window.go("explore")
    window.session.choose(n_facets=12)
    before = dataset.representatives.count.value()
    window.go("dataset").representatives.count.setValue(before - 1)
    steps.look(resting=True)
    acted = []
    window.go("lecture")
    while undo.isEnabled():
        title = undo.text()
        undo.trigger()
        acted.append((title, window.pages.current))
    assert acted == [
        ("Undo on Dataset", "dataset"),
        ("Undo on Explore", "explore"),
        ("Undo on Angle of repose", "repose"),
    ]
    assert (dataset.representatives.count.value(), window.session.choices.n_facets) == (before, 20)
    assert repose.setup.particles.value() != 500
    while redo.isEnabled():
        redo.trigger()
    assert dataset.representatives.count.value() == before - 1
    assert (repose.setup.particles.value(), window.session.choices.n_facets) == (500, 12)


def test_that_undo_of_the_window_takes_back_corrections_while_the_page_of_scans_is_seen(shown, preferences):
    window = shown(MainWindow(Session(InlineRunner(), Choices(method=QUICK)), preferences, "image"))
    undo, redo = (window.menus.by_name[each] for each in ("undo", "redo"))
    page = window.go("scan")
    page.tabs.setCurrentWidget(page.edits)
    assert not undo.isEnabled()
    edited = CorrectionState(edits=(LabelEdit("fill", ((4, 5, 6),)),))
    page.corrections.history.push(edited)
    window.commands.page_steps.look()
    assert undo.text() == "Undo on Scan"
    undo.trigger()
    assert page.corrections.state == CorrectionState()
    assert not undo.isEnabled()
    assert redo.text() == "Redo on Scan"
    redo.trigger()
    assert page.corrections.state == edited
    window.go("explore")
    assert not undo.isEnabled()


def test_that_a_copy_of_a_process_of_the_same_number_is_offered(preferences):  # noqa: ARG001
    path = autosave_path().with_name(f"autosave-{os.getpid()}-of-another.regolith")
    path.parent.mkdir(parents=True, exist_ok=True)
    Project().save(path)
    held = CopyLock(path)
    assert held.take()
    assert stale_autosaves() == []
    held.release()
    assert stale_autosaves() == [path]
    path.unlink()


def test_that_closing_asks_where_a_session_without_a_name_was_changed(shown, preferences):
    window = shown(MainWindow(Session(InlineRunner(), Choices(method=QUICK)), preferences, "image"))
    window.session.adopt([Particle("ball", icosphere(1).moved(scale=20.0))])
    assert window.projects.unsaved() == []
    window.session.choose(n_facets=9)
    assert window.projects.unsaved() == ["This session is not saved as a project."]
