"""Start the window: check the display, show a splash while the rest loads, make window and session."""

import gc
import os
import signal
import socket
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from psygnal import EmitLoopError
from PySide6.QtCore import QCoreApplication, QLocale, QObject, QSocketNotifier, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QFont,
    QGuiApplication,
    QIcon,
    QOffscreenSurface,
    QOpenGLContext,
    QPainter,
    QPixmap,
    QSurfaceFormat,
)
from PySide6.QtWidgets import QApplication, QLabel

from regolith_studio.errors import MissingRequirement, RegolithError
from regolith_studio.resources import resource
from regolith_studio.ui.theme import pixmap
from regolith_studio.version import __version__

if TYPE_CHECKING:  # the splash is shown before they are loaded
    from regolith_studio.session.preferences import Preferences
    from regolith_studio.ui.main_window import MainWindow

SWITCH_INTERVAL = 0.001
"""Seconds after which a computing thread hands the interpreter to the thread of the window.

Qt releases the interpreter at each call, so that the window waits for it often; Python's default is 5 ms.
"""
VARIABLE = "REGOLITH_STUDIO_VIEWS"
"""Environment variable that asks for ``live`` or ``image``."""
_WITHOUT_OPENGL = ("offscreen", "minimal", "vnc", "linuxfb")
_WITHOUT_DISPLAY = ("offscreen", "minimal", "vnc", "linuxfb", "eglfs")
FILLED_CHECK = 100
"""Milliseconds between two looks at whether the views of the first start are filled."""
FIRST_PAGE = "explore"
"""The page where the tour begins."""
IDLE, BUSY = 3_000, 60_000
"""Milliseconds without work, and at most, after which hidden pages forget closed particles."""
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


def best_kind() -> str:
    """``live`` where a window can hold an OpenGL 3.2 context, else ``image``, unless the variable says."""
    asked = os.environ.get(VARIABLE, "")
    if asked in ("live", "image"):
        return asked
    if QGuiApplication.platformName() in _WITHOUT_OPENGL:
        return "image"
    return "live" if _has_opengl() else "image"


def surface_format() -> QSurfaceFormat:
    """Desktop OpenGL 3.2 core, as VTK needs it; edges are smoothed by VTK, not by the window."""
    wanted = QSurfaceFormat()
    wanted.setRenderableType(QSurfaceFormat.RenderableType.OpenGL)
    wanted.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    wanted.setVersion(3, 2)
    wanted.setSwapBehavior(QSurfaceFormat.SwapBehavior.DoubleBuffer)
    wanted.setDepthBufferSize(8)
    wanted.setAlphaBufferSize(8)
    wanted.setStencilBufferSize(0)
    wanted.setSamples(0)
    return wanted


def _has_opengl() -> bool:
    surface = QOffscreenSurface()
    surface.setFormat(surface_format())
    surface.create()
    context = QOpenGLContext()
    context.setFormat(surface_format())
    works = context.create() and surface.isValid() and context.makeCurrent(surface)
    if works:
        works = context.format().version() >= (3, 2)
        context.doneCurrent()
    return bool(works)


def show_recovery_and_tour(window: "MainWindow") -> None:
    """Offer what a crash has left; start the tour at the first start, when there is something to see."""
    from regolith_studio.ui.dialogs.help import TOUR_SEEN

    if QApplication.activeModalWidget() is not None:  # asks for the unit of files that were given
        QTimer.singleShot(FILLED_CHECK, window, lambda: show_recovery_and_tour(window))
        return
    window.projects.offer_recovery()
    if window.preferences.window.get(TOUR_SEEN):
        return
    timer = QTimer(window, interval=FILLED_CHECK)

    def start_when_filled() -> None:
        filled = window.session.results.polyhedron is not None or not window.session.tasks
        if filled and QApplication.activeModalWidget() is None:  # else the question about a recovery is open
            timer.stop()
            if window.pages.current == FIRST_PAGE:  # else its user is at work already
                window.show_tour()

    timer.timeout.connect(start_when_filled)
    timer.start()


def open_window(
    paths: Sequence[str | Path] = (),
    unit: str | None = None,
    views: str | None = None,
    preferences: "Preferences | None" = None,
) -> "MainWindow":
    """A window with its own session; the particles arrive a moment later."""
    from regolith_studio.jobs.compile_kernels import compile_first
    from regolith_studio.jobs.events import Job
    from regolith_studio.jobs.runners.thread import ThreadRunner
    from regolith_studio.session.preferences import Preferences
    from regolith_studio.session.session import Session
    from regolith_studio.ui.main_window import MainWindow

    poster = MainThreadInvoker()
    runner = ThreadRunner(poster.post)
    runner.submit(Job(compile_first), lambda _event: None, "compile")
    session = Session(runner)
    files = [Path(path) for path in paths]
    if not files:
        session.open_sample()  # is read while the window is built
    window = MainWindow(session, preferences or Preferences.load(), views or best_kind())
    poster.setParent(window)
    if files:
        QTimer.singleShot(0, window, lambda: window.commands.open_paths(files, unit))
    _release_memory(window)
    return window


def _release_memory(window: "MainWindow") -> None:
    """Let hidden pages drop closed particles when nothing runs, so that their meshes are freed."""
    timer, latest = QTimer(window, singleShot=True, interval=IDLE), QTimer(window, interval=BUSY)
    for each in (timer, latest):
        each.timeout.connect(window.pages.refresh_hidden)
    latest.start()
    window.bindings.listen("tasks", lambda *_: timer.stop() if window.session.tasks else timer.start())


Hook = Callable[[type[BaseException], BaseException, TracebackType | None], Any]


def make_excepthook(report: Callable[[str, str], None]) -> Hook:
    """An excepthook that reports one sentence and keeps the program alive."""

    def hook(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        details = "".join(traceback.format_exception(kind, error, trace))
        print(details, file=sys.stderr)  # noqa: T201
        cause = error.__cause__ if isinstance(error, EmitLoopError) else None
        reason = cause or error  # psygnal wraps what a listener of the session raises
        if isinstance(reason, RegolithError):
            report(str(reason), details)
        else:
            from regolith_studio.ui.translation import tr

            name = type(reason).__name__
            report(tr("Internal error ({name}); the program continues.", name=name), details)

    return hook


Call = Callable[[], None]


class MainThreadInvoker(QObject):
    """``post`` may be called from any thread; the function runs soon, in order, where this object lives."""

    _posted = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._open = True
        self._posted.connect(self._run, Qt.ConnectionType.QueuedConnection)

    def post(self, call: Call) -> None:
        """Run `call` in the thread of the window; dropped when the window has closed."""
        if self._open:
            self._posted.emit(call)

    def close(self) -> None:
        self._open = False

    def _run(self, call: Call) -> None:
        if self._open:
            call()
