"""Language, theme and font size, chosen in a dialog; sizes of window and parts: restored and saved."""

import base64
import binascii
from collections.abc import Callable, Mapping, Sequence
from typing import Any, cast

from PySide6.QtCore import QByteArray, QObject, QSignalBlocker, QSize, Signal
from PySide6.QtWidgets import QApplication, QFormLayout, QMainWindow, QSpinBox, QSplitter, QToolBar, QWidget

from regolith_studio.messages import N_
from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.keyboard import KeyboardFocus, UndoKeys
from regolith_studio.ui.layout import (
    GrowingDialog,
    dialog_buttons,
    named,
    restore_borders,
    room_on_screen,
    vbox,
)
from regolith_studio.ui.theme import (
    LARGEST,
    SMALLEST,
    USUAL,
    apply_font_size,
    choose_font_size,
    choose_theme,
)
from regolith_studio.ui.translation import LANGUAGES, SETTING, SYSTEM, tr
from regolith_studio.ui.widgets.fields import ChoiceBox
from regolith_studio.ui.widgets.labels import hint_label

LAYOUT = "layout"
STANDARD_SIZE = (1480, 900)
"""Of a new window in pixels, where the screen is large enough."""
NO_LIMIT = (1 << 24) - 1
"""Qt's maximum height of a widget that has none."""


class WindowState:
    """Keeps geometry and splitters in the preferences; splitters without an object name are left alone.

    ``preferences``: where it is kept, under ``window["layout"]``.
    """

    def __init__(self, preferences: Preferences) -> None:
        self._preferences = preferences

    def restore_window(self, window: QMainWindow) -> bool:
        """Give the window its last place, or one that the screen holds; says whether there was a last."""
        kept = _bytes(self._kept().get("window"))
        if kept is not None and window.restoreGeometry(kept):
            return True
        window.resize(window.size().boundedTo(room_on_screen(window)))
        return False

    def restore_parts(self, root: QWidget) -> None:
        """Put the borders in a page back where they were."""
        kept = self._kept()
        for splitter in root.findChildren(QSplitter):
            state = _bytes(kept.get(splitter.objectName())) if splitter.objectName() else None
            if state is not None:
                splitter.restoreState(state)

    def keep(self, window: QMainWindow) -> None:
        states = {each.objectName(): each.saveState() for each in window.findChildren(QSplitter)}
        states = {name: state for name, state in states.items() if name} | {"window": window.saveGeometry()}
        texts = {name: base64.b64encode(state.data()).decode("ascii") for name, state in states.items()}
        self._preferences.window = self._preferences.window | {LAYOUT: self._kept() | texts}

    def restore_standard(self, window: QMainWindow) -> None:
        """Give window and borders the places of a new window, and forget others."""
        self._preferences.window = self._preferences.window | {LAYOUT: {}}
        if not window.isMaximized() and not window.isFullScreen():
            window.resize(QSize(*STANDARD_SIZE).boundedTo(room_on_screen(window)))
        restore_borders(window)

    def _kept(self) -> dict[str, Any]:
        kept = self._preferences.window.get(LAYOUT)
        return dict(kept) if isinstance(kept, dict) else {}


def show_bars(window: QMainWindow, others: Sequence[QWidget], *, shown: bool) -> None:
    """Show or hide the bars of a window: on a full screen there is only the page."""
    for bar in (*window.findChildren(QToolBar), *others):
        bar.setVisible(shown)
    # the shortcuts of a menu bar that is hidden are not heard
    window.menuBar().setMaximumHeight(NO_LIMIT if shown else 0)


def _bytes(text: object) -> QByteArray | None:
    if not isinstance(text, str):
        return None
    try:
        return QByteArray(base64.b64decode(text, validate=True))
    except (binascii.Error, ValueError):
        return None


FONT_SIZE = "font_size"
"""In the preferences of the window: font size in percent."""
THEMES = {SYSTEM: N_("As the system"), "light": N_("Light"), "dark": N_("Dark")}


class PreferencesDialog(GrowingDialog):
    """Edits settings of the window; changes apply at once, the language at the next start."""

    valueChanged = Signal(dict)  # noqa: N815

    def __init__(self, kept: Mapping[str, Any], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Preferences"))
        self.setObjectName("preferences_dialog")
        self.setMinimumWidth(420)
        self.language = ChoiceBox("preferences_language", tr("Language"), LANGUAGES)
        self.theme = ChoiceBox("preferences_theme", tr("Theme"), THEMES)
        self.font_size = named(QSpinBox(), "preferences_letters", tr("Font size"))
        self.font_size.setRange(int(SMALLEST), int(LARGEST))
        self.font_size.setSingleStep(10)
        self.font_size.setSuffix(" %")
        self.font_size.setKeyboardTracking(False)
        self.note = hint_label(tr("The language takes effect when the program starts again."))
        self._arrange()
        self.setValue(kept)
        self._begun = self.language.value()
        self.language.activated.connect(self._change_language)
        self.theme.activated.connect(lambda _: self.valueChanged.emit({"theme": self.theme.value()}))
        self.font_size.valueChanged.connect(lambda percent: self.valueChanged.emit({FONT_SIZE: percent}))

    def value(self) -> dict[str, Any]:
        return {
            SETTING: self.language.value(),
            "theme": self.theme.value(),
            FONT_SIZE: self.font_size.value(),
        }

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show these settings, the usual ones where they are missing or not known; announces nothing."""
        for box, name, known in ((self.language, SETTING, LANGUAGES), (self.theme, "theme", THEMES)):
            box.setValue(value[name] if value.get(name) in known else SYSTEM)
        percent = value.get(FONT_SIZE)
        with QSignalBlocker(self.font_size):
            self.font_size.setValue(int(percent) if isinstance(percent, int | float) else int(USUAL))

    def _change_language(self) -> None:
        self.note.setVisible(self.language.value() != self._begun)
        self.valueChanged.emit({SETTING: self.language.value()})

    def _arrange(self) -> None:
        form = QFormLayout()
        form.addRow(tr("Language"), self.language)
        form.addRow("", self.note)
        form.addRow(tr("Theme"), self.theme)
        form.addRow(tr("Font size"), self.font_size)
        vbox(form, dialog_buttons(self), parent=self, margins=None)
        self.note.hide()


class Appearance(QObject):
    """Applies the saved appearance; the font size is set before other widgets are made.

    - ``preferences``: where it is kept.
    - ``apply``: called when theme or font size have changed.
    - ``window``: parent of the dialog.
    """

    def __init__(self, preferences: Preferences, apply: Callable[[], None], window: QWidget) -> None:
        super().__init__(window)
        self._preferences, self._apply, self._window = preferences, apply, window
        self.focus = KeyboardFocus(self)
        self.undo_keys = UndoKeys(self)
        self._take()
        apply_font_size(cast(QApplication, QApplication.instance()))

    def ask(self) -> None:
        dialog = PreferencesDialog(self._preferences.window, self._window)
        dialog.valueChanged.connect(lambda changes: self.choose(**changes))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def choose(self, **changes: object) -> None:
        """Keep settings by their names; another theme and font size are seen at once."""
        before = self._seen()
        self._preferences.window = self._preferences.window | changes
        self._preferences.save()
        self._take()
        if self._seen() != before:  # a style takes a second to reach all widgets
            self._apply()

    def _seen(self) -> tuple[object, object]:
        return self._preferences.window.get("theme", "system"), self._preferences.window.get(FONT_SIZE)

    def _take(self) -> None:
        choose_theme(str(self._preferences.window.get("theme", "system")))
        choose_font_size(self._preferences.window.get(FONT_SIZE))
