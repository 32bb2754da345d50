"""Saves and restores the size of the window and the positions of its splitters."""

import base64
import binascii
from typing import Any

from PySide6.QtCore import QByteArray, QSize
from PySide6.QtWidgets import QMainWindow, QSplitter, QWidget

from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.layout import STANDARD_SIZES

LAYOUT = "layout"
STANDARD_SIZE = (1480, 900)
"""Of a new window in pixels, where the screen is large enough."""
FRAME = QSize(8, 40)
"""Pixels that window managers add to the size of a window for its title and borders, at most."""
EQUAL = 1000


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
        """Note down how everything stands now."""
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


def restore_borders(window: QWidget) -> None:
    """Give the borders between the parts of all pages the places of a new window."""
    for splitter in window.findChildren(QSplitter):
        splitter.setSizes(splitter.property(STANDARD_SIZES) or [EQUAL] * splitter.count())


def room_on_screen(window: QMainWindow) -> QSize:
    """Largest size of the window's content with which its frame is on the screen."""
    return window.screen().availableSize() - FRAME


def _bytes(text: object) -> QByteArray | None:
    if not isinstance(text, str):
        return None
    try:
        return QByteArray(base64.b64decode(text, validate=True))
    except (binascii.Error, ValueError):
        return None
