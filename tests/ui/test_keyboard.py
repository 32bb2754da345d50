"""The window without a mouse: Tab reaches every control of every page, and each has a name."""

import numpy as np
import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSlider,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QDialog,
    QHeaderView,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QScrollBar,
    QTabBar,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.jobs.runners import InlineRunner
from regolith_studio.session.choices import Choices
from regolith_studio.session.session import Session
from regolith_studio.ui.dialogs.files import UnitDialog
from regolith_studio.ui.dialogs.help import CitationLinks
from regolith_studio.ui.main_window import MainWindow
from regolith_studio.ui.pages import PAGES
from regolith_studio.ui.result_card import ResultRecord, ResultState, ResultView
from regolith_studio.ui.views.view import WHEEL_ZOOM, ViewFrame
from regolith_studio.ui.widgets.labels import CitingLabel

KINDS = (
    *(QAbstractButton, QComboBox, QAbstractSpinBox, QAbstractSlider),
    *(QLineEdit, QAbstractItemView, QPlainTextEdit, QTabBar),
)
PARTS = (QScrollBar, QHeaderView)
STEPS = 300


@pytest.fixture
def window(sample_window):
    made = sample_window(1480, 900)
    activate(made)
    return made


def activate(window):
    """Give the keys to a window: a display without a window manager may take them when another one closes."""
    if not window.isActiveWindow():
        window.activateWindow()
    assert QTest.qWaitForWindowActive(window, 5000)


def controls(page):
    """What can be pressed, chosen or written into, without the inner parts of such things."""
    found = [each for kind in KINDS for each in page.findChildren(kind) if each.isVisible()]
    return [
        each
        for each in found
        if not isinstance(each, PARTS)
        and not isinstance(each.parent(), QAbstractSpinBox | QComboBox)
        and not each.objectName().startswith("qt_")
    ]


def walked(window):
    """What has the focus, Tab after Tab, until it begins again."""
    seen = []
    for _ in range(STEPS):
        QTest.keyClick(QApplication.focusWidget() or window, Qt.Key.Key_Tab)
        now = QApplication.focusWidget()
        if seen and now is seen[0]:
            return seen
        seen.append(now)
    raise AssertionError(f"Tab is caught by {type(seen[-1]).__name__} {seen[-1].objectName()}")


@pytest.mark.slow
def test_that_every_control_of_every_page_is_named_and_reached_by_tab(window, settled):
    for page in PAGES.values():
        widget = window.go(page.key)
        settled(window)
        for each in controls(widget):
            text = each.text() if isinstance(each, QAbstractButton) else ""
            assert each.accessibleName() or text, f"{page.key}: {type(each).__name__} {each.objectName()}"
        reached = walked(window)
        for each in controls(widget):
            if each.isEnabled() and each.focusPolicy() & Qt.FocusPolicy.TabFocus:
                assert each in reached, (
                    f"{page.key}: {type(each).__name__} {each.objectName()} is not reached"
                )


def press(window, key):
    """A key as the display server tells it: to the window, not to a widget in it."""
    activate(window)
    QTest.keyClick(window.windowHandle(), key)
    QApplication.processEvents()


