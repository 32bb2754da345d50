"""The guide that ships with the program, and where it describes each page of the window."""

import re

from PySide6.QtCore import Qt, QUrl
from PySide6.QtGui import QImage, QTextDocument
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QPushButton,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.guide import chapter
from regolith_studio.resources import guide_folder
from regolith_studio.ui.translation import tr

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
    return _REFERENCE.sub(lambda found: f"[{found[1] or found[2]}]({found[2]}.md)", plain)


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
