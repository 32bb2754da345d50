"""Theme and letters: applied when they change, and only then."""

import pytest
from PySide6.QtWidgets import QWidget

from regolith_studio.ui.dialogs.preferences import LETTERS
from regolith_studio.ui.looks import Looks
from regolith_studio.ui.theme import DARK, choose_letters, choose_theme, current_theme


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
