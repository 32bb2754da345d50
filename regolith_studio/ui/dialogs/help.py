"""The guide, the tour, and what the program is and how it is cited."""

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, metadata, version

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, QSize, Qt, QUrl, Slot
from PySide6.QtGui import (
    QColor,
    QDesktopServices,
    QImage,
    QKeyEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QRegion,
    QTextDocument,
)
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.guide import chapter
from regolith_studio.resources import guide_folder, resource
from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.layout import STRETCH, dialog_buttons, hbox, named, room_on_screen, vbox
from regolith_studio.ui.theme import current_theme, pixmap
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import CITATION, heading, hint_label, with_subscripts
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
    dialog = named(QDialog(parent), "guide_dialog")
    dialog.setWindowTitle(tr("Guide"))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.resize(QSize(860, 680).boundedTo(room_on_screen(dialog)))
    text = GuideBrowser()
    contents, back = QPushButton(tr("Contents")), QPushButton(tr("Back"))
    contents.clicked.connect(lambda: text.show_chapter(CONTENTS))
    back.clicked.connect(text.backward)
    vbox((text, 1), hbox(contents, back, STRETCH, dialog_buttons(dialog)), parent=dialog, margins=None)
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
    dialog = named(QDialog(parent), "about_dialog")
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
    row = hbox(mark, (text, 1), spacing=16)
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
    vbox(content, dialog_buttons(dialog), parent=dialog, margins=None)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    return dialog


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return tr("(not installed)")


TOUR_SEEN = "tour_seen"
"""In the preferences of the window: that the tour need not start by itself any more."""
_WIDTH = 364
_GAP = 14


@dataclass(frozen=True)
class Step:
    """One step of the tour: its page, the object name of its widget, its text."""

    page: str
    target: str
    title: str
    text: str


def steps() -> tuple[Step, ...]:
    """All stops, in order."""
    entries = json.loads(resource("tour", "en.json").read_text(encoding="utf-8"))
    shown = ({**entry, "title": tr(entry["title"]), "text": tr(entry["text"])} for entry in entries)
    return tuple(Step(**entry) for entry in shown)


def start_tour(window: QWidget, go: Callable[[str], object], preferences: Preferences) -> "Tour":
    """Begin at the first stop, instead of a tour that is under way; `go` shows a page by its key."""
    for old in window.findChildren(Tour):
        old.finish()
    return Tour(window, go, preferences)


