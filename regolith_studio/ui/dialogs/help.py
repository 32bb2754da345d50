"""About the program."""

from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, metadata, version

from PySide6.QtCore import QObject, Qt, QUrl, Slot
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.ui.icons import pixmap
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import CITATION, heading, remark
from regolith_studio.version import __version__

PAPER = (
    "Geometry-Preserving Mesh Coarsening of Stochastically Generated Regolith Particles"
    " for Use in DEM Simulations"
)
"""The paper whose equations, figures, tables and sections the window names."""

LICENCE = "BSD-3-Clause"
COPYLEFT = ("PySide6-Essentials", "connected-components-3d")
"""Dependencies whose licences ask something of those who pass the program on with its libraries."""


def about_dialog(parent: QWidget, renderer: str) -> QDialog:
    """Version, purpose, the libraries that matter when something looks wrong, and licences."""
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
    text.addWidget(remark(_licences()))
    row = QHBoxLayout()
    row.setSpacing(16)
    row.addWidget(mark)
    row.addLayout(text, 1)
    return _closed(dialog, row)


class CitationLinks(QObject):
    """Opens the citation of the paper for every link of a label to it.

    Parameters
    ----------
    show
        Opens the dialog that cites the paper.
    """

    def __init__(self, show: Callable[[], object], parent: QObject) -> None:
        super().__init__(parent)
        self._show = show
        # PySide6 takes a text, not the bytes that its stubs declare
        QDesktopServices.setUrlHandler(QUrl(CITATION).scheme(), self, "open")  # type: ignore[arg-type]
        self.destroyed.connect(_follow_no_links)

    @Slot(QUrl)
    def open(self, _address: QUrl) -> None:
        """Show the citation."""
        self._show()


def _follow_no_links() -> None:
    QDesktopServices.unsetUrlHandler(QUrl(CITATION).scheme())


def _licences() -> str:
    others = ", ".join(f"{name} ({licence_of(name)})" for name in COPYLEFT)
    return tr(
        "Licence: {licence}. Libraries with other terms for those who pass them on: {others},"
        " FFTW in the wheels of pyshtools (GPL-2.0-or-later).",
        licence=LICENCE,
        others=others,
    )


def licence_of(name: str) -> str:
    """Licence of an installed package as its metadata state it: an expression, one line, or a classifier."""
    try:
        fields = metadata(name).json
    except PackageNotFoundError:
        return tr("(not installed)")
    stated = str(fields.get("license_expression") or fields.get("license") or "")
    if stated and "\n" not in stated:
        return stated
    classifiers = [each.split(" :: ") for each in fields.get("classifier", [])]
    return ", ".join(words[-1] for words in classifiers if words[0] == "License")


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
