"""Each panel keeps its promise: what is written is read back, and only the user's changes are announced."""

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pyqtgraph as pg
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QFontMetrics
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QAbstractSpinBox, QComboBox, QSlider, QWidget

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.settings import CoarseningSettings
from regolith_studio.coarsening.weights import KEPT, LossWeights, presets
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe, relative_errors
from regolith_studio.geometry.mesh_health import inspect
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.ray_casting import jaccard_distance
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest, coarsen_one
from regolith_studio.jobs.events import Partial
from regolith_studio.session.choices import Choices
from regolith_studio.session.results import ParticleEntry, Results
from regolith_studio.session.sample_table import health_word
from regolith_studio.session.tasks import Task
from regolith_studio.studies.lmax import LmaxStudy
from regolith_studio.ui.activity import IDLE, TasksPanel
from regolith_studio.ui.pages.explore.page import ParticleListPanel
from regolith_studio.ui.pages.explore.panels import AssessmentPanel, CoarseningPanel, FitPanel, LossPanel
from regolith_studio.ui.pages.explore.plots import DescriptorTablePanel, ErrorBarsPanel, LossCurvePanel
from regolith_studio.ui.pages.studies.plots import LmaxStudyPanel
from regolith_studio.ui.result_card import ResultState
from regolith_studio.ui.widgets.forms import SettingsForm
from regolith_studio.ui.widgets.plots.bars import BarPlot, BarSeries

WEIGHTS = LossWeights.of(volume=0.5, sphericity=1.25, jaccard_distance=7.0)
VALUES = {
    FitPanel: {"l_max": 17, "star_point": "kernel_centre", "rule": "first", "reference": "ellipsoid"},
    CoarseningPanel: {
        "stop_at": "error",
        "n_facets": 33,
        "n_triangles": 77,
        "n_vertices": 39,
        "largest_error": 0.0035,
        "target": "particle",
        "method": "annealing",
        "settings": (("cooling", 0.8),),
        "seed": 12,
    },
    LossPanel: {"weights": WEIGHTS, "preset": "descriptors"},
}


def entry(name, scale=1.0, **more):
    return ParticleEntry(name, Particle(name, icosphere(2).moved(scale=scale)), **more)


def measured(name, scale):
    bare = entry(name, scale)
    mesh = bare.particle.mesh
    return ParticleEntry(name, bare.particle, inspect(mesh), describe(mesh))


@pytest.mark.parametrize("kind", VALUES)
def test_that_a_value_written_into_a_panel_is_read_back_and_not_announced(shown, kind):
    panel, heard = shown(kind()), []
    panel.valueChanged.connect(heard.append)
    panel.setValue(VALUES[kind])
    QTest.qWait(50)
    assert panel.value() == VALUES[kind]
    assert set(panel.value()) == set(panel.FIELDS)
    assert heard == []


def test_that_another_reference_is_announced_as_one_step(shown):
    panel, heard, ended = shown(FitPanel()), [], []
    panel.valueChanged.connect(heard.append)
    panel.editingFinished.connect(lambda: ended.append(True))
    panel.more.button.click()
    QTest.keyClick(panel.ways["reference"], Qt.Key.Key_Down)
    assert heard == [{"reference": "ellipsoid"}]
    assert ended == [True]


@pytest.mark.parametrize("kind", VALUES)
def test_that_every_control_has_a_name_for_screen_readers(shown, kind):
    panel = shown(kind())
    for control in (
        panel.findChildren(QComboBox) + panel.findChildren(QAbstractSpinBox) + panel.findChildren(QSlider)
    ):
        assert control.accessibleName(), f"{control.objectName()} has no accessible name"
    for button in panel.findChildren(QAbstractButton):
        assert button.accessibleName() or button.text() or button.objectName().startswith("qt_")


