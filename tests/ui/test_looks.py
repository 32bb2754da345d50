"""Theme and letters: applied when they change, and only then."""

import pytest
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QCheckBox, QDialog, QDialogButtonBox, QLabel, QVBoxLayout, QWidget

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


def luminance(colour):
    """Relative luminance of sRGB, as WCAG 2.2 defines it."""
    parts = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in colour]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


def contrast(one, other):
    """WCAG's ratio of two colours, 1 to 21."""
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("theme", [LIGHT, DARK])
@pytest.mark.parametrize("checked", [False, True])
def test_that_a_check_box_stands_out_as_controls_must(app, shown, theme, checked):
    """WCAG 2.2, 1.4.11: what shows a control and its state has a contrast of at least 3."""
    window = QWidget()
    box = QCheckBox(window)
    box.setChecked(checked)
    QVBoxLayout(window).addWidget(box)
    apply_theme(app, theme, shown(window))
    app.processEvents()
    image = box.grab().toImage()
    seen = {image.pixelColor(x, y).getRgbF()[:3] for x in range(image.width()) for y in range(image.height())}
    ground = QColor(theme.window).getRgbF()[:3]
    assert max(contrast(colour, ground) for colour in seen) >= 3.0
