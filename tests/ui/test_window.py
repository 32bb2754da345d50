"""The whole window, drawn into pictures: what a user does and what then is seen."""

import json
import time

import numpy as np
import pytest
from psygnal import EmitLoopError
from PySide6.QtCore import QMimeData, QPointF, Qt, QTimer, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QSlider, QToolBar, QWidget

from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.events import Job, Progress
from regolith_studio.resources import resource
from regolith_studio.session.results import SessionEvents
from regolith_studio.ui.dialogs.files import UnitDialog
from regolith_studio.ui.page import PageStack
from regolith_studio.ui.startup import check_display, make_excepthook, open_window
from regolith_studio.ui.theme import DARK, LIGHT, current_theme
from regolith_studio.ui.widgets.toast import Toast

SECONDS = 120.0


def pictures(window):
    return [view.picture().astype(int) for view in window.page.three_views.views.values()]


def changed(before, after):
    return [bool(difference(one, two) > 0.05) for one, two in zip(before, after, strict=True)]


def difference(one, other):
    """Mean difference over what two pictures have in common: neighbours differ by a pixel in width."""
    height, width = np.minimum(one.shape, other.shape)[:2]
    return np.abs(one[:height, :width] - other[:height, :width]).mean()


def stl(path, inverted=False):
    """An ASCII STL of an egg of 2 by 2 by 4 units, or of one that is turned inside out."""
    mesh = icosphere(2).moved(rotation=np.diag([1.0, 1.0, 2.0]))
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in triangle)
        + "endloop\nendfacet\n"
        for triangle in (mesh.triangles[:, ::-1] if inverted else mesh.triangles)
    )
    path.write_text(f"solid egg\n{facets}endsolid egg\n")
    return path


def answer(kind, act):
    """Wait for a dialog of this kind and act on it."""

    def look():
        for each in QApplication.topLevelWidgets():
            if isinstance(each, kind) and each.isVisible():
                timer.stop()
                act(each)
                return

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(20)
    return timer


def test_that_the_window_opens_on_the_sample_with_three_different_views(window):
    assert len(window.page.particles.entries()) == 12
    one, two, three = pictures(window)
    assert changed([one, two], [two, three]) == [True, True]
    assert not window.page.plots.error_bars.plot.is_empty()
    assert not window.page.plots.loss_curve.plot.is_empty()
    assert not window.page.plots.spectrum.plot.is_empty()


def test_that_l_max_changes_the_fit_and_the_polyhedron_but_not_the_particle(window, wait, settled):
    before = pictures(window)
    slider = window.findChild(QSlider, "l_max_slider")
    for _ in range(6):
        QTest.keyClick(slider, Qt.Key.Key_Left)
    wait(lambda: window.session.choices.l_max == 4)
    wait(lambda: window.session.results.coarsened is not None, SECONDS)
    settled(window)
    assert changed(before, pictures(window)) == [False, True, True]
    assert "4" in window.page.three_views.frames["fit"]._title.text()


def test_that_a_dragged_slider_is_one_step_of_undo(window, wait):
    slider = window.findChild(QSlider, "n_facets_slider")
    slider.setSliderDown(True)
    for value in range(21, 31):
        slider.setValue(value)
        QTest.qWait(8)
    slider.setSliderDown(False)
    wait(lambda: window.session.choices.n_facets == 30)
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, 5000)
    QTest.keySequence(window, "Ctrl+Z")
    wait(lambda: window.session.choices.n_facets == 20)
    assert window.page.coarsening.value()["n_facets"] == 20
    QTest.keySequence(window, "Ctrl+Shift+Z")
    wait(lambda: window.page.coarsening.value()["n_facets"] == 30)


@pytest.mark.slow
def test_that_another_particle_fills_all_three_views(window, wait, settled):
    before = pictures(window)
    table = window.page.particles.table
    QTest.mouseClick(
        table.viewport(), Qt.MouseButton.LeftButton, pos=table.visualRect(table.model().index(6, 0)).center()
    )
    wait(lambda: window.session.choices.selected == window.page.particles.entries()[6].id)
    wait(lambda: window.session.results.coarsened is not None, SECONDS)
    settled(window)
    assert changed(before, pictures(window)) == [True, True, True]


