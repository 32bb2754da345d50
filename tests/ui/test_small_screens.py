"""Windows with little room: a screen of 1920x1080 pixels at a scale of two leaves 960x540."""

import pytest
from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QHBoxLayout, QLineEdit, QScrollArea, QWidget

from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.choices import Choices
from regolith_studio.session.session import Session
from regolith_studio.ui.appearance import FONT_SIZE
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.page import ScrollablePage
from regolith_studio.ui.pages import PAGES
from regolith_studio.ui.pages.explore.plots import FONT_SIZE as LETTERS_OF_TWO
from regolith_studio.ui.theme import choose_font_size
from regolith_studio.ui.widgets.fields import ElidedComboBox, text_room
from regolith_studio.ui.widgets.plots.base import plain_text

SCREEN = QSize(960, 540)
FRAME = 40
"""Pixels that a title bar and a panel of the desktop take."""


@pytest.fixture
def usual_font(app):
    usual = app.font()
    yield
    choose_font_size(None)
    app.setFont(usual)


@pytest.mark.usefixtures("usual_font")
@pytest.mark.parametrize("letters", [100, pytest.param(150, marks=pytest.mark.slow), 200])
def test_that_the_window_fits_a_small_screen_at_any_size_of_letters(shown, preferences, letters, app):
    preferences.window = preferences.window | {FONT_SIZE: letters}
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    app.processEvents()
    least = window.minimumSizeHint()
    assert least.width() <= SCREEN.width()
    assert least.height() <= SCREEN.height() - FRAME
    assert all(button.isVisible() for button in window.pages.buttons.values())


@pytest.mark.slow
@pytest.mark.usefixtures("usual_font")
@pytest.mark.parametrize(("language", "letters"), [("en", 100), ("de", 125), ("de", 200)])
def test_that_no_page_is_scrolled_sideways_on_a_small_screen(
    shown, preferences, app, speaking, language, letters
):
    speaking(language)
    preferences.window = preferences.window | {FONT_SIZE: letters}
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.resize(1280, 800)
    for key in PAGES:
        window.go(key)
        for _ in range(5):
            app.processEvents()
        area = window.page.parentWidget().parentWidget()
        assert area.horizontalScrollBar().maximum() == 0, key


@pytest.mark.slow
@pytest.mark.usefixtures("usual_font")
@pytest.mark.parametrize("language", ["en", "de"])
def test_that_pages_are_only_scrolled_down_with_a_font_of_twice_the_size(
    shown, preferences, app, speaking, language
):
    speaking(language)
    preferences.window = preferences.window | {FONT_SIZE: 200}
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.session.adopt([Particle(f"grain-{k}", icosphere(1).moved(scale=20.0 + k)) for k in range(3)])
    for width, height in ((960, 540), (1280, 800), (1920, 1080)):
        window.resize(width, height)
        for key in PAGES:
            page = window.go(key)
            for _ in range(8):
                app.processEvents()
            area = page.parentWidget().parentWidget()
            assert area.horizontalScrollBar().maximum() == 0, (key, width)
            if key == "dataset" or (width == SCREEN.width() and key in ("explore", "model")):
                column = page.findChild(QScrollArea, "controls").verticalScrollBar()
                assert 0 in (column.maximum(), area.verticalScrollBar().maximum()), (key, width)
            if key == "sample":
                for figure in page.statistics.card.figures:
                    least = figure.minimumSizeHint()
                    assert figure.width() >= least.width(), (figure.text(), width)
                    assert figure.height() >= least.height(), (figure.text(), width)


@pytest.mark.usefixtures("usual_font")
def test_that_the_buttons_of_studies_are_whole_in_large_letters(shown, preferences, app):
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.resize(1280, 800)
    page = window.go("studies")
    for letters in (150, 200):
        window.appearance.choose(**{FONT_SIZE: letters})
        for _ in range(5):
            app.processEvents()
        for tab in range(page.tabs.count()):
            page.tabs.setCurrentIndex(tab)
            app.processEvents()
            button = page.tabs.widget(tab).card.button
            assert button.visibleRegion().boundingRect() == button.rect(), letters
            assert button.width() >= button.fontMetrics().horizontalAdvance(button.text()) + 8


def test_that_a_page_too_wide_for_the_window_scrolls_to_what_has_the_focus(shown, wait):
    page = QWidget()
    row = QHBoxLayout(page)
    fields = [QLineEdit() for _ in range(4)]
    for field in fields:
        field.setMinimumWidth(300)
        row.addWidget(field)
    room = ScrollablePage(page)
    room.resize(500, 200)
    shown(room)
    assert page.width() >= 1200
    for field in (fields[-1], fields[0]):
        room.ensureWidgetVisible(fields[0])
        room.activateWindow()
        field.setFocus()
        room.focusNextPrevChild(True)
        focused = room.focusWidget()
        wait(lambda one=focused: not one.visibleRegion().isEmpty(), 5.0)
    room.resize(1400, 200)
    assert page.width() == room.viewport().width()


def framed(view):
    """Half of what the shorter side of a view shows, in micrometres."""
    width, height = view.widget.width(), view.widget.height()
    return view.pose.parallel_scale * min(1.0, width / height)


