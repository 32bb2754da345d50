"""What the preferences change, and when."""

import pytest
from PySide6.QtWidgets import QApplication, QDialog

from regolith_studio.ui.appearance import PreferencesDialog
from regolith_studio.ui.startup import open_window


@pytest.fixture
def opened(shown, preferences, settled):
    """Opens a window that has drawn everything."""

    def run():
        made = shown(open_window(views="image", preferences=preferences))
        settled(made, 120.0)
        return made

    return run


@pytest.mark.slow
def test_that_preferences_hold_at_once_or_at_the_next_start(opened, wait):
    window = opened()
    app, before = QApplication.instance(), QApplication.font().pointSizeF()
    window.menus.by_name["preferences"].trigger()
    dialog = window.findChild(PreferencesDialog)
    assert dialog.value() == {"language": "system", "theme": "system", "font_size": 100}
    assert not dialog.note.isVisible()
    dialog.language.setCurrentIndex(dialog.language.findData("de"))
    dialog.language.activated.emit(dialog.language.currentIndex())
    dialog.theme.setCurrentIndex(dialog.theme.findData("dark"))
    dialog.theme.activated.emit(dialog.theme.currentIndex())
    dialog.font_size.setValue(150)
    assert dialog.note.isVisible()
    assert app.font().pointSizeF() == pytest.approx(1.5 * before)
    kept = window.preferences.load().window
    assert (kept["language"], kept["theme"], kept["font_size"]) == ("de", "dark", 150)
    dialog.font_size.setValue(100)
    dialog.close()
    assert app.font().pointSizeF() == pytest.approx(before)
    window.appearance.choose(theme="system")
    wait(lambda: window.findChild(QDialog, "preferences_dialog") is None)


def test_that_preferences_that_make_no_sense_are_the_usual_ones(shown):
    dialog = shown(PreferencesDialog({"language": "tlh", "theme": 4, "font_size": "huge"}))
    assert dialog.value() == {"language": "system", "theme": "system", "font_size": 100}


def test_that_preferences_begin_at_their_first_field(shown, app):
    dialog = shown(PreferencesDialog({}))
    dialog.activateWindow()
    app.processEvents()
    assert dialog.focusWidget() is dialog.language
