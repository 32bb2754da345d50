"""The guide, and what the program is and how it is cited."""

import re
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, metadata, version

from PySide6.QtCore import QObject, Qt, QUrl, Slot
from PySide6.QtGui import QDesktopServices, QImage, QTextDocument
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.guide import chapter
from regolith_studio.resources import guide_folder
from regolith_studio.ui.icons import pixmap
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import CITATION, heading, hint_label
from regolith_studio.version import __version__

PAGES = {
    "explore": "window",
    "sample": "window",
    "scan": "segmentation",
    "model": "shape_model",
    "studies": "studies",
    "dataset": "dataset",
    "repose": "repose",
    "lecture": "teaching",
}
"""Chapter of the guide on each page of the window."""
CONTENTS = "index"
MARGINS = 40
"""Pixels beside a picture."""
_REFERENCE = re.compile(r"\{doc\}`(?:([^`<]+?)\s*<)?([\w-]+)>?`")
_DOWNLOAD = re.compile(r"\{download\}`([^`<]+?)\s*<[^>]+>`")
_DIRECTIVE = re.compile(r"^(```|:::)\{.*?^\1\s*$", re.DOTALL | re.MULTILINE)


class GuideBrowser(QTextBrowser):
    """Shows a chapter; links lead to others, and to web pages outside."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("guide_text")
        self.setAccessibleName(tr("Guide"))
        self.setOpenExternalLinks(True)

    def show_chapter(self, name: str) -> None:
        """Show a chapter by the name of its file."""
        address = QUrl.fromLocalFile(str(guide_folder() / f"{name}.md"))
        self.setSource(address, QTextDocument.ResourceType.MarkdownResource)

    def loadResource(self, kind: int, name: QUrl | str) -> object:
        address = QUrl(name)
        if address.path().endswith(".md"):
            path = guide_folder() / address.fileName()
            return as_markdown(chapter(path.stem)) if path.exists() else ""
        if address.path().endswith(".png"):
            picture = QImage(str(guide_folder() / "images" / address.fileName()))
            room = self.viewport().width() - MARGINS
            return picture.scaledToWidth(
                min(room, picture.width()), Qt.TransformationMode.SmoothTransformation
            )
        return super().loadResource(kind, name)


def as_markdown(text: str) -> str:
    """A chapter without the directives of Sphinx, its references as links."""
    plain = _DOWNLOAD.sub(r"\1", _DIRECTIVE.sub("", text))
    return _REFERENCE.sub(lambda match: f"[{match[1] or match[2]}]({match[2]}.md)", plain)


def guide_dialog(parent: QWidget, page: str = "") -> QDialog:
    """The guide at the chapter of a page, or at its contents."""
    dialog = QDialog(parent)
    dialog.setObjectName("guide_dialog")
    dialog.setWindowTitle(tr("Guide"))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.resize(860, 680)
    text = GuideBrowser()
    contents, back = QPushButton(tr("Contents")), QPushButton(tr("Back"))
    contents.clicked.connect(lambda: text.show_chapter(CONTENTS))
    back.clicked.connect(text.backward)
    buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, parent=dialog)
    buttons.rejected.connect(dialog.reject)
    row = QHBoxLayout()
    row.addWidget(contents)
    row.addWidget(back)
    row.addStretch(1)
    row.addWidget(buttons)
    layout = QVBoxLayout(dialog)
    layout.addWidget(text, 1)
    layout.addLayout(row)
    text.show_chapter(PAGES.get(page, CONTENTS))
    return dialog


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
    text.addWidget(hint_label(", ".join(f"{name} {_version(name)}" for name in names)))
    drawn = tr("drawn by OpenGL in the window") if renderer == "live" else tr("pictures, drawn off-screen")
    text.addWidget(hint_label(tr("Three-dimensional views: {how}", how=drawn)))
    source = hint_label(tr("After: {title}.", title=PAPER))
    source.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    text.addWidget(source)
    text.addWidget(hint_label(_licences()))
    row = QHBoxLayout()
    row.setSpacing(16)
    row.addWidget(mark)
    row.addLayout(text, 1)
    return _closed(dialog, row)


class CitationLinks(QObject):
    """Opens the citation of the paper for every link of a label to it.

    ``show``: opens the dialog that cites the paper.
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
