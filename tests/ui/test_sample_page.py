"""The page of the sample: table, filter, plot, statistics and view belong together."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyqtgraph as pg
import pytest
from PySide6.QtCore import QItemSelectionModel, QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QPushButton

from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.readers.particles import LoadedParticles
from regolith_studio.session.choices import Choices
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.session import Session
from regolith_studio.ui.appearance import FONT_SIZE
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.pages.sample import PAGE
from regolith_studio.ui.pages.sample.plots import ScatterPanel, StatisticsPanel
from regolith_studio.ui.result_card import ResultState
from regolith_studio.ui.widgets.labels import short_number

SECONDS = 120.0


@pytest.fixture
def window(sample_window):
    return sample_window(1200, 760)


@pytest.fixture
def page(page_of, wait):
    """The page alone over the shipped particles, coarsened fast."""
    session = Session(InlineRunner(), Choices(method="quadric", level=2, l_max=4))
    session.open_sample()
    return measured(page_of(PAGE, 1200, 760, session), wait)


@pytest.fixture
def page_in_window(window, wait):
    return measured(window.go("sample"), wait)


def measured(page, wait):
    """The page once it shows the descriptors of all particles."""
    wait(lambda: len(page.table.particles.rows) == 12)
    wait(lambda: all(entry.descriptors for entry in page.table.particles.rows))
    return page


def choose(page, *names):
    """Choose rows as a user does who holds Ctrl."""
    flags, table = QItemSelectionModel.SelectionFlag, page.table
    for row, entry in enumerate(table.particles.rows):
        if entry.id in names:
            table.selectionModel().select(table.model().index(row, 0), flags.Select | flags.Rows)


def test_that_a_click_in_the_table_puts_the_particle_on_screen_everywhere(window, page_in_window, wait):
    page = page_in_window
    row = next(r for r, entry in enumerate(page.table.particles.rows) if entry.id == "flat-1")
    place = page.table.visualRect(page.table.model().index(row, 0)).center()
    QTest.mouseClick(page.table.viewport(), Qt.MouseButton.LeftButton, pos=place)
    assert window.session.choices.selected == "flat-1"
    wait(lambda: "flat-1" in page.frame.view.widget.accessibleName())
    window.go("explore")
    wait(lambda: window.page.particles.value() == {"selected": "flat-1"})


def test_that_the_view_says_what_its_colours_mean_while_they_are_shown(page, wait):
    page.session.select("agglutinate-1")
    wait(lambda: "hidden from the star point (" in page.frame.detail.text())
    page.health.where.click()
    assert page.frame.detail.text().endswith("triangles")
    page.health.where.click()
    assert "hidden from the star point (" in page.frame.detail.text()


def test_that_the_filter_narrows_table_plot_and_statistics(page):
    QTest.keyClicks(page.filter, "S<0.75 AR>2")
    names = [entry.id for entry in page.table.particles.rows]
    assert 0 < len(names) < 12
    assert all(e.descriptors["sphericity"] < 0.75 for e in page.table.particles.rows)
    assert page.title.text() == f"Sample ({len(names)} of 12)"
    assert page.statistics.value().rows[0][1] == len(names)
    page.filter.setText("S<oops")
    assert page.assessment.isVisible()
    assert page.assessment.text().endswith("All particles are shown.")
    assert len(page.table.particles.rows) == 12  # not what the filter was while it was typed
    page.commands()["clear_filter"]()
    assert not page.assessment.isVisible()
    assert len(page.table.particles.rows) == 12


@pytest.mark.slow
def test_that_several_rows_are_ringed_in_the_plot_and_counted_alone(page):
    page.table.choose([])
    choose(page, "bead-1", "bead-2", "flat-1")
    assert page.table.chosen() == ["bead-1", "bead-2", "flat-1"]
    assert page.statistics.value().rows[0][1] == 3
    sizes = [
        point.size() for item in page.scatter._items if hasattr(item, "points") for point in item.points()
    ]
    assert sorted(set(sizes)) == [8, 13]
    assert sizes.count(13) == 3


@pytest.mark.slow
def test_that_a_point_of_the_plot_chooses_its_row(page):
    page.scatter.pointChosen.emit("angular-2", False)
    assert page.table.chosen() == ["angular-2"]
    assert page.session.choices.selected == "angular-2"
    page.scatter.pointChosen.emit("bead-1", True)
    assert page.table.chosen() == ["angular-2", "bead-1"]


def test_that_keys_sort_the_table_and_show_the_distribution_of_its_column(page):
    table, keys = page.table, Qt.Key
    columns = table.particles.columns
    listed = [each.key for number, each in enumerate(columns) if not table.isColumnHidden(number)]
    both = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    for key in (keys.Key_Right, *[keys.Key_Right] * listed.index("volume"), keys.Key_Down):
        QTest.keyClick(table, key, both)
    volumes = [entry.descriptors["volume"] for entry in table.particles.rows]
    assert volumes == sorted(volumes, reverse=True)
    assert page.statistics.choices()["key"] == "volume"


def test_that_the_exported_table_has_the_rows_that_are_seen_with_units(page, tmp_path, monkeypatch):
    target = tmp_path / "particles.csv"
    monkeypatch.setattr(
        "regolith_studio.ui.pages.sample.page.QFileDialog.getSaveFileName", lambda *_: (str(target), "")
    )
    page.filter.setText("bead")
    page.export_table()
    rows = list(csv.reader(target.read_text(encoding="utf-8").splitlines()))
    assert "volume [um^3]" in rows[0]
    assert [row[0] for row in rows[1:]] == ["bead-1", "bead-2"]
    page.copy_table()
    assert QApplication.clipboard().text().splitlines()[1].split("\t")[0] == "bead-1"


@pytest.mark.slow
def test_that_only_the_chosen_particles_can_be_kept(page, wait):
    page.table.choose([])
    choose(page, "bead-1", "bead-2")
    page.keep_selected_particles()
    assert [entry.id for entry in page.session.particles] == ["bead-1", "bead-2"]
    wait(lambda: len(page.table.particles.rows) == 2)


def ellipsoids(rng, scale, n):
    ball = icosphere(2)
    axes = scale * np.exp(0.2 * rng.standard_normal((n, 3))) * (1.3, 1.0, 0.8)
    return [Particle(f"e{k}", Mesh(ball.vertices * row, ball.faces)) for k, row in enumerate(axes)]


@pytest.mark.slow
def test_that_other_materials_are_compared_with_the_sample(page, wait, tmp_path, monkeypatch):
    """The sample is one part of fine and three of coarse grains; so is the nearest mixture, within 15 %."""
    rng = np.random.default_rng(0)
    fine, coarse = ellipsoids(rng, 10, 60), ellipsoids(rng, 30, 60)
    names = []
    for name, grains in (("fine", fine), ("coarse", coarse)):
        rows = [
            [describe(each)[key] for key in ("equivalent_radius", "sphericity", "aspect_ratio")]
            for each in grains
        ]
        lines = ["equivalent_radius (um),sphericity,aspect_ratio", *(",".join(map(str, row)) for row in rows)]
        names.append(str(tmp_path / f"{name}.csv"))
        Path(names[-1]).write_text("\n".join(lines))
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: (names, ""))
    page.commands()["match"]()
    panel = page.match
    save = page.findChild(QPushButton, "match_save")
    assert not save.isEnabled()
    assert panel.unit.currentText() == "Micrometres (µm)"
    assert page.plots.currentWidget() is panel
    panel.start()  # twelve shipped particles
    wait(lambda: panel.card.record.state is ResultState.FAILED)
    assert "The sample has 12 particles; a comparison needs at least 20" in panel.card.record.note
    sample = (*fine[:20], *coarse[:60])
    monkeypatch.setattr(Session, "open_particles", property(lambda _: sample))
    panel.start()
    wait(lambda: panel.found is not None, SECONDS)
    assert panel.found.match.parts[0].number_share == pytest.approx(0.25, abs=0.15)
    assert save.isEnabled()
    assert panel.card.record.values[1] == "< 1"
    texts = [[panel.table.rows.item(row, at).text() for at in range(8)] for row in range(3)]
    assert [row[0] for row in texts] == ["coarse.csv", "fine.csv", "mixture"]
    assert float(texts[0][2]) < float(texts[1][2])
    assert [float(row[2]) >= 0 for row in texts] == [True] * 3
    assert texts[2][1] == "100"
    headings = [panel.table.rows.horizontalHeaderItem(at).text() for at in range(8)]
    assert headings[3:] == ["Distance / noise", "r_eq [%]", "S [%]", "AR [%]", "Particles"]
    assert not panel.picture.pixmap().isNull()
    monkeypatch.setattr(FolderDialog, "ask", lambda *_: str(tmp_path / "out"))
    panel.save()
    wait(lambda: (tmp_path / "out" / "match.csv").is_file())
    assert panel.card.record.note == ""
    assert panel.card.record.made_from == "coarse.csv"
    sample = fine[:30]
    panel.candidates.takeItem(0)
    panel.start()
    wait(lambda: panel.found.match.mixture.n_particles == 60, SECONDS)
    wait(lambda: panel.card.record.note.startswith("No mixture matches the sample"))


@pytest.mark.slow
def test_that_what_a_project_keeps_of_the_page_comes_back(page):
    page.filter.setText("flat")
    page.scatter.set_axes("volume", "sphericity")
    column = [each.key for each in page.table.particles.columns].index("convexity")
    page.table.sortByColumn(column, Qt.SortOrder.DescendingOrder)
    assert page.statistics.choices()["key"] == "convexity"
    kept = page.state()
    page.statistics.choose({"key": "volume", "weighting": "volume"})
    page.filter.clear()
    page.scatter.set_axes("flatness", "elongation")
    page.restore(kept)
    assert page.filter.text() == "flat"
    assert page.scatter.axes() == ("volume", "sphericity")
    assert page.statistics.choices() == kept["statistics"]


def test_that_statistics_undo_the_loss_at_the_border_only_where_there_was_one(shown):
    panel = StatisticsPanel()
    shown(panel)
    shown(panel.distribution)
    sphere = icosphere(2)
    plain = [
        ParticleEntry(name, Particle(name, mesh), None, describe(mesh))
        for name, mesh in (("small", sphere), ("large", sphere.moved(scale=2.0)))
    ]
    panel.show_entries(plain)
    panel.resize(1600, 300)
    last = panel.table.columnCount() - 1
    assert panel.table.columnWidth(last) < 2 * panel.table.columnWidth(last - 1), "no column is far away"
    assert not panel.border.isVisible()
    small, large = (entry.descriptors["volume"] for entry in plain)
    assert panel.value().rows[0][2] == pytest.approx((small + large) / 2)
    weighted = [plain[0], replace(plain[1], particle=replace(plain[1].particle, weight=3.0))]
    panel.show_entries(weighted)
    assert panel.border.isVisible()
    assert panel.value().rows[0][2] == pytest.approx((small + 3 * large) / 4)
    histogram, cumulative = panel.plot.curves
    assert max(histogram.y) == pytest.approx(75.0)
    assert cumulative.x == pytest.approx((small, small, large, large))
    assert cumulative.y == pytest.approx((0.0, 25.0, 25.0, 100.0))
    assert panel.card.record.values[1] == short_number(large)
    assert "corrected for grains at the border" in panel.card.record.made_with
    QTest.mouseClick(panel.border, Qt.MouseButton.LeftButton, pos=QPoint(8, panel.border.height() // 2))
    assert panel.value().rows[0][2] == pytest.approx((small + large) / 2)


@pytest.mark.slow
def test_that_the_names_of_the_classes_of_zingg_take_the_letters_of_the_window(window, page_in_window, wait):
    usual = QApplication.font().pointSizeF()

    def sizes():
        words = [each for each in page_in_window.scatter._items if isinstance(each, pg.TextItem)]
        return {each.textItem.font().pointSizeF() for each in words}

    for letters in (200, 100):
        window.appearance.choose(**{FONT_SIZE: letters})
        wait(lambda: sizes() == {QApplication.font().pointSizeF()})
    assert QApplication.font().pointSizeF() == pytest.approx(usual)


@pytest.mark.parametrize("height", [260, 700])
def test_that_no_point_covers_a_name_of_zingg(shown, height):
    panel = ScatterPanel()
    panel.resize(500, height)
    ends = {"flatness": (0.3, 1.0, 0.3, 1.0), "elongation": (0.3, 0.3, 1.0, 1.0)}
    rows = [dict(zip(ends, pair, strict=True)) for pair in zip(*ends.values(), strict=True)]
    particles = [Particle(str(number), icosphere(0)) for number in range(len(rows))]
    panel.show_entries(
        [ParticleEntry(each.name, each, descriptors=row) for each, row in zip(particles, rows, strict=True)],
        (),
    )
    shown(panel)
    panel.grab()  # pyqtgraph places texts when it paints, which the display may ask for later
    words = [each for each in panel._items if isinstance(each, pg.TextItem)]
    assert len(words) == 4
    (points,) = [each for each in panel._items if isinstance(each, pg.ScatterPlotItem)]
    box = panel.plot.canvas.getViewBox()
    seen = box.mapRectToScene(box.rect())
    for word in words:
        place = word.mapRectToScene(word.boundingRect())
        assert seen.adjusted(-1, -1, 1, 1).contains(place)
        for point in points.points():
            at = points.mapToScene(point.pos())
            assert not place.contains(at), word.toPlainText()


def test_that_a_logarithmic_plot_cannot_be_dragged_to_where_numbers_end(shown):
    from regolith_studio.ui.widgets.plots.base import MAX_DECADES
    from regolith_studio.ui.widgets.plots.curves import CurvePlot

    plot = shown(CurvePlot("degree", "amplitude", "nothing", log_y=True))
    plot.canvas.getViewBox().setYRange(-1e4, 1e4)
    assert max(map(abs, plot.canvas.getAxis("left").range)) <= MAX_DECADES
    plot.canvas.getViewBox().setXRange(0, 1e4)
    assert plot.canvas.getAxis("bottom").range[1] >= 1e4
    plot.set_theme(plot.theme)


def test_that_a_part_of_an_archive_is_called_one_as_long_as_it_is_shown(page, wait):
    sentence = "Shown is a random part of the archive: 1,000 of 84,311, seed 0."
    whole = LoadedParticles(page.session.open_particles)
    page.session._replace_particles(replace(whole, left_out=(sentence,)))
    wait(lambda: page.context.bindings.idle)
    assert page.assessment.isVisibleTo(page)
    assert page.assessment.text() == sentence
    page.filter.setText("S<")
    assert "All particles are shown." in page.assessment.text()
    page.filter.setText("")
    assert page.assessment.text() == sentence
    page.session._replace_particles(whole, add=True)
    wait(lambda: page.context.bindings.idle)
    assert page.assessment.text() == sentence
    page.session._replace_particles(whole)
    wait(lambda: page.context.bindings.idle)
    assert not page.assessment.isVisibleTo(page)
