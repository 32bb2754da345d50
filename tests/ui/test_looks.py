"""Theme and letters: applied when they change, and only then."""

import pytest
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QLabel, QVBoxLayout, QWidget

from regolith_studio.ui.dialogs.preferences import LETTERS
from regolith_studio.ui.looks import Looks
from regolith_studio.ui.theme import DARK, LIGHT, apply_theme, choose_letters, choose_theme, current_theme


@pytest.fixture
def usual_looks():
    yield
    choose_theme("system")
    choose_letters(None)


@pytest.mark.usefixtures("app", "usual_looks")
def test_that_only_another_look_is_applied(shown, preferences):
    applied = []
    looks = Looks(preferences, lambda: applied.append(current_theme()), shown(QWidget()))
    looks.choose(theme="dark")
    looks.choose(theme="dark")
    looks.choose(language="de")
    assert applied == [DARK]
    looks.choose(**{LETTERS: 120})
    assert applied == [DARK, DARK]
    assert preferences.window["language"] == "de"


def test_that_a_theme_reaches_dialogs_of_the_window_and_changes_no_sheet_of_the_application(app, shown):
    window = shown(QWidget())
    apply_theme(app, LIGHT, window)
    everywhere = app.styleSheet()
    dialog = QDialog(window)
    buttons, remark = QDialogButtonBox(QDialogButtonBox.StandardButton.Close), QLabel("1")
    remark.setProperty("role", "remark")
    column = QVBoxLayout(dialog)
    column.addWidget(remark)
    column.addWidget(buttons)
    shown(dialog)
    for theme in (DARK, LIGHT):
        apply_theme(app, theme, window)
        app.processEvents()
        assert remark.palette().windowText().color() == QColor(theme.muted)
        assert window.palette().window().color() == QColor(theme.window)
    assert all(button.icon().isNull() for button in buttons.buttons())
    assert app.styleSheet() == everywhere
