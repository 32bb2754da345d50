"""Texts of changing length in a fixed height, so that the controls below do not move."""

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QPoint, QSize, Qt, QTimer
from PySide6.QtGui import QResizeEvent
from PySide6.QtGui import Qt as QtOfText
from PySide6.QtWidgets import QLabel, QScrollArea, QSizePolicy, QToolButton, QVBoxLayout, QWhatsThis, QWidget

from regolith_studio.ui.translation import rich, tr

NOTE_LINES = 2
"""Visible lines of a note between controls."""
SIGN = "i"
ACCENTS = 2
"""Pixels above the first line: the dots of Ä, Ö and Ü rise above what Qt takes for the height of a line."""


class FixedHeightText(QScrollArea):
    """Labels with the height of a fixed number of lines; where they are longer, a button shows all.

    Parameters
    ----------
    texts
        From top to bottom; hidden ones take no space.
    lines
        Visible at once.
    """

    def __init__(self, texts: Sequence[QLabel], lines: int = NOTE_LINES) -> None:
        super().__init__()
        self._lines, self._texts = lines, tuple(texts)
        self._inside = QWidget()
        column = QVBoxLayout(self._inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        for text in texts:
            text.setContentsMargins(0, ACCENTS, 0, 0)
            text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
            column.addWidget(text)
        column.addStretch(1)
        self.setProperty("role", "texts")
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAccessibleName(tr("Remarks"))
        self.setWidget(self._inside)
        for part in (self.viewport(), self._inside):
            part.setAutoFillBackground(False)  # shows what is behind, which is lighter in tabs
        self.more = QToolButton(self)
        self.more.setObjectName("whole_text")
        self.more.setText(SIGN)
        self.more.setToolTip(tr("Show the whole text"))
        self.more.setAccessibleName(self.more.toolTip())
        self.more.clicked.connect(self._show_all)
        self.more.hide()
        self.verticalScrollBar().rangeChanged.connect(self._offer_more)

    @property
    def line(self) -> int:
        """Height of one line."""
        return self.fontMetrics().lineSpacing()

    def whole_text(self) -> str:
        """All that the visible labels say."""
        texts = [each.text() for each in self._texts if each.text() and not each.isHidden()]
        return "<br>".join(text if QtOfText.mightBeRichText(text) else rich(text) for text in texts)

    def sizeHint(self) -> QSize:
        return QSize(super().sizeHint().width(), self._lines * self.line + ACCENTS + 2 * self.frameWidth())

    def minimumSizeHint(self) -> QSize:
        button = self.more.sizeHint().width()
        return QSize(self._inside.minimumSizeHint().width() + button, self.sizeHint().height())

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self.updateGeometry()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._offer_more()

    def _offer_more(self, *_range: int) -> None:
        """Show the button only if a part of the text cannot be seen."""
        needed = self.verticalScrollBar().maximum() > 0
        size = QSize(self.more.sizeHint().width(), min(self.line + 4, self.height()))
        before, right = self.viewportMargins().right(), size.width() if needed else 0
        self.setViewportMargins(0, 0, right, 0)
        if right != before:  # Qt ignores a change of width while the texts are being laid out
            QTimer.singleShot(0, self, self._lay_out)
        self.more.resize(size)
        self.more.move(self.width() - size.width(), 0)
        self.more.setVisible(needed)

    def _lay_out(self) -> None:
        """Place the texts within the present width."""
        column = self._inside.layout()
        if column is not None:
            column.invalidate()
            column.activate()

    def _show_all(self) -> None:
        QWhatsThis.showText(self.mapToGlobal(QPoint(0, self.height())), self.whole_text(), self)
