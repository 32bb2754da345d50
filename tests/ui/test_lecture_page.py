"""The page "Lecture": played, stepped, drawn anew; every formula can be set."""

import re
from functools import partial

import numpy as np
import pytest
import shiboken6
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest

from regolith_studio.coarsening.loss import Evaluation
from regolith_studio.coarsening.progress import Move
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.lecture_jobs import AnnealingStep, DegreeStep, trace_degrees
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.scene.lecture_scenes import FACET_OLD, FRAME_NEW
from regolith_studio.session.session import Session
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.pages.lecture import PAGE, texts
from regolith_studio.ui.pages.lecture.lessons import PlaybackBar
from regolith_studio.ui.theme import DARK, LIGHT, choose_font_size
from regolith_studio.ui.views.view import ViewFrame
from regolith_studio.ui.widgets.formula import FormulaLabel
from regolith_studio.ui.widgets.plots.base import Plot

EGG = icosphere(3).moved(rotation=np.diag([30.0, 20.0, 45.0]))
CIGAR = icosphere(2).moved(rotation=np.diag([10.0, 12.0, 60.0]))


@pytest.fixture
def page(page_of, monkeypatch):
    coarse = partial(trace_degrees, level=3)
    monkeypatch.setattr("regolith_studio.ui.pages.lecture.page.trace_degrees", coarse)
    session = Session(InlineRunner())
    session.choose(n_facets=12, method="annealing", settings=(("iterations", 25),), l_max=4)
    session.adopt([Particle(name="egg", mesh=EGG), Particle(name="cigar", mesh=CIGAR)])
    return page_of(PAGE, 1200, 760, session)


def actor(frame, name):
    found = frame.view._plotter.actors.get(name)
    return found if found is not None and found.GetVisibility() else None


def test_that_every_step_of_the_annealing_is_shown_said_and_set(page):
    lesson = page.annealing._lesson
    assert len(lesson.steps) == 26
    playback, outcomes = page.annealing.playback, set()
    for number, step in enumerate(lesson.steps):
        playback.go(number)
        outcome = texts.outcome_of(step)
        outcomes.add(outcome)
        said = page.annealing.sentence.text()
        assert {"refused": "Rejected", "accepted": "accepted", "lucky": "probability", "start": "start"}[
            outcome
        ] in said
        if step.move is not None:
            assert f"Plane {step.move.plane + 1} of 12" in said
            frame = page.annealing.frames["annealing"]
            other = step.before if step.move.accepted else step.proposal
            assert (actor(frame, FRAME_NEW) is not None) == (other is not None)
            facet = step.proposed_facet if step.move.accepted else step.facet
            assert (actor(frame, FACET_OLD) is not None) == (facet is not None)
    assert {"start", "refused", "accepted"} <= outcomes
    assert len(page.annealing.loss.curves[0].x) == 26
    assert page.annealing.loss.curves[-1].y[0] == lesson.exact.loss


@pytest.mark.slow
@pytest.mark.parametrize("name", ["annealing", "exact"])
def test_that_the_polyhedra_of_both_methods_are_whole_in_their_views(page, name, wait):
    session = page._session
    session.choose(n_facets=20, l_max=10)
    session.open_sample()  # the first particle is so rough that its polyhedra stand out far
    wait(lambda: session.choices.selected == "agglutinate-1")
    wait(lambda: page.annealing._lesson.approximated is session.results.surface)
    wait(lambda: page.annealing._lesson.exact is not None)
    lesson, view = page.annealing._lesson, page.annealing.frames[name].view
    pose, focus = view.pose, np.array(view.pose.focal_point)
    towards = pose.position - focus
    side = np.cross(pose.view_up, towards)
    up = np.cross(towards, side)
    seen = {"annealing": lesson.steps[0].polyhedron, "exact": lesson.exact.polyhedron}[name]
    places = seen.mesh.vertices + lesson.centre - focus
    aspect = view.widget.width() / view.widget.height()
    assert np.abs(places @ up / np.linalg.norm(up)).max() < pose.parallel_scale
    assert np.abs(places @ side / np.linalg.norm(side)).max() < pose.parallel_scale * aspect


