"""The window without a mouse: Tab reaches every control of every page, and each has a name."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSlider,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QHeaderView,
    QLineEdit,
    QPlainTextEdit,
    QScrollBar,
)

from regolith_studio.ui.app import open_window
from regolith_studio.ui.pages import pages

KINDS = (
    *(QAbstractButton, QComboBox, QAbstractSpinBox, QAbstractSlider),
    *(QLineEdit, QAbstractItemView, QPlainTextEdit),
)
PARTS = (QScrollBar, QHeaderView)
STEPS = 300


@pytest.fixture
def window(shown, preferences, wait):
    made = open_window(views="image", preferences=preferences)
    made.resize(1480, 900)
    shown(made)
    made.activateWindow()
    assert QTest.qWaitForWindowActive(made, 5000)
    wait(lambda: made.session.results.coarsened is not None and not made.session.tasks, 170.0)
    return made


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


def test_that_every_control_of_every_page_is_named_and_reached_by_tab(window, settled):
    for page in pages():
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
