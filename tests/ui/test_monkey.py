"""A monkey at the window: random clicks, keys, drags, wheels; nothing may break, hang or be left behind."""

import gc
import os
import random
import sys
import time
import traceback
from contextlib import contextmanager

import psutil
import pytest
import shiboken6
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, QTimer
from PySide6.QtGui import QDesktopServices, QGuiApplication, QMouseEvent, QWheelEvent
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

from regolith_studio.ui.app import open_window

FORBIDDEN = {
    "quit",
    "studies.run_all",
    "open",
    "open_folder",
    "save_recipe",
    "save_project",
    "save_project_as",
}
"""Commands that ask for files of the machine, or end the game."""
LONG_WORK = {
    *("toast_details", "batch_go", "lmax_study_start", "coarsening_study_start", "solids_start"),
    *("faces_start", "tradeoff_start", "sensitivity_start"),
}
KEYS = (
    *(Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Home, Qt.Key.Key_End),
    *(Qt.Key.Key_PageUp, Qt.Key.Key_PageDown, Qt.Key.Key_Tab, Qt.Key.Key_Space, Qt.Key.Key_Escape),
    *(Qt.Key.Key_0, Qt.Key.Key_1, Qt.Key.Key_5, Qt.Key.Key_9, Qt.Key.Key_Period, Qt.Key.Key_Backspace),
)
LOOK_AROUND = 8
"""Events between two looks at what is there to be clicked, and between two turns of the event loop."""
PAGES = ("explore", "sample", "studies")
"""Those that are visited by the monkey that comes with every run of the tests; the long visit sees all."""
ANSWERS = {
    "getOpenFileName": ("", ""),
    "getOpenFileNames": ([], ""),
    "getSaveFileName": ("", ""),
    "getExistingDirectory": "",
    "exec": 0,
}
"""Of dialogs with a loop of their own: they would wait for somebody."""
SENTENCES = ("regolith_studio.errors", "regolith_studio.dem.engine_process.EngineError")
"""What a toast tells in a sentence; the monkey also asks engines for what cannot go well."""
PATIENCE = 200
"""Milliseconds after which a menu that a button has opened is closed: it has a loop of its own, too."""


class Monkey:
    """Acts on whatever it finds in the window.

    Parameters
    ----------
    window
        The playground.
    seed
        The same one does the same things.
    pages
        Where it goes.
    """

    def __init__(self, window, seed, pages=PAGES):
        self.window, self.random, self.done = window, random.Random(seed), 0
        self._known, self._pages = [], pages

    def act(self):
        """One thing a user could do; returns what and where, in a few words."""
        if self.done % LOOK_AROUND == 0:
            self._close_dialogs()
            self._known = self._widgets()
        self.done += 1
        action = self.random.choices(
            (self._click, self._press, self._drag, self._wheel, self._command, self._go, self._resize),
            (30, 25, 20, 12, 6, 2, 1),
        )[0]
        said = action()
        return f"{action.__name__.strip('_')} {said or ''} on {self.window.pages.current}"

    def _widgets(self):
        return [
            each
            for each in self.window.page.findChildren(QWidget)
            if each.isVisible() and each.isEnabled() and each.width() > 4 and each.height() > 4
        ]

    def _some_widget(self):
        widget = self.random.choice(self._known or [self.window.page])
        alive = shiboken6.isValid(widget) and widget.isVisible() and widget.isEnabled()
        return widget if alive else self.window.page

    def _place(self, widget):
        wide, high = max(1, widget.width()), max(1, widget.height())
        return QPoint(self.random.randrange(wide), self.random.randrange(high))

    def _click(self):
        widget = self._some_widget()
        if self._is_dangerous(widget):
            return ""
        name = widget.objectName() or type(widget).__name__
        _mouse(widget, QEvent.Type.MouseButtonPress, self._place(widget))
        _mouse(widget, QEvent.Type.MouseButtonRelease, self._place(widget))
        return name

    def _press(self):
        widget = self._some_widget()
        if not self._is_dangerous(widget) and not isinstance(widget, QPlainTextEdit):
            QTest.keyClick(widget, self.random.choice(KEYS))

    def _drag(self):
        sliders = [each for each in self._known if shiboken6.isValid(each) and isinstance(each, QSlider)]
        if sliders and self.random.random() < 0.5:
            slider = self.random.choice(sliders)
            slider.setValue(self.random.randint(slider.minimum(), slider.maximum()))
            return
        widget = self._some_widget()
        if self._is_dangerous(widget):
            return
        _mouse(widget, QEvent.Type.MouseButtonPress, self._place(widget))
        for _ in range(3):
            _mouse(widget, QEvent.Type.MouseMove, self._place(widget))
        _mouse(widget, QEvent.Type.MouseButtonRelease, self._place(widget))

    def _wheel(self):
        widget = self._some_widget()
        place = QPointF(self._place(widget))
        turn = QPoint(0, self.random.choice((-120, 120)))
        nothing, phase = Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase
        event = QWheelEvent(
            place, widget.mapToGlobal(place), QPoint(), turn, Qt.MouseButton.NoButton, nothing, phase, False
        )
        QApplication.sendEvent(widget, event)

    def _command(self):
        names = [
            name
            for name, action in self.window.menus.by_name.items()
            if action.isEnabled() and action.isVisible() and name not in FORBIDDEN and action.menu() is None
        ]
        name = self.random.choice(names)
        action = self.window.menus.by_name[name]
        if "…" not in action.text() and not name.startswith("go.") and "page" not in name:
            action.trigger()
        return name

    def _go(self):
        self.window.go(self.random.choice(self._pages))

    def _resize(self):
        self.window.resize(self.random.randint(600, 900), self.random.randint(420, 600))

    def _is_dangerous(self, widget):
        """Whether a click opens a file dialog or a menu with a loop of its own."""
        if isinstance(widget, QAbstractButton):
            return "…" in widget.text() or widget.objectName() in LONG_WORK
        return isinstance(widget, QComboBox | QMenu | QLineEdit) and self.random.random() < 0.7

    def _close_dialogs(self):
        _close_popups()
        for each in QApplication.topLevelWidgets():
            if isinstance(each, QDialog | QMessageBox | QFileDialog) and each.isVisible():
                each.reject()