def test_that_the_numbers_of_the_loss_add_up_to_the_loss(page):
    lesson = page.annealing._lesson
    for step in lesson.steps:
        terms = texts.terms_of(lesson.weights, step.evaluation)
        assert sum(terms.values()) == pytest.approx(step.evaluation.loss)
        line = " ".join(texts.loss_lines(lesson.weights, step.evaluation))
        numbers = [float(number) for number in re.findall(r"[-\d.e]+(?=_\{)", line)]
        assert len(numbers) == sum(term >= 5e-5 for term in terms.values())
        assert sum(numbers) == pytest.approx(step.evaluation.loss, rel=0.01, abs=4e-4)


def test_that_it_plays_by_itself_pauses_and_steps_back(page, wait):
    playback = page.annealing.playback
    playback.speed.setValue(20)
    commands = page.commands()
    commands["play"]()
    wait(lambda: playback.step >= 3, 10.0)
    commands["back"]()
    here = playback.step
    assert not playback.playing
    QTest.qWait(150)
    assert playback.step == here
    commands["forward"]()
    assert playback.step == here + 1
    playback.go(25)
    commands["play"]()  # at the end: from the beginning
    assert playback.playing
    assert playback.step < 25
    page.on_hide()
    assert not playback.playing


def test_that_space_plays_and_arrows_step_on_the_page(page):
    page.on_show()
    playback = page.annealing.playback
    QTest.keyClick(page, Qt.Key.Key_Right)
    assert playback.step == 1
    QTest.keyClick(page, Qt.Key.Key_Left)
    assert playback.step == 0
    QTest.keyClick(page, Qt.Key.Key_Space)
    assert playback.playing
    assert not page.particle.hasFocus()


def test_that_the_page_takes_the_keys_from_the_sidebar(shown, preferences):
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.pages.buttons["lecture"].setFocus()
    window.go("lecture")
    assert window.focusWidget() is window.page


@pytest.mark.slow
def test_that_the_page_fills_the_screen_and_escape_ends_it(page):
    page.commands()["full_screen"]()
    assert page.isFullScreen()
    QTest.keyClick(page, Qt.Key.Key_Escape)
    assert not page.isFullScreen()


@pytest.mark.slow
def test_that_another_seed_is_another_run_and_a_project_remembers_it(page):
    before = page.annealing._lesson.steps
    page.commands()["another"]()
    after = page.annealing._lesson.steps
    assert [step.evaluation.loss for step in before] != [step.evaluation.loss for step in after]
    state = page.state()
    page.commands()["another"]()
    page.restore(state)
    assert [s.evaluation.loss for s in page.annealing._lesson.steps] == [s.evaluation.loss for s in after]


@pytest.mark.slow
def test_that_the_lesson_follows_the_particle_and_the_choices(page, wait):
    page.particle.setCurrentIndex(1)
    assert page._session.choices.selected == "cigar"
    wait(lambda: page.annealing._lesson.approximated is page._session.results.surface, 20.0)
    page._session.choose(n_facets=8)
    wait(lambda: page.annealing._lesson.n_facets == 8)
    page._session.choose(settings=(("iterations", 5000),))
    wait(lambda: "at most 2,000" in page.annealing.sentence.text())


@pytest.mark.slow
def test_that_the_degrees_grow_from_a_sphere(page):
    page.tabs.setCurrentIndex(1)
    playback = page.degrees.playback
    assert playback.slider.maximum() == 30
    for degree in (0, 5, 30):
        playback.go(degree)
        assert f"l<sub>max</sub> = {degree}:" in page.degrees.sentence.text()
        assert f"={(degree + 1) ** 2}$" in page.degrees.formula.lines()[1]
        assert len(page.degrees.errors.curves[0].x) == degree + 1
    spread = page.degrees.frames["fit"].view._plotter.actors["surface"].mapper.dataset
    assert np.ptp(spread.points[:, 2]) == pytest.approx(90.0, rel=0.02)


