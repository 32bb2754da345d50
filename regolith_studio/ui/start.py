"""Starts the window: a splash first, then everything that takes time to load."""

import gc
import os
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QColor, QFont, QPainter, QPixmap
from PySide6.QtWidgets import QLabel

from regolith_studio import __version__
from regolith_studio.ui.application import make_application
from regolith_studio.ui.environment import check_display
from regolith_studio.ui.icons import pixmap

LINGER = 2.0
"""Seconds that the process may outlive its window."""
_WIDTH, _HEIGHT, _MARK = 420, 170, 92
_GROUND, _LETTERS, _QUIET = "#1d2126", "#e4e7eb", "#9aa4b0"


def run(paths: Sequence[str | Path] = (), unit: str | None = None) -> int:
    """Open the window, with these files or with the shipped sample; returns when it is closed.

    Parameters
    ----------
    paths
        Mesh files and folders, a project or a recipe.
    unit
        Their length unit; the window asks if it is not given.

    Raises
    ------
    EnvironmentProblem
        If there is no display.
    """
    check_display()
    gc.disable()  # nothing that is loaded or built from here on is garbage: 0.3 s of 2
    app = make_application(sys.argv[:1])
    splash = make_splash()
    splash.show()
    app.processEvents()
    from regolith_studio.session.preferences import Preferences
    from regolith_studio.ui.translation.language import SETTING, SYSTEM, speak

    preferences = Preferences.load()
    speak(app, str(preferences.window.get(SETTING, SYSTEM)))
    from regolith_studio.ui.app import open_window, set_aside_what_stays, telling_hook, welcome

    window = open_window(paths, unit, preferences=preferences)
    sys.excepthook = telling_hook(window.toast.problem)
    window.show()
    splash.close()
    set_aside_what_stays(window)
    gc.enable()
    QTimer.singleShot(0, window, lambda: welcome(window))
    clock = latest_end()
    window.pages.ended.connect(clock.start)
    code = app.exec()
    clock.cancel()
    sys.excepthook = sys.__excepthook__
    return code


def latest_end(seconds: float = LINGER) -> threading.Timer:
    """A clock that, once started and not cancelled, ends the process after so long, whatever its threads do.

    Everything is kept when the window has closed, and what runs has been told to stop; but finding grains in
    a scan looks up only between steps of some seconds, and the process would outlive its window for as long.
    """
    clock = threading.Timer(seconds, os._exit, (0,))  # nothing before it: that might wait for the interpreter
    clock.daemon = True
    return clock


def make_splash() -> QLabel:
    """Mark, name and version.

    No ``QSplashScreen``: that one waits a second for a window manager's answer before it goes on.
    """
    picture = QPixmap(_WIDTH, _HEIGHT)
    picture.fill(QColor(_GROUND))
    painter = QPainter(picture)
    painter.drawPixmap(32, (_HEIGHT - _MARK) // 2, pixmap("app", _LETTERS, _MARK))
    large = QFont()
    large.setPointSize(19)
    large.setBold(True)
    painter.setFont(large)
    painter.setPen(QColor(_LETTERS))
    painter.drawText(150, 82, "Regolith Studio")
    painter.setFont(QFont())
    painter.setPen(QColor(_QUIET))
    painter.drawText(150, 108, f"{__version__}   CT → DEM")
    painter.end()
    splash = QLabel()
    splash.setWindowFlags(Qt.WindowType.SplashScreen | Qt.WindowType.WindowStaysOnTopHint)
    splash.setPixmap(picture)
    splash.resize(picture.size())
    splash.move(splash.screen().availableGeometry().center() - splash.rect().center())
    return splash