def test_that_dropped_files_are_opened_in_the_unit_that_is_answered(window, wait, tmp_path):
    path = stl(tmp_path / "egg.stl")
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    timer = answer(UnitDialog, lambda dialog: (dialog.setValue("mm"), dialog.accept()))
    copy, nothing = Qt.DropAction.CopyAction, Qt.KeyboardModifier.NoModifier
    window.dropEvent(QDropEvent(QPointF(5, 5), copy, data, Qt.MouseButton.LeftButton, nothing))
    wait(lambda: [entry.id for entry in window.page.particles.entries()] == ["egg"], SECONDS)
    timer.stop()
    assert np.ptp(window.session.particles[0].particle.mesh.vertices[:, 2]) == pytest.approx(4000.0)
    assert window.preferences.unit_for(path) == "mm"
    assert window.preferences.recent == (str(path),)


@pytest.mark.slow
def test_that_meshes_are_left_as_they_are_where_the_menu_says_so(window, wait, tmp_path):
    path = stl(tmp_path / "egg.stl", inverted=True)
    mend = window.menus.by_name["repair"]
    mend.trigger()
    assert (mend.isChecked(), window.session.choices.repair) == (False, False)
    window.commands.undo()
    assert (mend.isChecked(), window.session.choices.repair) == (True, True)
    window.commands.redo()
    window.commands.open_paths([path], "um")
    wait(lambda: [entry.id for entry in window.session.particles] == ["egg"], SECONDS)
    assert window.session.particles[0].particle.notes == ("Its normals point inwards.",)


def test_that_what_cannot_be_opened_costs_one_sentence_and_nothing_else(window, wait, tmp_path):
    before, refused = (
        window.session.particles,
        {
            ("thesis.docx",): "thesis.docx: not a mesh",
            ("a.stl", "b.tif"): "several kinds",
            ("a.tif", "b.tif"): "2 files",
            ("broken.stl",): "broken.stl",
        },
    )
    for names, words in refused.items():
        for each in names:
            (tmp_path / each).write_bytes(b"\x00" * 90)
        window.commands.open_paths([tmp_path / each for each in names], "um")
        wait(lambda words=words: words in window.toast.sentence.text(), SECONDS)
        assert window.session.particles == before


@pytest.mark.slow
def test_that_volumes_datasets_cards_and_exports_go_to_their_pages(window, tmp_path):
    window.menus.by_name["export"].trigger()
    assert window.pages.current == "dataset"
    assert window.page.targets.export.isEnabled()
    first = window.page.targets.first
    assert window.focusWidget() is first
    assert not first.visibleRegion().isEmpty()
    opened = []
    for key in ("scan", "dataset", "model"):
        page = window.go(key)
        page.open_path = lambda path, key=key: opened.append((key, path.name))
    window.go("explore")
    (tmp_path / "scan.nii.gz").touch()
    (tmp_path / "shapes").mkdir()
    (tmp_path / "shapes" / "dataset.json").touch()
    for path in (tmp_path / "scan.nii.gz", tmp_path / "shapes", resource("materials", "ma165.json")):
        window.commands.open_paths([path])
    assert opened == [("scan", "scan.nii.gz"), ("dataset", "shapes"), ("model", "ma165.json")]
    assert window.pages.current == "model"


@pytest.mark.slow
def test_that_bad_files_among_good_ones_are_told_and_the_good_ones_open(window, wait, tmp_path):
    stl(tmp_path / "egg.stl")
    (tmp_path / "broken.stl").write_bytes(b"\x00" * 90)
    (tmp_path / "empty.ply").touch()
    window.commands.open_paths([tmp_path], "um")
    wait(lambda: [entry.id for entry in window.session.particles] == ["egg"], SECONDS)
    said = window.toast.sentence.text()
    assert window.toast.isVisible()
    assert said.startswith("2 were left out. The first: broken.stl ")
    assert "Traceback" not in said


def test_that_an_error_of_the_program_is_told_and_survived(shown, capsys):
    toast = Toast(shown(QWidget()))
    hook = make_excepthook(toast.problem)
    for error in (ValueError("shape"), InputError("The seed must not be negative.")):
        hook(type(error), error, None)
        assert toast.isVisible()
    assert toast.sentence.text() == "The seed must not be negative."
    assert "ValueError" in capsys.readouterr().err