def test_that_a_weight_that_is_moved_marks_the_preset_as_modified_and_reset_unmarks_it(shown, wait):
    panel, heard = shown(LossPanel()), []
    panel.setValue({"weights": presets()["all"].weights, "preset": "all"})
    assert not panel.is_modified()
    panel.valueChanged.connect(heard.append)
    QTest.keyClick(panel.sliders["volume"].slider, Qt.Key.Key_Right)
    wait(lambda: heard)
    assert heard[-1]["weights"]["volume"] == pytest.approx(1.05)
    assert "(modified)" in panel.preset.currentText()
    assert "weight 1" not in panel.origin.text()
    assert panel.origin.text().startswith("Changed from")
    QTest.mouseClick(panel.reset, Qt.MouseButton.LeftButton)
    assert heard[-1] == {"weights": presets()["all"].weights, "preset": "all"}
    assert "(modified)" not in panel.preset.currentText()


def test_that_a_lock_beside_a_weight_keeps_its_descriptor(shown):
    panel, heard = shown(LossPanel()), []
    panel.setValue({"weights": presets()["all"].weights, "preset": "all"})
    assert {key for key, lock in panel.locks.items() if lock.isChecked()} == set(KEPT)
    panel.valueChanged.connect(heard.append)
    QTest.mouseClick(panel.locks["sphericity"], Qt.MouseButton.LeftButton)
    assert heard[-1]["weights"].keep == set(KEPT) - {"sphericity"}
    assert heard[-1]["weights"]["sphericity"] == 1.0
    assert "weighed: Jaccard distance, sphericity" in panel.origin.toolTip()
    QTest.mouseClick(panel.locks["sphericity"], Qt.MouseButton.LeftButton)
    assert heard[-1]["weights"] == presets()["all"].weights
    panel.setValue({"weights": LossWeights.of(volume=1), "preset": "all"})
    assert {key for key, lock in panel.locks.items() if lock.isChecked()} == {"volume"}


def test_that_methods_that_know_weights_only_have_no_locks(shown):
    panel = shown(LossPanel())
    panel.setValue({"weights": presets()["all"].weights, "preset": "all"})
    panel.set_keeps_terms(False)
    assert not any(lock.isEnabled() or lock.isChecked() for lock in panel.locks.values())
    assert "keeps" not in panel.origin.toolTip()
    panel.set_keeps_terms(True)
    assert panel.locks["volume"].isChecked()


def test_that_another_method_drops_the_settings_of_the_first(shown):
    panel, heard = shown(CoarseningPanel()), []
    panel.setValue(VALUES[CoarseningPanel])
    panel.valueChanged.connect(heard.append)
    panel.method.setCurrentIndex(panel.method.findData("quadric"))
    panel.method.activated.emit(panel.method.currentIndex())
    assert heard == [{"method": "quadric", "settings": ()}]


@pytest.mark.parametrize(
    ("stop", "field", "typed", "told"),
    [
        ("facets", "n_facets", 12, 12),
        ("triangles", "n_triangles", 44, 44),
        ("vertices", "n_vertices", 24, 24),
        ("error", "largest_error", 2.5, 0.025),
    ],
)
def test_that_the_number_of_what_is_stopped_at_is_the_one_that_can_be_set(shown, stop, field, typed, told):
    panel = shown(CoarseningPanel())
    said = []
    panel.valueChanged.connect(said.append)
    panel.stop_at.setCurrentIndex(panel.stop_at.findData(stop))
    names = ("n_facets", "n_triangles", "n_vertices", "largest_error")
    fields = {name: panel.findChild(QWidget, name) for name in names}
    assert [name for name in names if fields[name].isVisible()] == [field]
    fields[field].setValue(typed)
    stopped = [] if stop == "facets" else [{"stop_at": stop}]  # which is chosen already
    assert said == [*stopped, {field: told}]


def test_that_the_dice_takes_the_next_seed(shown):
    panel, heard = shown(CoarseningPanel()), []
    panel.valueChanged.connect(heard.append)
    QTest.mouseClick(panel.dice, Qt.MouseButton.LeftButton)
    assert heard == [{"seed": 1}]


def test_that_the_list_shows_what_is_known_and_announces_the_row_that_is_clicked(shown):
    panel, heard = shown(ParticleListPanel()), []
    panel.set_entries([measured("small", 1.0), entry("large", 10.0)])
    panel.setValue({"selected": "small"})
    panel.valueChanged.connect(heard.append)
    model = panel.table.model()
    texts = [model.index(0, column).data() for column in (0, 2, 3, 4)]
    assert texts[0] == "small"
    assert float(texts[1]) == pytest.approx(4.19, abs=0.2)
    assert model.index(1, 2).data() == "…"
    where = panel.table.visualRect(model.index(1, 0)).center()
    QTest.mouseClick(panel.table.viewport(), Qt.MouseButton.LeftButton, pos=where)
    assert heard == [{"selected": "large"}]
    assert panel.value() == {"selected": "large"}


