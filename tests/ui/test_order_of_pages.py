"""One order for all pages: results in the middle, choices at the right, their button below them."""

import pytest
from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QPushButton, QScrollArea, QWidget

from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.choices import Choices
from regolith_studio.session.session import Session
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.pages.dataset.views import SIZE
from regolith_studio.ui.widgets.formula import BREAK, LOWEST_LINE, MIN_LINE_HEIGHT, FormulaLabel

WITH_CHOICES = ("explore", "scan", "model", "dataset")
"""On the page Angle of repose the choices are behind its answer, in a tab; on Studies above all tabs."""
BUTTONS = {
    "model": ("model_fit", "model_half"),
    "dataset": ("dataset_find", "dataset_count"),
}
"""A button of each page, and a setting that it uses."""


@pytest.fixture
def window(shown, preferences):
    session = Session(InlineRunner(), Choices(method="quadric", level=2))
    made = MainWindow(session, preferences, "image")
    made.resize(1280, 800)
    session.adopt([Particle("ball", icosphere(2).moved(scale=40.0))])
    return shown(made)


def place(part, page):
    return part.mapTo(page, QPoint())


def test_that_choices_are_at_the_right_of_every_page_and_above_their_button(window, app):
    for key in WITH_CHOICES:
        page = window.go(key)
        app.processEvents()
        controls = page.findChild(QScrollArea, "controls")
        assert place(controls, page).x() > 0.5 * page.width(), key
        assert place(controls, page).x() + controls.width() >= page.width() - 12, key
        if key in BUTTONS:
            button, setting = (page.findChild(QWidget, name) for name in BUTTONS[key])
            assert place(button, page).y() > place(setting, page).y(), key
        if key == "dataset":  # the thumbnails have their room
            assert page.gallery.list.iconSize().width() >= 120
            assert page.gallery.height() >= SIZE + 2 * page.fontMetrics().lineSpacing()
    page = window.go("studies")
    app.processEvents()
    assert page.findChild(QPushButton, "coarsening_study_result_button").isVisible()


def test_that_no_line_of_a_formula_is_lower_than_twenty_pixels_however_narrow(shown, wait):
    label = shown(FormulaLabel("The loss"))
    label.set_lines(BREAK.join(f"${sign}0.12{n}_J$" for n, sign in enumerate(("L=", "+", "+", "+", "="))))
    wait(lambda: label.sizeHint().width() > 5)
    heights = []
    for width in (600, 180):
        label.resize(width, 100)
        rows = label.rows()
        heights.append((len(rows), label.sizeHint().height()))
        assert all(begin * label._scale() < width for row in rows for begin, _ in row)
        assert label._scale() * LOWEST_LINE.height() >= MIN_LINE_HEIGHT - 1e-9
    (few, low), (many, high) = heights
    assert few == 1 < many
    assert high >= many * MIN_LINE_HEIGHT > low