def test_that_an_enlarged_view_shows_the_particle_as_large_as_it_can(shown, preferences, settled):
    session = Session(InlineRunner(), Choices(method="quadric"))  # which needs no kernels to be compiled
    window = shown(MainWindow(session, preferences, "image"))
    session.open_sample()
    settled(window)
    views = window.page.three_views.views
    window.menus.by_name["explore.reset"].trigger()
    usual = framed(views["particle"])
    for name in ("particle", "fit", "polyhedron"):
        window.menus.by_name["explore.enlarge"].trigger()
        settled(window)
        assert framed(views[name]) == pytest.approx(usual, rel=0.02)


def test_that_bodies_are_framed_again_when_the_window_or_a_border_is_moved(shown, preferences, settled, wait):
    session = Session(InlineRunner(), Choices(method="quadric"))
    window = shown(MainWindow(session, preferences, "image"))
    session.open_sample()
    window.resize(1920, 1080)
    settled(window)
    views = window.page.three_views.views
    window.menus.by_name["explore.reset"].trigger()
    usual = framed(views["particle"])
    for width, height in ((960, 540), (1280, 800), (1920, 1080)):
        window.resize(width, height)
        wait(lambda width=width: window.width() == width)
        settled(window)
        assert [framed(view) for view in views.values()] == pytest.approx([usual] * 3, rel=0.02)
    turned = views["fit"].pose
    window.page.three_views.setSizes([200, 200, 700])
    settled(window)
    assert views["particle"].widget.width() < views["polyhedron"].widget.width() / 2
    assert [framed(view) for view in views.values()] == pytest.approx([usual] * 3, rel=0.02)
    assert {view.pose.position for view in views.values()} == {turned.position}


@pytest.mark.usefixtures("usual_font")
@pytest.mark.parametrize(
    "letters", [100, pytest.param(150, marks=pytest.mark.slow), pytest.param(200, marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("width", [1280, pytest.param(1920, marks=pytest.mark.slow)])
def test_that_the_legends_of_explore_are_whole(shown, preferences, settled, app, letters, width):
    preferences.window = preferences.window | {FONT_SIZE: letters}
    session = Session(InlineRunner(), Choices(method="quadric"))
    window = MainWindow(session, preferences, "image")
    window.resize(width, 800 if width == 1280 else 1080)
    shown(window)
    session.open_sample()
    settled(window)
    for _ in range(3):
        app.processEvents()
    page = window.page
    for panel in (page.plots.error_bars, page.plots.loss_curve):
        legend = panel.plot.legend
        panel.parentWidget().setCurrentWidget(panel)
        app.processEvents()
        entries = plain_text(legend.text()).replace("\xa0", "_").split()
        assert entries
        assert max(map(legend.fontMetrics().horizontalAdvance, entries)) <= legend.width()


@pytest.mark.usefixtures("usual_font")
def test_that_methods_and_most_presets_are_whole_with_a_font_of_twice_the_size(shown, preferences, app):
    preferences.window = preferences.window | {FONT_SIZE: 200}
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.resize(1280, 800)
    for _ in range(5):
        app.processEvents()
    page = window.page
    method, preset = page.coarsening.method, page.loss.preset
    methods = [method.itemText(row) for row in range(method.count())]
    for box, texts in (
        (method, methods),
        (preset, ("All descriptors and overlap", "Aspect ratio and overlap")),
    ):
        assert max(map(box.fontMetrics().horizontalAdvance, texts)) <= text_room(box)


def test_that_explore_does_not_scroll_on_a_small_screen_below_a_title_bar(shown, preferences, settled):
    session = Session(InlineRunner(), Choices(method="quadric"))
    window = shown(MainWindow(session, preferences, "image"))
    session.open_sample()
    window.resize(1280, 800 - FRAME)
    settled(window)
    controls = window.page.findChild(QScrollArea, "controls")
    bars = [each.verticalScrollBar() for each in (controls, *window.pages.scroll_areas)]
    assert [bar.maximum() for bar in bars] == [0, 0]


def test_that_several_messages_of_the_log_are_seen_at_once(shown, preferences, wait):
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.resize(1280, 800)
    window.activity.show_tab("log")
    log = window.activity.log.text
    wait(lambda: log.height() >= 7 * log.fontMetrics().lineSpacing(), 10.0)


def test_that_plots_stand_behind_each_other_only_where_two_have_no_room(shown, preferences):
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    plots = window.page.plots
    everything = {plots.error_bars, plots.table, plots.section, plots.loss_curve, plots.spectrum}
    least = LETTERS_OF_TWO * plots.fontMetrics().horizontalAdvance("0")
    for width, beside in ((least, 2), (least - 1, 0), (least, 2)):
        plots.resize(width, 300)
        tabs = [[group.widget(at) for at in range(group.count())] for group in (plots.left, plots.right)]
        assert {panel for group in tabs for panel in group} == everything
        assert len(tabs[1]) == beside
        assert plots.right.isVisible() == bool(beside)


@pytest.mark.parametrize("points", [7.3, 9.0, 11.7])
def test_that_a_box_as_wide_as_it_prefers_shows_its_longest_label_whole(shown, app, points):
    box = ElidedComboBox()
    box.prefers_whole = True
    font = box.font()
    font.setPointSizeF(points)
    box.setFont(font)
    box.setMinimumContentsLength(2)
    box.addItems(["Exact minimum volume", "Volume"])
    shown(box).resize(box.sizeHint())
    app.processEvents()
    right = Qt.TextElideMode.ElideRight
    for row in range(box.count()):
        label = box.itemText(row)
        assert box.fontMetrics().elidedText(label, right, text_room(box)) == label
