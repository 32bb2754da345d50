"""The one application object; made before anything heavy is imported."""

from collections.abc import Sequence

from PySide6.QtCore import QCoreApplication, Qt
from PySide6.QtGui import QIcon, QSurfaceFormat
from PySide6.QtWidgets import QApplication

from regolith_studio.resources import resource
from regolith_studio.ui.views.factory import surface_format


def make_application(arguments: Sequence[str]) -> QApplication:
    """The one application object, with contexts shared between windows and the format that VTK needs."""
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
    QSurfaceFormat.setDefaultFormat(surface_format())
    app = QApplication(list(arguments))
    app.setApplicationName("Regolith Studio")
    app.setDesktopFileName("regolith-studio")
    app.setWindowIcon(QIcon(str(resource("icons", "app.svg"))))
    return app
