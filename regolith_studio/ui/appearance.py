"""Language, theme and font size: read from the preferences, chosen in a dialog, saved."""

from collections.abc import Callable
from typing import cast

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QApplication, QWidget

from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.dialogs.preferences import LETTERS, PreferencesDialog
from regolith_studio.ui.keyboard import KeyboardFocus, UndoKeys
from regolith_studio.ui.theme import apply_letters, choose_letters, choose_theme


class Appearance(QObject):
    """Applies the saved appearance; the font size is set before other widgets are made.

    Parameters
    ----------
    preferences
        Where it is kept.
    apply
        Called when theme or letters have changed.
    window
        Parent of the dialog.
    """

    def __init__(self, preferences: Preferences, apply: Callable[[], None], window: QWidget) -> None:
        super().__init__(window)
        self._preferences, self._apply, self._window = preferences, apply, window
        self.focus = KeyboardFocus(self)
        self.undo_keys = UndoKeys(self)
        self._take()
        apply_letters(cast(QApplication, QApplication.instance()))

    def ask(self) -> None:
        """Show the dialog."""
        dialog = PreferencesDialog(self._preferences.window, self._window)
        dialog.valueChanged.connect(lambda changes: self.choose(**changes))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def choose(self, **changes: object) -> None:
        """Keep settings by their names; another theme and other letters are seen at once."""
        before = self._seen()
        self._preferences.window = self._preferences.window | changes
        self._preferences.save()
        self._take()
        if self._seen() != before:  # a style takes a second to reach all widgets
            self._apply()

    def _seen(self) -> tuple[object, object]:
        return self._preferences.window.get("theme", "system"), self._preferences.window.get(LETTERS)

    def _take(self) -> None:
        choose_theme(str(self._preferences.window.get("theme", "system")))
        choose_letters(self._preferences.window.get(LETTERS))