def test_that_a_list_of_any_width_shows_whole_names_and_whole_columns(shown, wait):
    panel = shown(ParticleListPanel())
    panel.set_entries([measured("agglutinate-1", 1.0), measured("bead-2", 2.0)])
    table, name = panel.table, QFontMetrics(panel.table.font()).horizontalAdvance("agglutinate-1")

    def seen():
        return [each for each in range(5) if not table.isColumnHidden(each)]

    for width, columns in ((150, 1), (230, 2), (500, 4)):
        panel.resize(width, 300)
        bar = table.horizontalScrollBar()  # a display may answer late
        wait(lambda columns=columns, bar=bar: len(seen()) == columns and bar.maximum() == 0, 10.0)
        assert table.columnWidth(0) >= name
        assert table.isColumnHidden(1), "one group needs no column"
        assert all(table.columnWidth(each) >= table.sizeHintForColumn(each) for each in seen())
    tip = table.model().index(0, 0).data(Qt.ItemDataRole.ToolTipRole)
    assert tip.startswith("agglutinate-1\nV [µm³] ")


def test_that_the_list_sorts_by_number_and_not_by_text(shown):
    panel = shown(ParticleListPanel())
    panel.set_entries([measured("nine", 9.0), measured("ten", 10.0), measured("two", 2.0)])
    panel.table.sortByColumn(2, Qt.SortOrder.AscendingOrder)
    model = panel.table.model()
    assert [model.index(row, 0).data() for row in range(3)] == ["two", "nine", "ten"]


def test_that_health_is_told_by_an_icon():
    assert health_word(entry("a")) == "unknown"
    assert health_word(measured("a", 1.0)) == "sound"
    mended = Particle("a", icosphere(1), notes=("A hole was closed.",))
    assert health_word(ParticleEntry("a", mended, inspect(mended.mesh))) == "repaired"
    open_mesh = type(mended.mesh)(mended.mesh.vertices, mended.mesh.faces[1:])
    assert health_word(ParticleEntry("a", Particle("a", open_mesh), inspect(open_mesh))) == "unsound"


def test_that_the_verdict_on_one_particle_never_stands_for_another(shown):
    panel, choices = shown(AssessmentPanel()), Choices(method="quadric", selected="a")
    found = coarsen(icosphere(2), 12, "quadric")
    loss = f"{found.loss:#.4g}"
    panel.show_results(Results(best=found, coarsened=found), choices)
    assert panel.figures[0].text() == loss
    panel.show_results(Results(best=found), choices.replaced(n_facets=13))
    assert panel.figures[0].text() == loss  # dimmed until the next one is there
    panel.show_results(Results(best=found), choices.replaced(selected="b"))
    assert panel.figures[0].text() == "–"
    assert "not finished" in panel.sentence.text()
    panel.show_results(Results(), Choices())
    assert panel.sentence.text() == "Open a particle first."


def test_that_presets_are_losses_and_one_without_is_listed_only_while_it_is_in_use(shown):
    panel = shown(LossPanel())
    assert panel.preset.findData("quadric") < 0
    panel.setValue({"weights": presets()["quadric"].weights, "preset": "quadric"})
    assert panel.preset.currentData() == "quadric"