def test_that_the_sentence_of_a_listener_of_the_session_is_reported(capsys):
    def refuse():
        raise InputError("The seed must not be negative.")

    events, reported = SessionEvents(), []
    events.fit.connect(refuse)
    with pytest.raises(EmitLoopError) as caught:
        events.fit.emit()
    make_excepthook(lambda sentence, _details: reported.append(sentence))(caught.type, caught.value, None)
    assert reported == ["The seed must not be negative."]
    assert "InputError" in capsys.readouterr().err


@pytest.mark.slow
def test_that_the_recipe_is_what_is_chosen(window, tmp_path, monkeypatch):
    target = tmp_path / "recipe.json"
    monkeypatch.setattr(
        "regolith_studio.ui.commands.QFileDialog.getSaveFileName", lambda *_: (str(target), "")
    )
    window.session.choose(n_facets=12, seed=5)
    window.menus.by_name["save_recipe"].trigger()
    recipe = json.loads(target.read_text())
    assert (recipe["n_facets"], recipe["seed"], recipe["inputs"]) == (12, 5, ["sample:all"])
    window.session.choose(n_facets=30)
    window.commands.open_paths([target])
    assert (window.session.choices.n_facets, window.session.choices.seed) == (12, 5)
    drawn = {"population": {"sources": ["ma165"], "n": 9000}, "n_facets": 14}
    target.write_text(json.dumps(drawn))
    reading = [task.id for task in window.session.tasks if task.queue == "load"]
    window.commands.open_paths([target])
    assert window.session.choices.n_facets == 14
    assert "Run as a batch" in window.toast.sentence.text()
    assert {task.id for task in window.session.tasks if task.queue == "load"} <= set(reading)


@pytest.mark.slow
def test_that_the_window_follows_dark_and_light(window, wait):
    light = [picture.mean() for picture in pictures(window)]
    window.menus.by_name["theme_dark"].trigger()
    assert current_theme() is DARK
    wait(lambda: window.page.plots.error_bars.plot.theme is DARK)
    assert all(picture.mean() < mean - 60 for picture, mean in zip(pictures(window), light, strict=True))
    assert window.preferences.window["theme"] == "dark"
    window.menus.by_name["theme_light"].trigger()
    assert current_theme() is LIGHT
    window.menus.by_name["theme_system"].trigger()


def work_without_end():
    while True:
        time.sleep(0.01)
        yield Progress(0, 0)


@pytest.mark.slow
def test_that_closed_particles_are_released_although_work_never_ends(monkeypatch, shown, preferences, wait):
    monkeypatch.setattr("regolith_studio.ui.startup.BUSY", 500)
    released = []
    monkeypatch.setattr(PageStack, "refresh_hidden", lambda _stack: released.append(True))
    window = open_window(views="image", preferences=preferences)
    shown(window)
    window.session.run("endless", "endless", Job(work_without_end), lambda _result: None)
    wait(lambda: len(released) > 1, SECONDS)
    assert window.session.tasks


def test_that_closing_while_busy_stops_what_runs(window, wait, monkeypatch):
    monkeypatch.setattr("regolith_studio.ui.main_window.may_close", lambda *_: True)
    window.session.choose(method="annealing", settings=(("iterations", 100_000),))
    wait(lambda: any(task.queue == "coarsening" for task in window.session.tasks))
    window.close()
    assert window.session.tasks == ()
    assert window.session.results.coarsened is None, "it was not waited for"


def test_that_no_display_is_said_in_one_sentence():
    check_display({"DISPLAY": ":0"}, "linux")
    check_display({"QT_QPA_PLATFORM": "offscreen"}, "linux")
    check_display({}, "darwin")
    with pytest.raises(MissingRequirement, match=r"no display .* demo"):
        check_display({}, "linux")


@pytest.mark.slow
def test_that_a_full_screen_has_no_bars_but_hears_the_keys_of_the_menus(window, wait):
    window.show()
    bars = (*window.findChildren(QToolBar), window.statusBar(), window.pages.sidebar)
    window.setWindowState(Qt.WindowState.WindowFullScreen)
    wait(lambda: not any(bar.isVisible() for bar in bars))
    assert window.menuBar().height() == 0
    assert window.menuBar().isVisible(), "else its shortcuts would not be heard"
    window.setWindowState(Qt.WindowState.WindowNoState)
    wait(lambda: all(bar.isVisible() for bar in bars) and window.menuBar().height() > 0)
