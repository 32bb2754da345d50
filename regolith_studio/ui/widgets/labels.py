"""Labels and their texts: headings, hints, elided text, symbols with subscripts, short numbers."""

import html
import re
from collections.abc import Sequence

from PySide6.QtCore import QEvent, QLocale, QObject, QSize, Qt
from PySide6.QtGui import QFocusEvent, QPainter, QPaintEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QLabel, QScrollArea, QSizePolicy, QToolButton, QVBoxLayout, QWhatsThis, QWidget

from regolith_studio.ui.layout import named
from regolith_studio.ui.translation import Markup, inert, localized, number_text, rich, tr

_TAG = re.compile(r"(<[^<>]*>)")
_CITED = re.compile(
    r"((?:Eq|Fig|Gl|Abb)\. \d+"
    r"|(?:Figures?|Bilder|Bild|Abbildung(?:en)?|Tab(?:le|elle)|[Ss]ection|Abschnitt) \d[\d.]*"
    r"(?: (?:and|und) \d+)?|\bthe paper\b|\b(?:im|des|der) Artikels?\b)"
)
"""References to the paper in the languages of the window."""
CITATION = "regolith:citation"
"""Address of the citation, see :class:`regolith_studio.ui.dialogs.help.CitationLinks`."""
_SYMBOL = re.compile(r"\b([lDA])_(min|max|l)\b")
_SUBSCRIPT = re.compile(r"([A-Za-zΨ])_([A-Za-z0-9]+)")
_WITH_SUBSCRIPT = "aehiklmnoprstx0123456789"
_SMALL = str.maketrans(_WITH_SUBSCRIPT, "ₐₑₕᵢₖₗₘₙₒₚᵣₛₜₓ₀₁₂₃₄₅₆₇₈₉")


def rich_symbol(text: str) -> Markup:
    """A symbol such as ``D_min`` as rich text with a real subscript."""
    return Markup(_SUBSCRIPT.sub(r"\1<sub>\2</sub>", html.escape(text)))


def plain_symbol(text: str) -> str:
    """A symbol such as ``D_min`` as plain text: with the subscripts of Unicode, or as it is without them.

    There is none for q, so that ``r_eq`` stays as it is.
    """
    return _SUBSCRIPT.sub(lambda match: match[1] + subscript(match[2]), text)


def subscript(text: str) -> str:
    """Plain text as a subscript where Unicode has all of its characters as such, else after an underscore."""
    return text.translate(_SMALL) if set(text) <= set(_WITH_SUBSCRIPT) else f"_{text}"


def with_subscripts(words: str) -> str:
    """Rich text in which symbols have subscripts; a text without symbols is returned unchanged."""
    text, count = _SYMBOL.subn(r"\1<sub>\2</sub>", rich(words))
    return Markup(text) if count else words


def unbroken(rich: str) -> str:
    """Rich text with non-breaking spaces between words."""
    return "".join(part if part.startswith("<") else part.replace(" ", "&nbsp;") for part in _TAG.split(rich))


def with_citations(words: str) -> str:
    """Rich text in which every reference to the paper is a link; a text without one is returned unchanged."""
    linked, count = _CITED.subn(rf'<a href="{CITATION}">\1</a>', rich(words))
    return Markup(linked) if count else inert(words)


class CitingLabel(QLabel):
    """A label whose references to the paper open its citation; Tab comes to them, and Return opens it."""

    def __init__(self, text: str = "") -> None:
        super().__init__()
        self.setOpenExternalLinks(True)
        self.setText(text)

    def setText(self, text: str) -> None:
        linked = with_citations(text)
        super().setText(linked)
        flag = Qt.TextInteractionFlag
        keys = flag.LinksAccessibleByKeyboard if "<a " in linked else flag.NoTextInteraction
        self.setTextInteractionFlags(flag.LinksAccessibleByMouse | keys)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Choose a link at once: Qt would wait for a second Tab."""
        super().focusInEvent(event)
        if event.reason() in (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason):
            self.focusNextPrevChild(event.reason() == Qt.FocusReason.TabFocusReason)

    def changeEvent(self, event: QEvent) -> None:
        """Lay the text out again in another palette: links keep the colour that they were laid out in."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            words = self.text()
            super().setText("")
            super().setText(words)


class _Heading(CitingLabel):
    """A wrapped heading.

    A part whose height depends on its width would let a column scroll where it could shrink.
    """

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.setWordWrap(True)

    def hasHeightForWidth(self) -> bool:
        return False

    def minimumSizeHint(self) -> QSize:
        return QSize(super().minimumSizeHint().width(), max(self.heightForWidth(self.width()), 0))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.updateGeometry()


def heading(text: str) -> QLabel:
    return named(_Heading(text), role="heading")


def hint_label(text: str = "", role: str = "hint") -> QLabel:
    """A wrapped text in a muted colour, or in that of a warning if `role` is ``warning``."""
    label = named(CitingLabel(text), role=role)
    label.setWordWrap(True)
    return label


NOTE_LINES = 2
"""Visible lines of a note between controls."""