def test_that_loss_and_errors_of_the_best_polyhedron_so_far_are_live(shown):
    card, bars, table = shown(AssessmentPanel()), shown(ErrorBarsPanel()), shown(DescriptorTablePanel())
    choices, target = Choices(method="annealing", selected="a"), icosphere(2)
    request = CoarseningRequest(choices.weights, 12, "annealing", (("iterations", 5),))
    step = next(each.value for each in coarsen_one(target, request) if isinstance(each, Partial))
    expected = relative_errors(describe(target), describe(step.mesh))
    assert step.errors == pytest.approx({key: expected[key] for key in LOSS_KEYS}, abs=1e-6)
    assert step.jaccard_distance == pytest.approx(jaccard_distance(target, step.polyhedron), abs=0.01)
    card.show_results(Results(), choices)
    for panel in (card, bars):
        panel.show_results(Results(best=step), choices)
    table.show_results(Results(best=step))
    assert card.figures[0].text() == f"{step.loss:#.4g}"
    assert card.sentence.text() == "Best so far."
    assert bars.plot.numbers()[1][1][2] == pytest.approx(100 * expected["sphericity"], rel=1e-5)
    assert table.table.item(0, 2).text() != "–"


def test_that_a_task_appears_after_a_moment_and_can_be_stopped(shown, wait):
    panel, asked = shown(TasksPanel()), []
    panel.cancelRequested.connect(asked.append)
    panel.setValue([Task(7, "study", "RMSRE against l_max", 3, 12, "angular-1")])
    assert panel.text.text() == IDLE
    wait(panel.bar.isVisible)
    assert "3 of 12" in panel.text.text()
    panel.setValue([Task(7, "scan", "Separating touching grains", 283_404, 566_809)])
    assert panel.text.text() == "Separating touching grains (50\N{NO-BREAK SPACE}%)"
    QTest.mouseClick(panel.stop, Qt.MouseButton.LeftButton)
    assert asked == [7]
    stopping = Task(7, "scan", "Separating touching grains", stopping=True)
    panel.setValue([stopping])
    assert panel.text.text() == "Separating touching grains – Stopping …"
    panel.setValue([stopping, Task(8, "study", "RMSRE against l_max")])
    wait(lambda: panel.text.text().startswith("RMSRE"))  # the next one that can be stopped
    QTest.mouseClick(panel.stop, Qt.MouseButton.LeftButton)
    assert asked == [7, 8]
    panel.setValue([])
    assert panel.text.text() == IDLE
    assert not panel.bar.isVisible()


@dataclass(frozen=True)
class _Settings:
    switch: bool = field(default=False, metadata={"label": "A switch"})
    count: int = field(default=3, metadata={"minimum": 1, "maximum": 9})
    share: float = 0.25
    kind: str = field(default="a", metadata={"choices": ("a", "b")})


def test_that_a_form_holds_only_what_differs_from_the_defaults(shown):
    form = shown(SettingsForm(_Settings))
    assert form.value() == {}
    wanted = {"switch": True, "count": 5, "share": 0.5, "kind": "b"}
    form.setValue(wanted)
    assert form.value() == wanted
    assert form.editors["share"].text() == "0.5"  # and not 0.500
    form.setValue({})
    assert form.value() == {}


def test_that_a_form_shows_fractions_in_per_cent_and_announces_what_was_edited(shown):
    form, heard = shown(SettingsForm(CoarseningSettings, names=("largest_error", "seed"))), []
    form.edited.connect(heard.append)
    form.editors["largest_error"].field.setValue(2.5)
    form.editors["seed"].setValue(3)
    assert heard == [{"largest_error": 0.025}, {"seed": 3}]
    assert form.editors["largest_error"].field.suffix() == " %"
    assert form.values() == {"largest_error": 0.025, "seed": 3}


def test_that_a_line_is_drawn_across_a_bar_where_it_cannot_be_lower(shown):
    plot = shown(BarPlot("Descriptor", "Relative error [%]", "Nothing yet."))
    plot.set_bars(["V", "CH"], [BarSeries("Polyhedron", "#e69f00", (0.0, 12.0), bounds=(0.0, 10.0))])
    lines = [item.getData() for item in plot._items if isinstance(item, pg.PlotDataItem)]
    assert len(lines) == 1
    assert list(lines[0][1]) == [10.0, 10.0]
    assert lines[0][0].mean() == pytest.approx(1.0)
    assert "bound" in plot.legend.text()
    head, rows = plot.numbers()
    assert head == ("category", "Polyhedron [%]", "Polyhedron, not below [%]")
    assert rows == [("V", 0.0, 0.0), ("CH", 12.0, 10.0)]