def _close_popups():
    while (popup := QApplication.activePopupWidget()) is not None:
        popup.close()


@contextmanager
def _somebody_closes_popups():
    timer = QTimer(interval=PATIENCE)
    timer.timeout.connect(_close_popups)
    timer.start()
    try:
        yield
    finally:
        timer.stop()


def _mouse(widget, kind, place):
    """A mouse event straight to a widget, so that no real pointer is needed."""
    left, nothing = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    local = QPointF(place)
    buttons = Qt.MouseButton.NoButton if kind == QEvent.Type.MouseButtonRelease else left
    button = Qt.MouseButton.NoButton if kind == QEvent.Type.MouseMove else left
    event = QMouseEvent(kind, local, widget.mapToGlobal(local), button, buttons, nothing)
    QApplication.sendEvent(widget, event)


@pytest.fixture
def views():
    """``REGOLITH_STUDIO_VIEWS=live`` lets it play with live views."""
    return os.environ.get("REGOLITH_STUDIO_VIEWS", "image")


@pytest.fixture
def window(monkeypatch, shown, preferences, wait, views):
    monkeypatch.setattr("regolith_studio.ui.main_window.may_close", lambda *_: True)
    if views == "live" and QGuiApplication.platformName() == "offscreen":
        pytest.skip("live views need a display")
    made = open_window(views=views, preferences=preferences)
    made.resize(760, 520)
    shown(made)
    wait(lambda: made.session.results.coarsened is not None and not made.session.tasks, 120.0)
    made.session.choose(method="quadric", level=2)
    return made


def play(window, monkeypatch, app, count, seed, pages=PAGES, tell=lambda *_: None):
    """Let the monkey act; what goes wrong in a slot reaches sys.excepthook and fails the test.

    `tell` is told at each twentieth of the way how many events there were, how many megabytes are resident,
    and how many seconds the longest event since the last time took, and which action it was.
    """
    for name, answer in ANSWERS.items():
        monkeypatch.setattr(QFileDialog, name, lambda *_args, answer=answer, **_more: answer)
    monkeypatch.setattr(QMessageBox, "question", lambda *_: QMessageBox.StandardButton.No)
    monkeypatch.setattr(QDesktopServices, "openUrl", lambda *_: True)
    wrong, problems, slowest = [], [], (0.0, "")
    monkeypatch.setattr(sys, "excepthook", lambda *error: wrong.append(error))
    window.toast.shown.connect(lambda _kind, _sentence, details: problems.append(details))
    monkey = Monkey(window, seed, pages)
    with _somebody_closes_popups():
        for number in range(count):
            if number % max(1, count // 20) == 0:
                tell(number, round(psutil.Process().memory_info().rss / 1e6), slowest)
                slowest = (0.0, "")
            began = time.perf_counter()
            what = monkey.act()
            slowest = max(slowest, (time.perf_counter() - began, what))
            if number % LOOK_AROUND == 0:
                app.processEvents()
            story = "".join(traceback.format_exception(*wrong[0])) if wrong else ""
            assert not wrong, f"event {number} of seed {seed}: {story}"
    mistakes = [text for text in problems if "Traceback" in text and not any(map(text.count, SENTENCES))]
    assert not mistakes, mistakes[0]
    for task in window.session.tasks:
        window.session.cancel(task.id)


@pytest.mark.slow
def test_that_a_short_visit_of_the_monkey_leaves_the_window_well(window, monkeypatch, app, wait):
    play(window, monkeypatch, app, 250, seed=1)
    window.go("explore")
    window.session.choose(selected=window.session.particles[0].id, l_max=7)
    wait(lambda: not window.session.tasks, 60.0)
    assert window.session.results.surface_l_max == 7 or window.session.results.surface is None


@pytest.mark.slow
@pytest.mark.window
@pytest.mark.parametrize("views", ["live"])
@pytest.mark.parametrize("seed", [3, 4, 5])
def test_that_live_views_bear_a_thousand_events(window, monkeypatch, app, settled, seed):
    play(window, monkeypatch, app, 1_000, seed, pages=tuple(window.pages.pages))
    settled(window, 110.0)


@pytest.mark.slow
@pytest.mark.timeout(0)
@pytest.mark.skipif("REGOLITH_STUDIO_MONKEY" not in os.environ, reason="asked for by a number of events")
def test_that_a_long_visit_of_the_monkey_leaves_the_window_well(window, monkeypatch, app, wait, capsys):
    """``REGOLITH_STUDIO_MONKEY=50000`` lets it stay for so many events, about 15 ms each."""
    count, pages = int(os.environ["REGOLITH_STUDIO_MONKEY"]), tuple(window.pages.pages)

    def tell(number, megabytes, slowest):
        seconds, what = slowest
        held = f"{megabytes} MB, {len(window.session.particles)} particles"
        with capsys.disabled():
            sys.stdout.write(f"\n{number:,} events: {held}, longest {seconds:.2f} s ({what})")
            sys.stdout.flush()

    play(window, monkeypatch, app, count, seed=2, pages=pages, tell=tell)
    gc.unfreeze()
    wait(lambda: not window.session.tasks, 60.0)