def point(widget, place=None):
    """A click as the display server tells it."""
    window = widget.window()
    at = widget.mapTo(window, place or widget.rect().center())
    QTest.mouseClick(window.windowHandle(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
    QApplication.processEvents()


def framed(window):
    """What the window frames because it has the keys."""
    return [each for each in window.findChildren(QWidget) if each.property("focused")]


@pytest.mark.slow
def test_that_the_focus_is_framed_after_a_key_and_not_after_the_mouse(window, settled):
    window.go("lecture")
    settled(window)
    tabs = window.page.tabs.tabBar()
    assert framed(window) == []
    for at in (1, 2, 0):
        point(tabs, tabs.tabRect(at).center())
        settled(window)
        assert window.page.tabs.currentIndex() == at
        assert framed(window) == []
    assert not window.testAttribute(Qt.WidgetAttribute.WA_KeyboardFocusChange)
    found = []
    while not any(isinstance(each, ViewFrame) for each in found):
        press(window, Qt.Key.Key_Tab)
        found += framed(window)
        assert len(framed(window)) <= 1
        assert len(found) < STEPS
    assert tabs in found
    assert window.testAttribute(Qt.WidgetAttribute.WA_KeyboardFocusChange)
    frame = framed(window)[0]
    point(frame.view.widget)
    assert QApplication.focusWidget() is frame.view.widget
    assert framed(window) == []
    assert not window.testAttribute(Qt.WidgetAttribute.WA_KeyboardFocusChange)
    press(window, Qt.Key.Key_Right)
    assert framed(window) == [frame]
    settled(window)


def test_that_a_view_shows_that_it_has_the_keys_and_turns_with_them(window, settled, wait):
    frames = window.page.three_views.frames
    view = frames["fit"].view
    window.page.fit.l_max.field.setFocus()
    press(window, Qt.Key.Key_Tab)
    view.widget.setFocus(Qt.FocusReason.TabFocusReason)
    wait(lambda: [name for name, frame in frames.items() if frame.property("focused")] == ["fit"], 5.0)
    before = np.subtract(view.pose.position, view.pose.focal_point)
    QTest.keyClick(view.widget, Qt.Key.Key_Right)
    turned = np.subtract(view.pose.position, view.pose.focal_point)
    assert np.linalg.norm(turned) == pytest.approx(np.linalg.norm(before))
    assert np.degrees(np.arccos(turned @ before / (before @ before))) > 1.0
    for other in frames.values():
        assert other.view.pose == view.pose, "linked cameras turn together"
    QTest.keyClick(view.widget, Qt.Key.Key_Left)
    assert np.subtract(view.pose.position, view.pose.focal_point) == pytest.approx(before, rel=1e-9, abs=1e-9)
    wide = view.pose.parallel_scale
    QTest.keyClick(view.widget, Qt.Key.Key_Plus)
    assert view.pose.parallel_scale == pytest.approx(wide / WHEEL_ZOOM)
    window.findChild(QTableView, "particle_table").setFocus()
    assert not any(frame.property("focused") for frame in frames.values())
    settled(window)


DIALOGS = (
    *("run_batch", "preferences", "palette", "shortcuts", "about"),
    "explore.save_picture",
)
"""Commands that ask by a dialog of their own."""


def check_dialog(dialog, name, wait):
    """Everything in it has a name, Tab comes everywhere, and Escape leaves it.

    Qt calls the window of a dialog active while that of its parent is; a window manager takes its time.
    """
    dialog.activateWindow()
    wait(dialog.isActiveWindow, 5.0)
    assert dialog.windowTitle(), f"{name} has no title"
    found = controls(dialog)
    for each in found:
        text = each.text() if isinstance(each, QAbstractButton) else ""
        assert each.accessibleName() or text, f"{name}: {type(each).__name__} {each.objectName()}"
    reached = walked(dialog)
    for each in found:
        if each.isEnabled() and each.focusPolicy() & Qt.FocusPolicy.TabFocus:
            assert each in reached, f"{name}: {type(each).__name__} {each.objectName()} is not reached"
    QTest.keyClick(QApplication.focusWidget() or dialog, Qt.Key.Key_Escape)
    wait(lambda: not dialog.isVisible(), 5.0)


def answer(window, act):
    """Act on the next dialog, also where the command waits for it; what came of it is in the list."""
    done, timer = [], QTimer(window, interval=20)

    def look():
        opened = [each for each in QApplication.topLevelWidgets() if each.isVisible() and each is not window]
        if dialog := next((each for each in opened if isinstance(each, QDialog)), None):
            timer.stop()
            try:
                act(dialog)
                done.append(None)
            except AssertionError as error:
                done.append(str(error))
                dialog.reject()

    timer.timeout.connect(look)
    timer.start()
    return done


def test_that_every_dialog_can_be_used_without_a_mouse(shown, preferences, wait, settled, tmp_path):
    session = Session(InlineRunner(), Choices(method="quadric"))  # which needs no kernels to be compiled
    window = shown(MainWindow(session, preferences, "image"))
    session.open_sample()
    settled(window)
    for name in DIALOGS:
        checked = answer(window, lambda dialog, name=name: check_dialog(dialog, name, wait))
        window.menus.by_name[name].trigger()
        wait(lambda checked=checked: checked, 20.0)
        assert checked == [None], (name, checked)
    check_dialog(shown(UnitDialog([tmp_path / "grain.stl"], "um", window)), "unit", wait)


def test_that_tab_comes_to_each_reference_and_return_opens_its_citation(shown):
    place, opened = shown(QWidget()), []
    links = CitationLinks(lambda: opened.append(True), place)
    before, after = QPushButton("before"), QPushButton("after")
    column = QVBoxLayout(place)
    for each in (before, CitingLabel("Eq. 9 and Fig. 7"), CitingLabel("without a reference"), after):
        column.addWidget(each)
    place.activateWindow()
    assert QTest.qWaitForWindowActive(place, 5000)
    before.setFocus()
    for count in (1, 2):
        QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Tab)
        QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Return)
        assert len(opened) == count
    QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Tab)
    assert QApplication.focusWidget() is after
    links.deleteLater()


