"""The page "Shape model": fit, drag the spectrum, draw, judge, hand over."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog, QLabel

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.harmonics.synthesis import level_for
from regolith_studio.jobs.model_jobs import GenerationRequest, draw_shapes, fit_shapes, make_particles
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.readers.shape_files import ShapeSource, read_shape_source
from regolith_studio.session.choices import Choices
from regolith_studio.session.session import Session
from regolith_studio.shape_models.models import MODELS, write_model
from regolith_studio.shape_models.sample import Sample
from regolith_studio.steps import result_of
from regolith_studio.studies.population import KEYS
from regolith_studio.studies.population_distances import DistributionComparison
from regolith_studio.ui.pages.model import PAGE
from regolith_studio.ui.pages.model.controls import DistributionsPanel
from regolith_studio.ui.result_card import ResultState
from regolith_studio.ui.theme import LIGHT
from regolith_studio.ui.translation import translate
from regolith_studio.ui.widgets.plots.bars import SpectrumEditor
from tests.plugin import lunar_kinds
from tests.ui.reading import english_left

AMPLITUDES = np.array([0.02, 0.09, 0.03, 0.02])


@pytest.fixture
def page(opened):
    return opened()


@pytest.fixture
def opened(page_of):
    """Opens the page, in the language that is spoken then."""
    return lambda: page_of(PAGE, 1100, 760)


def rough_sample(n=30, l_max=4):
    rng = np.random.default_rng(0)
    degree = degrees((l_max + 1) ** 2)
    rows = rng.normal(size=(n, (l_max + 1) ** 2)) * 0.3 * np.maximum(degree, 1.0) ** -2
    rows[:, 0] = np.sqrt(4 * np.pi)
    return Sample(rows * 10 * np.exp(0.3 * rng.normal(size=(n, 1))))


def take(page, sample):
    page._add(ShapeSource(sample, "rough", "0" * 64), Path("rough.json"))
    page.source.l_max.setValue(4)


def egg(n):
    ball = icosphere(2)
    return Particle(f"egg-{n}", Mesh(ball.vertices * np.array([1.4, 1.2, 1.0]) * (10.0 + n), ball.faces))


def column_texts(table, column):
    """The different texts in a column."""
    return {table.item(row, column).text() for row in range(table.rowCount())}


def choose_model(page, key):
    page.source.model.setCurrentIndex(page.source.model.findData(key))


def place(editor, degree, percent):
    seen = editor.canvas.getViewBox().mapViewToScene(QPointF(degree, np.log10(percent)))
    return editor.canvas.mapFromScene(seen)


def test_that_a_bar_follows_the_mouse(shown, wait):
    editor = shown(SpectrumEditor("nothing"))
    editor.resize(500, 300)
    told, ends = [], []
    editor.valueChanged.connect(told.append)
    editor.editingFinished.connect(lambda: ends.append(True))
    editor.setValue(AMPLITUDES)
    QTest.qWait(30)
    assert not told
    viewport = editor.canvas.viewport()
    QTest.mousePress(viewport, Qt.MouseButton.LeftButton, pos=place(editor, 2, 9))
    QTest.mouseMove(viewport, place(editor, 2, 20))
    QTest.mouseRelease(viewport, Qt.MouseButton.LeftButton, pos=place(editor, 2, 20))
    assert told[-1][1] == pytest.approx(0.20, rel=0.1)
    np.testing.assert_array_equal(np.delete(told[-1], 1), np.delete(AMPLITUDES, 1))
    assert ends
    editor.reset()
    wait(lambda: bool((told[-1] == AMPLITUDES).all()))
    assert not editor.is_changed()


def test_that_keys_change_a_bar_and_a_spectrum_that_is_only_shown_stays(shown):
    editor = shown(SpectrumEditor("nothing"))
    editor.setValue(AMPLITUDES)
    QTest.keyClick(editor, Qt.Key.Key_Right)
    QTest.keyClick(editor, Qt.Key.Key_Up)
    assert editor.value()[1] == pytest.approx(0.09 * 1.1)
    editor.setValue(AMPLITUDES, editable=False)
    QTest.keyClick(editor, Qt.Key.Key_Up)
    QTest.mousePress(editor.canvas.viewport(), Qt.MouseButton.LeftButton, pos=place(editor, 3, 10))
    np.testing.assert_array_equal(editor.value(), AMPLITUDES)


@pytest.mark.parametrize(("l_max", "level"), [(10, 4), (30, 5)])
def test_that_shapes_on_screen_have_a_mesh_that_is_fine_enough_for_their_degree(l_max, level):
    """Level 4 has fewer than three vertices a wave of degree 30: thin rims were jagged."""
    rows = np.zeros((2, (l_max + 1) ** 2))
    rows[:, 0], rows[:, -1] = 10.0, (0.1, -0.1)
    source = ShapeSource(Sample(rows), "rough", "0" * 64)
    request = GenerationRequest("gaussian_field", l_max=l_max, n=1)
    fitted = result_of(fit_shapes(source, request))
    drawn = result_of(draw_shapes(fitted.model, request))
    for mesh in (fitted.first, *fitted.examples, *drawn.examples):
        assert len(mesh.vertices) == len(icosphere(level).vertices)


def test_that_the_drawn_particle_follows_the_spectrum_of_a_material(page):
    page.source.choose_source("ma165")
    assert not page.source.model.isEnabled()
    page.source.fit.click()
    before = page.live.frame.view.picture().astype(int)
    spectrum = page.live.spectrum.value()
    spectrum[1] = 0.4
    page.live.spectrum._values = spectrum
    page._edit(spectrum)
    assert np.abs(page.live.frame.view.picture() - before).mean() > 0.5
    assert page._model.spectrum[2] == pytest.approx(4 * np.pi * 0.16)
    page.live.spectrum.reset()
    assert page._model is page._fitted.model


def test_that_particles_are_drawn_in_the_range_shown_and_taken_over(page, wait):
    page.source.choose_source("ma165")
    page.source.l_max.setValue(12)
    page.source.fit.click()
    page.drawing.setValue({"n": 4, "seed": 2, "size_range": [9.0, 11.0]})
    page.drawing.draw.click()
    radii = page._drawn.draws.equivalent_radii()
    assert 9.0 <= radii.min() <= radii.max() <= 11.0
    record = page.drawing.card.record
    (count, ends), source = record.values, record.made_from
    assert (count, source, record.state) == (
        "4",
        f"Drawn from {page.source.source.currentText()}",
        ResultState.CURRENT,
    )
    assert [float(end) for end in ends.split(" – ")] == pytest.approx([radii.min(), radii.max()], rel=0.006)
    page.drawing.seed.setValue(3)
    assert page.drawing.card.record.state is ResultState.STALE
    page.drawing.seed.setValue(2)
    assert page.drawing.card.record.state is ResultState.CURRENT
    assert page.gallery.frame.view.picture().std() > 5
    page.drawing.adopt.click()
    opened = page._context.session.particles
    assert [entry.id for entry in opened] == [f"ma165-000{i}" for i in range(4)]
    assert {entry.particle.group for entry in opened} == {"ma165 (virtual)"}, "apart from measured ones"
    level = level_for(page._drawn.draws.l_max)
    assert {len(entry.particle.mesh.faces) for entry in opened} == {20 * 4**level}
    wait(lambda: page.source.source.itemText(0) == "Open particles (4)")


@pytest.mark.slow
def test_that_drawing_fits_the_selected_source_first_and_goes_on_after_its_draws_are_opened(page):
    page.source.choose_source("ma165")
    page.drawing.setValue({"n": 4})
    page.drawing.draw.click()
    assert (page._fitted.source.name, len(page._drawn.draws)) == ("ma165", 4)
    fitted = page._fitted
    page.drawing.setValue({"n": 3, "seed": 5})
    page.drawing.draw.click()
    assert page._fitted is fitted, "number and seed ask for no other fit"
    take(page, rough_sample())
    choose_model(page, "gaussian_field")
    page.drawing.draw.click()
    assert (page._fitted.source.name, page._fitted.n_fitted) == ("rough", 30)
    page.source.half.setChecked(True)
    page.drawing.draw.click()
    assert page._fitted.n_fitted == 15


@pytest.mark.slow
def test_that_particles_drawn_from_open_ones_and_opened_are_not_fitted_instead_of_them(page, wait):
    session = page._context.session
    session.adopt([egg(n) for n in range(3)])
    page.source.choose_source("open")
    choose_model(page, "gaussian_field")
    page.source.l_max.setValue(4)
    page.drawing.setValue({"n": 2})
    wait(page.drawing.draw.isEnabled)
    page.drawing.draw.click()
    fitted = page._fitted
    commands = page._context.commands
    commands.ask_before_making = lambda: "replace"
    commands.adopt = lambda made, origin, _answer: session.adopt(made, origin=origin) or True
    page.drawing.adopt.click()
    wait(lambda: page.source.source.itemText(0) == "Open particles (2)")
    assert (
        page.source.findings.text() == "2 of the 2 open particles were drawn: a fit to them repeats a model."
    )
    page.drawing.draw.click()
    assert page._fitted is fitted
    session.adopt([egg(n) for n in range(4)])
    page.drawing.draw.click()
    assert page._fitted.n_fitted == 4


@pytest.mark.slow
def test_that_models_are_judged_on_the_sample_that_was_fitted(page):
    take(page, rough_sample())
    choose_model(page, "gaussian_field")
    assert not page.evaluation.card.button.isEnabled()
    page.source.fit.click()
    assert page.live.spectrum.value() == pytest.approx(
        np.sqrt(page._model.spectrum[1:]) / page._model.mean, rel=1e-12
    )
    page.evaluation.setValue({"splits": 1, "repeats": 1, "all_models": False})
    page.evaluate()
    assert page.evaluation.ranking.rowCount() == 1
    assert page.evaluation.ranking.item(0, 0).text() == MODELS["gaussian_field"].label
    shown = page.evaluation.figures["number"].plots
    assert [plot.curves[0].label for plot in shown] == ["measured"] * len(KEYS)
    for plot in shown:  # histograms have the area 1
        areas = [np.trapezoid(curve.y, curve.x) for curve in plot.curves]
        assert areas == pytest.approx([1.0] * len(areas), rel=1e-9)
    assert len(page.evaluation.figures["pairs"].plots) == 3
    tabs = page.evaluation.tabs
    assert not tabs.isTabVisible(tabs.indexOf(page.evaluation.places["components"]))
    tables = page.evaluation.tables
    assert tables["distances"].rowCount() == 2 * len(KEYS)
    headers = [tables["distances"].horizontalHeaderItem(at).text() for at in range(6)]
    assert headers == ["Model", "Weighting", "Descriptor", "W [%]", "from [%]", "to [%]"]
    assert tables["distances"].item(0, 2).text() == CATALOGUE[KEYS[0]].label
    assert column_texts(tables["targets"], 5) <= {"yes", "no", "not decidable with so few"}
    assert tables["energies"].rowCount() == 10


@pytest.mark.slow
def test_that_a_model_of_another_package_is_fitted_shown_and_drawn(opened, monkeypatch):
    monkeypatch.setitem(MODELS._rows, "lunar_model", lunar_kinds.MODEL)
    page = opened()
    take(page, rough_sample())
    choose_model(page, "lunar_model")
    page.fit_model()
    np.testing.assert_allclose(page.live.spectrum.value(), np.full(2, 0.01), rtol=0.2)
    assert len(page.gallery._shown[0]) > 0
    page.draw()
    assert page._drawn.draws.model == "lunar_model"


@pytest.mark.slow
def test_that_the_parts_of_a_mixture_are_named(page):
    take(page, rough_sample())
    page.source.model.setCurrentIndex(page.source.model.findData("gaussian_mixture"))
    page.source.forms["gaussian_mixture"].setValue({"n_components": 2})
    page.source.fit.click()
    assert page.drawing.names.text() == "part 1, part 2"
    page.drawing.names.setText("basalt, glass")
    page.drawing.names.editingFinished.emit()
    page.drawing.setValue({"n": 12})
    page.drawing.draw.click()
    page.drawing.adopt.click()
    assert {entry.particle.group for entry in page._context.session.particles} == {"basalt", "glass"}
    page.drawing.names.setText("one")
    page.drawing.names.editingFinished.emit()
    assert page.drawing.names.text() == "basalt, glass"


def test_that_what_cannot_be_done_is_said(page):
    said = []
    page._context.toast.problem = lambda sentence, *_: said.append(sentence)
    page.commands()["fit_model"]()
    page.commands()["draw"]()
    page.commands()["adopt"]()
    page.commands()["judge"]()
    page.commands()["save_model"]()
    page.commands()["save_card"]()
    assert [sentence.split(":")[0] for sentence in said] == [
        "No particle is open",
        "No particle is open",
        "There are no drawn particles yet",
        "Models are evaluated on measured particles",
        "There is no model to save",
        "A material card needs a model of a sample",
    ]


@pytest.mark.slow
def test_that_a_model_and_a_card_are_saved_and_opened_again(page, tmp_path, monkeypatch):
    take(page, rough_sample())
    page.source.fit.click()
    for name, save in (("m", page.save_model), ("card", page.save_card)):  # typed without the suffix
        monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_, name=name: (str(tmp_path / name), ""))
        save()
    assert read_shape_source(str(tmp_path / "card.json")).content.n_particles == 30
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "m.json"), ""))
    page.open_source()
    assert page.source.fit.text() == "Use the model"
    page.source.fit.click()
    assert page._fitted.examples == ()
    assert page._model.key == "recombined"


def test_that_the_state_of_the_page_is_plain_and_comes_back(page):
    page.source.choose_source("ma165")
    page.source.forms["sample_matched"].setValue({"turn": 1.0})
    page.drawing.setValue({"n": 7, "seed": 3, "size_range": [2.0, 5.0]})
    state = page.state()
    page.restore({"source": {"source": "open"}, "drawing": {}, "unknown": 1})
    assert page.state()["drawing"]["n"] == 100
    page.restore(state)
    assert page.state() == state


@pytest.mark.slow
def test_that_what_is_fitted_drawn_and_judged_goes_through_the_translation(opened, speaking):
    speaking("brackets")
    page = opened()
    take(page, rough_sample())
    page.source.model.setCurrentIndex(page.source.model.findData("log_field"))
    page.source.fit.click()
    page.drawing.setValue({"n": 4})
    page.drawing.draw.click()
    page.evaluation.setValue({"splits": 1, "repeats": 2, "all_models": False})
    page.evaluate()
    assert [each for each in english_left(page) if each[1] not in ("rough", "r_eq")] == []
    for table in (page.evaluation.ranking, *page.evaluation.tables.values()):
        cells = [
            table.item(row, column).text()
            for row in range(table.rowCount())
            for column in range(table.columnCount())
        ]
        assert [cell for cell in cells if any(map(str.isalpha, cell)) and "⟦" not in cell] == []


def test_that_draws_are_shown_in_units_of_noise_the_farthest_first(shown):
    rng = np.random.default_rng(0)
    measured, drawn = (1.0 + 0.1 * rng.normal(size=(n, len(KEYS))) for n in (100, 60))
    drawn[:, KEYS.index("convexity")] += 0.3
    panel = shown(DistributionsPanel())
    panel.show_compared(
        DistributionComparison(KEYS, measured, drawn, np.empty((0, len(KEYS))), "log_field", 10, 10)
    )
    assert {len(plot.curves) for plot in panel.small.values()} == {2}, "all descriptors at once"
    panel.key.setCurrentIndex(panel.key.findData("convexity"))
    assert len(panel.plot.curves) == 2
    assert panel.table.item(0, 0).text() == CATALOGUE["convexity"].label
    assert "times the sampling noise" in panel.assessment.text()
    panel.show_compared(None)
    assert panel.assessment.text() == ""
    assert not panel.table.isVisible()


def test_that_a_project_keeps_the_file_of_a_model_and_draws_from_no_other_where_it_is_missing(
    page, opened, tmp_path
):
    page.source.choose_source("ma165")
    page.fit_model()
    write_model(tmp_path / "own.json", page._model)
    page.open_path(tmp_path / "own.json")
    state = page.state() | {"made": {"fitted": True, "drawn": True}}
    again = opened()
    again.restore(state)
    assert again.source.value()["source"] == state["source"]["source"]
    assert again.source.source.currentText() == page.source.source.currentText()
    (tmp_path / "own.json").rename(tmp_path / "moved.json")
    late = opened()
    late.restore(state)
    assert "own.json" in late._context.toast.sentence.text()
    late.resume(state)
    assert late._drawn is late._fitted is None
    assert late.state() == state
    late.source.choose_source("ma165")
    assert late.state()["source"]["source"] == "ma165"


class HoldingRunner(InlineRunner):
    """Keeps jobs of some queues until they are let go."""

    def __init__(self, *queues):
        super().__init__()
        self.queues, self.held = queues, []

    def submit(self, job, listener, queue=""):
        if not any(each in queue for each in self.queues):
            return super().submit(job, listener, queue)
        self.held.append(lambda: InlineRunner.submit(self, job, listener, queue))
        return SimpleNamespace(cancel=lambda: None)


def test_that_the_card_of_the_draws_says_that_a_model_is_being_fitted_and_why_it_was_not(page_of, speaking):
    speaking("de")
    runner = HoldingRunner("fit")
    page = page_of(PAGE, 1100, 760, Session(runner, Choices(level=2)))
    take(page, rough_sample())
    page.drawing.number.setValue(4)
    page.draw()
    assert page.drawing.card.record.state is ResultState.RUNNING
    runner.held.pop()()
    assert page.drawing.card.record.state is ResultState.CURRENT
    assert len(page._drawn.draws) == 4
    few = rough_sample(4)
    page._add(ShapeSource(few, "few", "1" * 64), Path("few.json"))
    page.source.model.setCurrentIndex(page.source.model.findData("gaussian_mixture"))
    page.source.forms["gaussian_mixture"].setValue({"n_components": 3})
    page.draw()
    page.fit_model()
    assert page.drawing.card.record.state is not ResultState.RUNNING
    page.draw()
    runner.held.pop()()
    record = page.drawing.card.record
    assert record.state is ResultState.FAILED
    assert translate(record.note).startswith("4 Partikel reichen für 1 bis 1 Teile, nicht für 3")


def test_that_add_or_replace_is_asked_before_particles_are_made(page, monkeypatch):
    order, answers = [], ["", "replace"]
    monkeypatch.setattr(page.session._live, "follow", lambda *_: None)  # no fit, no polyhedron
    take(page, rough_sample())
    page.drawing.number.setValue(3)
    page.draw()
    commands, submit = page.context.commands, InlineRunner.submit
    monkeypatch.setattr(commands, "ask_before_making", lambda: order.append("asked") or answers.pop(0))
    monkeypatch.setattr(
        InlineRunner,
        "submit",
        lambda self, job, *more: order.append(job.function) or submit(self, job, *more),
    )
    page.adopt()
    assert order == ["asked"]
    page.adopt()
    assert order[1:3] == ["asked", make_particles]
    assert order.count("asked") == 2
    assert len(page.session.particles) == 3


def test_that_the_distributions_say_that_the_draws_are_being_measured(page_of):
    runner = HoldingRunner("compare")
    page = page_of(PAGE, 1100, 760, Session(runner, Choices(level=2)))
    take(page, rough_sample())
    page.drawing.number.setValue(20)
    texts = lambda: [each.text() for each in page.distributions.plot.findChildren(QLabel)]  # noqa: E731
    assert any(text.startswith("Draw particles") for text in texts())
    page.draw()
    assert any(text.startswith("The particles are being measured") for text in texts())
    page.distributions.set_theme(LIGHT)
    assert not any(text.startswith("Draw particles") for text in texts())
    runner.held.pop()()
    assert page.distributions.small["sphericity"].curves
    page.fit_model()
    assert any(text.startswith("Draw particles") for text in texts())