class Tour(QWidget):
    """A frame around the widget, and a bubble with text; the window stays usable."""

    def __init__(self, window: QWidget, go: Callable[[str], object], preferences: Preferences) -> None:
        super().__init__(window)
        self.setObjectName("tour")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._window, self._go, self._preferences = window, go, preferences
        self._steps, self._at = steps(), 0
        self._elsewhere = False
        self._spot = QRect()
        self._watched: QWidget | None = None
        self._bubble = named(QFrame(window), "tour_bubble", role="toast")
        self._bubble.setProperty("kind", "note")
        self._title, self._text, self._count = heading(""), QLabel(), hint_label()
        self._text.setWordWrap(True)
        self.back, self.next = QPushButton(tr("Back")), QPushButton(tr("Next"))
        self.end = QPushButton(tr("End tour"))
        for button, name in ((self.back, "tour_back"), (self.next, "tour_next"), (self.end, "tour_end")):
            button.setObjectName(name)
            button.setAutoDefault(True)  # the return key presses it, as in a dialog
        self._arrange()
        self.back.clicked.connect(lambda: self.go(self._at - 1))
        self.next.clicked.connect(lambda: self.go(self._at + 1))
        self.end.clicked.connect(self.finish)
        window.installEventFilter(self)
        self.go(0)
        self.next.setFocus()

    @property
    def at(self) -> int:
        """Number of the present stop, from 0."""
        return self._at

    def go(self, number: int) -> None:
        """Show another stop; past the last one the tour ends."""
        if number >= len(self._steps):
            self.finish()
            return
        self._at = max(0, number)
        step = self._steps[self._at]
        self._go(step.page)
        self._title.setText(with_subscripts(step.title))
        self._text.setText(with_subscripts(step.text))
        self._count.setText(tr("{at} of {total}", at=self._at + 1, total=len(self._steps)))
        self.back.setEnabled(self._at > 0)
        self.next.setText(tr("Done") if self._at == len(self._steps) - 1 else tr("Next"))
        self._bubble.setAccessibleName(f"{step.title}. {step.text}")
        self._place()

    def follow(self, page: str) -> None:
        """Hide the frame while another page than that of this stop is shown."""
        self._elsewhere = page != self._steps[self._at].page
        self._place()

    def finish(self) -> None:
        """End the tour, and remember that it was seen."""
        self._window.removeEventFilter(self)
        self._watch(None)
        self._preferences.window = self._preferences.window | {TOUR_SEEN: True}
        self._preferences.save()
        for widget in (self._bubble, self):
            widget.hide()
            widget.deleteLater()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize and watched in (self._window, self._watched):
            self._place()
        if isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape:
            self.finish()
        return super().eventFilter(watched, event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(current_theme().accent), 3))
        painter.drawRoundedRect(self._spot.adjusted(2, 2, -2, -2), 7, 7)
        painter.end()

    def target(self) -> QWidget | None:
        """What this stop is about, or the nearest part around it that can be seen."""
        widget = self._window.findChild(QWidget, self._steps[self._at].target)
        while widget is not None and not widget.isVisible():
            widget = widget.parentWidget()
        return None if widget is self._window else widget

    def _place(self) -> None:
        self.hide()  # beside views that draw by themselves a frame that only moves leaves its trace behind
        self.setGeometry(self._window.rect())
        target = self.target()
        self._watch(target)
        if target is None:
            self._spot = QRect(self.rect().center(), self.rect().center())
        else:
            self._spot = QRect(target.mapTo(self._window, QPoint(0, 0)), target.size()).adjusted(-5, -5, 5, 5)
        self._spot &= self.rect()
        ring = QRegion(self._spot) - QRegion(self._spot.adjusted(5, 5, -5, -5))
        self.setMask(ring)  # nothing but the frame is drawn over views that draw by themselves
        width = max(_WIDTH, self._bubble.minimumSizeHint().width())
        self._bubble.setFixedSize(width, max(90, self._bubble.heightForWidth(width)))
        self._bubble.move(_beside(self._spot, self._bubble.rect(), self.rect()))
        for widget in (self._bubble,) if self._elsewhere else (self, self._bubble):
            widget.show()
            widget.raise_()

    def _watch(self, target: QWidget | None) -> None:
        """Follow the size of what this stop is about: a tool bar above it may still change its height."""
        if target is not self._watched:
            if self._watched is not None:
                self._watched.removeEventFilter(self)
            if target is not None:
                target.installEventFilter(self)
            self._watched = target

    def _arrange(self) -> None:
        self._count.setWordWrap(False)
        row = hbox((self._count, 1), self.end, self.back, self.next)
        vbox(self._title, self._text, row, parent=self._bubble, margins=(16, 14, 16, 12), spacing=8)


def _beside(spot: QRect, bubble: QRect, room: QRect) -> QPoint:
    """Where the bubble stands: right of the spot, left of it, below, above, or in its middle."""
    width, height = bubble.width(), bubble.height()
    top = max(_GAP, min(spot.center().y() - height // 2, room.height() - height - _GAP))
    left = max(_GAP, min(spot.center().x() - width // 2, room.width() - width - _GAP))
    if spot.right() + _GAP + width < room.width():
        return QPoint(spot.right() + _GAP, top)
    if spot.left() - _GAP - width > 0:
        return QPoint(spot.left() - _GAP - width, top)
    if spot.bottom() + _GAP + height < room.height():
        return QPoint(left, spot.bottom() + _GAP)
    if spot.top() - _GAP - height > 0:
        return QPoint(left, spot.top() - _GAP - height)
    return QPoint(left, top)
