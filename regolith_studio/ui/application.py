"""The one application object; made before anything heavy is imported."""

import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any

from PySide6.QtCore import QCoreApplication, QLocale, Qt
from PySide6.QtGui import QIcon, QSurfaceFormat
from PySide6.QtWidgets import QApplication

from regolith_studio.jobs.thrift import share_one_heap
from regolith_studio.resources import resource
from regolith_studio.ui.asked_modules import load_when_asked
from regolith_studio.ui.views.factory import surface_format

NUMBERS = QLocale(QLocale.Language.C)
"""Numbers have a point in every language, as in the paper and in all files."""

IGNORED_FILES = ("numpy.f2py", "pooch", "scipy.fft", "scipy.ndimage", "scipy.optimize")
"""Modules that are imported and not asked at the start of a window, most never: for Fortran, for examples of
pyvista, for scans, and for bodies whose star point must be searched."""

TURN = 0.001
"""Seconds for which a thread that computes keeps the interpreter while that of the window waits for it.

Qt lets go of the interpreter at each call, so a page waited five milliseconds many times over: with one busy
thread going round the pages held the window for 0.63 s in all instead of 0.84.
"""


def make_application(arguments: Sequence[str]) -> QApplication:
    """The one application object, with contexts shared between windows and the format that VTK needs.

    Palette and font of the application reach widgets under a style sheet too, as they do all others.
    """
    share_one_heap()
    sys.setswitchinterval(TURN)
    leave_sources_unread()
    load_when_asked(IGNORED_FILES)
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_UseStyleSheetPropagationInWidgetStyles)
    QSurfaceFormat.setDefaultFormat(surface_format())
    QLocale.setDefault(NUMBERS)
    app = QApplication(list(arguments))
    app.setApplicationName("Regolith Studio")
    app.setDesktopFileName("regolith-studio")
    app.setWindowIcon(QIcon(str(resource("icons", "app.svg"))))
    return app


def leave_sources_unread() -> None:
    """Let PySide not read the source of every module that is imported from now on, and keep all of it.

    It looks there for the word PySide6, to know where names may be switched to ``snake_case``; nobody does
    that here. 80 MB less in the window. Where PySide has changed inside, nothing is done.
    """
    with suppress(ImportError):
        feature: Any = import_module("shibokensupport.feature")
        if callable(getattr(feature, "_mod_uses_pyside", None)):
            feature._mod_uses_pyside = lambda _module: False
