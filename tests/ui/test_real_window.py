"""The real window on a display, driven by mouse and keys only: from "open file" to a dataset on disk.

With ``REGOLITH_STUDIO_UPDATE=1`` the picture of the documentation is written anew.
"""

import os
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QRect, Qt, QTimer
from PySide6.QtGui import QColor, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QLineEdit,
    QSlider,
    QWidget,
)

from regolith_studio.dataset.folder_io import read_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.resources import resource
from regolith_studio.ui.dialogs.files import UnitDialog
from regolith_studio.ui.dialogs.help import Tour, start_tour
from regolith_studio.ui.startup import open_window
from regolith_studio.ui.theme import current_theme

pytestmark = pytest.mark.window

DOCUMENTATION = Path(__file__).resolve().parents[2] / "docs" / "images" / "window.png"
SECONDS = 60.0


@pytest.fixture
def window(shown, preferences, drawn):
    if QGuiApplication.platformName() == "offscreen":
        pytest.skip("needs a display")
    made = open_window(views="live", preferences=preferences)
    made.resize(1480, 900)
    shown(made)
    QTest.qWaitForWindowExposed(made)
    drawn(made)
    return made


@pytest.fixture
def drawn(wait, settled):
    """Lets the event loop run until a window shows its polyhedron."""

    def run(window):
        wait(lambda: window.session.results.coarsened is not None, SECONDS)
        settled(window)
        QTest.qWait(50)  # the display server has painted, too

    return run


def pictures(window):
    return [view.picture().astype(int) for view in window.page.three_views.views.values()]


def difference(one, other):
    height, width = np.minimum(one.shape, other.shape)[:2]
    return float(np.abs(one[:height, :width] - other[:height, :width]).mean())


def differing(before, after):
    return [difference(one, other) > 0.2 for one, other in zip(before, after, strict=True)]


def coverage(picture):
    """Share of a picture that is not background: a gradient of nearly grey colours, row by row."""
    return float((np.abs(picture - picture[:, :1]).max(axis=2) > 12).mean())


def until_gone(kind, act):
    """While a modal dialog of this kind is open, act on it again and again; give it up after a while."""
    seen = []

    def look():
        dialog = visible(kind)
        if dialog is None:
            return
        seen.append(dialog.objectName())
        if len(seen) > 80:
            dialog.reject()
        else:
            act(dialog)

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(80)
    return timer


def visible(kind):
    return next(
        (each for each in QApplication.topLevelWidgets() if isinstance(each, kind) and each.isVisible()), None
    )


def click(widget, pos=None):
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=pos or widget.rect().center())


def activate(window):
    """Bring the window to the front; shortcuts belong to the window that is active."""
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, 5000)


def write(field, text):
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)


def drag_slider(slider, share):
    """Press the handle of a slider, pull it to a share of its length in steps, let go."""
    from PySide6.QtWidgets import QStyle, QStyleOptionSlider

    option = QStyleOptionSlider()
    slider.initStyleOption(option)
    handle = (
        slider.style()
        .subControlRect(QStyle.ComplexControl.CC_Slider, option, QStyle.SubControl.SC_SliderHandle, slider)
        .center()
    )
    end = QPoint(round(share * slider.width()), handle.y())
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=handle)
    for step in range(1, 9):
        QTest.mouseMove(slider, handle + (end - handle) * step / 8)
        QTest.qWait(15)
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=end)


def answer_file_dialog(path):
    def act(dialog):
        field = dialog.findChild(QLineEdit, "fileNameEdit")
        if field.text() != str(path):
            write(field, str(path))
        else:
            click(dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open))

    return until_gone(QFileDialog, act)


def answer_unit_dialog():
    def act(dialog):
        click(dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Open))

    return until_gone(UnitDialog, act)


def open_by_keys(window, path, wait):
    """Ctrl+O, the path, Open; then the unit."""
    timers = [answer_file_dialog(path), answer_unit_dialog()]
    activate(window)
    QTest.keyClick(window, Qt.Key.Key_O, Qt.KeyboardModifier.ControlModifier)
    wait(lambda: [entry.id for entry in window.page.particles.entries()] == [path.stem], SECONDS)
    for timer in timers:
        timer.stop()