def test_that_a_dragged_bar_changes_the_field_and_a_button_draws_it_anew(page):
    page.tabs.setCurrentIndex(2)
    field = page.field
    first = field.drawn.values.copy()
    page.commands()["another"]()
    assert np.abs(field.drawn.values - first).max() > 0.01
    spread = field.drawn.values.std()
    editor = field.spectrum
    view = editor.canvas.getViewBox()
    place = editor.canvas.mapFromScene(view.mapViewToScene(QPointF(2, np.log10(30.0))))
    viewport = editor.canvas.viewport()
    QTest.mousePress(viewport, Qt.MouseButton.LeftButton, pos=place)
    QTest.mouseRelease(viewport, Qt.MouseButton.LeftButton, pos=place)
    assert field.drawn.values.std() > 1.5 * spread
    (share,) = re.findall(r"(\d+)\\%_\{\\,2\}", field.formula.lines()[1])
    assert 27 <= int(share) <= 33  # 30 % to within a pixel of the plot
    assert "Degree 2 is the strongest" in field.sentence.text()
    field.reset.click()
    assert field.drawn.values.std() == pytest.approx(spread)


@pytest.mark.slow
def test_that_letters_and_formulas_grow_and_the_theme_changes(page, wait):
    wait(lambda: page.annealing.rule.sizeHint().height() > page.annealing.rule.fontMetrics().height())
    before, high = page.annealing.sentence.fontMetrics().height(), page.annealing.rule.sizeHint().height()
    page.commands()["larger"]()
    page.commands()["larger"]()
    assert page.annealing.sentence.fontMetrics().height() > before
    assert page.annealing.rule.sizeHint().height() > high
    page.set_theme(DARK)
    assert page._context.recall("font_size") > 1.5


@pytest.mark.slow
def test_that_letters_that_are_large_everywhere_are_not_enlarged_twice(page, app):
    sentence = page.annealing.sentence
    usual = sentence.font().pointSizeF()
    assert usual > app.font().pointSizeF()
    try:
        choose_font_size(200)
        page.set_theme(LIGHT)
        assert sentence.font().pointSizeF() == pytest.approx(app.font().pointSizeF(), abs=0.1)
    finally:
        choose_font_size(None)
    page.set_theme(LIGHT)
    assert sentence.font().pointSizeF() == pytest.approx(usual)


@pytest.mark.slow
def test_that_a_formula_has_its_height_beside_a_plot_that_is_asked_to_be_higher(page, wait):
    """Its legend wraps, so Qt took the height that it likes for the least that it needs."""
    page.tabs.setCurrentWidget(page.field)
    formula = page.field.formula
    wait(lambda: formula.sizeHint().height() > 2 * formula.fontMetrics().height())
    wait(lambda: formula.height() == formula.sizeHint().height(), 5.0)


def test_that_a_formula_is_drawn_in_ink_and_shrinks_to_its_room(shown, wait):
    label = shown(FormulaLabel("energy"))
    label.set_lines(r"$E=m\,c^2$", r"$\frac{1}{2}\sum_i x_i$")
    wait(lambda: label.sizeHint().height() > 2 * label.fontMetrics().height())
    label.resize(label.sizeHint())
    wide = label.grab().toImage()
    ground = wide.pixelColor(0, 0)
    inked = [
        (x, y)
        for x in range(wide.width())
        for y in range(wide.height())
        if abs(wide.pixelColor(x, y).lightness() - ground.lightness()) > 80
    ]
    assert len(inked) > 100
    assert max(x for x, _ in inked) > 0.8 * wide.width()
    for share in (0.67, 0.4):
        label.resize(round(share * label.sizeHint().width()), label.sizeHint().height())
        narrow = label.grab().toImage()
        right = [narrow.pixelColor(narrow.width() - 1, y) for y in range(narrow.height())]
        assert all(colour == ground for colour in right)