def test_that_the_keys_stay_with_a_result_while_it_is_computed(shown):
    card = ResultView("some_study", ("Answer",), "Compute")
    window = QWidget()
    column = QVBoxLayout(window)
    column.addWidget(card)
    column.addWidget(QLineEdit())
    shown(window)
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, 5000)
    asked = []
    card.startRequested.connect(lambda: asked.append("start"))
    card.stopRequested.connect(lambda: asked.append("stop"))
    card.button.setFocus()
    for state in (ResultState.NONE, ResultState.RUNNING):
        card.show_record(ResultRecord(state=state))
        QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Space)
    assert asked == ["start", "stop"]


def chord(window, key, modifiers=Qt.KeyboardModifier.NoModifier):
    QTest.keyClick(window.windowHandle(), key, modifiers)
    QApplication.processEvents()


def test_that_tab_comes_to_the_page_that_is_seen_in_the_bar_of_pages(shown, preferences):
    window = shown(MainWindow(Session(InlineRunner()), preferences, "image"))
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, 5000)
    bar = window.pages.buttons
    for key in ("sample", "explore", "dataset"):
        window.go(key)
        assert [name for name, each in bar.items() if each.focusPolicy() & Qt.FocusPolicy.TabFocus] == [key]
    bar["dataset"].setFocus()
    chord(window, Qt.Key.Key_2, Qt.KeyboardModifier.AltModifier)
    assert window.pages.current == "sample"
    assert QApplication.focusWidget() is bar["sample"]
    chord(window, Qt.Key.Key_Down)
    chord(window, Qt.Key.Key_Space)
    assert window.pages.current == "scan"
    assert QApplication.focusWidget() is bar["scan"]


@pytest.mark.slow
def test_that_undo_and_redo_work_while_a_number_box_has_the_keys(window, settled):
    page, session = window.page, window.session
    control, shift = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
    field = page.fit.l_max.field
    field.setFocus()
    for _ in range(5):
        chord(window, Qt.Key.Key_Up)
        settled(window)
    assert session.choices.l_max == field.value() == 15
    for _ in range(5):
        chord(window, Qt.Key.Key_Z, control)
        settled(window)
    assert field.hasFocus()
    assert session.choices.l_max == field.value() == 10
    for _ in range(5):
        chord(window, Qt.Key.Key_Z, control | shift)
        settled(window)
    assert session.choices.l_max == field.value() == 15
    field.selectAll()
    chord(window, Qt.Key.Key_3)
    chord(window, Qt.Key.Key_Z, control)  # what is being typed is the box's
    assert field.text() == "15"
    assert session.choices.l_max == 15


@pytest.mark.slow
def test_that_a_typed_number_is_undone_by_the_window_once_it_counts(window, settled):
    field, session = window.page.coarsening.seed, window.session
    before = session.choices.seed
    field.setFocus()
    field.selectAll()
    for key in (Qt.Key.Key_4, Qt.Key.Key_2, Qt.Key.Key_Return):
        chord(window, key)
    settled(window)
    assert session.choices.seed == 42
    chord(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    settled(window)
    assert session.choices.seed == field.value() == before
