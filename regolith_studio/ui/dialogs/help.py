"""About the program."""

from importlib.metadata import PackageNotFoundError, version

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QVBoxLayout,
    QWidget,
)

from regolith_studio import __version__
from regolith_studio.ui.icons import pixmap
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import heading, remark

PAPER = (
    "Geometry-Preserving Mesh Coarsening of Stochastically Generated Regolith Particles"
    " for Use in DEM Simulations"
)
"""The paper whose equations, figures, tables and sections the window names."""


def about_dialog(parent: QWidget, renderer: str) -> QDialog:
    """Version, purpose, and the libraries that matter when something looks wrong."""
    dialog = QDialog(parent)
    dialog.setObjectName("about_dialog")
    dialog.setWindowTitle(tr("About Regolith Studio"))
    mark = QLabel()
    mark.setPixmap(pixmap("app", "#000000", 72))
    mark.setAlignment(Qt.AlignmentFlag.AlignTop)
    text = QVBoxLayout()
    text.addWidget(heading(f"Regolith Studio {__version__}"))
    purpose = tr("From X-ray micro-CT to DEM-ready regolith particles whose geometry is right.")
    text.addWidget(QLabel(purpose))
    names = ("PySide6-Essentials", "vtk", "pyvista", "pyqtgraph", "numpy", "numba")
    text.addWidget(remark(", ".join(f"{name} {_version(name)}" for name in names)))
    drawn = tr("drawn by OpenGL in the window") if renderer == "live" else tr("pictures, drawn off-screen")
    text.addWidget(remark(tr("Three-dimensional views: {how}", how=drawn)))
    source = remark(tr("After: {title}.", title=PAPER))
    source.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    text.addWidget(source)
    row = QHBoxLayout()
    row.setSpacing(16)
    row.addWidget(mark)
    row.addLayout(text, 1)
    return _closed(dialog, row)


def _closed(dialog: QDialog, content: QHBoxLayout) -> QDialog:
    buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, parent=dialog)
    buttons.rejected.connect(dialog.reject)
    layout = QVBoxLayout(dialog)
    layout.addLayout(content)
    layout.addWidget(buttons)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    return dialog


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return tr("(not installed)")