def test_that_a_label_whose_formula_was_never_set_can_go(shown, wait):
    label, other = FormulaLabel("gone"), shown(FormulaLabel("stays"))
    label.set_lines(r"$never\;set$")
    shiboken6.delete(label)
    other.set_lines(r"$set\;at\;last$")
    wait(lambda: other.sizeHint().width() > 20)


@pytest.mark.slow
def test_that_a_stopped_lesson_says_so_and_begins_again_at_the_next_visit(page):
    page._stopped()
    assert "Stopped" in page.annealing.sentence.text()
    page.on_hide()
    page.on_show()
    assert "start" in page.annealing.sentence.text()


@pytest.mark.slow
def test_that_plots_are_high_enough_for_their_letters_in_a_low_window(page, app):
    page.resize(900, 420)
    for _ in range(3):
        app.processEvents()
    annealing = (page.annealing.loss, page.annealing.chance, page.annealing.terms)
    for plot in (*annealing, page.degrees.errors, page.field.spectrum):
        assert plot.minimumHeight() == 11 * plot.fontMetrics().height()
    for plot in annealing:
        assert plot.height() >= plot.minimumHeight()
        assert plot.legend.height() + 4 * plot.fontMetrics().height() < plot.height()


@pytest.mark.slow
@pytest.mark.parametrize("place", range(3))
def test_that_all_plots_of_a_lesson_are_seen_at_once_in_a_small_window(page, place, app):
    page.resize(1150, 650)  # what a window of 1280 x 800 leaves for it
    page.tabs.setCurrentIndex(place)
    app.processEvents()
    lesson = page.tabs.currentWidget()
    plots = [each for each in lesson.findChildren(Plot) if each.isVisibleTo(lesson)]
    assert plots
    for each in plots:
        assert each.visibleRegion().boundingRect().size() == each.size(), each.objectName()


@pytest.mark.slow
def test_that_a_view_keeps_a_third_of_a_low_window(page, app):
    page.resize(960, 540)
    app.processEvents()
    frames = [each for each in page.findChildren(ViewFrame) if each.isVisible()]
    assert frames
    assert all(frame.height() >= page.window().height() // 3 for frame in frames)


def test_that_losses_that_differ_by_rounding_neither_fall_nor_have_sixteen_digits():
    """A plane that bounds no facet was moved: the numbers are of such a step."""
    before, after = (Evaluation({}, loss, loss) for loss in (0.5869966240911841, 0.5869966240911836))
    move = Move(2, np.zeros((12, 3)), 0.1, before, after, 0.1, 0.5, True)
    step = AnnealingStep(4, None, after, move)
    words = texts.sentence_of(step, None)
    assert "the loss does not change" in words
    assert "0.5869" not in words
    assert "<0" not in texts.decision_line(step)


def test_that_german_nouns_keep_their_capitals_within_a_sentence(speaking):
    speaking("de")
    assert texts.in_a_sentence("Volume") == "Volumen"
    sentence = texts.degree_sentence(DegreeStep(3, icosphere(0), {"volume": 0.2}, 0.1, 1.0))
    assert sentence.endswith("Volumen 20,0\N{NO-BREAK SPACE}%.")


def test_that_the_number_of_a_step_has_room_in_letters_that_the_label_gets_later(shown, app):
    bar = shown(PlaybackBar("bar", "step"))
    bar.set_count(101)
    for size in (9, 20):
        bar.clock.setStyleSheet(f"font-size: {size}pt")
        bar.resize(300, bar.sizeHint().height())
        app.processEvents()
        assert bar.clock.width() >= bar.clock.fontMetrics().horizontalAdvance(bar.clock.text())