class FixedHeightText(QScrollArea):
    """Labels with the height of a fixed number of lines, so that the controls below do not move.

    ``texts``: from top to bottom; hidden ones take no space. A button shows longer ones in full: a bar to
    scroll within a column that scrolls would take its wheel. ``lines``: visible at once; ``least``: the same
    where the window has no room for more.
    """

    def __init__(self, texts: Sequence[QLabel], lines: int = NOTE_LINES, least: int = 0) -> None:
        super().__init__()
        self._lines, self._least, self._inside = lines, least or lines, QWidget()
        self._texts, inside = tuple(texts), self._inside
        self.more = QToolButton(self)
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        for text in texts:
            text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
            text.installEventFilter(self)
            column.addWidget(text)
        column.addStretch(1)
        self.setProperty("role", "texts")
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAccessibleName(tr("Remarks"))
        self.more.setText("…")
        self.more.setAutoFillBackground(True)
        self.more.setAccessibleName(tr("Show the whole text"))
        self.more.setToolTip(tr("Show the whole text"))
        self.more.hide()
        self.more.clicked.connect(self.show_whole)
        self.verticalScrollBar().rangeChanged.connect(lambda _least, most: self.more.setVisible(most > 0))
        self.setWidget(inside)
        for part in (self.viewport(), inside):
            part.setAutoFillBackground(False)  # shows what is behind, which is lighter in tabs

    def show_whole(self) -> None:
        """Show the texts in full below their place, until something is clicked or typed."""
        words = [text.text() for text in self._texts if not text.isHidden()]
        shown = "<br>".join(each if _TAG.search(each) else rich(each) for each in words)
        QWhatsThis.showText(self.mapToGlobal(self.rect().bottomLeft()), shown, self)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        line = self._line
        part = (self.height() - 2 * self.frameWidth()) % line
        self.setViewportMargins(0, 0, 0, part)  # the tops of a further line would be seen there
        width = self.more.sizeHint().width()
        bottom = self.height() - self.frameWidth() - part
        self.more.setGeometry(self.width() - width, bottom - line, width, line)

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()  # it is for the column around

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched in self._texts and event.type() == QEvent.Type.FontChange:
            self.updateGeometry()
        return super().eventFilter(watched, event)

    def sizeHint(self) -> QSize:
        return QSize(super().sizeHint().width(), self._height(self._lines))

    def minimumSizeHint(self) -> QSize:
        return QSize(self._inside.minimumSizeHint().width(), self._height(self._least))

    def _height(self, lines: int) -> int:
        # the dots of Ä, Ö and Ü rise above what Qt takes for the height of a line
        return lines * self._line + 2 + 2 * self.frameWidth()

    @property
    def _line(self) -> int:
        """Height of a line of the texts, whose font may be larger than that of this widget."""
        for text in self._texts:
            text.ensurePolished()
        return max(text.fontMetrics().lineSpacing() for text in self._texts)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self.updateGeometry()


class WrappedLabel(QLabel):
    """A wrapped text whose minimum height holds all of its lines."""

    def __init__(self, text: str = "") -> None:
        super().__init__(inert(text))
        self.setWordWrap(True)
        self.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)

    def setText(self, text: str) -> None:
        super().setText(inert(text))

    def minimumSizeHint(self) -> QSize:
        return QSize(super().minimumSizeHint().width(), max(self.heightForWidth(self.width()), 0))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.updateGeometry()


class ElidedLabel(QWidget):
    """One line of plain text, elided if necessary, with the whole text as tool tip.

    ``role``: ``heading`` or ``hint_label``, for the style sheet. ``elide``: where it is elided: paths in the
    middle. ``by_parts``: parts behind a comma or semicolon that there is no room for are left out whole.
    """

    def __init__(
        self,
        text: str = "",
        role: str = "",
        *,
        elide: Qt.TextElideMode = Qt.TextElideMode.ElideRight,
        by_parts: bool = False,
    ) -> None:
        super().__init__()
        self._elide, self._by_parts = elide, by_parts
        self._text = ""
        self.setProperty("role", role)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setText(text)

    def text(self) -> str:
        return self._text

    def setText(self, text: str) -> None:
        if text != self._text:
            self._text = text
            self.setToolTip(inert(text))
            self.setAccessibleName(text)
            self.update()

    def sizeHint(self) -> QSize:
        metrics = self.fontMetrics()
        return QSize(metrics.horizontalAdvance(self._text) + 2, metrics.height() + 2)

    def minimumSizeHint(self) -> QSize:
        return QSize(20, self.fontMetrics().height() + 2)

    def shown_text(self) -> str:
        metrics, text = self.fontMetrics(), self._text
        while self._by_parts and metrics.horizontalAdvance(text) > self.width():
            end = max(text.rfind(", "), text.rfind("; "))
            if end < 0:
                break
            text = text[:end]
        return metrics.elidedText(text, self._elide, self.width())

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        painter = QPainter(self)
        shown = self.shown_text()
        flags = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        painter.setPen(self.palette().windowText().color())
        painter.drawText(self.rect(), int(flags), shown)
        painter.end()


def short_number(value: float, digits: int = 4) -> str:
    """`value` with so many significant digits: ``1.05e6``, not ``1.05e+06``; ``0.770``, not ``0.77``.

    Trailing zeros are kept, so that the numbers of a column can be compared.
    """
    text = localized(f"{value:#.{digits}g}")
    if "e" not in text:
        return text.rstrip(QLocale().decimalPoint())
    mantissa, _, exponent = text.partition("e")
    return f"{mantissa}e{int(exponent)}"


def grouped_number(value: float, digits: int = 4) -> str:
    """`value` with so many significant digits, its thousands apart: ``12,260``; from 1e8 on ``1.226e8``."""
    rounded = float(f"{value:.{digits}g}")
    if 10.0 ** (digits - 1) <= abs(rounded) < 1e8:
        return number_text(rounded, ",.0f")
    return short_number(value, digits)
