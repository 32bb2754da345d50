"""Start the window: check the display, make the application object, show a splash while the rest loads."""

import gc
import os
import signal
import socket
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QLocale, QSocketNotifier, Qt, QTimer
from PySide6.QtGui import QColor, QFont, QIcon, QPainter, QPixmap, QSurfaceFormat
from PySide6.QtWidgets import QApplication, QLabel

from regolith_studio.errors import MissingRequirement
from regolith_studio.resources import resource
from regolith_studio.ui.icons import pixmap
from regolith_studio.ui.views.factory import surface_format
from regolith_studio.version import __version__

SWITCH_INTERVAL = 0.001
"""Seconds after which a computing thread hands the interpreter to the thread of the window.

Qt releases the interpreter at each call, so that the window waits for it often; Python's default is 5 ms.
"""
_WITHOUT_DISPLAY = ("offscreen", "minimal", "vnc", "linuxfb", "eglfs")
_WIDTH, _HEIGHT, _MARK = 420, 170, 92
_GROUND, _LETTERS, _QUIET = "#1d2126", "#e4e7eb", "#9aa4b0"


def run(paths: Sequence[str | Path] = (), unit: str | None = None) -> int:
    """Open the window, with these files or with the shipped sample; returns when it is closed.

    ``paths``: mesh files and folders, a project or a recipe. ``unit``: their length unit; the window asks if
    it is not given.
    """
    check_display()
    gc.disable()  # almost nothing that is loaded or built here is garbage
    app = make_application(sys.argv[:1])
    splash = make_splash()
    splash.show()
    app.processEvents()
    from regolith_studio.session.preferences import Preferences
    from regolith_studio.ui.translation import SETTING, SYSTEM, install_translators

    preferences = Preferences.load()
    install_translators(app, str(preferences.window.get(SETTING, SYSTEM)))
    from regolith_studio.ui.app import make_excepthook, open_window, show_recovery_and_tour

    window = open_window(paths, unit, preferences=preferences)
    sys.excepthook = make_excepthook(window.toast.problem)
    window.show()
    splash.close()
    gc.freeze()  # later collections skip the modules and the window: up to 90 ms each
    gc.enable()
    QTimer.singleShot(0, window, lambda: show_recovery_and_tour(window))
    close_on_interrupt(app)
    code = app.exec()
    sys.excepthook = sys.__excepthook__
    return code


def check_display(environment: Mapping[str, str] | None = None, platform: str = sys.platform) -> None:
    """Make sure that a window can be opened: without a display Qt aborts the process."""
    given = os.environ if environment is None else environment
    if not platform.startswith("linux"):
        return
    if given.get("QT_QPA_PLATFORM", "").split(":")[0] in _WITHOUT_DISPLAY:
        return
    if not (given.get("DISPLAY") or given.get("WAYLAND_DISPLAY")):
        raise MissingRequirement(
            "There is no display to open a window on (DISPLAY and WAYLAND_DISPLAY are not set); "
            "the commands work without one, for example: regolith-studio demo -o DIR"
        )


def make_application(arguments: Sequence[str]) -> QApplication:
    """The application object, with contexts shared between windows and the surface format that VTK needs.

    Palette and font of the application also reach widgets under a style sheet. Numbers have a decimal point
    until a language is installed that writes them otherwise.
    """
    sys.setswitchinterval(SWITCH_INTERVAL)
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_UseStyleSheetPropagationInWidgetStyles)
    QSurfaceFormat.setDefaultFormat(surface_format())
    QLocale.setDefault(QLocale(QLocale.Language.C))
    app = QApplication(list(arguments))
    app.setApplicationName("Regolith Studio")
    app.setDesktopFileName("regolith-studio")
    app.setWindowIcon(QIcon(str(resource("icons", "app.svg"))))
    return app


def close_on_interrupt(app: QApplication) -> None:
    """Let Ctrl+C close the window, also while it is idle.

    Python acts on a signal when it runs next in the main thread, and nothing runs there while Qt waits for
    events. So the signal writes to a socket, and Qt calls Python to read it. Closing is an event, which also
    waits for a loop that has not begun.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        return
    reading, writing = socket.socketpair()
    for end in (reading, writing):
        end.setblocking(False)
    signal.set_wakeup_fd(writing.fileno(), warn_on_full_buffer=False)
    notifier = QSocketNotifier(reading.fileno(), QSocketNotifier.Type.Read, app)
    notifier.activated.connect(lambda *_, ends=(reading, writing): ends[0].recv(1))
    signal.signal(signal.SIGINT, lambda *_: QTimer.singleShot(0, app.quit))


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