@pytest.mark.slow
def test_that_a_file_becomes_a_dataset_by_mouse_and_keys_alone(window, wait, drawn, tmp_path):
    drawn(window)
    sample = pictures(window)
    open_by_keys(window, resource("samples", "particles", "elongated-1.stl"), wait)
    drawn(window)
    first = pictures(window)
    assert all(coverage(picture) > 0.03 for picture in first)
    assert all(difference(one, two) > 0.5 for one, two in zip(sample, first, strict=True))
    assert difference(first[0], first[1]) > 0.5
    assert difference(first[1], first[2]) > 0.5

    drag_slider(window.findChild(QSlider, "l_max_slider"), 0.1)
    wait(lambda: window.session.choices.l_max < 6)
    drawn(window)
    second = pictures(window)
    assert differing(first, second) == [False, True, True]

    drag_slider(window.findChild(QSlider, "weight_volume_slider"), 0.95)
    wait(lambda: window.session.choices.weights["volume"] > 1.5)
    drag_slider(window.findChild(QSlider, "n_facets_slider"), 0.1)
    wait(lambda: window.session.choices.n_facets < 16)
    drawn(window)
    third = pictures(window)
    assert [difference(one, two) > 0.2 for one, two in zip(second, third, strict=True)] == [
        False,
        False,
        True,
    ]

    turn = window.page.three_views.views["fit"].widget.childAt(60, 60)
    QTest.mousePress(turn, Qt.MouseButton.LeftButton, pos=QPoint(60, 60))
    QTest.mouseMove(turn, QPoint(160, 90))
    QTest.mouseRelease(turn, Qt.MouseButton.LeftButton, pos=QPoint(160, 90))
    wait(lambda: differing(third, pictures(window)) == [True, True, True])

    folder = tmp_path / "dataset"
    activate(window)
    QTest.keyClick(window, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    wait(lambda: window.pages.current == "dataset")
    window.page.representatives.which.setCurrentIndex(1)
    window.page.build_in(folder)
    wait(lambda: window.session.dataset_folder == folder, SECONDS)
    assert list(validate_dataset(folder)) == []
    assert read_dataset(folder) is not None


def on_screen(window, area):
    """What the display really shows of an area of the window; `grab` would draw it anew."""
    picture = window.screen().grabWindow(window.winId(), area.x(), area.y(), area.width(), area.height())
    return picture.toImage()


def accented(picture):
    """Share of the dots that have the colour of the tour's frame."""
    accent = QColor(current_theme().accent).rgb()
    dots = [(x, y) for x in range(picture.width()) for y in range(picture.height())]
    return sum(picture.pixel(x, y) == accent for x, y in dots) / len(dots)


@pytest.mark.slow
def test_that_the_tour_goes_on_with_return_and_leaves_no_frame_behind(window, wait, settled):
    activate(window)
    tour = start_tour(window, window.go, window.preferences)
    three_views = window.page.three_views
    corner = three_views.mapTo(window, QPoint(0, 0))
    middle_of_the_left_edge = QRect(corner.x() - 3, corner.y() + three_views.height() // 2, 3, 40)
    wait(lambda: accented(on_screen(window, middle_of_the_left_edge)) > 0.3)
    QTest.keyClick(tour.next, Qt.Key.Key_Return)
    assert tour.at == 1
    wait(lambda: accented(on_screen(window, middle_of_the_left_edge)) == 0)
    QTest.keyClick(tour.back, Qt.Key.Key_Return)
    assert tour.at == 0
    wait(lambda: accented(on_screen(window, middle_of_the_left_edge)) > 0.3)
    tour.finish()
    wait(lambda: accented(on_screen(window, middle_of_the_left_edge)) == 0)
    settled(window)


@pytest.mark.slow
def test_that_the_frame_of_the_tour_is_hidden_on_another_page(window, settled):
    window.show_tour()
    tour = window.findChild(Tour)
    assert tour.isVisible()
    window.go("dataset")
    window.resize(window.width() - 10, window.height())
    assert not tour.isVisible()
    window.go("explore")
    assert tour.isVisible()
    QTest.mouseClick(tour.end, Qt.MouseButton.LeftButton)
    settled(window)


@pytest.mark.slow
def test_that_the_picture_of_the_documentation_can_be_taken(window, drawn):
    window.session.select("angular-1")
    drawn(window)
    QTest.qWait(400)
    picture = window.grab().toImage()
    for frame in window.page.three_views.frames.values():
        corner = frame.view.widget.mapTo(window, QPoint(0, 0))
        size = frame.view.widget.size()
        inside = picture.copy(corner.x(), corner.y(), size.width(), size.height())
        colours = {inside.pixel(x, size.height() // 2) for x in range(0, size.width(), 4)}
        assert len(colours) > 3, f"{frame.objectName()} is empty in the picture"
    assert not any(isinstance(each, QDialog) and each.isVisible() for each in window.findChildren(QWidget))
    if os.environ.get("REGOLITH_STUDIO_UPDATE"):
        DOCUMENTATION.parent.mkdir(parents=True, exist_ok=True)
        assert picture.save(str(DOCUMENTATION))
