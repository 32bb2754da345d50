"""Random acts on the window, as of somebody who clicks, types, drags and turns the wheel anywhere."""

import random
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest.mock import patch

import shiboken6
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, QTimer
from PySide6.QtGui import QDesktopServices, QDrag, QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QDialog,
    QFileDialog,
    QLineEdit,
    QMenu,
    QMessageBox,
    QPlainTextEdit,
    QSlider,
    QWidget,
)

FORBIDDEN = {
    "quit",
    "studies.run_all",
    "open",
    "open_folder",
    "save_recipe",
    "save_project",
    "save_project_as",
}
"""Commands that ask for files of the machine, or close the window."""
LONG_WORK = {
    *(
        "toast_details",
        "batch_go",
        "lmax_study_result_button",
        "coarsening_study_result_button",
        "solids_result_button",
    ),
    *("faces_start", "tradeoff_start", "sensitivity_start"),
}
"""Buttons that are not clicked."""
KEYS = (
    *(Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Home, Qt.Key.Key_End),
    *(Qt.Key.Key_PageUp, Qt.Key.Key_PageDown, Qt.Key.Key_Tab, Qt.Key.Key_Space, Qt.Key.Key_Escape),
    *(Qt.Key.Key_0, Qt.Key.Key_1, Qt.Key.Key_5, Qt.Key.Key_9, Qt.Key.Key_Period, Qt.Key.Key_Backspace),
)
LOOK_AROUND = 8
"""Acts between two looks at what is there to be clicked, and between two turns of the event loop."""
ANSWERS = {
    "getOpenFileName": ("", ""),
    "getOpenFileNames": ([], ""),
    "getSaveFileName": ("", ""),
    "getExistingDirectory": "",
    "exec": 0,
}
"""Of dialogs with an event loop of their own, which would wait for somebody."""
POPUP_MILLISECONDS = 200
"""After which a menu is closed: it has an event loop of its own, too."""
EXPECTED_ERRORS = ("regolith_studio.errors", "regolith_studio.dem.engine_process.EngineError")
"""Errors that the window reports in a sentence; random settings of an engine end so."""


class RandomActs:
    """Acts on whatever is found in the window.

    Parameters
    ----------
    window
        The main window.
    seed
        The same one does the same things.
    pages
        Names of the pages that are visited; all if empty.
    """

    def __init__(self, window: Any, seed: int, pages: Sequence[str] = ()) -> None:
        self._window, self._random, self._count = window, random.Random(seed), 0
        self._known: list[QWidget] = []
        self._pages = tuple(pages or window.pages.pages)

    def act(self) -> str:
        """One thing that a user could do; returns what and where, in a few words."""
        if self._count % LOOK_AROUND == 0:
            _close_dialogs()
            self._known = self._widgets()
        self._count += 1
        action: Callable[[], str] = self._random.choices(
            (self._click, self._press, self._drag, self._wheel, self._command, self._go, self._resize),
            (30, 25, 20, 12, 6, 2, 1),
        )[0]
        said = action()
        if self._count % LOOK_AROUND == 0:
            QApplication.processEvents()
        return f"{action.__name__.strip('_')} {said} on {self._window.pages.current}"

    def _widgets(self) -> list[QWidget]:
        return [
            each
            for each in self._window.page.findChildren(QWidget)
            if each.isVisible() and each.isEnabled() and each.width() > 4 and each.height() > 4
        ]

    def _some_widget(self) -> QWidget:
        page: QWidget = self._window.page
        widget = self._random.choice(self._known or [page])
        alive = shiboken6.isValid(widget) and widget.isVisible() and widget.isEnabled()
        return widget if alive else page

    def _place(self, widget: QWidget) -> QPoint:
        wide, high = max(1, widget.width()), max(1, widget.height())
        return QPoint(self._random.randrange(wide), self._random.randrange(high))

    def _click(self) -> str:
        widget = self._some_widget()
        if self._is_skipped(widget):
            return ""
        name = widget.objectName() or type(widget).__name__
        _mouse(widget, QEvent.Type.MouseButtonPress, self._place(widget))
        _mouse(widget, QEvent.Type.MouseButtonRelease, self._place(widget))
        return name

    def _press(self) -> str:
        widget = self._some_widget()
        if not self._is_skipped(widget) and not isinstance(widget, QPlainTextEdit):
            QTest.keyClick(widget, self._random.choice(KEYS))
        return ""

    def _drag(self) -> str:
        sliders = [each for each in self._known if shiboken6.isValid(each) and isinstance(each, QSlider)]
        if sliders and self._random.random() < 0.5:
            slider = self._random.choice(sliders)
            slider.setValue(self._random.randint(slider.minimum(), slider.maximum()))
            return slider.objectName()
        widget = self._some_widget()
        if self._is_skipped(widget):
            return ""
        _mouse(widget, QEvent.Type.MouseButtonPress, self._place(widget))
        for _ in range(3):
            _mouse(widget, QEvent.Type.MouseMove, self._place(widget))
        _mouse(widget, QEvent.Type.MouseButtonRelease, self._place(widget))
        return ""

    def _wheel(self) -> str:
        widget = self._some_widget()
        place = QPointF(self._place(widget))
        turn = QPoint(0, self._random.choice((-120, 120)))
        nothing, phase = Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase
        event = QWheelEvent(
            place, widget.mapToGlobal(place), QPoint(), turn, Qt.MouseButton.NoButton, nothing, phase, False
        )
        QApplication.sendEvent(widget, event)
        return ""

    def _command(self) -> str:
        actions = self._window.menus.by_name
        names = [
            name
            for name, action in actions.items()
            if action.isEnabled() and action.isVisible() and name not in FORBIDDEN and action.menu() is None
        ]
        name = self._random.choice(names)
        if "…" not in actions[name].text() and not name.startswith("go.") and "page" not in name:
            actions[name].trigger()
        return name

    def _go(self) -> str:
        name = self._random.choice(self._pages)
        self._window.go(name)
        return name

    def _resize(self) -> str:
        self._window.resize(self._random.randint(600, 900), self._random.randint(420, 600))
        return ""

    def _is_skipped(self, widget: QWidget) -> bool:
        """Whether a click opens a file dialog, starts long work, or opens a menu (seldom wanted)."""
        if isinstance(widget, QAbstractButton):
            return "…" in widget.text() or widget.objectName() in LONG_WORK
        return isinstance(widget, QComboBox | QMenu | QLineEdit) and self._random.random() < 0.7


