"""Tasks as somebody new would do them: by mouse and keys only, from a fresh start, in few steps.

A press, a drag, a chord or a line of text is one interaction each, the closing of the tour included. With
``REGOLITH_STUDIO_SHOTS=FOLDER`` a picture of the window is kept after each of them.
"""

import csv
import os
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QDialogButtonBox,
    QFileDialog,
    QLineEdit,
    QPushButton,
    QTableView,
    QTabWidget,
    QToolButton,
    QWidget,
)

from regolith_studio.coarsening.weights import presets
from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.ui.dialogs.files import UnitDialog
from regolith_studio.ui.startup import open_window, show_recovery_and_tour

MOST = 10
"""Interactions that a task may take."""
SECONDS = 170.0


class Newcomer:
    """Acts on what is seen, and counts.

    Parameters
    ----------
    window
        Freshly opened, with its tour.
    task
        Begins the names of the pictures.
    """

    def __init__(self, window, wait, settled, task):
        self.window, self.wait, self.settled, self.task, self.count = window, wait, settled, task, 0

    def done(self):
        """An interaction is over: draw, and keep a picture of it."""
        self.count += 1
        QTest.qWait(30)
        if folder := os.environ.get("REGOLITH_STUDIO_SHOTS"):
            QTest.qWait(400)
            Path(folder).mkdir(parents=True, exist_ok=True)
            name = f"{self.task}_{self.count:02d}.png"
            self.window.grab().save(str(Path(folder) / name))
            for number, each in enumerate(self._dialogs()):
                each.grab().save(str(Path(folder) / f"{self.task}_{self.count:02d}_dialog{number}.png"))

    def see(self, kind, name):
        """A widget of the page or the window by its object name; it must be seen and not be covered."""
        for top in (*self._dialogs(), self.window):
            widget = top.findChild(kind, name)
            if widget is not None and widget.isVisible():
                self.wait(widget.isEnabled, 5.0)  # values are checked a moment later
                return widget
        raise AssertionError(f"{name} is not seen")

    def click(self, kind, name):
        self.press(self.see(kind, name))

    def press(self, widget, place=None):
        """Click where the mouse really meets the widget."""
        place = place or widget.rect().center()
        top = widget.window()

        def seen():
            under = top.childAt(widget.mapTo(top, place))
            return under is widget or widget.isAncestorOf(under)

        self.wait(seen, 20.0)  # a message may cover it for some seconds
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=place)
        self.done()

    def row(self, table, number):
        view = self.see(QTableView, table)
        self.press(view.viewport(), view.visualRect(view.model().index(number, 0)).center())

    def tab(self, name, title):
        bar = self.see(QTabWidget, name).tabBar()
        number = next(at for at in range(bar.count()) if bar.tabText(at) == title)
        self.press(bar, bar.tabRect(number).center())

    def choose(self, name, label):
        """Unfold a list, and click the line that reads so: two interactions."""
        box = self.see(QComboBox, name)
        self.click(QComboBox, name)
        view = box.view()
        self.wait(view.isVisible)
        QTest.qWait(QApplication.doubleClickInterval() + 50)  # a list takes no click so soon after the first
        index = view.model().index(box.findText(label), 0)
        assert index.isValid(), f"{name} has no {label!r}"
        QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=view.visualRect(index).center())
        self.done()

    def type(self, name, text):
        """Click a field and write into it: two interactions."""
        field = self.see(QWidget, name)
        line = field if isinstance(field, QLineEdit) else field.findChild(QLineEdit)
        QTest.mouseClick(line, Qt.MouseButton.LeftButton, pos=QPoint(8, line.height() // 2))
        self.done()
        QTest.keySequence(line, "Ctrl+A")
        QTest.keyClicks(line, text)
        self.done()
        QTest.keyClick(line, Qt.Key.Key_Return)

    def tool(self, words):
        """Click a button of the tool bar by its words."""
        buttons = self.window.menus.bar.findChildren(QToolButton)
        self.press(next(each for each in buttons if each.isVisible() and each.text().startswith(words)))

    def answer(self, path, act, asks_unit=False):
        """Do what asks for a file, paste its path (``None`` for the suggested one) and accept, and a unit."""
        timer, written, accepted = QTimer(interval=50), [], []

        def look():
            dialog = next((each for each in self._dialogs() if isinstance(each, QFileDialog)), None)
            if dialog is not None and not written:
                written.append(path)
                if path is not None:
                    line = dialog.findChild(QLineEdit)
                    line.selectAll()
                    QApplication.clipboard().setText(str(path))
                    QTest.keySequence(line, "Ctrl+V")
                    self.done()
                box = dialog.findChild(QDialogButtonBox)
                self.press(next(each for each in box.buttons() if each.isDefault()))
            unit = next((each for each in self._dialogs() if isinstance(each, UnitDialog)), None)
            if unit is not None and unit.can_open:
                timer.stop()
                accepted.append(unit)
                QTest.keyClick(unit, Qt.Key.Key_Return)
                self.done()

        timer.timeout.connect(look)
        timer.start()
        act()
        self.wait(lambda: written and (accepted or not asks_unit) and not self._dialogs(), 20.0)
        timer.stop()
        timer.timeout.disconnect(look)

    def command(self, name):
        """What the chord of a command does; chords reach no window without a window manager."""
        self.window.menus.by_name[name].trigger()
        self.done()

    def rest(self):
        """Wait until nothing runs."""
        self.settled(self.window, SECONDS)

    @staticmethod
    def _dialogs():
        return [each for each in QApplication.topLevelWidgets() if each.isVisible() and each.isModal()]


@pytest.fixture
def newcomer(shown, preferences, wait, settled, request):
    """Somebody who sees the window for the first time, tour and all."""
    window = open_window(views="image", preferences=preferences)
    window.resize(1480, 900)
    shown(window)
    show_recovery_and_tour(window)
    assert window.findChild(QPushButton, "tour_end") is None, "the tour begins when the views are filled"
    wait(lambda: window.session.results.coarsened is not None, SECONDS)
    settled(window)
    made = Newcomer(window, wait, settled, request.node.name.removeprefix("test_that_")[:24])
    wait(lambda: window.findChild(QPushButton, "tour_end") is not None)
    made.click(QPushButton, "tour_end")
    yield made
    assert made.count <= MOST


def column(window, title):
    """What the table of descriptors says, by the first word of its rows."""
    table = window.findChild(QWidget, "descriptor_table").table
    at = next(n for n in range(table.columnCount()) if table.horizontalHeaderItem(n).text() == title)
    tips = [table.verticalHeaderItem(row).toolTip() for row in range(table.rowCount())]
    rows = [tip.partition(":")[0].partition(", ")[2] for tip in tips]
    texts = [table.item(row, at).text() for row in range(table.rowCount())]
    return {name: float(text.replace(",", "")) for name, text in zip(rows, texts, strict=True)}


@pytest.mark.slow
def test_that_two_particles_are_compared_at_two_degrees(newcomer):
    window, seen = newcomer.window, {}
    newcomer.tab("plots_left", "Descriptors")
    for row, degrees in ((0, (4, 10)), (3, (10, 4))):
        newcomer.row("particle_table", row)
        for degree in degrees:
            if window.session.choices.l_max != degree:
                newcomer.type("l_max", str(degree))
            newcomer.rest()
            name = window.session.choices.selected
            measured, fitted = column(window, "Particle"), column(window, "Fit")
            seen[name, degree] = abs(fitted["Surface area"] / measured["Surface area"] - 1)
            assert f"{degree}" in window.page.three_views.frames["fit"]._title.text()
    assert len({name for name, _degree in seen}) == 2
    for name in {name for name, _degree in seen}:
        assert seen[name, 10] < seen[name, 4], f"more of {name} is kept at a higher degree"


@pytest.mark.slow
def test_that_a_polyhedron_keeps_volume_area_and_aspect_ratio(newcomer):
    newcomer.choose("preset", presets()["volume_sphericity_aspect_ratio"].label)
    newcomer.tab("plots_left", "Descriptors")
    newcomer.rest()
    fit, solid = column(newcomer.window, "Fit"), column(newcomer.window, "Polyhedron")
    for name in ("Volume", "Surface area", "Aspect ratio"):
        assert solid[name] == pytest.approx(fit[name], rel=1e-3), name
    assert newcomer.window.session.results.coarsened.n_facets == 20
    assert "20 facets" in newcomer.window.page.three_views.frames["polyhedron"]._title.text()


@pytest.mark.slow
def test_that_figure_8_is_reproduced_for_the_sample_and_saved(newcomer, tmp_path):
    newcomer.click(QWidget, "page_studies")
    newcomer.click(QPushButton, "coarsening_study_result_button")
    newcomer.wait(lambda: newcomer.window.session.tasks, 20.0)
    newcomer.rest()
    newcomer.answer(tmp_path, lambda: newcomer.tool("Save figures and tables"))
    newcomer.rest()
    table = next(tmp_path.glob("*coarsening*.csv"))
    rows = list(csv.DictReader(line for line in table.read_text().splitlines() if not line.startswith("#")))
    assert len(rows) >= 7
    assert {".png", ".svg", ".json"} <= {path.suffix for path in tmp_path.iterdir()}


@pytest.mark.slow
def test_that_a_hundred_virtual_particles_are_compared_with_the_sample(newcomer):
    newcomer.click(QWidget, "page_model")
    newcomer.click(QPushButton, "model_fit")
    newcomer.rest()
    newcomer.click(QPushButton, "model_drawn_button")
    newcomer.rest()
    newcomer.tab("model_tabs", "Distributions")
    newcomer.choose("model_distribution_of", "Aspect ratio")
    page = newcomer.window.page
    assert page.drawing.card.record.values[0] == "100"
    measured, drawn = page.distributions.plot.curves
    assert (measured.label, drawn.label) == ("12 measured", "100 drawn")
    fitted = sorted(entry.descriptors["aspect_ratio"] for entry in newcomer.window.session.particles)
    assert measured.x[0] == pytest.approx(fitted[0], rel=0.05), "of the fits, not of the scans"
    assert drawn.y[-1] == pytest.approx(100.0)
    assert "Kolmogorov-Smirnov" in page.distributions.words.text()


@pytest.mark.slow
def test_that_a_folder_of_one_s_own_becomes_a_polyhedron_with_its_errors(newcomer, tmp_path):
    (tmp_path / "ball.stl").write_bytes(stl_bytes(icosphere(3).moved(scale=40.0).triangles, "ball"))
    window = newcomer.window
    newcomer.answer(tmp_path, lambda: newcomer.command("open_folder"), asks_unit=True)
    newcomer.rest()
    assert [entry.id for entry in window.session.particles] == ["ball"]
    found = window.session.results.coarsened
    assert window.page.assessment.figures[0].text() == f"{found.loss:#.4g}"
    assert len(window.page.plots.error_bars.plot.series) >= 2


@pytest.mark.slow
def test_that_a_scan_becomes_grains_in_a_table(newcomer):
    newcomer.click(QWidget, "page_scan")
    for name in ("scan_sample", "scan_grains_button", "scan_make", "scan_show"):
        newcomer.click(QPushButton, name)
        newcomer.rest()
    assert newcomer.window.pages.current == "sample"
    assert len(newcomer.window.session.particles) > 10


@pytest.mark.slow
def test_that_a_heap_has_an_angle_with_an_interval(newcomer, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    newcomer.click(QWidget, "page_repose")
    newcomer.click(QPushButton, "repose_angle_button")  # builds a dataset of the open particles
    newcomer.rest()
    newcomer.click(QPushButton, "repose_angle_button")
    newcomer.rest()
    angle, interval = (figure.text() for figure in newcomer.window.page.angle.figures)
    assert 10.0 < float(angle.rstrip("°")) < 60.0
    assert " to " in interval


@pytest.mark.slow
def test_that_a_lesson_plays_its_steps_with_their_formulas(newcomer):
    newcomer.click(QWidget, "page_lecture")
    playback = newcomer.window.page.annealing.playback
    newcomer.wait(lambda: playback.has_steps, SECONDS)
    newcomer.tool("Play or pause")
    newcomer.wait(lambda: playback.step >= 3, 30.0)
    assert len(newcomer.window.page.annealing.rule.lines()) == 3


@pytest.mark.slow
def test_that_ten_shapes_are_exported_for_two_programs(newcomer, tmp_path):
    newcomer.click(QWidget, "page_dataset")
    newcomer.answer(tmp_path, lambda: newcomer.click(QPushButton, "dataset_export"))
    newcomer.rest()
    folder = newcomer.window.session.dataset_folder
    assert folder.parent == tmp_path
    assert len(read_dataset(folder)) == 10
    assert list(validate_dataset(folder)) == []
    assert len(list((tmp_path / "rocky" / "meshes").glob("*.stl"))) == 10
    assert list((tmp_path / "yade").glob("*.py"))


@pytest.mark.slow
def test_that_drawn_particles_are_exported_for_two_programs(newcomer, tmp_path):
    newcomer.click(QWidget, "page_model")
    newcomer.click(QPushButton, "model_drawn_button")
    newcomer.rest()
    newcomer.click(QPushButton, "model_adopt")
    newcomer.rest()
    newcomer.click(QWidget, "page_dataset")
    newcomer.answer(tmp_path, lambda: newcomer.click(QPushButton, "dataset_export"))
    newcomer.rest()
    dataset = read_dataset(newcomer.window.session.dataset_folder)
    assert sum(one.n_members for one in dataset.representatives) == 100
    assert list((tmp_path / "rocky").glob("*.py"))
    assert list((tmp_path / "yade").glob("*.py"))