def test_that_the_smallest_l_max_follows_the_error_that_is_allowed(shown):
    panel = shown(LmaxStudyPanel())
    errors = np.array([[[0.2, 0.1], [0.04, 0.06], [0.01, 0.02]]])
    study = LmaxStudy((2, 6, 10), ("volume", "sphericity"), ("a",), ("",), errors)
    for tolerance, smallest, note in ((5.0, "10", ""), (7.0, "6", ""), (0.5, "–", "none of these")):
        panel.tolerance.setValue(tolerance)
        record = panel.record(study, Choices())
        assert (record.values, record.note) == ((smallest,), note)


@pytest.mark.parametrize("steps", [1, 2, 100])
def test_that_the_loss_has_no_steps_before_the_first(shown, wait, steps):
    panel = shown(LossCurvePanel())
    panel.resize(420, 240)
    panel.show_results(Results(loss_history=tuple((step, 0.5 - step / 1000) for step in range(steps))))
    view = panel.plot.canvas.getViewBox()
    wait(lambda: view.viewRange()[0][1] >= steps - 1, 10.0)
    first, last = view.viewRange()[0]
    assert -0.5 <= first <= 0.0, "the first step can be seen, and nothing before it"
    assert last < 1.2 * steps + 1.0


def test_that_the_curve_of_the_loss_ends_at_the_result_and_names_no_better_one(shown):
    panel = shown(LossCurvePanel())
    history = ((0, 0.9), (1, 0.6), (2, 0.65))
    panel.show_results(Results(loss_history=history, coarsened=SimpleNamespace(loss=0.66)))
    assert [(curve.label, curve.y[-1]) for curve in panel.plot.curves] == [
        ("current", 0.65),
        ("result", 0.66),
    ]
    panel.show_results(Results(loss_history=history, coarsened=SimpleNamespace(loss=0.6)))
    assert [curve.label for curve in panel.plot.curves] == ["current", "best so far", "result"]


def test_that_steps_are_whole_numbers_and_a_result_without_steps_has_its_own_curve(shown):
    panel = shown(LossCurvePanel())
    panel.show_results(Results(loss_history=((0, 0.9), (1, 0.8), (0, 0.7), (1, 0.6))))
    assert panel.plot.count_axis.whole
    panel.show_results(Results(coarsened=SimpleNamespace(loss=0.3), best=SimpleNamespace()))
    assert {curve.y for curve in panel.plot.curves} == {(0.3,)}


def test_that_a_failure_is_on_the_card_and_the_curve_is_gone(shown):
    curve, card = shown(LossCurvePanel()), shown(AssessmentPanel())
    curve.show_results(Results(loss_history=((0, 0.9), (1, 0.8))))
    failed = Results(failures={"coarsening": "There is no polyhedron."})
    curve.show_results(failed)
    card.show_results(failed, Choices())
    assert curve.plot.is_empty()
    assert card.record.state is ResultState.FAILED
    assert card.record.note == "There is no polyhedron."


def test_that_a_button_names_what_it_does_and_the_finding_stands_below_it(shown):
    panel = shown(CoarseningPanel())
    panel.show_search(running=True)
    assert (panel.enough.text(), panel.finding.text()) == ("Suggest n", "Searching …")
    panel.show_sufficient(50, saturated=False, now=20, reason="")
    assert (panel.enough.text(), panel.finding.text()) == ("Use 50 facets", "Errors still fall at 50 facets.")
    panel.show_search(running=False)
    assert panel.finding.text() == "Coarsens this particle at several numbers of facets."
    assert panel.finding.isVisible(), "no empty strip below the button"
    panel.setValue(panel.value() | {"stop_at": "error"})
    assert not panel.finding.isVisible()


def test_that_the_losses_of_two_starts_are_not_joined_by_a_line(shown):
    panel = shown(LossCurvePanel())
    panel.show_results(Results(loss_history=((0, 0.9), (1, 0.8), (0, 0.7), (1, 0.6))))
    current, best = panel.plot.curves
    assert current.y == pytest.approx((0.9, 0.8, np.nan, 0.7, 0.6), nan_ok=True)
    assert current.x == pytest.approx((0, 1, np.nan, 0, 1), nan_ok=True)
    assert best.y == pytest.approx(current.y, nan_ok=True)