@contextmanager
def dialogs_answered() -> Iterator[None]:
    """Close what waits for a user: file dialogs and questions return at once, menus soon."""
    timer = QTimer(interval=POPUP_MILLISECONDS)
    timer.timeout.connect(_close_popups)
    timer.start()
    with ExitStack() as patches:
        for name, answer in ANSWERS.items():
            patches.enter_context(patch.object(QFileDialog, name, return_value=answer))
        no = QMessageBox.StandardButton.No
        patches.enter_context(patch.object(QMessageBox, "question", return_value=no))
        patches.enter_context(patch.object(QDesktopServices, "openUrl", return_value=True))
        try:
            yield
        finally:
            timer.stop()


@contextmanager
def errors_collected(window: Any) -> Iterator[list[str]]:
    """Tracebacks of what went wrong in a slot or in a job, but for :data:`EXPECTED_ERRORS`."""
    found: list[str] = []

    def report(_kind: str, _sentence: str, details: str) -> None:
        if "Traceback" in details and not any(each in details for each in EXPECTED_ERRORS):
            found.append(details)

    window.toast.shown.connect(report)
    with patch.object(
        sys, "excepthook", lambda *error: found.append("".join(traceback.format_exception(*error)))
    ):
        yield found
    window.toast.shown.disconnect(report)


def _close_dialogs() -> None:
    _close_popups()
    for each in QApplication.topLevelWidgets():
        if isinstance(each, QDialog | QMessageBox | QFileDialog) and each.isVisible():
            each.reject()


def _close_popups() -> None:
    QDrag.cancel()  # selected text that was dragged waits for a pointer, too
    while (popup := QApplication.activePopupWidget()) is not None:
        popup.close()


def _mouse(widget: QWidget, kind: QEvent.Type, place: QPoint) -> None:
    """A mouse event straight to a widget, so that no real pointer is needed."""
    left, nothing = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    local = QPointF(place)
    buttons = Qt.MouseButton.NoButton if kind == QEvent.Type.MouseButtonRelease else left
    button = Qt.MouseButton.NoButton if kind == QEvent.Type.MouseMove else left
    event = QMouseEvent(kind, local, widget.mapToGlobal(local), button, buttons, nothing)
    QApplication.sendEvent(widget, event)
